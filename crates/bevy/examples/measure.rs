//! Measures what a frame costs and how far it is from full rate: the figures of the README.
//!
//! `cargo run --release --example measure -- SCENE MODE SCANPATH FRAMES [FOLDER]`
//!
//! SCENE: courtyard; small (the courtyard at 640x360); triangles (with a million triangles more); shadows (with two
//! lamps that have shadow maps); both (and the triangles cast shadows); cheap (both, without other lamps, so that
//! pixels are cheap); worst (cheap at 640x360); grille (the courtyard with thin bars and edges at slopes); grille-slow
//! (camera at a fifth of the speed); still (nothing moves). SCENE@WIDTHxHEIGHT has another size.
//!
//! MODE: full; prepass (full rate with depth and motion prepasses); msaa (full rate, Bevy's MSAA of 4); taa:SCALE
//! (Bevy's temporal antialiasing at SCALE of both sides, enlarged bilinearly); quads (foveated, the default);
//! quads:FOVEA_DEG:RATE_MID:RATE_FAR:BUDGET; uniform:SHARE (without a gaze); one of these with +aa (antialiased);
//! reference (full rate with four samples a pixel); deferred:MODE (one of these with a deferred camera, whose materials
//! are deferred).
//!
//! Prints medians of the frames: time from a frame's start until the device has finished it; CPU time of the process;
//! and on Linux CPU time of all but the software renderer's threads and the submission to it: what the application
//! itself costs. Systems run one after the other. With FOLDER writes the frames there as PNG, and the gaze as
//! `gaze.csv`.
//!
//! `cargo run --release --example measure -- psnr FOLDER REFERENCE`
//!
//! Prints PSNR of the frames in FOLDER against those in REFERENCE: of the whole frames, and within the fovea.

mod common;

use bevy::anti_alias::taa::TemporalAntiAliasing;
use bevy::core_pipeline::prepass::{DeferredPrepass, DepthPrepass, MotionVectorPrepass};
use bevy::ecs::schedule::{Schedules, SingleThreadedExecutor};
use bevy::pbr::DefaultOpaqueRendererMethod;
use bevy::prelude::*;
use bevy::render::RenderApp;
use bevy::render::renderer::{RenderGraph, RenderGraphSystems};
use bevy_afterimage::{Afterimage, AfterimageStats, Foveated, Gaze, Scanpath};
use common::crowd::CrowdPlugin;
use common::grille::GrillePlugin;
use common::headless::{FRAME, Headless, psnr_db, read_png, write_png};
use common::scene::{Mover, ScenePlugin, TONEMAPPING, stroll};
use rustix::time::{ClockId, clock_gettime};
use std::error::Error;
use std::path::Path;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Instant;

const LAMPS: usize = 12;
/// Before the mode of a deferred camera.
const DEFERRED: &str = "deferred:";
/// Start in the scanpath, in seconds.
const START_S: f64 = 1.0;
/// Radius of the fovea in heights of the view: 5 degrees of 45.
const FOVEA: f32 = 0.105;

/// A scene and how it is shown.
struct Scene {
    name: &'static str,
    size: UVec2,
    /// Frames before the clock starts.
    warm_up: usize,
    camera: Mover,
    extra: Extra,
}

/// What stands in the courtyard.
enum Extra {
    Nothing,
    Grille,
    Crowd(CrowdPlugin),
}

const LARGE: UVec2 = UVec2::new(1280, 720);
const SMALL: UVec2 = UVec2::new(640, 360);
const STILL: UVec2 = UVec2::new(320, 180);
/// 256 shapes of 4096 triangles.
const SIDE: usize = 16;

/// After six frames pipelines are compiled. History that antialiases is a mean of many frames.
const SCENES: [Scene; 10] = [
    Scene { name: "courtyard", size: LARGE, warm_up: 6, camera: Mover::Stroll, extra: Extra::Nothing },
    Scene { name: "small", size: SMALL, warm_up: 6, camera: Mover::Stroll, extra: Extra::Nothing },
    Scene { name: "triangles", size: LARGE, warm_up: 6, camera: Mover::Stroll, extra: crowd(SIDE, false, 0) },
    Scene { name: "shadows", size: LARGE, warm_up: 6, camera: Mover::Stroll, extra: crowd(0, true, 2) },
    Scene { name: "both", size: LARGE, warm_up: 6, camera: Mover::Stroll, extra: crowd(SIDE, true, 2) },
    Scene { name: "cheap", size: LARGE, warm_up: 6, camera: Mover::Stroll, extra: crowd(SIDE, true, 2) },
    Scene { name: "worst", size: SMALL, warm_up: 6, camera: Mover::Stroll, extra: crowd(SIDE, true, 2) },
    Scene { name: "grille", size: SMALL, warm_up: 30, camera: Mover::Stroll, extra: Extra::Grille },
    Scene { name: "grille-slow", size: SMALL, warm_up: 30, camera: Mover::Amble, extra: Extra::Grille },
    Scene { name: "still", size: STILL, warm_up: 63, camera: Mover::Stand, extra: Extra::Grille },
];

const fn crowd(side: usize, casts_shadows: bool, lamps: usize) -> Extra {
    Extra::Crowd(CrowdPlugin { side, casts_shadows, lamps })
}

fn ms(clock: ClockId) -> f64 {
    let time = clock_gettime(clock);
    1e3 * time.tv_sec as f64 + 1e-6 * time.tv_nsec as f64
}

/// CPU time of submissions so far, in nanoseconds. Software drivers draw in them.
static SUBMITTED_NS: AtomicU64 = AtomicU64::new(0);

/// CPU time of all threads but the software renderer's, less submissions. 0 where threads cannot be listed.
fn own_ms() -> f64 {
    let process = std::process::id().to_string();
    let own_name = std::fs::read_to_string("/proc/self/comm").unwrap_or_default();
    let entries = std::fs::read_dir("/proc/self/task").into_iter().flatten().flatten();
    let of_thread = |entry: std::fs::DirEntry| -> Option<f64> {
        let read = |file| std::fs::read_to_string(entry.path().join(file)).ok();
        let name = read("comm")?;
        // Bevy names its threads. The driver's have its own name, or that of the process.
        let is_driver = name == own_name && entry.file_name().to_str() != Some(&process);
        if is_driver || name.contains("llvmpipe") {
            return None;
        }
        read("schedstat")?.split(' ').next()?.parse().ok()
    };
    let all_ns: f64 = entries.filter_map(of_thread).sum();
    1e-6 * (all_ns - SUBMITTED_NS.load(Ordering::Relaxed) as f64)
}

/// Has systems run one after the other, on the main thread, and submissions timed.
fn run_in_order(app: &mut App) {
    let submit = |sign: f64| {
        move || {
            let now_ns = (sign * 1e6 * ms(ClockId::ThreadCPUTime)) as i64;
            SUBMITTED_NS.fetch_add(now_ns as u64, Ordering::Relaxed);
        }
    };
    let render = app.sub_app_mut(RenderApp);
    render.add_systems(
        RenderGraph,
        (
            submit(-1.0).after(RenderGraphSystems::Render).before(RenderGraphSystems::Submit),
            submit(1.0).after(RenderGraphSystems::Submit).before(RenderGraphSystems::Finish),
        ),
    );
    let in_order = |world: &mut World| {
        world.resource_mut::<Schedules>().iter_mut().for_each(|(_, schedule)| {
            schedule.set_executor(SingleThreadedExecutor::new());
        });
    };
    in_order(app.world_mut());
    in_order(app.sub_app_mut(RenderApp).world_mut());
}

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    match &arguments.iter().map(String::as_str).collect::<Vec<_>>()[..] {
        ["psnr", folder, reference] => score(Path::new(folder), Path::new(reference)),
        [scene, mode, scanpath, frames, folder @ ..] => {
            let names = SCENES.iter().map(|known| known.name).collect::<Vec<_>>().join(", ");
            let (name, size) = scene.split_once('@').map_or((*scene, None), |(name, size)| (name, Some(size)));
            let known = SCENES.into_iter().find(|known| known.name == name);
            let mut scene = known.ok_or_else(|| format!("SCENE is one of {names}"))?;
            if let Some(size) = size {
                let (width, height) = size.split_once('x').ok_or("a size is WIDTHxHEIGHT, in pixels")?;
                scene.size = UVec2::new(width.parse()?, height.parse()?);
            }
            let folder = folder.first().map(Path::new);
            measure(scene, mode, &Scanpath::read(scanpath)?, frames.parse()?, folder)
        }
        _ => Err("expected: SCENE MODE SCANPATH FRAMES [FOLDER], or psnr FOLDER REFERENCE".into()),
    }
}

fn measure(
    scene: Scene,
    mode: &str,
    scanpath: &Scanpath,
    frames: usize,
    folder: Option<&Path>,
) -> Result<(), Box<dyn Error>> {
    let kind = mode.strip_prefix(DEFERRED).unwrap_or(mode);
    let scale: f32 = match kind.strip_prefix("taa:") {
        Some(scale) => scale.parse()?,
        None if kind == "reference" => 2.0,
        None => 1.0,
    };
    let shown = scene.size;
    let size = (shown.as_vec2() * scale).round().as_uvec2();
    let lamps = if matches!(scene.name, "cheap" | "worst") { 0 } else { LAMPS };
    let courtyard = ScenePlugin { lamps, moves: scene.name != "still" };
    let is_deferred = kind != mode;
    let courtyard = (courtyard, move |app: &mut App| {
        if is_deferred {
            app.insert_resource(DefaultOpaqueRendererMethod::deferred());
        }
    });
    let mut headless = match scene.extra {
        Extra::Nothing => Headless::new(size, courtyard),
        Extra::Grille => Headless::new(size, (courtyard, GrillePlugin)),
        Extra::Crowd(crowd) => Headless::new(size, (courtyard, crowd)),
    };
    run_in_order(&mut headless.app);
    spawn_camera(&mut headless, scene.camera, mode)?;

    let mut times = vec![];
    let mut gazes = "frame,x_px,y_px\n".to_owned();
    let mut cameras = headless.app.world_mut().query::<&mut Camera>();
    for frame in 0..frames + scene.warm_up {
        if kind == "reference" {
            // It needs no warm-up, which would take long.
            cameras.single_mut(headless.app.world_mut())?.is_active = frame + 1 >= scene.warm_up;
        }
        let uv = scanpath.at(START_S + frame as f64 * FRAME.as_secs_f64());
        headless.app.world_mut().resource_mut::<Gaze>().set(uv);
        let (began_ms, began_own_ms, began) = (ms(ClockId::ProcessCPUTime), own_ms(), Instant::now());
        headless.frames(1);
        headless.wait();
        let Some(index) = frame.checked_sub(scene.warm_up) else { continue };
        let waited_ms = 1e3 * began.elapsed().as_secs_f64();
        times.push([waited_ms, ms(ClockId::ProcessCPUTime) - began_ms, own_ms() - began_own_ms]);
        if let Some(folder) = folder {
            let shot = resized(&headless.read(), size, shown);
            write_png(&folder.join(format!("{index:06}.png")), shown, &shot)?;
            let px = uv.map_or(Vec2::NAN, |uv| uv * shown.as_vec2() - 0.5);
            gazes += &format!("{index},{},{}\n", px.x, px.y);
        }
    }
    let [waited_ms, spent_ms, own_ms] = [0, 1, 2].map(|kind| {
        times.sort_by(|a, b| a[kind].total_cmp(&b[kind]));
        times.get(frames / 2).map_or(f64::NAN, |time| time[kind])
    });
    let (name, adapter) = (scene.name, headless.adapter());
    // Counting is not measured.
    let world = headless.app.world_mut();
    let cameras: Vec<Entity> = world.query_filtered::<Entity, With<Afterimage>>().iter(world).collect();
    cameras.iter().for_each(|&camera| {
        world.entity_mut(camera).insert(AfterimageStats::default());
    });
    (0..4).for_each(|_| {
        headless.frames(1);
        headless.wait();
    });
    let world = headless.app.world_mut();
    let shaded = world.query::<&AfterimageStats>().iter(world).next().map(|stats| stats.shaded);
    let share = shaded.map_or(100.0, |shaded| 100.0 * shaded as f64 / f64::from(size.element_product()));
    println!(
        "{name} {size}, {mode}: {waited_ms:.1} ms a frame, {spent_ms:.1} ms of CPU time, {own_ms:.2} ms without the \
         renderer's, {share:.1} % of the pixels shaded, {adapter}"
    );
    if let Some(folder) = folder {
        std::fs::write(folder.join("gaze.csv"), gazes)?;
    }
    headless.problems().first().map_or(Ok(()), |problem| Err(problem.as_str().into()))
}

fn spawn_camera(headless: &mut Headless, mover: Mover, mode: &str) -> Result<(), Box<dyn Error>> {
    let target = headless.render_target();
    let mut camera =
        headless.app.world_mut().spawn((Camera3d::default(), Msaa::Off, TONEMAPPING, target, stroll(0.0), mover));
    if mode.starts_with(DEFERRED) {
        camera.insert((DeferredPrepass, DepthPrepass));
    }
    let name = mode.strip_prefix(DEFERRED).unwrap_or(mode);
    let (name, antialias) = name.strip_suffix("+aa").map_or((name, false), |name| (name, true));
    let foveated = |foveated| (Afterimage { antialias, ..default() }, foveated);
    match name {
        "full" | "reference" => &mut camera,
        "prepass" => camera.insert((DepthPrepass, MotionVectorPrepass)),
        "msaa" => camera.insert(Msaa::Sample4),
        "quads" => camera.insert(foveated(Foveated::default())),
        _ if name.starts_with("taa:") => camera.insert(TemporalAntiAliasing::default()),
        _ => {
            let foveation = match name.split(':').collect::<Vec<_>>()[..] {
                ["uniform", share] => Foveated::uniform(share.parse()?),
                ["quads", fovea_deg, rate_mid, rate_far, budget] => Foveated {
                    fovea_deg: fovea_deg.parse()?,
                    rate_mid: rate_mid.parse()?,
                    rate_far: rate_far.parse()?,
                    budget: budget.parse()?,
                    ..default()
                },
                _ => {
                    return Err(format!(
                        "mode is {mode}: expected full, prepass, msaa, taa:SCALE, quads, \
                         quads:FOVEA_DEG:RATE_MID:RATE_FAR:BUDGET, uniform:SHARE, reference, or one that chooses \
                         quads with +aa; each also as deferred:MODE"
                    )
                    .into());
                }
            };
            camera.insert(foveated(foveation))
        }
    };
    Ok(())
}

/// Prints the PSNR of frames, over all of them.
fn score(folder: &Path, reference: &Path) -> Result<(), Box<dyn Error>> {
    let gazes = std::fs::read_to_string(folder.join("gaze.csv"))?;
    let (mut all, mut fovea) = ([vec![], vec![]], [vec![], vec![]]);
    for line in gazes.lines().skip(1) {
        let [index, x, y] = line.split(',').collect::<Vec<_>>()[..] else {
            return Err("gaze.csv: three columns".into());
        };
        let gaze = Vec2::new(x.parse()?, y.parse()?);
        let name = format!("{:06}.png", index.parse::<usize>()?);
        for (i, folder) in [folder, reference].into_iter().enumerate() {
            let (size, image) = read_png(&folder.join(&name))?;
            for (at, pixel) in image.chunks_exact(4).enumerate() {
                let px = UVec2::new(at as u32 % size.x, at as u32 / size.x).as_vec2();
                if px.distance(gaze) < FOVEA * size.y as f32 {
                    fovea[i].extend_from_slice(pixel);
                }
            }
            all[i].extend(image);
        }
    }
    let [all, fovea] = [all, fovea].map(|[shown, reference]| psnr_db(&shown, &reference));
    println!("{}: {all:.2} dB, {fovea:.2} dB within the fovea", folder.display());
    Ok(())
}

/// The image at the size that is shown: the mean of four pixels, or enlarged bilinearly; both in linear light.
fn resized(rgba: &[u8], from: UVec2, to: UVec2) -> Vec<u8> {
    if from == to {
        return rgba.to_vec();
    }
    let decode: Vec<f32> = (0..=255).map(|byte| Color::srgb_u8(byte, 0, 0).to_linear().red).collect();
    let pixel = |x: u32, y: u32, channel: usize| decode[usize::from(rgba[4 * (y * from.x + x) as usize + channel])];
    let encode = |linear: f32| (255.0 * Color::linear_rgb(linear, 0.0, 0.0).to_srgba().red).round() as u8;
    let ratio = from.as_vec2() / to.as_vec2();
    let mut shown = Vec::with_capacity(4 * to.element_product() as usize);
    for y in 0..to.y {
        for x in 0..to.x {
            let at = (UVec2::new(x, y).as_vec2() + 0.5) * ratio - 0.5;
            let low = at.floor();
            let part = at - low;
            let [x0, y0] = [low.x.max(0.0) as u32, low.y.max(0.0) as u32];
            let [x1, y1] = [((low.x + 1.0) as u32).min(from.x - 1), ((low.y + 1.0) as u32).min(from.y - 1)];
            for channel in 0..3 {
                let row = |y| pixel(x0, y, channel).lerp(pixel(x1, y, channel), part.x);
                shown.push(encode(row(y0).lerp(row(y1), part.y)));
            }
            shown.push(255);
        }
    }
    shown
}

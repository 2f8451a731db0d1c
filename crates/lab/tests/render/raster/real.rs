//! Every available scene: finite, and similar to the path tracer's image.

use super::rig::{device, draw};
use afterimage::Image;
use afterimage::kernel::color::srgb_encode;
use afterimage_lab::scene::{Environment, Scene, SceneLimits, builtin};
use afterimage_lab::source::{FrameSource, RasterSource, SceneCamera};
use afterimage_lab::trace::cpu::CpuTracer;
use afterimage_lab::trace::effects::{Effect, Effects};
use afterimage_lab::trace::film::Film;
use afterimage_lab::trace::settings::TraceSettings;
use afterimage_lab::trace::work;
use afterimage_lab::trace::world::World;
use std::path::PathBuf;

/// Folder of scenes that are not in the repository; if it is missing, prints that and returns `None`.
pub fn folder() -> Option<PathBuf> {
    let root = afterimage_testing::workspace();
    let places = ["shared/data/scenes", "../shared/data/scenes"];
    let found = places.iter().map(|p| root.join(p)).find(|p| p.is_dir());
    if found.is_none() {
        eprintln!("SKIPPED: no scenes in ../shared/data/scenes");
    }
    found
}

fn shown(image: &Image<[f32; 3]>) -> Image<[f32; 3]> {
    image.map(|c| c.map(|v| srgb_encode((v / (1.0 + v)).clamp(0.0, 1.0))))
}

fn psnr(a: &Image<[f32; 3]>, b: &Image<[f32; 3]>) -> f64 {
    let squares: f64 =
        a.pixels().iter().zip(b.pixels()).flat_map(|(a, b)| (0..3).map(move |i| f64::from(a[i] - b[i]).powi(2))).sum();
    -10.0 * (squares / (3 * a.pixels().len()) as f64).log10()
}

/// PSNR of the tone-mapped image against 16 paths per pixel; `None` without a device. Panics if the frame is not
/// finite.
fn likeness(input: &str) -> Option<f64> {
    let device = device()?;
    let mut scene = Scene::open(input, &SceneLimits::default()).unwrap();
    let needs = Effects::needed(&scene);
    if ![Effect::EmissiveTriangles, Effect::PunctualLights, Effect::Environment].iter().any(|&e| needs.has(e)) {
        scene.environment = Environment::Constant([1.0; 3]);
    }
    let size = [160, 90];
    let view = SceneCamera::choose(&scene, None, size, None).unwrap().view(&scene, 0, 0.0);
    let frame = draw(&device, &scene, [&view; 2], [0.0; 2]);
    assert!(frame.color.pixels().iter().flatten().all(|v| v.is_finite() && *v >= 0.0), "{input}");
    assert!(frame.motion.pixels().iter().flatten().all(|v| v.is_finite()), "{input}");
    assert!(frame.distance.pixels().iter().all(|v| *v > 0.0), "{input}");
    let world = World::new(&scene);
    let mut film = Film::new(size);
    CpuTracer::new(TraceSettings::default()).trace(
        &world,
        &view,
        0,
        &work::uniform(size[0], 0..size[1], 0..16),
        &mut film,
    );
    let psnr = psnr(&shown(&frame.color), &shown(&film.color()));
    println!("{input}: {psnr:.1} dB");
    if input == "builtin:courtyard" {
        // Planted errors: a black image, and the image upside down.
        let (h, traced) = (size[1] as usize, shown(&film.color()));
        let turned = Image::from_fn(size, |[x, y]| frame.color.at(x as usize, h - 1 - y as usize));
        for wrong in [Image::filled(size, [0.0; 3]), shown(&turned)] {
            let db = self::psnr(&wrong, &traced);
            assert!(db < ALIKE_DB, "{db:.1} dB");
        }
    }
    Some(psnr)
}

/// Indirect light and sky occlusion are estimates, so images are similar, not equal. Half of the image black instead of
/// white gives 3 dB; everything off by a quarter of white, as when twice too bright, gives 12 dB.
const ALIKE_DB: f64 = 12.0;

#[test]
fn builtin_scenes_look_like_traced_ones() {
    for name in builtin::NAMES {
        let Some(db) = likeness(&format!("builtin:{name}")) else { return };
        assert!(db > ALIKE_DB, "{name}: {db:.1} dB");
    }
}

#[test]
fn files_look_like_traced_ones() {
    let Some(folder) = folder() else { return };
    let mut files: Vec<_> = std::fs::read_dir(folder)
        .unwrap()
        .flat_map(|e| std::fs::read_dir(e.unwrap().path()).unwrap())
        .map(|e| e.unwrap().path())
        .collect();
    files.retain(|p| p.extension().is_some_and(|e| e == "gltf" || e == "glb"));
    files.sort();
    assert!(files.len() >= 9);
    for file in files {
        let Some(db) = likeness(file.to_str().unwrap()) else { return };
        assert!(db > ALIKE_DB, "{}: {db:.1} dB", file.display());
    }
}

/// The previous frame warped by the motion vectors matches this frame wherever the surface was visible: bilinear,
/// distances within 2 %.
#[test]
fn vectors_explain_the_next_frame() {
    let (Some(device), Some(folder)) = (device(), folder()) else { return };
    let scene = Scene::open(folder.join("sponza/sponza.gltf").to_str().unwrap(), &SceneLimits::default()).unwrap();
    let size = [640, 360];
    let file = folder.join("../sequences/sponza_lateral/cameras.json");
    let camera = SceneCamera::choose(&scene, file.to_str(), size, None).unwrap();
    let mut source = RasterSource::new(device, scene, camera, None, super::rig::FAST).unwrap();
    let frames = [3, 4].map(|i| source.frame(i).unwrap());
    let [before, now] = [&frames[0], &frames[1]];
    let (motion, depth, previous) =
        (now.motion.as_ref().unwrap(), now.depth.as_ref().unwrap(), before.depth.as_ref().unwrap());
    let [was, is] = [before, now].map(|f| f.color.map(|c| c.map(|v| srgb_encode(v.clamp(0.0, 1.0)))));
    let row = now.previous_from_current.unwrap()[2];
    let (mut with, mut without, mut count) = (0.0, 0.0, 0);
    for y in 0..size[1] as usize {
        for x in 0..size[0] as usize {
            let m = motion.at(x, y);
            let (px, py) = (x as f32 + m[0], y as f32 + m[1]);
            let (i, j) = (px.floor(), py.floor());
            if !(i >= 0.0 && j >= 0.0 && i + 1.0 < size[0] as f32 && j + 1.0 < size[1] as f32) {
                continue;
            }
            let (s, t, i, j) = (px - i, py - j, i as usize, j as usize);
            let ray = source.views(4).0[0].geometry().ray([x as f32, y as f32]);
            let z = depth.at(x, y);
            let expected = (row[0] * ray[0] + row[1] * ray[1] + row[2]) * z + row[3];
            let four = [(i, j), (i + 1, j), (i, j + 1), (i + 1, j + 1)];
            if !four.iter().all(|&(i, j)| (previous.at(i, j) / expected - 1.0).abs() < 0.02) {
                continue;
            }
            for c in 0..3 {
                let v = four.map(|(i, j)| was.at(i, j)[c]);
                let top = v[0] + (v[1] - v[0]) * s;
                let bottom = v[2] + (v[3] - v[2]) * s;
                with += f64::from(top + (bottom - top) * t - is.at(x, y)[c]).powi(2);
                without += f64::from(was.at(x, y)[c] - is.at(x, y)[c]).powi(2);
            }
            count += 3;
        }
    }
    let db = |sum: f64| -10.0 * (sum / count as f64).log10();
    println!("explained {:.2} dB, without vectors {:.2} dB, {count} values", db(with), db(without));
    assert!(count > size[0] as usize * size[1] as usize * 2);
    assert!(db(with) >= 35.0 && db(without) < db(with) - 6.0);
}

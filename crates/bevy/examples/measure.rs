//! Measures what a frame costs and how far it is from full rate: the figures of the README.
//!
//! `cargo run --release --example measure -- MODE SCANPATH FRAMES [FOLDER]`
//!
//! MODE: full, prepass (full rate with a depth prepass), quad, sparse, sparse48 (rates of 4 and 8), taa:SCALE (Bevy's
//! temporal antialiasing at SCALE of both sides, enlarged bilinearly), reference (full rate with four samples a pixel).
//! Prints CPU time of the process per frame. With FOLDER writes the frames there as PNG, and the gaze as `gaze.csv`;
//! the time then includes that.

mod common;

use bevy::anti_alias::taa::TemporalAntiAliasing;
use bevy::core_pipeline::prepass::DepthPrepass;
use bevy::prelude::*;
use bevy_afterimage::{Afterimage, Foveated, FoveationKind, Gaze, Scanpath};
use common::headless::{FRAME, Headless, write_png};
use common::scene::{Mover, ScenePlugin, TONEMAPPING, stroll};
use rustix::time::{ClockId, clock_gettime};
use std::error::Error;
use std::path::Path;

const SIZE: UVec2 = UVec2::new(1280, 720);
/// Frames before the clock starts: compilation of pipelines, first history.
const WARM_UP: usize = 6;
const LAMPS: usize = 12;
/// Start in the scanpath, in seconds.
const START_S: f64 = 1.0;

fn cpu_ms() -> f64 {
    let time = clock_gettime(ClockId::ProcessCPUTime);
    1e3 * time.tv_sec as f64 + 1e-6 * time.tv_nsec as f64
}

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [mode, scanpath, frames, folder @ ..] = &arguments[..] else {
        return Err("expected: MODE SCANPATH FRAMES [FOLDER]".into());
    };
    let (scanpath, frames, folder) =
        (Scanpath::read(scanpath)?, frames.parse::<usize>()?, folder.first().map(Path::new));
    let scale: f32 = match mode.strip_prefix("taa:") {
        Some(scale) => scale.parse()?,
        None if mode == "reference" => 2.0,
        None => 1.0,
    };
    let size = (SIZE.as_vec2() * scale).round().as_uvec2();
    let mut headless = Headless::new(size, ScenePlugin { lamps: LAMPS, moves: true });
    let target = headless.render_target();
    let mut camera = headless.app.world_mut().spawn((
        Camera3d::default(),
        Msaa::Off,
        TONEMAPPING,
        target,
        stroll(0.0),
        Mover::Stroll,
    ));
    let foveated = |kind, [rate_mid, rate_far]: [u32; 2]| {
        (Afterimage::default(), Foveated { kind, rate_mid, rate_far, ..default() })
    };
    match mode.as_str() {
        "full" | "reference" => &mut camera,
        "prepass" => camera.insert(DepthPrepass),
        "quad" => camera.insert(foveated(FoveationKind::QuadViews, [2, 4])),
        "sparse" => camera.insert(foveated(FoveationKind::Sparse, [2, 4])),
        "sparse48" => camera.insert(foveated(FoveationKind::Sparse, [4, 8])),
        _ if mode.starts_with("taa:") => camera.insert(TemporalAntiAliasing::default()),
        _ => {
            return Err(format!(
                "mode is {mode}: expected full, prepass, quad, sparse, sparse48, taa:SCALE or reference"
            )
            .into());
        }
    };

    let mut began = cpu_ms();
    let mut gazes = "frame,x_px,y_px\n".to_owned();
    for frame in 0..frames + WARM_UP {
        if frame == WARM_UP {
            headless.wait();
            began = cpu_ms();
        }
        let uv = scanpath.at(START_S + frame as f64 * FRAME.as_secs_f64());
        headless.app.world_mut().resource_mut::<Gaze>().set(uv);
        headless.frames(1);
        if let Some((folder, index)) = folder.zip(frame.checked_sub(WARM_UP)) {
            let shot = resized(&headless.read(), size);
            write_png(&folder.join(format!("{index:06}.png")), SIZE, &shot)?;
            let px = uv.map_or(Vec2::NAN, |uv| uv * SIZE.as_vec2() - 0.5);
            gazes += &format!("{index},{},{}\n", px.x, px.y);
        }
    }
    headless.wait();
    println!("{mode}: {:.1} ms of CPU time a frame, {}", (cpu_ms() - began) / frames as f64, headless.adapter());
    if let Some(folder) = folder {
        std::fs::write(folder.join("gaze.csv"), gazes)?;
    }
    headless.problems().first().map_or(Ok(()), |problem| Err(problem.as_str().into()))
}

/// The image at the size that is shown: the mean of four pixels, or enlarged bilinearly; both in linear light.
fn resized(rgba: &[u8], from: UVec2) -> Vec<u8> {
    if from == SIZE {
        return rgba.to_vec();
    }
    let decode: Vec<f32> = (0..=255).map(|byte| Color::srgb_u8(byte, 0, 0).to_linear().red).collect();
    let pixel = |x: u32, y: u32, channel: usize| decode[usize::from(rgba[4 * (y * from.x + x) as usize + channel])];
    let encode = |linear: f32| (255.0 * Color::linear_rgb(linear, 0.0, 0.0).to_srgba().red).round() as u8;
    let ratio = from.as_vec2() / SIZE.as_vec2();
    let mut shown = Vec::with_capacity(4 * SIZE.element_product() as usize);
    for y in 0..SIZE.y {
        for x in 0..SIZE.x {
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

//! Rasterises, foveates and enhances a scene: prints retention, and writes the images of a rasterised frame.
//!
//! `cargo run --release -p afterimage-lab --example 09_raster_scene [SCENE [FRAMES [OUT.png]]]`; SCENE is a .gltf or
//! .glb file, or builtin:NAME (default builtin:cubes). Needs an adapter; a software one is enough.

use afterimage::internal::{Foveation, Method, Settings};
use afterimage::kernel::color::srgb_encode;
use afterimage::{Image, ViewGeometry};
use afterimage_lab::device::{Backend, Headless};
use afterimage_lab::metric::{References, Scorer, encode};
use afterimage_lab::picture::{to_rgb8, write_png};
use afterimage_lab::pipeline::{Pipeline, RunKind};
use afterimage_lab::source::{FrameSource, RasterSource, ReadLimits, SceneOptions};
use std::path::Path;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let input = args.first().map_or("builtin:cubes", String::as_str);
    let frames: u64 = args.get(1).map_or(Ok(30), |n| n.parse())?;
    let device = Headless::find_roomy(true).ok_or("there is no adapter; install mesa-vulkan-drivers")?;
    let options = SceneOptions { size: Some([480, 270]), ..Default::default() };
    let mut source = RasterSource::open(input, &ReadLimits::default(), &options, None, device.clone())?;
    let info = source.info().clone();
    let geometry = ViewGeometry::flat(info.size, info.hfov_deg.unwrap_or(70.0))?;

    let runs = [
        ("none", Settings { method: Method::None, ..Settings::default() }),
        ("taa", Settings { method: Method::Taa, ..Settings::default() }),
        ("smr", Settings::default()),
    ];
    let kinds = runs.map(|run| RunKind::PostProcess(run.1));
    let backend = Backend::Gpu(device);
    let mut pipeline = Pipeline::new(geometry, Foveation::default(), &kinds, info.still, &[], &backend)?;
    let mut scorers = runs.map(|_| Scorer::default());
    let mut references = References::default();
    let mut sheet = vec![];
    for index in 0..frames {
        // The gaze moves over the frame from left to right and back.
        let t = 0.5 - 0.5 * (index as f32 * 0.15).cos();
        let gaze = [(0.2 + 0.6 * t) * info.size[0] as f32, 0.5 * info.size[1] as f32];
        let frame = source.render(&pipeline.request(index, Some(gaze)))?;
        let step = pipeline.step(&frame)?;
        let full = encode(&frame.reference.color, 0.0);
        let reference = references.next(&full, &step.tracked, &step.ecc_deg);
        for (scorer, shown) in scorers.iter_mut().zip(&step.outputs) {
            scorer.push(&reference, &encode(&shown.image, 0.0), &step.tracked, &step.ecc_deg);
        }
        if index + 1 == frames {
            let moves = frame.reference.motion.as_ref().map_or(0.0, |m| {
                let seen = m.pixels().iter().filter(|v| v[0].abs() < 1e5);
                seen.map(|v| v[0].hypot(v[1])).fold(0.0, f32::max)
            });
            println!("{}, {}x{}: fastest {moves:.1} px a frame", info.name, info.size[0], info.size[1]);
            sheet = vec![frame.reference.color.clone(), step.outputs[0].image.clone(), step.outputs[2].image.clone()];
        }
    }
    println!("method  PSNR dB  retained dB");
    for ((name, _), scorer) in runs.iter().zip(&scorers) {
        let scores = scorer.scores();
        let db = |v: Option<f64>| v.map_or("-".into(), |v| format!("{v:.2}"));
        println!("{name:6} {:>8} {:>12}", db(scores.whole.psnr_db), db(scores.retained_psnr_db));
    }
    if let Some(path) = args.get(2) {
        let picture = beside(&sheet).map(|c| c.map(|v| srgb_encode(v.clamp(0.0, 1.0))));
        write_png(Path::new(path), &to_rgb8(&picture))?;
        println!("{path}: reference, foveated, smr");
    }
    Ok(())
}

/// Images of one size side by side, the first on the left.
fn beside(images: &[Image<[f32; 3]>]) -> Image<[f32; 3]> {
    let [w, h] = images[0].size();
    Image::from_fn([w * images.len() as u32, h], |[x, y]| images[(x / w) as usize].at((x % w) as usize, y as usize))
}

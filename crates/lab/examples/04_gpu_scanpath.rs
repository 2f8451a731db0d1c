//! A recorded scanpath over a still on a GPU: the foveated frame, and the output of the post-process.
//!
//! `cargo run -p afterimage-lab --example 04_gpu_scanpath [INPUT [SCANPATH.csv]]`; writes `out/04_gpu_scanpath.png`

use afterimage::internal::{Foveation, Method, Settings};
use afterimage::{Image, ViewGeometry};
use afterimage_lab::device::{Backend, Headless};
use afterimage_lab::metric::encode;
use afterimage_lab::picture::{to_rgb8, write_png};
use afterimage_lab::pipeline::{Pipeline, RunKind};
use afterimage_lab::scanpath::{FrameGaze, GazeMap, read_csv};
use afterimage_lab::source;
use afterimage_lab::source::{ReadLimits, SceneOptions};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut args = std::env::args().skip(1);
    let input = args.next().unwrap_or("analytic:still".into());
    let scanpath = args.next().unwrap_or("fixtures/scanpath_viewing.csv".into());
    let gpu = Headless::find(true).ok_or("no adapter")?;
    println!("on {}", gpu.info.name);

    let scene = SceneOptions { size: Some([480, 270]), ..SceneOptions::default() };
    let mut source = source::open(&input, &ReadLimits::default(), &scene)?;
    let info = source.info().clone();
    let geometry = ViewGeometry::flat(info.size, info.hfov_deg.unwrap_or(70.0))?;
    let path = read_csv(&scanpath)?;
    let gaze = FrameGaze::new(&path, &geometry, GazeMap::default_for(path.screen()), 0.0, 60.0)?;

    // Without the gate: on a still it can only lose detail.
    let none = Settings { method: Method::None, ..Settings::default() };
    let runs = [none, Settings::default()].map(RunKind::PostProcess);
    let foveation = Foveation { rate_mid: 4, rate_far: 8, ..Foveation::default() };
    let mut pipeline = Pipeline::new(geometry, foveation, &runs, info.still, &[], &Backend::Gpu(gpu))?;
    let mut last = None;
    for index in 0..120 {
        let frame = source.render(&pipeline.request(index, gaze.px(index)))?;
        let step = pipeline.step(&frame)?;
        if index % 20 == 19 {
            let stats = step.outputs[1].stats;
            let [x, y] = step.gaze_px;
            println!(
                "frame {index:3}: eye at ({x:3.0}, {y:3.0}), {:4.1} % of all samples replaced, {:.1} ms",
                100.0 * stats.replaced as f64 / stats.pixels as f64,
                step.outputs[1].elapsed.wall_ms
            );
        }
        last = Some(step);
    }

    // Foveated above, output below; a black and white square marks the last gaze.
    let step = last.ok_or("no frame")?;
    let [width, height] = info.size;
    let both = Image::from_fn([width, 2 * height], |[x, y]| {
        let away = [x as f32 - step.gaze_px[0], (y % height) as f32 - step.gaze_px[1]].map(f32::abs);
        match away[0].max(away[1]) {
            0.0..3.0 => [1.0; 3],
            3.0..5.0 => [0.0; 3],
            _ => step.outputs[(y / height) as usize].image.at(x as usize, (y % height) as usize),
        }
    });
    std::fs::create_dir_all("out")?;
    write_png("out/04_gpu_scanpath.png".as_ref(), &to_rgb8(&encode(&both, 0.0)))?;
    println!("foveated above, enhanced below: out/04_gpu_scanpath.png");
    Ok(())
}

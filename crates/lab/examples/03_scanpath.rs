//! Follow a recorded scanpath over your own frames, and score the result.
//!
//! `cargo run --release -p afterimage-lab --example 03_scanpath [INPUT [SCANPATH.csv]]`

use afterimage::ViewGeometry;
use afterimage::internal::{Foveation, Method, Settings};
use afterimage_lab::device::Backend;
use afterimage_lab::metric::{References, Scorer, encode};
use afterimage_lab::pipeline::{Pipeline, RunKind};
use afterimage_lab::scanpath::{FrameGaze, GazeMap, read_csv};
use afterimage_lab::source;
use afterimage_lab::source::{ReadLimits, SceneOptions};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut args = std::env::args().skip(1);
    let input = args.next().unwrap_or("fixtures/text_page.png".into());
    let scanpath = args.next().unwrap_or("fixtures/scanpath_viewing.csv".into());

    let mut source = source::open(&input, &ReadLimits::default(), &SceneOptions::default())?;
    let info = source.info().clone();
    let geometry = ViewGeometry::flat(info.size, info.hfov_deg.unwrap_or(70.0))?;
    let path = read_csv(&scanpath)?;
    let map = GazeMap::default_for(path.screen());
    let gaze = FrameGaze::new(&path, &geometry, map, 0.0, 60.0)?;

    let foveation = Foveation { rate_mid: 4, rate_far: 8, ..Foveation::default() };
    let none = Settings { method: Method::None, ..Settings::default() };
    let runs = [none, Settings::default()].map(RunKind::PostProcess);
    let mut pipeline = Pipeline::new(geometry, foveation, &runs, info.still, &[], &Backend::Cpu)?;
    let mut scorers = [Scorer::default(), Scorer::default()];
    let mut references = References::default();
    for index in 0..60 {
        let frame = source.render(&pipeline.request(index, gaze.px(index)))?;
        let step = pipeline.step(&frame)?;
        let full = encode(&frame.reference.color, 0.0);
        let reference = references.next(&full, &step.tracked, &step.ecc_deg);
        for (scorer, shown) in scorers.iter_mut().zip(&step.outputs) {
            scorer.push(&reference, &encode(&shown.image, 0.0), &step.tracked, &step.ecc_deg);
        }
    }
    for (name, scorer) in ["none", "wrs"].iter().zip(&scorers) {
        let s = scorer.scores();
        println!(
            "{name:5} PSNR {:.2} dB, SSIM {:.4}, of what was seen sharp before {:.2} dB",
            s.whole.psnr_db.unwrap_or(f64::NAN),
            s.whole.ssim.unwrap_or(f64::NAN),
            s.retained_psnr_db.unwrap_or(f64::NAN)
        );
    }
    Ok(())
}

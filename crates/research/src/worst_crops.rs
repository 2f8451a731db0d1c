//! Finds the crops of 64x64 pixels in which a method is worst against the foveated frame, over clips, scanpaths,
//! filters and rates.
//!
//! `cargo research worst-crops FRAMES SCANPATH.csv[,...] INPUT...`; INPUT as for
//! `afterimage run`. Scenes (`builtin:NAME`, .gltf, .glb) are rasterised, which needs an adapter; a software one is
//! enough.
//!
//! Makes tables of `docs/method.md` and `docs/metrics.md`.

use crate::error::AnyError;
use afterimage::internal::{Foveation, FoveationKind, MethodKind, Settings};
use afterimage::{FrameError, ViewGeometry};
use afterimage_lab::device::{Backend, Headless};
use afterimage_lab::frame::RenderedFrame;
use afterimage_lab::metric::{Crops, encode};
use afterimage_lab::pipeline::{Pipeline, RunKind};
use afterimage_lab::scanpath::{FrameGaze, GazeMap, read_csv};
use afterimage_lab::source::{self, FrameRequest, FrameSource, RasterSource, ReadLimits, SceneOptions};
use clap::Args;
use rayon::prelude::*;

/// Size of analytic and rasterised frames in pixels.
const SIZE: [u32; 2] = [480, 270];
const RATES: [[u32; 2]; 3] = [[2, 4], [4, 8], [8, 16]];
/// Start of the clips in the scanpaths, in seconds.
const START_S: f64 = 1.0;

const METHODS: [(&str, MethodKind); 4] =
    [("taa", MethodKind::Taa), ("taau", MethodKind::Taau), ("wrs", MethodKind::Wrs), ("smr", MethodKind::Smr)];

/// A clip with a gaze and a foveation.
struct Row {
    name: String,
    gaze: FrameGaze,
    pipeline: Pipeline,
    crops: [Crops; METHODS.len()],
}

/// The crops of 64x64 pixels in which a method is worst against the foveated frame
#[derive(Args, Clone, Debug)]
pub struct WorstCropsArgs {
    /// Frames of each clip
    #[arg(value_parser = clap::value_parser!(u64).range(1..=100_000))]
    pub frames: u64,
    /// Scanpaths, separated by commas
    #[arg(required = true, value_name = "SCANPATH.csv", value_delimiter = ',', num_args = 1)]
    pub scanpaths: Vec<String>,
    /// Clips and scenes, as for `afterimage run`
    #[arg(required = true, value_name = "INPUT")]
    pub inputs: Vec<String>,
}

pub fn bench(args: &WorstCropsArgs) -> Result<(), AnyError> {
    say!("PSNR of the worst crop minus that of the foveated frame in dB (frame: x, y)");
    say!("{:64}{}", "clip", METHODS.map(|m| format!("{:>24}", m.0)).concat());
    for input in &args.inputs {
        let mut source = open(input)?;
        let mut rows = rows(source.as_ref(), input, &args.scanpaths)?;
        for index in 0..args.frames {
            let frame = source.render(&FrameRequest::full_rate(index))?;
            let full = encode(&frame.reference.color, 0.0);
            rows.par_iter_mut().try_for_each(|row| {
                let gaze_px = row.pipeline.request(index, row.gaze.px(index)).gaze_px;
                let step = row.pipeline.step(&RenderedFrame { gaze_px, ..frame.clone() })?;
                let shown: Vec<_> = step.outputs.iter().map(|output| encode(&output.image, 0.0)).collect();
                let (foveated, methods) = shown.split_first().expect("the first method is none");
                for (crops, shown) in row.crops.iter_mut().zip(methods) {
                    crops.push(&full, shown, foveated);
                }
                Ok::<(), FrameError>(())
            })?;
        }
        for row in &rows {
            let cell = |crops: &Crops| {
                let text = crops
                    .worst()
                    .map_or("-".into(), |w| format!("{:.2} ({}: {}, {})", w.delta_db, w.frame, w.x_px, w.y_px));
                format!("{text:>24}")
            };
            say!("{:64}{}", row.name, row.crops.each_ref().map(cell).concat());
        }
    }
    Ok(())
}

fn open(input: &str) -> Result<Box<dyn FrameSource>, AnyError> {
    let (limits, options) = (ReadLimits::default(), SceneOptions { size: Some(SIZE), ..Default::default() });
    if source::is_scene(input) {
        let device = Headless::find_roomy(true).ok_or("there is no adapter; install mesa-vulkan-drivers")?;
        return Ok(Box::new(RasterSource::open(input, &limits, &options, None, device)?));
    }
    let options = if input.starts_with("analytic:") { options } else { SceneOptions::default() };
    Ok(source::open(input, &limits, &options)?)
}

/// All gazes and foveations of a clip.
fn rows(source: &dyn FrameSource, input: &str, scanpaths: &[String]) -> Result<Vec<Row>, AnyError> {
    let info = source.info();
    let geometry = ViewGeometry::flat(info.size, info.hfov_deg.unwrap_or(70.0))?;
    let method = |method: MethodKind| RunKind::PostProcess(Settings { method: method.into(), ..Settings::default() });
    let kinds: Vec<_> = [MethodKind::None].into_iter().chain(METHODS.map(|m| m.1)).map(method).collect();
    let mut rows = vec![];
    for file in scanpaths {
        let path = read_csv(file)?;
        for filter in [FoveationKind::Mip, FoveationKind::Block] {
            for [rate_mid, rate_far] in RATES {
                let foveation = Foveation { kind: filter, rate_mid, rate_far, ..Foveation::default() };
                let fps = info.fps.unwrap_or(60.0);
                let map = GazeMap::default_for(path.screen());
                rows.push(Row {
                    name: format!("{} {} {filter:?} {rate_mid}/{rate_far}", last(input), last(file)),
                    gaze: FrameGaze::new(&path, &geometry, map, START_S, fps.into())?,
                    pipeline: Pipeline::new(geometry, foveation, &kinds, info.still, &[], &Backend::Cpu)?,
                    crops: Default::default(),
                });
            }
        }
    }
    Ok(rows)
}

/// Last part of a path.
fn last(path: &str) -> &str {
    path.rsplit('/').next().unwrap_or(path)
}

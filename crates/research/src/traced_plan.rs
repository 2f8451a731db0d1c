//! Path-traced frames whose pixels and numbers of paths smr chooses, beside frames of fixed patterns.
//!
//! Each row says the paths of a frame; PSNR in dB (sRGB) of all pixels, and of fovea, middle and periphery; FLIP; and
//! the PSNR of pixels that were sharp in an earlier frame. A row is `NAME:FOVEA_DEG,MID_DEG,RATE_MID,RATE_FAR,BUDGET`,
//! with a second row without history if the name ends in `none`; `regions:PATHS` a point; or `acuity:LEAST`, two paths
//! a point.
//!
//! `cargo research traced-plan SCENE`
//!
//! Makes the table of "Samples in their places" in `docs/path-tracing.md`.

use crate::error::AnyError;
use afterimage::cpu::{CpuAfterimage, Frame};
use afterimage::internal::{ContextDesc, Foveation, Method, Reset, Settings, ViewFrame};
use afterimage::{Gaze, Image, ViewGeometry};
use afterimage_cli::args::parse_size;
use afterimage_lab::device::Backend;
use afterimage_lab::frame::{Content, RenderedFrame, ShadedColor, ShadingRequest};
use afterimage_lab::metric::{Flip, References, Scorer, Tracker, encode};
use afterimage_lab::scanpath::{FrameGaze, GazeMap, read_csv};
use afterimage_lab::source::{FrameRequest, FrameSource, ReadLimits, SceneOptions, Wanted};
use afterimage_trace::sampling::{Acuity, Regions, Sampling};
use afterimage_trace::settings::TraceSettings;
use afterimage_trace::{TracedSamples, TracedSource};
use clap::Args;

/// Rows of the table.
const ROWS: &str = "plan:5.2,5.2,2,2,0.025;even:8.6,8.6,2,2,0;none:5.2,5.2,4,8,0.14;acuity:0.07;acuity:0.16;regions:2";

/// Frames that a row shows.
enum Kind {
    /// Chosen by smr.
    Planned,
    /// Those that the row before chose, without history.
    WithoutHistory,
    /// Traced in a pattern and filled between the samples.
    Filled(Box<TracedSource>),
}

struct Row {
    name: String,
    kind: Kind,
    post: CpuAfterimage,
    scorer: Scorer,
    paths: u64,
}

/// A chosen frame as it was traced.
struct Traced {
    mask: Image<bool>,
    color: Image<[f32; 3]>,
    noise: Image<[f32; 2]>,
    paths: u64,
}

impl Row {
    fn new(name: &str, kind: Kind, size: [u32; 2], settings: Settings) -> Result<Self, AnyError> {
        let post = CpuAfterimage::new(&ContextDesc { settings, ..ContextDesc::new(size) })?;
        Ok(Self { name: name.into(), kind, post, scorer: Scorer::default(), paths: 0 })
    }

    /// Shows a frame. `last`: the last one that was chosen.
    fn show(
        &mut self,
        frame: &RenderedFrame,
        view: ViewFrame,
        source: &mut TracedSource,
        last: &mut Option<Traced>,
    ) -> Result<Image<[f32; 3]>, AnyError> {
        let size = self.post.desc().size_px;
        let seen = &frame.reference;
        let (depth, motion) = (seen.depth.as_ref().ok_or("no depth")?, seen.motion.as_ref().ok_or("no motion")?);
        let (depths, motions, views) = ([depth], [motion], [view]);
        let reset = if seen.cut { Reset::All } else { Reset::None };
        let bare =
            Frame { depth: Some(&depths), motion: Some(&motions), reset, ..Frame::new(&[], &views, frame.index) };
        let mut shown = [Image::filled(size, [0.0; 3])];
        match &mut self.kind {
            Kind::Planned => {
                let mask = self.post.plan(&bare)?[0].clone();
                let paths = self.post.paths()[0].clone();
                let sum = paths.pixels().iter().map(|&paths| u64::from(paths)).sum();
                let request = ShadingRequest::new(mask.clone(), None).with_paths(Some(paths));
                let shaded = source.shade(frame, &request)?.ok_or("not traced")?;
                let ShadedColor::InMemory(color) = shaded.color else { Err("on a device")? };
                let traced = Traced { mask, color, noise: shaded.noise.ok_or("no noise")?, paths: sum };
                let (colors, noises) = ([&traced.color], [&traced.noise]);
                self.post.process(&Frame { color: &colors, noise: Some(&noises), ..bare }, &mut shown)?;
                self.paths += sum;
                *last = Some(traced);
            }
            Kind::WithoutHistory => {
                let traced = last.as_ref().ok_or("nothing was chosen")?;
                let mask = traced.mask.map(|chosen| f32::from(u8::from(chosen)));
                let (colors, noises, masks) = ([&traced.color], [&traced.noise], [&mask]);
                let input = Frame { color: &colors, noise: Some(&noises), mask: Some(&masks), ..bare };
                self.post.process(&input, &mut shown)?;
                self.paths += traced.paths;
            }
            Kind::Filled(source) => {
                let request = FrameRequest {
                    gaze_px: view.gaze.resolve(None, &view.geometry),
                    reference: false,
                    ..FrameRequest::full_rate(frame.index)
                };
                let Content::Foveated(filled) = source.render(&request)?.content else { Err("not foveated")? };
                let noise = filled.noise.as_ref().ok_or("no noise")?;
                let (colors, noises, lods) = ([&filled.color], [noise], [&filled.lod]);
                let input = Frame { color: &colors, noise: Some(&noises), lod: Some(&lods), ..bare };
                self.post.process(&input, &mut shown)?;
                self.paths += filled.samples.iter().sum::<u64>();
            }
        }
        let [shown] = shown;
        Ok(shown)
    }
}

/// Path-traced frames whose pixels and numbers of paths smr chooses, beside frames of fixed patterns
#[derive(Args, Clone, Debug)]
pub struct TracedPlanArgs {
    /// Scene, as for `afterimage run`
    pub scene: String,
    /// Camera of the scene, as for `afterimage run`
    #[arg(long, value_name = "NAME|FILE.json")]
    pub camera: Option<String>,
    /// Size of a frame, pixels
    #[arg(long, value_parser = parse_size, value_name = "WxH", default_value = "256x144")]
    pub size: [u32; 2],
    /// Frames of the clip
    #[arg(long, value_name = "N", default_value_t = 24, value_parser = clap::value_parser!(u64).range(1..=100_000))]
    pub frames: u64,
    /// Scanpath, as for `afterimage run`
    #[arg(long, value_name = "FILE.csv", default_value = "image_500hz.csv")]
    pub gaze: String,
    /// Start time in the scanpath, seconds
    #[arg(long, value_name = "S", default_value_t = 1.0)]
    pub start: f64,
    /// Paths a pixel of the reference
    #[arg(long, value_name = "N", default_value_t = 32)]
    pub reference_samples: u32,
    /// plan, even or none with FOVEA_DEG,MID_DEG,RATE_MID,RATE_FAR,BUDGET; regions with paths a point; acuity with the
    /// least share
    #[arg(long, value_name = "NAME:NUMBERS;...", default_value = ROWS)]
    pub rows: String,
}

pub fn bench(args: &TracedPlanArgs) -> Result<(), AnyError> {
    let (scene, size, frames) = (&args.scene, args.size, args.frames);
    let options = SceneOptions { size: Some(size), hfov_deg: None, fps: None };
    let open = |foveated: Option<Sampling>| {
        let samples = TracedSamples { foveated, samples: 2, full_rate_samples: args.reference_samples };
        let camera = args.camera.as_deref();
        let settings = TraceSettings::default();
        TracedSource::open(scene, &ReadLimits::from_megapixels(64), &options, camera, &Backend::Cpu, settings, samples)
    };
    let mut source = open(None)?;
    let info = source.info().clone();
    let geometry = ViewGeometry::flat(size, info.hfov_deg.unwrap_or(70.0))?;
    let path = read_csv(&args.gaze)?;
    let map = GazeMap::default_for(path.screen());
    let gaze = FrameGaze::new(&path, &geometry, map, args.start, f64::from(info.fps.unwrap_or(60.0)))?;

    let mut rows = vec![];
    for text in args.rows.split(';').filter(|text| !text.is_empty()) {
        let (name, numbers) = text.split_once(':').ok_or("a row is NAME:NUMBERS")?;
        let n: Vec<f32> = numbers.split(',').map(str::parse).collect::<Result<_, _>>()?;
        let sampling = match name {
            "regions" => Some(Sampling::Regions(Regions { samples: [n[0] as u32; 3], ..Regions::default() })),
            "acuity" => Some(Sampling::Acuity(Acuity { least: n[0], ..Acuity::default() })),
            _ => None,
        };
        if let Some(sampling) = sampling {
            let settings = Settings { foveation: sampling.foveation(), ..Settings::traced() };
            let kind = Kind::Filled(Box::new(open(Some(sampling))?));
            rows.push(Row::new(text, kind, size, settings)?);
            continue;
        }
        let foveation = Foveation {
            fovea_deg: n[0],
            mid_deg: n[1],
            rate_mid: n[2] as u32,
            rate_far: n[3] as u32,
            budget: n[4],
            single_pixels: true,
            ..Foveation::quads()
        };
        let settings = Settings { foveation, ..Settings::traced() };
        rows.push(Row::new(text, Kind::Planned, size, settings)?);
        if name.ends_with("none") {
            let settings = Settings { method: Method::None, ..settings };
            rows.push(Row::new(&format!("{text} without history"), Kind::WithoutHistory, size, settings)?);
        }
    }

    let mut references = References::with_flip(Flip::for_view(&geometry));
    let mut tracker = Tracker::default();
    let regions = Sampling::Regions(Regions::default()).foveation();
    let mut gaze_px = size.map(|side| 0.5 * (side as f32 - 1.0));
    let mut last = None;
    for index in 0..frames {
        gaze_px = gaze.px(index).unwrap_or(gaze_px);
        let request = FrameRequest { gaze_px, wanted: Wanted::Surfaces, ..FrameRequest::full_rate(index) };
        let frame = source.render(&request)?;
        let ecc_deg = geometry.eccentricity_map(gaze_px);
        let tracked = tracker.advance(&frame.reference, &geometry, &ecc_deg, &regions.lod_map(&geometry, gaze_px));
        let full = encode(&frame.reference.color, 0.0);
        let reference = references.next(&full, &tracked, &ecc_deg);
        let view = ViewFrame {
            previous_from_current: frame.reference.previous_from_current,
            ..ViewFrame::new(geometry, Gaze::At { px: gaze_px })
        };
        for row in &mut rows {
            let shown = row.show(&frame, view, &mut source, &mut last)?;
            row.scorer.push(&reference, &encode(&shown, 0.0), &tracked, &ecc_deg);
        }
    }
    for row in &rows {
        let scores = row.scorer.scores();
        let number = |v: Option<f64>| v.unwrap_or(f64::NAN);
        say!(
            "{:36} {:6.0} paths {:6.2}; {:5.2}, {:5.2}, {:5.2}; {:.4}; {:5.2}",
            row.name,
            row.paths as f64 / frames as f64,
            number(scores.whole.psnr_db),
            number(scores.bands[0].psnr_db),
            number(scores.bands[1].psnr_db),
            number(scores.bands[2].psnr_db),
            number(scores.whole.flip),
            number(scores.retained_psnr_db),
        );
    }
    Ok(())
}

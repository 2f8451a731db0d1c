//! `report.json` of a run.

use super::{Clip, ClipReport};
use crate::clock::Quartiles;
use crate::method_report::MethodReport;
use crate::output::{Output, WriteError};
use crate::pipeline::ProcessorInfo;
use crate::times::RenderTime;
use afterimage::internal::FoveationKind;
use afterimage_metric::Display;
use serde::Serialize;

/// Facts about the run that [`Clip`] does not hold.
pub struct RunFacts<'a> {
    /// Name of the input.
    pub input: &'a str,
    /// Frames per second.
    pub fps: f32,
    /// Seed of the random numbers.
    pub seed: u64,
    /// Simulator filter or sampling pattern that foveates the frames.
    pub simulator: &'static str,
    /// Where depth and motion of rendered samples are known; `None` for other frames.
    pub geometry: Option<&'static str>,
    /// Side of the pixels of uniform frames, pixels of the full-rate frame.
    pub scale: Option<f32>,
    /// Gaze as the user gave it.
    pub gaze: &'a str,
    /// Map from screen to frame: `angle`, `fit`, or `none` for positions that are frame pixels already.
    pub gaze_map: &'a str,
    /// Start time in the scanpath, seconds.
    pub start_s: f64,
    /// Latency of the eye tracker, milliseconds.
    pub gaze_latency_ms: f64,
    /// Whether the fovea stays in the middle of the frame.
    pub fixed_fovea: bool,
}

#[derive(Serialize)]
struct RunReport<'a> {
    tool: &'static str,
    version: &'static str,
    input: &'a str,
    size: [u32; 2],
    frames: usize,
    fps: f32,
    hfov_deg: f32,
    seed: u64,
    exposure_ev: f32,
    backend: ProcessorInfo,
    foveation: FoveationReport,
    /// Camera samples of all foveated frames; null if a simulator foveates full-rate frames.
    samples: Option<u64>,
    /// Whether the projection is jittered.
    jitter: bool,
    /// Whether smr gets the albedo of every pixel.
    albedo: bool,
    /// Samples a pixel of the rasterised or analytic reference; null: as many as the input has.
    reference_samples: Option<u32>,
    /// First frame that counts in scores.
    score_from: usize,
    gaze: &'a str,
    gaze_map: &'a str,
    start_s: f64,
    gaze_latency_ms: f64,
    fixed_fovea: bool,
    /// FLIP's viewing distance, in pixels per degree of visual angle; null without FLIP.
    flip_pixels_per_degree: Option<f32>,
    /// The display of JOD; null without JOD.
    jod_display: Option<JodDisplay>,
    /// Time of rendering the frames at full rate, which foveation saves; null if they were not rendered, or with other
    /// samples a pixel.
    full_rate: Option<RenderTime>,
    methods: Methods<'a>,
}

/// The display of JOD, in a report.
#[derive(Serialize)]
pub struct JodDisplay {
    /// Luminance of white in cd/m2.
    peak_nits: f32,
    /// Luminance of white over that of black.
    contrast: f32,
    /// Illuminance of the screen by the room in lux.
    ambient_lux: f32,
}

impl From<Display> for JodDisplay {
    fn from(display: Display) -> Self {
        let Display { peak_nits, contrast, ambient_lux } = display;
        Self { peak_nits, contrast, ambient_lux }
    }
}

#[derive(Serialize)]
struct FoveationReport {
    simulator: &'static str,
    /// Where depth and motion are known, full or samples; null unless frames are composed of quad views.
    geometry: Option<&'static str>,
    fovea_deg: f32,
    mid_deg: f32,
    blend_deg: f32,
    rate_mid: u32,
    rate_far: u32,
    /// Pixels that a frame shades by need, percent; null unless methods choose the pixels that are shaded.
    budget_percent: Option<f32>,
    /// Side of the pixels of uniform frames, pixels of the full-rate frame; null for other frames.
    scale: Option<f32>,
    ms: Option<Quartiles>,
}

/// Methods in the order of the command line, as a JSON map.
struct Methods<'a>(&'a [(&'static str, MethodReport)]);

impl Serialize for Methods<'_> {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_map(self.0.iter().map(|(name, report)| (name, report)))
    }
}

/// Writes `report.json`.
pub fn write_report(facts: &RunFacts<'_>, clip: &Clip, report: &ClipReport, out: &Output) -> Result<(), WriteError> {
    let foveation = clip.foveation;
    let json = RunReport {
        tool: "afterimage",
        version: env!("CARGO_PKG_VERSION"),
        input: facts.input,
        size: clip.geometry.size_px(),
        frames: report.gaze_px.len(),
        fps: facts.fps,
        hfov_deg: clip.geometry.hfov_deg(),
        seed: facts.seed,
        exposure_ev: report.exposure_ev,
        backend: clip.processor.info(),
        foveation: FoveationReport {
            simulator: facts.simulator,
            geometry: facts.geometry,
            fovea_deg: foveation.fovea_deg,
            mid_deg: foveation.mid_deg,
            blend_deg: foveation.blend_deg,
            rate_mid: foveation.rate_mid,
            rate_far: foveation.rate_far,
            budget_percent: (foveation.kind == FoveationKind::Quads).then_some(100.0 * foveation.budget),
            scale: facts.scale,
            ms: report.foveation_ms,
        },
        samples: (report.samples > 0).then_some(report.samples),
        jitter: clip.jitter,
        albedo: clip.methods.iter().any(|(_, kind)| kind.has_albedo()),
        reference_samples: clip.reference_samples,
        score_from: clip.score_from,
        gaze: facts.gaze,
        gaze_map: facts.gaze_map,
        start_s: facts.start_s,
        gaze_latency_ms: facts.gaze_latency_ms,
        fixed_fovea: facts.fixed_fovea,
        flip_pixels_per_degree: clip.flip().map(|flip| flip.pixels_per_degree()),
        jod_display: clip.viewing().map(|viewing| viewing.display.into()),
        full_rate: report.full_rate,
        methods: Methods(&report.methods),
    };
    out.json("report.json", &json)
}

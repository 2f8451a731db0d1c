//! Measures a batch: all methods take turns on every frame, so that other load on the machine affects all of them
//! alike.

use super::batch::{Batch, Planned};
use crate::args::Named;
use crate::clip::{Clip, FrameResult};
use crate::commands::run::{RunArgs, plan};
use crate::failure::Failure;
use crate::method_report::MethodAccumulator;
use crate::output::WriteError;
use crate::report::jpeg::write_jpeg;
use crate::sweep::measurement::{ClipFacts, Machine};
use crate::sweep::rust_source::as_rust;
use crate::sweep::store::{PICTURES, id};
use crate::sweep::{Measurement, Options, Store};
use afterimage::Image;
use afterimage::internal::{FoveationKind, Method, MethodKind, Settings};
use afterimage::kernel::debug_view::heat;
use afterimage_lab::clock::Quartiles;
use afterimage_lab::device::{Backend, PassClock, copy_ms_per_byte};
use afterimage_lab::metric;
use afterimage_lab::metric::Flip;
use afterimage_lab::picture::to_rgb8;
use afterimage_lab::pipeline::Processor;
use afterimage_lab::pipeline::{MethodOutput, RunKind};
use afterimage_lab::source::{FrameSource, SourceInfo};
use indicatif::ProgressBar;
use rayon::prelude::*;

/// Untimed frames: pipelines compile, caches and histories fill.
pub const WARM_UP: usize = 8;
/// Smallest number of timed frames.
pub const MIN_TIMED: usize = 30;
/// Width of the pictures of a point, pixels.
const PICTURE_WIDTH: u32 = 960;

/// Sums over the frames of a batch.
struct BatchAccumulator {
    subjects: Vec<MethodAccumulator>,
    control_ms: Vec<f64>,
    samples_share: f64,
    samples: Option<u64>,
    frames: usize,
}

/// Checks a point. All points are checked before the first is measured, so that a sweep does not fail halfway.
pub fn check(subject: &Planned) -> Result<(), Failure> {
    plan::foveation(&subject.args)?;
    if let Some(frames) = subject.args.frames {
        check_frames(&subject.args, frames)?;
    }
    // Assume a still input for the oracle: opening the input checks that later.
    let info = SourceInfo { still: true, ..SourceInfo::default() };
    plan::run_kind(&subject.args, subject.method, &info).map(|_| ())
}

fn check_frames(args: &RunArgs, frames: u64) -> Result<(), Failure> {
    let least = WARM_UP + MIN_TIMED;
    if frames >= least as u64 {
        return Ok(());
    }
    Err(Failure::Input(format!(
        "{}: {frames} frames are too few; expected at least {least} ({WARM_UP} to warm up and {MIN_TIMED} timed): --frames {least}",
        args.input.name
    )))
}

/// Measures the points of a batch and saves the measurements.
pub fn measure(batch: &Batch, common: &Options, store: &Store, bar: &ProgressBar) -> Result<(), Failure> {
    let args = &batch.subjects[0].args;
    let backend = args.backend.open_for(&args.input.name)?;
    let head = args.head()?;
    let mut source = args.input.open(&args.rendering(&backend, head.as_ref())?)?;
    let plan = plan::plan(args, source.info(), backend.clone(), head.as_ref())?;
    let mut methods = vec![("control", control(&batch.subjects[0]))];
    for subject in &batch.subjects {
        methods.push((subject.method.name(), plan::run_kind(&subject.args, subject.method, source.info())?));
    }
    let clip = Clip { methods, debug: vec![], pixel: None, ..plan.clip };
    check_frames(args, clip.gaze.len() as u64)?;
    let copy_ms_per_byte = copy_ms_per_byte(&backend);
    let (sums, memory_bytes) = play(batch, &clip, source.as_mut(), store, bar)?;
    let machine = machine(&backend);
    let facts = ClipFacts {
        size: clip.geometry.size_px(),
        frames: clip.gaze.len() as u64,
        timed_frames: (clip.gaze.len() - WARM_UP) as u64,
        fps: plan.fps,
        hfov_deg: clip.geometry.hfov_deg(),
    };
    let round = format!("{} and {} more", id(&batch.subjects[0].point), batch.subjects.len() - 1);
    let pixels = facts.size.iter().map(|&s| f64::from(s)).product::<f64>();
    for (i, (subject, accumulator)) in batch.subjects.iter().zip(&sums.subjects).enumerate() {
        let figures = accumulator.report(memory_bytes[i] as f64 / pixels);
        let (pass, render) = (accumulator.times().after(WARM_UP), accumulator.render().after(WARM_UP));
        let rust = match &clip.methods[i + 1].1 {
            RunKind::PostProcess(settings) | RunKind::WithAlbedo(settings) | RunKind::WithShader(settings, _) => {
                as_rust(&Settings { foveation: clip.foveation, ..*settings })
            }
            RunKind::Oracle => "no settings: the oracle is an upper bound that knows all earlier frames".into(),
        };
        let measurement = Measurement {
            version: env!("CARGO_PKG_VERSION").into(),
            point: subject.point.clone(),
            common: common.clone(),
            clip: facts.clone(),
            machine: machine.clone(),
            pass_ms: timed(&pass.cost_ms()),
            pass_cpu_ms: pass.cpu_ms(),
            frame_ms: pass.cost_ms().iter().map(|ms| (ms * 1e4).round() / 1e4).collect(),
            round: round.clone(),
            control_ms: timed(&sums.control_ms[WARM_UP..]),
            render_ms: Quartiles::of(&render.cost_ms()),
            render_cpu_ms: render.cpu_ms(),
            samples_share: figures.shaded_share.unwrap_or(sums.samples_share / sums.frames as f64),
            samples_per_pixel: sums.samples.map(|all| all as f64 / (sums.frames as f64 * pixels)),
            copy_ms: copy_ms_per_byte * f64::from(figures.bytes_per_pixel.unwrap_or(0)) * pixels,
            figures,
            rust,
        };
        store.save(&measurement).map_err(|e| Failure::writing(store.root(), e))?;
    }
    Ok(())
}

/// The control method, the same in every batch: its time shows the drift of the machine's speed between batches.
fn control(subject: &Planned) -> RunKind {
    let noisy = matches!(subject.args.sampling(), Ok(Some(_)));
    RunKind::PostProcess(Settings { method: Method::Taa, noisy, ..Settings::default() })
}

fn timed(times: &[f64]) -> Quartiles {
    Quartiles::of(times).expect("there are frames beyond the warm-up")
}

/// Runs the clip. Returns the sums, and the bytes of persistent memory of each point.
fn play(
    batch: &Batch,
    clip: &Clip,
    source: &mut dyn FrameSource,
    store: &Store,
    bar: &ProgressBar,
) -> Result<(BatchAccumulator, Vec<usize>), Failure> {
    let mut sums = BatchAccumulator {
        subjects: batch.subjects.iter().map(|_| MethodAccumulator::default()).collect(),
        control_ms: vec![],
        samples_share: 0.0,
        samples: None,
        frames: 0,
    };
    let flip = Flip::for_view(&clip.geometry);
    let pipeline = clip.start(source)?.play(&mut |result| {
        if result.index == clip.score_from {
            sums.subjects.iter_mut().for_each(MethodAccumulator::restart);
        }
        let is_last = result.index + 1 == clip.gaze.len();
        sums.control_ms.push(result.step.outputs[0].elapsed.cost_ms());
        sums.samples_share += samples_share(result, clip, &batch.subjects[0]);
        sums.samples = result.frame.samples.map(|now| sums.samples.unwrap_or(0) + now).or(sums.samples);
        sums.frames += 1;
        let foveated = batch.subjects.iter().position(|s| s.method.name() == MethodKind::None.name());
        let foveated = foveated.map(|i| metric::encode(&result.step.outputs[i + 1].image, result.exposure_ev));
        let of_subject = |(accumulator, (subject, shown)): (&mut MethodAccumulator, (&Planned, &MethodOutput))| {
            let encoded = metric::encode(&shown.image, result.exposure_ev);
            accumulator.push(result.frame, result.reference, &encoded, foveated.as_ref(), shown, result.step);
            if is_last { pictures(store, subject, result.reference.encoded(), &encoded, &flip) } else { Ok(()) }
        };
        let subjects = batch.subjects.par_iter().zip(&result.step.outputs[1..]);
        sums.subjects.par_iter_mut().zip(subjects).try_for_each(of_subject)?;
        bar.inc(batch.subjects.len() as u64);
        Ok(())
    })?;
    let memory_bytes = (0..batch.subjects.len()).map(|i| pipeline.memory_bytes(i + 1)).collect();
    Ok((sums, memory_bytes))
}

/// Samples of the foveated frame divided by those of a full-rate frame with the fovea's quality.
fn samples_share(result: &FrameResult<'_>, clip: &Clip, subject: &Planned) -> f64 {
    let lods = result.step.lods.pixels();
    match result.frame.samples {
        Some(samples) => samples as f64 / (lods.len() as f64 * f64::from(subject.full_rate_samples())),
        None if clip.foveation.kind == FoveationKind::Off => 1.0,
        None => lods.iter().map(|lod| f64::from((-2.0 * lod).exp2())).sum::<f64>() / lods.len() as f64,
    }
}

/// Saves the pictures of a point for the report: its last frame, the FLIP error map, and the reference.
fn pictures(
    store: &Store,
    subject: &Planned,
    reference: &Image<[f32; 3]>,
    shown: &Image<[f32; 3]>,
    flip: &Flip,
) -> Result<(), WriteError> {
    let error = flip.map(reference, shown).map(|v| heat(v).to_array());
    for (what, picture) in PICTURES.into_iter().zip([shown, &error, reference]) {
        let path = store.picture(&subject.point, what);
        write_jpeg(&path, &to_rgb8(picture), PICTURE_WIDTH).map_err(|e| WriteError::new(&path, e))?;
    }
    Ok(())
}

/// Description of the machine.
pub fn machine(backend: &Backend) -> Machine {
    let report = backend.info();
    let clock = match backend {
        Backend::Gpu(gpu) => PassClock::new(gpu).name(),
        Backend::Cpu => "CPU time of the process",
    };
    Machine { kind: report.kind.into(), name: report.name, driver: report.driver, clock: clock.into() }
}

/// Steps of the progress bar for a batch: frames times points.
pub fn work(batch: &Batch) -> u64 {
    batch.subjects.len() as u64 * batch.subjects[0].args.frames.unwrap_or(300)
}

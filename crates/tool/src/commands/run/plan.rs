//! Plan of a run, checked before its first frame.

use super::{AlbedoName, RunArgs};
use crate::args::backend::BackendName;
use crate::args::input;
use crate::args::pattern::SamplingName;
use crate::args::{MethodName, Named};
use crate::clip::pixel::ExplainedPixel;
use crate::clip::{self, Clip, title};
use crate::failure::Failure;
use afterimage::internal::{Foveation, FoveationKind, Method, MethodKind, Settings};
use afterimage_lab::device::Backend;
use afterimage_lab::pipeline::RunKind;
use afterimage_lab::quad_views::QuadViewLayout;
use afterimage_lab::scanpath::HeadPath;
use afterimage_lab::source::SourceInfo;

/// The clip of a run, and facts that its report needs.
pub struct Plan {
    /// Name of the input.
    pub input: String,
    pub fps: f32,
    pub clip: Clip,
    pub gaze_map: &'static str,
}

/// Name of the simulator's filter or of the sampling pattern that foveates the frames.
pub fn simulator(args: &RunArgs) -> &'static str {
    match args.sampling.sampling {
        SamplingName::Uniform => args.foveation.filter().name(),
        pattern => pattern.name(),
    }
}

/// Plans a run on an input, whose camera may be that of a head.
pub fn plan(args: &RunArgs, info: &SourceInfo, backend: Backend, head: Option<&HeadPath>) -> Result<Plan, Failure> {
    let refuse = |text: String| Err(Failure::Input(text));
    let foveation = foveation(args)?;
    args.foveation.check(args.input.is_rasterised(), args.input.is_analytic())?;
    if args.foveation.is_quads() {
        check_quads(args)?;
    }
    if let Some(albedo) = &args.albedo {
        check_albedo(args, albedo, info.has_albedo)?;
    }
    let fps = args.input.fps(info);
    let geometry = args.input.geometry(info)?;
    let mut methods: Vec<(&'static str, RunKind)> = vec![];
    for &method in &args.method {
        if methods.iter().any(|m| m.0 == method.name()) {
            return refuse(format!("--method: {} is named twice", method.name()));
        }
        methods.push((method.name(), run_kind(args, method, info)?));
    }
    let track = args.gaze.resolve(&geometry, fps, input::frames(args.frames, info), head, args.gaze_latency)?;
    let frames = track.px.len();
    // Pixels lie at whole numbers.
    let middle_px = geometry.size_px().map(|side| 0.5 * (side as f32 - 1.0));
    let fixed = args.fixed_fovea.then(|| vec![Some(middle_px); frames]);
    if args.score_from >= frames {
        return refuse(format!(
            "--score-from {}: the clip has {frames} frames; choose an earlier one",
            args.score_from
        ));
    }
    let pixel = explained_pixel(args, geometry.size_px(), frames)?;
    Ok(Plan {
        input: info.name.clone(),
        fps,
        gaze_map: track.map,
        clip: Clip {
            title: title(&info.name, info.size, track.px.len(), fps, &words(args, &foveation)),
            geometry,
            foveation,
            quad_views: args.foveation.quad_views(),
            view_geometry: args.foveation.geometry(),
            jitter: args.foveation.is_jittered(),
            reference_samples: args.reference_samples()?,
            methods,
            gaze: track.px,
            late_gaze: fixed.or(track.late_px),
            score_from: args.score_from,
            exposure: args.exposure,
            write_frame: args.format.writer(),
            write_reference: args.reference,
            debug: args.debug.iter().map(|&view| (view.name(), view)).collect(),
            pixel,
            trust: args.trust,
            flip: !args.no_flip,
            jod: !args.no_jod,
            display: args.display.display(),
            fps,
            backend_note: match (args.backend, &backend) {
                _ if args.pixel.is_some() => "; --pixel",
                (BackendName::Auto, Backend::Cpu) => "; no GPU was found",
                _ => "",
            },
            processor: Box::new(backend),
        },
    })
}

/// The pixel of `--pixel`, and its frames, which must be in the clip.
fn explained_pixel(args: &RunArgs, size_px: [u32; 2], frames: usize) -> Result<Option<ExplainedPixel>, Failure> {
    let Some(px @ [x, y]) = args.pixel else { return Ok(None) };
    let [width, height] = size_px;
    if x >= width || y >= height {
        return Err(Failure::Input(format!(
            "--pixel {x},{y}: frames have {width}x{height} pixels; expected x from 0 to {} and y from 0 to {}",
            width - 1,
            height - 1
        )));
    }
    let [first, last] = args.pixel_frames.unwrap_or([frames - 1; 2]);
    if last >= frames {
        return Err(Failure::Input(format!(
            "--pixel-frames {first}..{last}: the clip has {frames} frames; expected frames from 0 to {}",
            frames - 1
        )));
    }
    Ok(Some(ExplainedPixel { px, frames: first..=last }))
}

/// Foveation of the frames: the simulator's, or the equivalent of the sampling pattern.
pub fn foveation(args: &RunArgs) -> Result<Foveation, Failure> {
    let simulated = args.foveation.foveation();
    simulated.validate()?;
    let foveation = match args.sampling()? {
        None => simulated,
        Some(pattern) => pattern.foveation(),
    };
    foveation.validate()?;
    Ok(foveation)
}

/// The foveation in words, for titles.
fn words(args: &RunArgs, foveation: &Foveation) -> String {
    match args.foveation.quad_views() {
        Some(QuadViewLayout::Uniform { step }) => format!("uniform, 1/{step} of the pixels along an axis"),
        _ => clip::foveation_words(foveation, simulator(args)),
    }
}

/// Pipeline stage of a method with these options, on an input of which it needs to know whether it is still and has an
/// albedo.
pub fn run_kind(args: &RunArgs, method: MethodName, info: &SourceInfo) -> Result<RunKind, Failure> {
    let sampling = args.sampling()?;
    let foveation = foveation(args)?;
    let name = method.name();
    let refuse = |text: &str| Err(Failure::Input(format!("--method {name}: {text}")));
    let filter = args.foveation.filter();
    let method = match method {
        MethodName::Post(MethodKind::Taau) if filter.is_quad_views() => {
            return refuse(&format!(
                "needs moving samples, which --foveation {} has not; use --foveation planned, for one pixel in 4 with \
                 --single-pixels --fovea 0 --mid 180 --rate-mid 2 --rate-far 2 --budget 0, or leave it out",
                filter.name()
            ));
        }
        MethodName::Oracle if filter.is_quad_views() => {
            return refuse("is defined for simulated levels of detail; use --foveation mip, or leave it out");
        }
        MethodName::Post(method) => method,
        MethodName::Oracle if sampling.is_some() => return refuse("needs simulated foveation; leave out --sampling"),
        MethodName::Oracle if foveation.kind == FoveationKind::Quads => {
            return refuse("is not defined for moving samples; use another --foveation, or leave it out");
        }
        MethodName::Oracle if info.still => return Ok(RunKind::Oracle),
        MethodName::Oracle => {
            let input = &args.input.name;
            return refuse(&format!("{input} moves, and the oracle is only defined for stills; leave it out"));
        }
    };
    let is_noisy = sampling.is_some() || args.is_traced_by_plan();
    let settings = Settings { foveation, ..args.method_settings.settings(method, args.seed, is_noisy) };
    let mut settings = args.foveation.antialiased(settings);
    let is_planned = settings.foveation.kind == FoveationKind::Quads;
    let kind = match &mut settings.method {
        Method::Smr(smr) if is_planned && args.takes_albedo(info.has_albedo) => {
            // History holds means, to which albedos belong, even of frames without jitter.
            smr.antialias = true;
            RunKind::WithAlbedo
        }
        _ => RunKind::PostProcess,
    };
    settings.validate()?;
    Ok(kind(settings))
}

/// Refuses frames that have no albedo, and methods that do not take it.
fn check_albedo(args: &RunArgs, albedo: &AlbedoName, has_albedo: bool) -> Result<(), Failure> {
    let is_scene = *albedo == AlbedoName::Scene;
    let missing = if *albedo == AlbedoName::Off {
        return Ok(());
    } else if is_scene && !args.input.is_rasterised() {
        "only rasterised scenes have it; give a scene (.gltf, .glb, builtin:NAME) without --source trace"
    } else if !is_scene && (args.input.is_scene() || !has_albedo) {
        "a layer of EXR frames is meant; give such frames, or --albedo scene for a rasterised scene"
    } else if is_scene && !(args.foveation.is_quads() && args.foveation.is_jittered()) {
        "it is for antialiased planned frames; add --foveation planned --jitter halton"
    } else if !args.foveation.is_quads() {
        "it is for planned frames; add --foveation planned"
    } else if !args.method.contains(&MethodName::Post(MethodKind::Smr)) {
        "smr alone takes it; add smr to --method"
    } else {
        return Ok(());
    };
    Err(Failure::Input(format!("--albedo: {missing}, or leave --albedo out")))
}

/// Refuses sampling patterns, which choose pixels themselves.
fn check_quads(args: &RunArgs) -> Result<(), Failure> {
    if args.sampling.sampling != SamplingName::Uniform {
        let name = args.sampling.sampling.name();
        return Err(Failure::Input(format!(
            "--foveation planned: methods choose the pixels, and --sampling {name} chooses them, too; leave one of the two out"
        )));
    }
    Ok(())
}

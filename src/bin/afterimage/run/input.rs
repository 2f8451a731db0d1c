//! What a run gets its frames from.

use super::{NO_ADAPTER, RunArgs, SourceName, backend_for_scenes};
use crate::args::FilterName;
use crate::failure::Failure;
use crate::trace::pattern::SamplingName;
use afterimage::pipeline::Headless;
use afterimage::source::{self, FrameSource, ReadLimits, SceneOptions, TracedSamples};
use afterimage::trace::sampling::Sampling;

/// Opens files as they are, scenes with a renderer.
pub fn open(args: &RunArgs, limits: &ReadLimits) -> Result<Box<dyn FrameSource + Send>, Failure> {
    let options = SceneOptions { size: args.size, hfov_deg: args.hfov, fps: args.fps };
    if source::is_scene(&args.input) {
        return match args.source.unwrap_or(SourceName::Raster) {
            SourceName::Raster => rasterised(args, limits, &options),
            SourceName::Trace => traced(args, limits, &options),
        };
    }
    if args.source.is_some() || args.camera.is_some() {
        let option = if args.source.is_some() { "--source" } else { "--camera" };
        return Err(Failure::Input(format!(
            "{option}: {} brings its own frames; expected a scene (.gltf, .glb, builtin:NAME), or leave it out",
            args.input
        )));
    }
    Ok(source::open(&args.input, limits, &options)?)
}

/// By render passes. They need a device even where the methods run on the CPU.
fn rasterised(
    args: &RunArgs,
    limits: &ReadLimits,
    options: &SceneOptions,
) -> Result<Box<dyn FrameSource + Send>, Failure> {
    let device = Headless::find_roomy(true).ok_or_else(|| Failure::Input(format!("--source raster: {NO_ADAPTER}")))?;
    let source = source::RasterSource::open(&args.input, limits, options, args.camera.as_deref(), device)?;
    warn(source.warnings());
    Ok(Box::new(source))
}

/// The pattern that frames are traced with, if they are not to be foveated by a simulator.
pub fn sampling(args: &RunArgs) -> Result<Option<Sampling>, Failure> {
    let traced = args.source == Some(SourceName::Trace);
    if args.sampling.sampling == SamplingName::Uniform {
        // Nothing foveates these frames: what is wrong about them is their noise.
        return Ok((traced && args.foveation.filter == FilterName::Off).then_some(Sampling::Uniform));
    }
    if !traced {
        return Err(Failure::Input(format!(
            "--sampling {}: only traced frames are sampled; add --source trace, or use --foveation",
            args.sampling.sampling.name()
        )));
    }
    args.sampling.sampling().map(Some)
}

/// By path tracing.
fn traced(args: &RunArgs, limits: &ReadLimits, options: &SceneOptions) -> Result<Box<dyn FrameSource + Send>, Failure> {
    for (option, value) in [("--spp", args.spp), ("--reference-spp", args.reference_spp)] {
        if value == 0 || value > 1 << 20 {
            return Err(Failure::Input(format!("{option} {value}: expected 1 to {}", 1 << 20)));
        }
    }
    let foveated = sampling(args)?;
    let full_rate_samples = if foveated.is_some() { args.reference_spp } else { args.spp };
    let samples = TracedSamples { foveated, samples: args.spp, full_rate_samples };
    let backend = backend_for_scenes(args.backend)?;
    let settings = args.paths.settings(args.seed)?;
    let camera = args.camera.as_deref();
    let source = source::TracedSource::open(&args.input, limits, options, camera, &backend, settings, samples)?;
    warn(source.warnings());
    Ok(Box::new(source))
}

fn warn(warnings: &[String]) {
    for warning in warnings {
        eprintln!("afterimage: warning: {warning}");
    }
}

//! Methods on the CPU.

use super::candidate::Candidate;
use super::executor::{Executor, RunInputs, Shade};
use super::run::{Chosen, MethodOutput, RunKind, chooses, unshaded};
use crate::clock::{Elapsed, Stopwatch};
use crate::frame::{DeviceHandle, RenderedFrame, Shaded, ShadedColor, ShadingRequest};
use afterimage::cpu::{CpuAfterimage, Frame, PixelTrace};
use afterimage::internal::ContextDesc;
use afterimage::internal::PixelNotes;
use afterimage::kernel::debug_view::view_color;
use afterimage::{CreateError, FrameError, Image};
use std::slice::from_ref;

/// Methods on the CPU.
#[derive(Default)]
pub(super) struct CpuExecutor(Vec<CpuAfterimage>);

impl Executor for CpuExecutor {
    fn add(&mut self, kind: &RunKind, desc: &ContextDesc) -> Result<(), CreateError> {
        kind.check_on_cpu()?;
        self.0.push(CpuAfterimage::new(desc)?);
        Ok(())
    }

    fn device(&self) -> Option<DeviceHandle> {
        None
    }

    fn set(&mut self, _: &RenderedFrame, _: &Candidate<'_>) -> Result<(), FrameError> {
        Ok(())
    }

    fn run(&mut self, run: usize, inputs: &RunInputs<'_>, shade: Shade<'_>) -> Result<MethodOutput, FrameError> {
        let post = &mut self.0[run];
        let candidate = inputs.candidate;
        let given = candidate.in_memory.as_ref().expect("frames are foveated in memory for runs on the CPU");
        let size = post.desc().size_px;
        let mut output = [Image::filled(size, [0.0; 3])];
        let mut traces = (!inputs.debug.is_empty()).then(|| [Image::filled(size, PixelTrace::default())]);
        let full_rate = inputs.frame.given();
        let (depth, motion) = match &given.geometry {
            Some((depth, motion)) => (Some(depth), Some(motion)),
            None => (full_rate.depth.as_ref(), full_rate.motion.as_ref()),
        };
        let trust = full_rate.trust.as_ref().filter(|_| inputs.use_trust);
        let color: &Image<[f32; 3]> = &given.color;
        let lod = given.has_lod.then_some(&candidate.lods);
        let albedo = inputs.frame.albedo.as_ref().filter(|_| post.desc().has_albedo);
        let frame = Frame {
            depth: depth.as_ref().map(from_ref),
            motion: motion.as_ref().map(from_ref),
            trust: trust.as_ref().map(from_ref),
            lod: lod.as_ref().map(from_ref),
            noise: given.noise.as_ref().map(from_ref),
            albedo: albedo.as_ref().map(from_ref),
            reset: inputs.reset(),
            ..Frame::new(from_ref(&color), from_ref(&candidate.view), inputs.frame.index)
        };
        let planned = Planned::new(post, &frame)?;
        let is_simulated = inputs.frame.is_simulated();
        let shaded = planned.as_ref().filter(|_| !is_simulated).and_then(|planned| shade(&planned.request));
        let pixels = match &shaded {
            Some(Shaded { color: ShadedColor::InMemory(color), .. }) => Some(color),
            _ => planned.as_ref().filter(|_| is_simulated).map(|_| &full_rate.color),
        };
        let half = match shaded.as_ref().and_then(|shaded| shaded.half.as_ref()) {
            Some(ShadedColor::InMemory(half)) => Some(half),
            _ => None,
        };
        let is_noisy = post.desc().settings.noisy;
        let noise = shaded.as_ref().and_then(|shaded| shaded.noise.as_ref()).filter(|_| is_noisy);
        let frame = match planned {
            Some(_) => Frame {
                color: pixels.as_ref().map(from_ref).ok_or_else(unshaded)?,
                half: half.as_ref().map(from_ref),
                noise: noise.as_ref().map(from_ref).or(frame.noise),
                ..frame
            },
            None => frame,
        };
        let mut pixel = inputs.pixel.map(|px| PixelNotes::new(0, px));
        let watch = Stopwatch::start();
        let stats = match (&mut pixel, &mut traces) {
            (Some(pixel), traces) => {
                let traces = traces.as_mut().map(|traces| &mut traces[..]);
                post.process_noted(&frame, &mut output, traces, pixel)?
            }
            (None, Some(traces)) => post.process_traced(&frame, &mut output, traces)?,
            (None, None) => post.process(&frame, &mut output)?,
        };
        let elapsed = watch.elapsed();
        let given = [depth.is_some(), motion.is_some(), trust.is_some()];
        let [image] = output;
        Ok(MethodOutput {
            image,
            elapsed: planned.as_ref().map_or(elapsed, |planned| elapsed.and(planned.took)),
            chosen: planned.map(|planned| Chosen {
                share: planned.request.share(),
                shading: shaded.as_ref().map(|shaded| shaded.took),
            }),
            stats,
            notes: pixel.map_or_else(Vec::new, |pixel| pixel.notes),
            traffic_bytes_per_pixel: Some(post.desc().settings.traffic_bytes_per_pixel(given)),
            debug: traces.map_or_else(Vec::new, |[trace]| {
                inputs.debug.iter().map(|&view| trace.map(|t| view_color(view, &t).to_array())).collect()
            }),
        })
    }

    fn memory_bytes(&self, run: usize) -> usize {
        self.0[run].memory_bytes()
    }
}

/// The pixels that a method chose.
struct Planned {
    request: ShadingRequest,
    /// Time of choosing them.
    took: Elapsed,
}

impl Planned {
    /// Chooses the pixels of a frame; `None` if the method chooses none.
    fn new(post: &mut CpuAfterimage, frame: &Frame<'_>) -> Result<Option<Self>, FrameError> {
        if !chooses(&post.desc().settings) {
            return Ok(None);
        }
        let watch = Stopwatch::start();
        let mask = post.plan(frame)?[0].clone();
        let took = watch.elapsed();
        let paths = post.desc().settings.noisy.then(|| post.paths()[0].clone());
        Ok(Some(Self { request: ShadingRequest::new(mask, None).with_paths(paths), took }))
    }
}

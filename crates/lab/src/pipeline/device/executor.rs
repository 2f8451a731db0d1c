//! Methods on a device.

use super::{DeviceFormats, DeviceInputs, DeviceRun};
use crate::clock::{Elapsed, Stopwatch};
use crate::device::{Headless, PassClock};
use crate::frame::{Content, DeviceHandle, RenderedFrame, Shaded, ShadedColor, ShadingRequest};
use afterimage::Image;
use afterimage::gpu::Frame;
use afterimage::internal::ContextDesc;
use afterimage::kernel::quads::place_in_quad;
use afterimage::{CreateError, DebugView, FrameError};
use afterimage_eval::pipeline::{
    Candidate, Chosen, Executor, MethodOutput, RunInputs, RunKind, Shade, chooses, unshaded,
};
use std::slice::from_ref;
use std::sync::Arc;
use wgpu::Texture;

/// Methods on a device, which share one frame.
pub struct DeviceExecutor {
    gpu: Arc<Headless>,
    inputs: DeviceInputs,
    clock: PassClock,
    runs: Vec<DeviceRun>,
    is_still: bool,
    /// Whether the frame of a still is already on the device.
    has_still: bool,
}

impl DeviceExecutor {
    /// An executor of frames with `desc`'s size and foveation. `is_still`: all frames are equal.
    pub fn new(gpu: &Arc<Headless>, desc: &ContextDesc, is_still: bool) -> Result<Self, CreateError> {
        Ok(Self {
            inputs: DeviceInputs::new(gpu, desc, DeviceFormats::EXACT)?,
            clock: PassClock::new(gpu),
            runs: vec![],
            is_still,
            has_still: false,
            gpu: gpu.clone(),
        })
    }
}

impl Executor for DeviceExecutor {
    fn add(&mut self, kind: &RunKind, desc: &ContextDesc) -> Result<(), CreateError> {
        self.runs.push(match kind {
            RunKind::WithShader(_, shader) => DeviceRun::with_shader(&self.gpu, desc, DeviceFormats::EXACT, shader)?,
            _ => DeviceRun::new(&self.gpu, desc, DeviceFormats::EXACT)?,
        });
        Ok(())
    }

    fn device(&self) -> Option<DeviceHandle> {
        Some(self.gpu.clone())
    }

    fn set(&mut self, frame: &RenderedFrame, candidate: &Candidate<'_>) -> Result<(), FrameError> {
        let mut encoder = self.gpu.device.create_command_encoder(&Default::default());
        let is_full_rate = matches!(frame.content, Content::FullRate);
        if !(is_full_rate && self.has_still && frame.reference_on_device.is_none()) {
            self.inputs.set(&mut encoder, frame);
        }
        if frame.is_simulated() {
            self.has_still = self.is_still && is_full_rate;
            self.inputs.foveate(&mut encoder, from_ref(&candidate.view), None)?;
        }
        self.gpu.queue.submit([encoder.finish()]);
        self.gpu.wait();
        self.gpu.check()
    }

    fn run(&mut self, run: usize, inputs: &RunInputs<'_>, shade: Shade<'_>) -> Result<MethodOutput, FrameError> {
        let (gpu, run) = (&self.gpu, &mut self.runs[run]);
        let views = from_ref(&inputs.candidate.view);
        let albedo = self.inputs.albedo().filter(|_| run.post().desc().has_albedo).map(Into::into);
        let frame = self.inputs.frame(views, inputs.frame.index, inputs.reset(), inputs.use_trust);
        let frame = Frame { albedo, ..frame };
        let planned = chooses(&run.post().desc().settings).then(|| plan(gpu, &self.clock, run, &frame)).transpose()?;
        let is_simulated = inputs.frame.is_simulated();
        let shaded = planned.as_ref().filter(|_| !is_simulated).and_then(|(request, _)| shade(request));
        let pixels = match &shaded {
            Some(Shaded { color: ShadedColor::OnDevice(color), .. }) => color.downcast_ref::<Texture>(),
            Some(Shaded { color: ShadedColor::InMemory(color), .. }) => Some(self.inputs.upload_shaded(color)),
            None => planned.as_ref().filter(|_| is_simulated).map(|_| self.inputs.full()),
        };
        let half = match shaded.as_ref().and_then(|shaded| shaded.half.as_ref()) {
            Some(ShadedColor::OnDevice(half)) => half.downcast_ref::<Texture>(),
            _ => None,
        };
        let is_noisy = run.post().desc().settings.noisy;
        let noise = shaded.as_ref().and_then(|shaded| shaded.noise.as_ref()).filter(|_| is_noisy);
        let noise = noise.map(|noise| self.inputs.upload_noise(noise));
        let frame = match planned {
            Some(_) => Frame {
                color: pixels.ok_or_else(unshaded)?.into(),
                half: half.map(Into::into),
                noise: noise.map(Into::into).or(frame.noise),
                ..frame
            },
            None => frame,
        };
        let encoder = || gpu.device.create_command_encoder(&Default::default());
        let mut debug_views = vec![];
        // Counters come from a debug view. If no view is requested, one is drawn for the counters and not read back.
        for &view in if inputs.debug.is_empty() { &[DebugView::Rejection] } else { inputs.debug } {
            let mut encoder = encoder();
            run.record_view(&mut encoder, &frame, view)?;
            gpu.queue.submit([encoder.finish()]);
            debug_views
                .extend(run.debug().filter(|_| !inputs.debug.is_empty()).map(|texture| gpu.read_rgb(texture, 0)));
        }
        // The device is idle when the watch starts.
        gpu.wait();
        let watch = Stopwatch::start();
        let mut encoder = encoder();
        run.record(&mut encoder, &frame, self.clock.timestamps())?;
        self.clock.resolve(&mut encoder);
        gpu.queue.submit([encoder.finish()]);
        let elapsed = self.clock.elapsed(gpu, &watch);
        let given = [frame.depth.is_some(), frame.motion.is_some(), frame.trust.is_some()];
        let output = MethodOutput {
            image: gpu.read_rgb(run.output(), 0),
            elapsed: planned.as_ref().map_or(elapsed, |(_, planning)| elapsed.and(*planning)),
            chosen: planned.map(|(request, _)| Chosen {
                share: request.share(),
                shading: shaded.as_ref().map(|shaded| shaded.took),
            }),
            stats: run.stats(),
            traffic_bytes_per_pixel: Some(run.post().desc().settings.traffic_bytes_per_pixel(given)),
            debug: debug_views,
            notes: vec![],
        };
        gpu.check().map(|()| output)
    }

    fn memory_bytes(&self, run: usize) -> usize {
        self.runs[run].post().memory_bytes() as usize
    }
}

/// The pixels that a method chooses, and the time of choosing them.
fn plan(
    gpu: &Headless,
    clock: &PassClock,
    run: &mut DeviceRun,
    frame: &Frame<'_>,
) -> Result<(ShadingRequest, Elapsed), FrameError> {
    gpu.wait();
    let watch = Stopwatch::start();
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    clock.begin(&mut encoder);
    run.post_mut().plan(&gpu.device, &mut encoder, frame)?;
    clock.end(&mut encoder);
    gpu.queue.submit([encoder.finish()]);
    let elapsed = clock.elapsed(gpu, &watch);
    let post = run.post();
    let (mask, list) = post.quad_mask().zip(post.quad_list(0)).expect("the settings ask for a plan");
    let quads = gpu.read::<u32>(mask, 0);
    let is_chosen = |[x, y]: [u32; 2]| quads.at(x as usize / 2, y as usize / 2) >> place_in_quad([x, y]) & 1 == 1;
    let mask = Image::from_fn(post.desc().size_px, is_chosen);
    let paths_at =
        |[x, y]: [u32; 2]| if is_chosen([x, y]) { quads.at(x as usize / 2, y as usize / 2) >> 8 & 31 } else { 0 };
    let paths = post.desc().settings.noisy.then(|| Image::from_fn(mask.size(), |px| paths_at(px) as u8));
    Ok((ShadingRequest::new(mask, Some(Arc::new(list.clone()))).with_paths(paths), elapsed))
}

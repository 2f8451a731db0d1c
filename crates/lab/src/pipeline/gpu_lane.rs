//! The post-process on a GPU for frames that live in memory: upload, record, submit, read back.

use super::SourceView;
use crate::clock::Stopwatch;
use crate::device::{Headless, PassClock};
use afterimage::gpu::{Afterimage, Frame, Target};
use afterimage::{ContextDesc, CreateError, DebugView, FrameError, FrameStats, Image, Method, Reset, Settings};
use std::sync::Arc;
use wgpu::{Buffer, CommandEncoder, Texture, TextureFormat, TextureUsages};

/// What a frame of one view brings.
pub(super) struct LaneInput<'a> {
    pub view: SourceView<'a>,
    pub index: u64,
    pub reset: Reset,
}

/// What came back.
pub(super) struct LaneOutput {
    pub image: Image<[f32; 3]>,
    pub wall_ms: f64,
    pub cpu_ms: Option<f64>,
    pub device_ms: Option<f64>,
    pub stats: FrameStats,
    pub traffic_bytes_per_pixel: u32,
    pub debug: Vec<Image<[f32; 3]>>,
}

const OUTPUT: TextureFormat = TextureFormat::Rgba32Float;

/// One context and the textures of its frames.
#[derive(Debug)]
pub(super) struct GpuLane {
    gpu: Arc<Headless>,
    post: Afterimage,
    color: Texture,
    depth: Texture,
    motion: Texture,
    trust: Texture,
    lod: Texture,
    noise: Texture,
    output: Texture,
    counters: Buffer,
    clock: PassClock,
}

impl GpuLane {
    pub fn new(gpu: &Arc<Headless>, context: ContextDesc, settings: Settings) -> Result<Self, CreateError> {
        Self::with(gpu, context, settings, |desc| Afterimage::new(&gpu.device, desc, OUTPUT))
    }

    /// With another text of the pass.
    #[cfg(feature = "ablation")]
    pub fn from_shader(
        gpu: &Arc<Headless>,
        context: ContextDesc,
        settings: Settings,
        source: &str,
    ) -> Result<Self, CreateError> {
        Self::with(gpu, context, settings, |desc| Afterimage::with_shader(&gpu.device, desc, OUTPUT, source))
    }

    fn with(
        gpu: &Arc<Headless>,
        context: ContextDesc,
        settings: Settings,
        post: impl FnOnce(&ContextDesc) -> Result<Afterimage, CreateError>,
    ) -> Result<Self, CreateError> {
        let desc = ContextDesc { settings, ..context };
        let texture = |format, usage| gpu.texture(context.size_px, 1, format, usage);
        let read = TextureUsages::TEXTURE_BINDING | TextureUsages::COPY_DST;
        let output = TextureUsages::STORAGE_BINDING | TextureUsages::COPY_SRC;
        Ok(Self {
            post: post(&desc)?,
            color: texture(TextureFormat::Rgba32Float, read),
            depth: texture(TextureFormat::R32Float, read),
            motion: texture(TextureFormat::Rg32Float, read),
            trust: texture(TextureFormat::R32Float, read),
            lod: texture(TextureFormat::R32Float, read),
            noise: texture(TextureFormat::Rg32Float, read),
            output: texture(OUTPUT, output),
            counters: gpu.counters(),
            clock: PassClock::new(gpu),
            gpu: gpu.clone(),
        })
    }

    /// Bytes kept between frames.
    pub fn memory_bytes(&self) -> usize {
        self.post.memory_bytes() as usize
    }

    /// The tunables.
    pub fn settings(&self) -> &Settings {
        &self.post.desc().settings
    }

    /// Packed noise of what is remembered, where that is noisy.
    pub fn noise(&self) -> Option<Image<u32>> {
        let settings = &self.post.desc().settings;
        let remembered =
            self.post.history_textures().get(2).filter(|_| settings.method == Method::Smr && settings.noisy);
        remembered.map(|texture| self.gpu.read(texture, 0))
    }

    pub fn process(&mut self, input: &LaneInput<'_>, debug: &[DebugView]) -> Result<LaneOutput, FrameError> {
        let view = &input.view;
        self.gpu.write_rgb(&self.color, 0, view.color);
        for (image, texture) in [(view.depth, &self.depth), (view.trust, &self.trust), (view.lod, &self.lod)] {
            if let Some(image) = image {
                self.gpu.write(texture, 0, image);
            }
        }
        for (image, texture) in [(view.motion, &self.motion), (view.noise, &self.noise)] {
            if let Some(image) = image {
                self.gpu.write(texture, 0, image);
            }
        }
        let frame = Frame {
            depth: view.depth.map(|_| &self.depth),
            motion: view.motion.map(|_| &self.motion),
            trust: view.trust.map(|_| &self.trust),
            lod: view.lod.map(|_| &self.lod),
            noise: view.noise.map(|_| &self.noise),
            reset: input.reset,
            ..Frame::new(&self.color, std::slice::from_ref(&view.facts), input.index)
        };
        // Counting takes time that is not the method's: it is done by a view, of which there is always one.
        let counted = Target { counters: Some(&self.counters), ..Target::new(&self.output) };
        let mut views = debug.to_vec();
        views.resize(debug.len().max(1), DebugView::Rejection);
        let mut pictures = vec![];
        for view in views {
            let mut encoder = self.encoder();
            self.post.record_view(&self.gpu.device, &mut encoder, &frame, counted, view)?;
            self.gpu.queue.submit([encoder.finish()]);
            pictures.push(self.gpu.read_rgb(&self.output, 0));
        }
        pictures.truncate(debug.len());
        // The uploads are done before the watch starts.
        self.gpu.queue.submit([]);
        self.gpu.wait();
        let watch = Stopwatch::start();
        let mut encoder = self.encoder();
        let timed = Target { timestamps: self.clock.timestamps(), ..Target::new(&self.output) };
        self.post.record(&self.gpu.device, &mut encoder, &frame, timed)?;
        self.clock.resolve(&mut encoder);
        self.gpu.queue.submit([encoder.finish()]);
        self.gpu.wait();
        let (wall_ms, cpu_ms) = (watch.wall_ms(), watch.cpu_ms());
        let device_ms = self.clock.is_device().then(|| self.clock.read_ms(&self.gpu, &watch));
        let given = [view.depth.is_some(), view.motion.is_some(), view.trust.is_some()];
        let traffic_bytes_per_pixel = self.post.desc().settings.traffic_bytes_per_pixel(given);
        let output = LaneOutput {
            image: self.gpu.read_rgb(&self.output, 0),
            wall_ms,
            cpu_ms,
            device_ms,
            stats: self.gpu.read_counters(&self.counters),
            traffic_bytes_per_pixel,
            debug: pictures,
        };
        self.gpu.check().map(|()| output)
    }

    fn encoder(&self) -> CommandEncoder {
        self.gpu.device.create_command_encoder(&Default::default())
    }
}

//! The post-process on a GPU for frames that live in memory: upload, record, submit, read back.

use super::Headless;
use crate::error::{CreateError, FrameError};
use crate::frame::{ContextDesc, Reset, ViewFrame};
use crate::gpu::{Afterimage, Frame, GpuDesc};
use crate::image::Image;
use crate::kernel::debug_view::DebugView;
use crate::report::clock::Stopwatch;
use crate::settings::{Method, Settings};
use crate::stats::FrameStats;
use std::sync::Arc;
use wgpu::{Buffer, CommandEncoder, Texture, TextureFormat, TextureUsages};

/// What one view of a frame brings.
pub(super) struct LaneInput<'a> {
    pub facts: ViewFrame,
    pub color: &'a Image<[f32; 3]>,
    pub depth: Option<&'a Image<f32>>,
    pub motion: Option<&'a Image<[f32; 2]>>,
    pub index: u64,
    pub reset: Reset,
}

/// What came back.
pub(super) struct LaneOutput {
    pub image: Image<[f32; 3]>,
    pub wall_ms: f64,
    pub cpu_ms: Option<f64>,
    pub stats: FrameStats,
    pub traffic_bytes_per_pixel: u32,
    pub debug: Vec<Image<[f32; 3]>>,
}

/// One context and the textures of its frames.
#[derive(Debug)]
pub(super) struct GpuLane {
    gpu: Arc<Headless>,
    post: Afterimage,
    color: Texture,
    depth: Texture,
    motion: Texture,
    output: Texture,
    counters: Buffer,
}

impl GpuLane {
    pub fn new(gpu: &Arc<Headless>, context: ContextDesc, settings: Settings) -> Result<Self, CreateError> {
        let desc = GpuDesc { context, output_format: TextureFormat::Rgba32Float, settings };
        let texture = |format, usage| gpu.texture(context.size_px, 1, format, usage);
        let read = TextureUsages::TEXTURE_BINDING | TextureUsages::COPY_DST;
        let output = TextureUsages::STORAGE_BINDING | TextureUsages::COPY_SRC;
        Ok(Self {
            post: Afterimage::new(&gpu.device, &desc)?,
            color: texture(TextureFormat::Rgba32Float, read),
            depth: texture(TextureFormat::R32Float, read),
            motion: texture(TextureFormat::Rg32Float, read),
            output: texture(TextureFormat::Rgba32Float, output),
            counters: gpu.counters(),
            gpu: gpu.clone(),
        })
    }

    /// Bytes kept between frames: none for a method without history, whatever was made for one.
    pub fn memory_bytes(&self) -> usize {
        if self.post.desc().settings.method == Method::None { 0 } else { self.post.memory_bytes() as usize }
    }

    pub fn process(&mut self, input: &LaneInput<'_>, debug: &[DebugView]) -> Result<LaneOutput, FrameError> {
        self.gpu.write_rgb(&self.color, 0, input.color);
        if let Some(depth) = input.depth {
            self.gpu.write(&self.depth, 0, depth);
        }
        if let Some(motion) = input.motion {
            self.gpu.write(&self.motion, 0, motion);
        }
        let frame = Frame {
            depth: input.depth.map(|_| &self.depth),
            motion: input.motion.map(|_| &self.motion),
            reset: input.reset,
            ..Frame::new(&self.color, &self.output, std::slice::from_ref(&input.facts), input.index)
        };
        // Counting takes time that is not the method's: it is done by a view, of which there is always one.
        let counted = Frame { counters: Some(&self.counters), ..frame };
        let mut views = debug.to_vec();
        views.resize(debug.len().max(1), DebugView::Flush);
        let mut pictures = vec![];
        for view in views {
            let mut encoder = self.encoder();
            self.post.record_view(&self.gpu.device, &mut encoder, &counted, view)?;
            self.gpu.queue.submit([encoder.finish()]);
            pictures.push(self.gpu.read_rgb(&self.output, 0));
        }
        pictures.truncate(debug.len());
        // The uploads are done before the watch starts.
        self.gpu.queue.submit([]);
        self.gpu.wait();
        let watch = Stopwatch::start();
        let mut encoder = self.encoder();
        self.post.record(&self.gpu.device, &mut encoder, &frame)?;
        self.gpu.queue.submit([encoder.finish()]);
        self.gpu.wait();
        let (wall_ms, cpu_ms) = (watch.wall_ms(), watch.cpu_ms());
        let given = [input.depth.is_some(), input.motion.is_some(), false];
        let traffic_bytes_per_pixel = self.post.desc().settings.traffic_bytes_per_pixel(given);
        Ok(LaneOutput {
            image: self.gpu.read_rgb(&self.output, 0),
            wall_ms,
            cpu_ms,
            stats: self.gpu.read_counters(&self.counters),
            traffic_bytes_per_pixel,
            debug: pictures,
        })
    }

    fn encoder(&self) -> CommandEncoder {
        self.gpu.device.create_command_encoder(&Default::default())
    }
}

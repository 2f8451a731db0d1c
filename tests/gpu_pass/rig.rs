//! The same frames through both executors, and what comes back from the device.

use super::gpu;
use afterimage::cpu::{CpuAfterimage, CpuFrame, CpuView};
use afterimage::frame::{ContextDesc, Exposure, Reset, ViewFrame};
use afterimage::gpu::{Afterimage, Frame, GpuDesc};
use afterimage::image::Image;
use afterimage::kernel::debug_view::{DebugView, PixelTrace};
use afterimage::settings::Settings;
use afterimage::stats::{COUNTERS_BYTES, FrameStats};
use wgpu::{Buffer, BufferUsages, Device, Queue, Texture, TextureFormat, TextureUsages};

/// Images of one view of one frame.
#[derive(Clone)]
pub struct View {
    pub facts: ViewFrame,
    pub color: Image<[f32; 3]>,
    pub depth: Option<Image<f32>>,
    pub motion: Option<Image<[f32; 2]>>,
    pub trust: Option<Image<f32>>,
}

/// A device with textures of one size, and both executors.
pub struct Rig {
    pub device: Device,
    pub queue: Queue,
    pub context: ContextDesc,
    pub cpu: CpuAfterimage,
    pub gpu: Afterimage,
    /// Of the frames to come.
    pub exposure: Exposure,
    color: Texture,
    depth: Texture,
    motion: Texture,
    trust: Texture,
    pub output: Texture,
    counters: Buffer,
}

/// What an executor made of a frame: shown colours and packed reservoirs, view after view.
#[derive(Clone, PartialEq, Debug)]
pub struct Made {
    pub shown: Vec<[u32; 3]>,
    pub words: Vec<[u32; 3]>,
    pub stats: FrameStats,
}

impl Rig {
    /// `None`, after saying so, without an adapter.
    pub fn new(context: ContextDesc, settings: Settings) -> Option<Self> {
        let (device, queue) = gpu::device()?;
        let desc = GpuDesc { context, output_format: TextureFormat::Rgba32Float, settings };
        let texture = |format, usage| make_texture(&device, &context, format, usage);
        let read = TextureUsages::TEXTURE_BINDING | TextureUsages::COPY_DST;
        Some(Self {
            cpu: CpuAfterimage::new(context, settings).unwrap(),
            gpu: gpu::validated(&device, "new", || Afterimage::new(&device, &desc)).unwrap(),
            color: texture(TextureFormat::Rgba32Float, read),
            depth: texture(TextureFormat::R32Float, read),
            motion: texture(TextureFormat::Rg32Float, read),
            trust: texture(TextureFormat::R32Float, read),
            output: texture(TextureFormat::Rgba32Float, TextureUsages::STORAGE_BINDING | TextureUsages::COPY_SRC),
            counters: device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("counters"),
                size: COUNTERS_BYTES,
                usage: BufferUsages::STORAGE | BufferUsages::COPY_DST | BufferUsages::COPY_SRC,
                mapped_at_creation: false,
            }),
            exposure: Exposure::Same,
            context,
            device,
            queue,
        })
    }

    pub fn on_cpu(&mut self, index: u64, reset: Reset, views: &[View]) -> (Made, Vec<Image<PixelTrace>>) {
        let size = self.context.size_px;
        let mut output = vec![Image::filled(size, [0.0; 3]); views.len()];
        let mut trace = vec![Image::filled(size, PixelTrace::default()); views.len()];
        let cpu_views: Vec<_> = views
            .iter()
            .map(|v| CpuView {
                depth: v.depth.as_ref(),
                motion: v.motion.as_ref(),
                trust: v.trust.as_ref(),
                ..CpuView::new(v.facts, &v.color)
            })
            .collect();
        let frame = CpuFrame { reset, exposure: self.exposure, ..CpuFrame::new(&cpu_views, index) };
        let stats = self.cpu.process(&frame, &mut output, Some(&mut trace)).unwrap();
        let shown = output.iter().flat_map(|o| o.pixels()).map(|c| c.map(f32::to_bits)).collect();
        (Made { shown, words: self.cpu.history().words().to_vec(), stats }, trace)
    }

    pub fn on_gpu(&mut self, index: u64, reset: Reset, views: &[View]) -> Made {
        self.record(index, reset, views, true, None);
        self.read()
    }

    /// As `on_gpu`, without counting.
    pub fn on_gpu_uncounted(&mut self, index: u64, reset: Reset, views: &[View]) -> Made {
        self.record(index, reset, views, false, None);
        self.read()
    }

    /// What `on_gpu` would decide; shown colours alone.
    pub fn decisions(&mut self, index: u64, reset: Reset, views: &[View], view: DebugView) -> Vec<[u32; 3]> {
        self.record(index, reset, views, true, Some(view));
        self.read().shown
    }

    fn record(&mut self, index: u64, reset: Reset, views: &[View], count: bool, view: Option<DebugView>) {
        self.upload(views);
        let facts: Vec<_> = views.iter().map(|v| v.facts).collect();
        let frame = Frame {
            depth: views[0].depth.is_some().then_some(&self.depth),
            motion: views[0].motion.is_some().then_some(&self.motion),
            trust: views[0].trust.is_some().then_some(&self.trust),
            exposure: self.exposure,
            counters: count.then_some(&self.counters),
            reset,
            ..Frame::new(&self.color, &self.output, &facts, index)
        };
        gpu::validated(&self.device, "record", || {
            let mut encoder = self.device.create_command_encoder(&Default::default());
            match view {
                None => self.gpu.record(&self.device, &mut encoder, &frame).unwrap(),
                Some(view) => self.gpu.record_view(&self.device, &mut encoder, &frame, view).unwrap(),
            };
            self.queue.submit([encoder.finish()]);
        });
    }

    /// The same images twice, with different facts, recorded into one encoder.
    pub fn on_gpu_in_one_submission(&mut self, view: &View, facts: &[ViewFrame]) -> Made {
        self.upload(std::slice::from_ref(view));
        let mut encoder = self.device.create_command_encoder(&Default::default());
        for (index, facts) in facts.iter().enumerate() {
            let frame = Frame {
                depth: Some(&self.depth),
                motion: Some(&self.motion),
                counters: Some(&self.counters),
                ..Frame::new(&self.color, &self.output, std::slice::from_ref(facts), index as u64)
            };
            self.gpu.record(&self.device, &mut encoder, &frame).unwrap();
        }
        self.queue.submit([encoder.finish()]);
        self.read()
    }

    /// Fills the past with words that are NaN as whatever they are read.
    pub fn poison(&self) {
        for texture in self.gpu.history_textures() {
            let texel = texture.format().block_copy_size(None).unwrap();
            let [width, height] = self.context.size_px;
            let bytes = vec![0xff; (texel * width * height) as usize];
            for layer in 0..self.context.view_count as usize {
                self.write(texture, layer, &bytes);
            }
        }
    }

    /// Gives each of two views the other's past.
    pub fn swap_past_layers(&self) {
        let made = self.read();
        let half = made.words.len() / 2;
        for layer in 0..2 {
            let words = &made.words[(1 - layer) * half..(2 - layer) * half];
            let colors: Vec<[u32; 2]> = words.iter().map(|w| [w[0], w[1]]).collect();
            let weights: Vec<u32> = words.iter().map(|w| w[2]).collect();
            let textures = self.gpu.history_textures();
            self.write(&textures[0], layer, bytemuck::cast_slice(&colors));
            self.write(&textures[1], layer, bytemuck::cast_slice(&weights));
        }
    }

    /// Shown colours and stored reservoirs as they are on the device.
    pub fn read(&self) -> Made {
        let shown = self.read_texture(&self.output);
        let [colors, weights] = [0, 1].map(|i| self.read_texture(&self.gpu.history_textures()[i]));
        Made {
            shown: shown.chunks_exact(4).map(|c| [c[0], c[1], c[2]]).collect(),
            words: colors.chunks_exact(2).zip(weights).map(|(c, w)| [c[0], c[1], w]).collect(),
            stats: self.read_counters(),
        }
    }

    fn read_counters(&self) -> FrameStats {
        let readback = self.readback(COUNTERS_BYTES);
        let mut encoder = self.device.create_command_encoder(&Default::default());
        encoder.copy_buffer_to_buffer(&self.counters, 0, &readback, 0, COUNTERS_BYTES);
        FrameStats::from_counters(&self.bytes(encoder, &readback)).unwrap()
    }

    fn readback(&self, size: u64) -> Buffer {
        let usage = BufferUsages::COPY_DST | BufferUsages::MAP_READ;
        let desc = wgpu::BufferDescriptor { label: Some("readback"), size, usage, mapped_at_creation: false };
        self.device.create_buffer(&desc)
    }

    /// What a readback buffer holds after what was recorded.
    fn bytes(&self, encoder: wgpu::CommandEncoder, buffer: &Buffer) -> Vec<u8> {
        self.queue.submit([encoder.finish()]);
        buffer.map_async(wgpu::MapMode::Read, .., |r| r.expect("the readback maps"));
        self.device.poll(wgpu::PollType::wait_indefinitely()).expect("the device finishes");
        buffer.get_mapped_range(..).expect("the readback is mapped").to_vec()
    }

    fn upload(&self, views: &[View]) {
        for (layer, view) in views.iter().enumerate() {
            let color: Vec<[f32; 4]> = view.color.pixels().iter().map(|c| [c[0], c[1], c[2], 1.0]).collect();
            self.write(&self.color, layer, bytemuck::cast_slice(&color));
            if let Some(depth) = &view.depth {
                self.write(&self.depth, layer, bytemuck::cast_slice(depth.pixels()));
            }
            if let Some(motion) = &view.motion {
                self.write(&self.motion, layer, bytemuck::cast_slice(motion.pixels()));
            }
            if let Some(trust) = &view.trust {
                self.write(&self.trust, layer, bytemuck::cast_slice(trust.pixels()));
            }
        }
    }

    fn write(&self, texture: &Texture, layer: usize, bytes: &[u8]) {
        gpu::write_layer(&self.queue, texture, layer, bytes);
    }

    fn read_texture(&self, texture: &Texture) -> Vec<u32> {
        gpu::read_texture(&self.device, &self.queue, texture)
    }
}

pub fn make_texture(device: &Device, context: &ContextDesc, format: TextureFormat, usage: TextureUsages) -> Texture {
    let [width, height] = context.size_px;
    device.create_texture(&wgpu::TextureDescriptor {
        label: Some("test"),
        size: wgpu::Extent3d { width, height, depth_or_array_layers: context.view_count },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage,
        view_formats: &[],
    })
}

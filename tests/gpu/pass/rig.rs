//! Frames through both executors, and the device's results.

use crate::images::{Images, OneView, held_words};
pub use crate::images::{View, noise};
use afterimage::cpu::CpuAfterimage;
use afterimage::gpu::{Afterimage, DebugTarget, Frame, Region, Target};
use afterimage::kernel::debug_view::PixelTrace;
use afterimage::kernel::pack;
use afterimage::shader::SHADERS;
use afterimage::wgpu::{self, Buffer, BufferUsages, Device, Queue, Texture, TextureFormat, TextureUsages};
use afterimage::{
    ContextDesc, DebugView, DepthConvention, Exposure, Filter, FrameStats, Image, Method, Reset, Settings, ViewFrame,
};
use afterimage_testing::Draws;

/// A device with textures of one size, and both executors.
pub struct Rig {
    pub device: Device,
    pub queue: Queue,
    pub context: ContextDesc,
    pub cpu: CpuAfterimage,
    pub gpu: Afterimage,
    /// Of the frames to come.
    pub exposure: Exposure,
    /// Whether inputs and outputs are regions of larger textures, one texture a view, in the frames to come.
    pub scattered: bool,
    /// Debug view to draw beside the next frames, and what it showed.
    pub beside: Option<DebugView>,
    textures: Textures,
    debug: Texture,
    counters: Buffer,
}

/// Inputs and output of one size.
struct Textures {
    color: Texture,
    depth: Texture,
    motion: Texture,
    trust: Texture,
    lod: Texture,
    noise: Texture,
    repaired: Texture,
    output: Texture,
}

impl Textures {
    fn new(device: &Device, context: &ContextDesc) -> Self {
        let texture = |format, usage| make_texture(device, context, format, usage);
        let read = TextureUsages::TEXTURE_BINDING | TextureUsages::COPY_DST | TextureUsages::COPY_SRC;
        let write = TextureUsages::STORAGE_BINDING | TextureUsages::COPY_SRC | TextureUsages::COPY_DST;
        Self {
            color: texture(TextureFormat::Rgba32Float, read),
            depth: texture(TextureFormat::R32Float, read),
            motion: texture(TextureFormat::Rg32Float, read),
            trust: texture(TextureFormat::R32Float, read),
            lod: texture(TextureFormat::R32Float, read),
            noise: texture(TextureFormat::Rg32Float, read),
            repaired: texture(TextureFormat::Rgba32Float, read),
            output: texture(TextureFormat::Rgba32Float, write),
        }
    }
}

/// Result of a frame: output colors and packed history, view after view.
#[derive(Clone, PartialEq, Debug)]
pub struct Made {
    pub shown: Vec<[u32; 3]>,
    pub words: Vec<[u32; 3]>,
    /// Chosen quads of a planned frame: 1, others 0.
    pub quads: Vec<u32>,
    pub stats: FrameStats,
}

impl Rig {
    /// `None`, after a message, without an adapter.
    pub fn new(context: ContextDesc, settings: Settings) -> Option<Self> {
        let pass = match (settings.method, settings.foveation.filter) {
            (Method::Smr(_), Filter::Sparse) => "sparse_pass".to_owned(),
            (Method::Wrs(_), Filter::Sparse) => "wrs_sparse_pass".to_owned(),
            (method, _) => format!("{}_pass", method.name()),
        };
        Self::with_shader(context, settings, &SHADERS.compose(&pass).source)
    }

    /// With another text of the pass on the GPU.
    pub fn with_shader(context: ContextDesc, settings: Settings, source: &str) -> Option<Self> {
        // One storage texture more than WebGPU's default, for views beside the frame.
        let required_limits = wgpu::Limits { max_storage_textures_per_shader_stage: 5, ..wgpu::Limits::default() };
        let desc = wgpu::DeviceDescriptor { required_limits, ..Default::default() };
        let (device, queue) = afterimage_testing::gpu::device_with(&desc)?;
        let context = ContextDesc { settings, ..context };
        let made = || Afterimage::with_shader(&device, &context, TextureFormat::Rgba32Float, source);
        Some(Self {
            cpu: CpuAfterimage::new(&context).unwrap(),
            gpu: afterimage_testing::gpu::validated(&device, "new", made).unwrap(),
            textures: Textures::new(&device, &context),
            debug: debug_texture(&device, &context),
            scattered: false,
            beside: None,
            counters: device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("counters"),
                size: FrameStats::COUNTERS_BYTES,
                usage: BufferUsages::STORAGE | BufferUsages::COPY_DST | BufferUsages::COPY_SRC,
                mapped_at_creation: false,
            }),
            exposure: Exposure::Same,
            context,
            device,
            queue,
        })
    }

    /// Changes the size of both executors and of the textures.
    pub fn resize(&mut self, size: [u32; 2]) {
        self.cpu.resize(size).unwrap();
        self.gpu.resize(&self.device, size).unwrap();
        self.context.size_px = size;
        self.textures = Textures::new(&self.device, &self.context);
        self.debug = debug_texture(&self.device, &self.context);
    }

    /// Changes the size of both executors, which keep their history, and of the textures.
    pub fn resize_keeping_history(&mut self, size: [u32; 2]) {
        self.cpu.resize_keeping_history(size).unwrap();
        afterimage_testing::gpu::validated(&self.device, "resize", || {
            let mut encoder = self.device.create_command_encoder(&Default::default());
            self.gpu.resize_keeping_history(&self.device, &mut encoder, size).unwrap();
            self.queue.submit([encoder.finish()]);
        });
        self.context.size_px = size;
        self.textures = Textures::new(&self.device, &self.context);
        self.debug = debug_texture(&self.device, &self.context);
    }

    /// Stored history of both executors.
    pub fn histories(&self) -> [Vec<[u32; 3]>; 2] {
        [held_words(&self.cpu), self.read().words]
    }

    /// What was drawn beside the last frame: linear color as halves.
    pub fn beside(&self) -> Vec<u32> {
        self.read_texture(&self.debug)
    }

    /// Makes the color input an atlas of another size.
    pub fn resize_color(&mut self, size_px: [u32; 2]) {
        let atlas = ContextDesc { size_px, ..self.context };
        let usage = TextureUsages::TEXTURE_BINDING | TextureUsages::COPY_DST | TextureUsages::COPY_SRC;
        self.textures.color = make_texture(&self.device, &atlas, TextureFormat::Rgba32Float, usage);
    }

    /// Stores motion as halves on the device from now on.
    pub fn halve_motion(&mut self) {
        let usage = TextureUsages::TEXTURE_BINDING | TextureUsages::COPY_DST;
        self.textures.motion = make_texture(&self.device, &self.context, TextureFormat::Rg16Float, usage);
    }

    /// Sets the history of both executors.
    pub fn restore(&mut self, words: &[[u32; 3]]) {
        self.cpu.restore_history(words);
        let (textures, len) = (self.gpu.history_textures(), words.len() / self.context.view_count as usize);
        for (layer, words) in words.chunks(len).enumerate() {
            let colors: Vec<[u32; 2]> = words.iter().map(|w| [w[0], w[1]]).collect();
            let weights: Vec<u32> = words.iter().map(|w| w[2]).collect();
            self.write(&textures[0], layer, bytemuck::cast_slice(&colors));
            self.write(&textures[1], layer, bytemuck::cast_slice(&weights));
        }
    }

    /// Processes a frame on both executors, which must agree in every bit of output, history and counters.
    #[track_caller]
    pub fn both(&mut self, index: u64, reset: Reset, views: &[View]) -> (Made, Vec<Image<PixelTrace>>) {
        let (cpu, trace) = self.on_cpu(index, reset, views);
        let gpu = self.on_gpu(index, reset, views);
        if gpu != cpu {
            let at = (0..cpu.words.len()).find(|&i| gpu.words[i] != cpu.words[i] || gpu.shown[i] != cpu.shown[i]);
            panic!("frame {index}: GPU and CPU differ, first at pixel {at:?}; {:?}, {:?}", gpu.stats, cpu.stats);
        }
        (cpu, trace)
    }

    pub fn on_cpu(&mut self, index: u64, reset: Reset, views: &[View]) -> (Made, Vec<Image<PixelTrace>>) {
        let size = self.context.size_px;
        let mut output = vec![Image::filled(size, [0.0; 3]); views.len()];
        let mut trace = vec![Image::filled(size, PixelTrace::default()); views.len()];
        let cpu_views: Vec<_> = views.iter().map(View::one).collect();
        let images = Images::of(&cpu_views);
        let frame = afterimage::cpu::Frame { reset, exposure: self.exposure, ..images.frame(index) };
        let repaired: Vec<_> = views.iter().filter_map(|v| v.repaired.as_ref()).collect();
        let repaired = (!repaired.is_empty()).then_some(&repaired[..]);
        let quads = match repaired {
            Some(_) => self.cpu.plan(&frame).unwrap().iter().flat_map(quads_of).collect(),
            None => vec![],
        };
        let frame = afterimage::cpu::Frame { repaired, ..frame };
        let stats = self.cpu.process_traced(&frame, &mut output, &mut trace).unwrap();
        let shown = output.iter().flat_map(|o| o.pixels()).map(|c| c.map(f32::to_bits)).collect();
        (Made { shown, words: held_words(&self.cpu), quads, stats }, trace)
    }

    /// Whether the executors differ on a frame: what a planted error must do.
    pub fn differs(&mut self, index: u64, reset: Reset, views: &[View]) -> bool {
        self.on_gpu(index, reset, views) != self.on_cpu(index, reset, views).0
    }

    pub fn on_gpu(&mut self, index: u64, reset: Reset, views: &[View]) -> Made {
        self.record(index, reset, views, true, None);
        self.read()
    }

    /// Errors of both executors for a frame that they must reject.
    pub fn refusal(&mut self, view: &View) -> String {
        self.upload(std::slice::from_ref(view));
        let frame = Frame {
            noise: view.noise.is_some().then_some((&self.textures.noise).into()),
            ..Frame::new(&self.textures.color, std::slice::from_ref(&view.facts), 0)
        };
        let output = &self.textures.output;
        let mut encoder = self.device.create_command_encoder(&Default::default());
        let gpu = self.gpu.record(&self.device, &mut encoder, &frame, output).unwrap_err().to_string();
        let images = Images::of(&[OneView { noise: view.noise.as_ref(), ..OneView::new(view.facts, &view.color) }]);
        let mut output = [Image::filled(self.context.size_px, [0.0; 3])];
        let cpu = self.cpu.process(&images.frame(0), &mut output).unwrap_err().to_string();
        assert_eq!(gpu, cpu);
        cpu
    }

    /// As `on_gpu`, without counting.
    pub fn on_gpu_uncounted(&mut self, index: u64, reset: Reset, views: &[View]) -> Made {
        self.record(index, reset, views, false, None);
        self.read()
    }

    /// Debug view of the decisions of `on_gpu`; output colors only.
    pub fn decisions(&mut self, index: u64, reset: Reset, views: &[View], view: DebugView) -> Vec<[u32; 3]> {
        self.record(index, reset, views, true, Some(view));
        self.read().shown
    }

    fn record(&mut self, index: u64, reset: Reset, views: &[View], count: bool, view: Option<DebugView>) {
        self.upload(views);
        let facts: Vec<_> = views.iter().map(|v| v.facts).collect();
        let frame = Frame {
            depth: views[0].depth.is_some().then_some((&self.textures.depth).into()),
            motion: views[0].motion.is_some().then_some((&self.textures.motion).into()),
            trust: views[0].trust.is_some().then_some((&self.textures.trust).into()),
            lod: views[0].lod.is_some().then_some((&self.textures.lod).into()),
            noise: views[0].noise.is_some().then_some((&self.textures.noise).into()),
            repaired: views[0].repaired.is_some().then_some((&self.textures.repaired).into()),
            exposure: self.exposure,
            reset,
            ..Frame::new(&self.textures.color, &facts, index)
        };
        let debug = self.beside.map(|view| DebugTarget { view, output: (&self.debug).into() });
        let target = Target { debug, counters: count.then_some(&self.counters), ..Target::new(&self.textures.output) };
        let scattered = |texture, number| Scattered::new(&self.device, &self.queue, texture, number);
        let textures = &self.textures;
        let inputs = [
            &textures.color,
            &textures.depth,
            &textures.motion,
            &textures.trust,
            &textures.lod,
            &textures.noise,
            &textures.repaired,
        ];
        let inputs: Vec<_> = (0..).zip(inputs).filter(|_| self.scattered).map(|(i, t)| scattered(t, i)).collect();
        let outputs: Vec<_> = [(&textures.output, 7), (&self.debug, 8)]
            .into_iter()
            .filter(|_| self.scattered)
            .map(|(t, i)| scattered(t, i))
            .collect();
        let regions: Vec<_> = inputs.iter().chain(&outputs).map(Scattered::regions).collect();
        let of = |i: usize, plain| regions.get(i).map_or(plain, |r| afterimage::gpu::Textures::Regions(r));
        let frame = Frame {
            color: of(0, frame.color),
            depth: frame.depth.map(|t| of(1, t)),
            motion: frame.motion.map(|t| of(2, t)),
            trust: frame.trust.map(|t| of(3, t)),
            lod: frame.lod.map(|t| of(4, t)),
            noise: frame.noise.map(|t| of(5, t)),
            repaired: frame.repaired.map(|t| of(6, t)),
            ..frame
        };
        let debug = target.debug.map(|d| DebugTarget { output: of(8, d.output), ..d });
        let target = Target { output: of(7, target.output), debug, ..target };
        afterimage_testing::gpu::validated(&self.device, "record", || {
            let mut encoder = self.device.create_command_encoder(&Default::default());
            inputs.iter().for_each(|i| i.scatter(&mut encoder));
            if frame.repaired.is_some() {
                self.gpu.plan(&self.device, &mut encoder, &frame).unwrap();
            }
            match view {
                None => self.gpu.record(&self.device, &mut encoder, &frame, target).unwrap(),
                Some(view) => self.gpu.record_view(&self.device, &mut encoder, &frame, target, view).unwrap(),
            };
            outputs.iter().for_each(|o| o.gather(&mut encoder));
            self.queue.submit([encoder.finish()]);
        });
    }

    /// The same images twice, with different descriptions, recorded into one encoder.
    pub fn on_gpu_in_one_submission(&mut self, view: &View, facts: &[ViewFrame]) -> Made {
        self.upload(std::slice::from_ref(view));
        let mut encoder = self.device.create_command_encoder(&Default::default());
        for (index, facts) in facts.iter().enumerate() {
            let frame = Frame {
                depth: Some((&self.textures.depth).into()),
                motion: Some((&self.textures.motion).into()),
                ..Frame::new(&self.textures.color, std::slice::from_ref(facts), index as u64)
            };
            let target = Target { counters: Some(&self.counters), ..Target::new(&self.textures.output) };
            self.gpu.record(&self.device, &mut encoder, &frame, target).unwrap();
        }
        self.queue.submit([encoder.finish()]);
        self.read()
    }

    /// Fills history, all its levels, with words that are NaN in any format.
    pub fn poison(&self) {
        for texture in self.gpu.history_textures() {
            for level in 0..texture.mip_level_count() {
                afterimage_testing::gpu::fill_level(&self.queue, texture, level, 0xff);
            }
        }
    }

    /// Swaps the history of two views, on the GPU alone.
    pub fn swap_past_layers(&mut self) {
        let mut words = self.read().words;
        let half = words.len() / 2;
        words.rotate_left(half);
        let cpu = self.cpu.clone();
        self.restore(&words);
        self.cpu = cpu;
    }

    /// Output colors and stored history, read back from the device.
    pub fn read(&self) -> Made {
        let shown = self.read_texture(&self.textures.output);
        let held: Vec<_> =
            self.gpu.history_textures().iter().take(2).map(|t| (t.format(), self.read_texture(t))).collect();
        Made {
            shown: shown.chunks_exact(4).map(|c| [c[0], c[1], c[2]]).collect(),
            words: match &held[..] {
                [(_, colors), (TextureFormat::R32Uint, weights)] => {
                    colors.chunks_exact(2).zip(weights).map(|(c, &w)| [c[0], c[1], w]).collect()
                }
                [(_, surfaces), ..] => {
                    let noise = self.gpu.history_textures().get(2).map(|t| self.read_texture(t)).unwrap_or_default();
                    let noise = noise.into_iter().chain(std::iter::repeat(0));
                    surfaces.chunks_exact(2).zip(noise).map(|(s, n)| [s[0], s[1], n]).collect()
                }
                [] => vec![],
            },
            // As it was planned last.
            quads: self.gpu.repair_mask().map_or_else(Vec::new, |mask| self.read_texture(mask)),
            stats: self.read_counters(),
        }
    }

    fn read_counters(&self) -> FrameStats {
        let bytes: Vec<u8> = afterimage_testing::gpu::read_buffer(&self.device, &self.queue, &self.counters);
        FrameStats::from_counters(&bytes).unwrap()
    }

    fn upload(&self, views: &[View]) {
        for (layer, view) in views.iter().enumerate() {
            let color: Vec<[f32; 4]> = view.color.pixels().iter().map(|c| [c[0], c[1], c[2], 1.0]).collect();
            self.write(&self.textures.color, layer, bytemuck::cast_slice(&color));
            if let Some(depth) = &view.depth {
                self.write(&self.textures.depth, layer, bytemuck::cast_slice(depth.pixels()));
            }
            if let Some(motion) = &view.motion {
                let halves: Vec<[u16; 2]> =
                    motion.pixels().iter().map(|m| m.map(|v| pack::half_bits(v) as u16)).collect();
                let bytes = match self.textures.motion.format() {
                    TextureFormat::Rg16Float => bytemuck::cast_slice(&halves),
                    _ => bytemuck::cast_slice(motion.pixels()),
                };
                self.write(&self.textures.motion, layer, bytes);
            }
            if let Some(trust) = &view.trust {
                self.write(&self.textures.trust, layer, bytemuck::cast_slice(trust.pixels()));
            }
            if let Some(lod) = &view.lod {
                self.write(&self.textures.lod, layer, bytemuck::cast_slice(lod.pixels()));
            }
            if let Some(repaired) = &view.repaired {
                let color: Vec<[f32; 4]> = repaired.pixels().iter().map(|c| [c[0], c[1], c[2], 1.0]).collect();
                self.write(&self.textures.repaired, layer, bytemuck::cast_slice(&color));
            }
            if let Some(noise) = &view.noise {
                self.write(&self.textures.noise, layer, bytemuck::cast_slice(noise.pixels()));
            }
        }
    }

    fn write(&self, texture: &Texture, layer: usize, bytes: &[u8]) {
        afterimage_testing::gpu::write_layer(&self.queue, texture, layer, bytes);
    }

    fn read_texture(&self, texture: &Texture) -> Vec<u32> {
        afterimage_testing::gpu::read_texture(&self.device, &self.queue, texture)
    }
}

/// The quads of a mask.
fn quads_of(mask: &Image<bool>) -> Vec<u32> {
    let quads = (0..mask.height()).step_by(2).flat_map(|y| (0..mask.width()).step_by(2).map(move |x| (x, y)));
    quads.map(|(x, y)| u32::from(mask.at(x, y))).collect()
}

/// The views of a texture, as regions of larger textures that contain NaN elsewhere.
struct Scattered<'a> {
    texture: &'a Texture,
    places: Vec<(Texture, [u32; 2])>,
}

impl<'a> Scattered<'a> {
    /// Origins and sizes follow from `number` and the view's index.
    fn new(device: &Device, queue: &Queue, texture: &'a Texture, number: u32) -> Self {
        let place = |view: u32| {
            let origin = [3 + 2 * number + view, 1 + number + 5 * view];
            let larger = device.create_texture(&wgpu::TextureDescriptor {
                label: Some("scattered"),
                size: wgpu::Extent3d {
                    width: texture.width() + origin[0] + number % 3,
                    height: texture.height() + origin[1] + view,
                    depth_or_array_layers: view + 1,
                },
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format: texture.format(),
                usage: texture.usage() | TextureUsages::COPY_SRC | TextureUsages::COPY_DST,
                view_formats: &[],
            });
            afterimage_testing::gpu::fill_level(queue, &larger, 0, 0xff);
            (larger, origin)
        };
        Self { texture, places: (0..texture.depth_or_array_layers()).map(place).collect() }
    }

    /// Each view is in the last layer of its texture.
    fn regions(&self) -> Vec<Region<'_>> {
        let region = |(texture, origin_px): &'_ (Texture, _)| (texture.depth_or_array_layers() - 1, *origin_px);
        let regions = self.places.iter().map(|place| (&place.0, region(place)));
        regions.map(|(texture, (layer, origin_px))| Region { texture, origin_px, layer }).collect()
    }

    fn scatter(&self, encoder: &mut wgpu::CommandEncoder) {
        self.copy(encoder, |plain, place| (plain, place));
    }

    fn gather(&self, encoder: &mut wgpu::CommandEncoder) {
        self.copy(encoder, |plain, place| (place, plain));
    }

    fn copy<'t>(
        &'t self,
        encoder: &mut wgpu::CommandEncoder,
        order: impl Fn(
            wgpu::TexelCopyTextureInfo<'t>,
            wgpu::TexelCopyTextureInfo<'t>,
        ) -> (wgpu::TexelCopyTextureInfo<'t>, wgpu::TexelCopyTextureInfo<'t>),
    ) {
        for (view, (texture, [x, y])) in (0..).zip(&self.places) {
            let at = |x, y, z| wgpu::Origin3d { x, y, z };
            let plain = wgpu::TexelCopyTextureInfo { origin: at(0, 0, view), ..self.texture.as_image_copy() };
            let place = wgpu::TexelCopyTextureInfo { origin: at(*x, *y, view), ..texture.as_image_copy() };
            let (width, height) = (self.texture.width(), self.texture.height());
            let (from, to) = order(plain, place);
            encoder.copy_texture_to_texture(from, to, wgpu::Extent3d { width, height, depth_or_array_layers: 1 });
        }
    }
}

fn debug_texture(device: &Device, context: &ContextDesc) -> Texture {
    let usage = TextureUsages::STORAGE_BINDING | TextureUsages::COPY_SRC | TextureUsages::COPY_DST;
    make_texture(device, context, TextureFormat::Rgba16Float, usage)
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

/// Packed reservoirs with another weight sum.
pub fn with_w_sum(words: &[[u32; 3]], w_sum: f32) -> Vec<[u32; 3]> {
    words.iter().map(|&w| pack::pack(pack::Stored { w_sum, ..pack::unpack(w) })).collect()
}

/// Colors that are noise, moving by whole and half pixels, over two depths.
pub fn noise_view(name: &str, desc: &ContextDesc) -> View {
    let mut draws = Draws::new(name);
    let size = desc.size_px;
    let scale = desc.motion.to_internal(size);
    let px = [draws.uniform() * size[0] as f32, draws.uniform() * size[1] as f32];
    let stored = |z: f32| match desc.depth {
        DepthConvention::Linear => z,
        DepthConvention::Forward { near, far } => (1.0 / near - 1.0 / z) / (1.0 / near - 1.0 / far),
        DepthConvention::Reversed { near, far } => (1.0 / z - 1.0 / far) / (1.0 / near - 1.0 / far),
        DepthConvention::Orthographic { near, far } => (z - near) / (far - near),
        other => panic!("{other:?}: a convention that the rig does not know"),
    };
    let color = Image::from_fn(size, |_| [draws.uniform(), draws.uniform(), draws.uniform()]);
    View {
        depth: Some(Image::from_fn(size, |[x, _]| stored(if x % 16 < 8 { 2.0 } else { 30.0 }))),
        motion: Some(Image::from_fn(size, |[x, y]| {
            let m = if (x / 8 + y / 8) % 2 == 0 { [16.0, -1.0] } else { [-0.5, 2.5] };
            [m[0] / scale[0], m[1] / scale[1]]
        })),
        ..View::still(color, px)
    }
}

//! Frames through both executors, and the device's results.

use crate::images::{Images, held_words, pixel, pixels, planned, traced, traced_alpha};
pub use crate::images::{View, noise};
use afterimage::cpu::CpuAfterimage;
use afterimage::gpu::{Afterimage, DebugTarget, Frame, Region, Target, Textures};
use afterimage::internal::{ContextDesc, FoveationKind, Reset, Settings};
use afterimage::internal::{Sources, method_pass};
use afterimage::kernel::debug_view::PixelTrace;
use afterimage::kernel::{pack, stored_reservoir};
use afterimage::shader::SHADERS;
use afterimage::wgpu::{self, Buffer, BufferUsages, Device, Queue, Texture, TextureFormat, TextureUsages};
use afterimage::{DebugView, DepthConvention, Exposure, FrameStats, Image};
use afterimage_testing::planted::all_caught;
use afterimage_testing::{Draws, agree};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// Devices that no test uses now, and what they have compiled. Making modules and pipelines took a third of the time of
/// these tests.
static IDLE: Mutex<Vec<(Device, Queue, Sources)>> = Mutex::new(vec![]);

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
    /// Whether the encoders of frames and resizes to come are dropped instead of submitted.
    pub drops: bool,
    /// Debug view to draw beside the next frames, and what it showed.
    pub beside: Option<DebugView>,
    /// Alpha of the colors of planned frames to come, one image a view; 1, and not read back, without.
    pub alpha: Option<Vec<Image<f32>>>,
    textures: [Texture; 12],
    counters: Buffer,
    /// What the device has compiled; `None` once it is of no use to other tests.
    compiled: Option<Sources>,
}

impl Drop for Rig {
    fn drop(&mut self) {
        // A recording is of one test.
        let is_reusable = !std::thread::panicking() && !afterimage_testing::gpu::is_recorded();
        if let Some(compiled) = self.compiled.take().filter(|_| is_reusable) {
            idle().push((self.device.clone(), self.queue.clone(), compiled));
        }
    }
}

fn idle() -> MutexGuard<'static, Vec<(Device, Queue, Sources)>> {
    IDLE.lock().unwrap_or_else(PoisonError::into_inner)
}

/// A device that no test uses now. Uncaptured errors panic.
fn idle_device() -> Option<(Device, Queue, Sources)> {
    let idle = idle().pop();
    idle.or_else(|| {
        let (device, queue) = device_of_five_outputs()?;
        Some((device, queue, Sources::default()))
    })
}

/// A fresh device with one storage texture more than WebGPU's default, for views beside the frame.
pub fn device_of_five_outputs() -> Option<(Device, Queue)> {
    let required_limits = wgpu::Limits { max_storage_textures_per_shader_stage: 5, ..wgpu::Limits::default() };
    afterimage_testing::gpu::device_with(&wgpu::DeviceDescriptor { required_limits, ..Default::default() })
}

// Places of textures: color, depth, motion, trust and reactive masks, levels of detail, noise, own mask, colors of half
// the size and albedo; output, debug view.
const COLOR: usize = 0;
const MOTION: usize = 2;
const NOISE: usize = 6;
const HALF: usize = 8;
const ALBEDO: usize = 9;
const OUTPUT: usize = 10;
const DEBUG: usize = 11;

const READ: TextureUsages =
    TextureUsages::TEXTURE_BINDING.union(TextureUsages::COPY_DST).union(TextureUsages::COPY_SRC);

fn make_textures(device: &Device, context: &ContextDesc) -> [Texture; 12] {
    std::array::from_fn(|i| {
        let format = match i {
            COLOR | HALF | ALBEDO | OUTPUT => TextureFormat::Rgba32Float,
            DEBUG => TextureFormat::Rgba16Float,
            MOTION | NOISE => TextureFormat::Rg32Float,
            _ => TextureFormat::R32Float,
        };
        let written = TextureUsages::STORAGE_BINDING | TextureUsages::COPY_SRC | TextureUsages::COPY_DST;
        let half = ContextDesc { size_px: context.size_px.map(|side| side.div_ceil(2)), ..*context };
        make_texture(device, if i == HALF { &half } else { context }, format, if i < OUTPUT { READ } else { written })
    })
}

/// Texels of each input that a view has. `alpha`: of its color.
fn texels(view: &View, alpha: Option<&Image<f32>>) -> [Option<Vec<f32>>; OUTPUT] {
    let one = |image: &Image<f32>| image.pixels().to_vec();
    let two = |image: &Image<[f32; 2]>| image.pixels().as_flattened().to_vec();
    let four = |image: &Image<[f32; 3]>| image.pixels().iter().flat_map(|c| [c[0], c[1], c[2], 1.0]).collect();
    let mut color: Vec<f32> = four(&view.color);
    for (texel, alpha) in color.chunks_exact_mut(4).zip(alpha.iter().flat_map(|alpha| alpha.pixels())) {
        texel[3] = *alpha;
    }
    [
        Some(color),
        view.depth.as_ref().map(one),
        view.motion.as_ref().map(two),
        view.trust.as_ref().map(one),
        view.reactive.as_ref().map(one),
        view.lod.as_ref().map(one),
        view.noise.as_ref().map(two),
        view.mask.as_ref().map(one),
        view.half.as_ref().map(four),
        view.albedo.as_ref().map(four),
    ]
}

/// The frame with those of the textures that the view has.
fn given<'a>(view: &View, textures: [Textures<'a>; 12], frame: Frame<'a>) -> Frame<'a> {
    let [_, depth, motion, trust, reactive, lod, noise, mask, half, albedo, ..] = textures;
    Frame {
        depth: view.depth.is_some().then_some(depth),
        motion: view.motion.is_some().then_some(motion),
        trust: view.trust.is_some().then_some(trust),
        reactive: view.reactive.is_some().then_some(reactive),
        lod: view.lod.is_some().then_some(lod),
        noise: view.noise.is_some().then_some(noise),
        mask: view.mask.is_some().then_some(mask),
        half: view.half.is_some().then_some(half),
        albedo: view.albedo.is_some().then_some(albedo),
        ..frame
    }
}

/// Result of a frame: output colors and packed history, view after view.
#[derive(Clone, PartialEq, Debug)]
pub struct Made {
    pub shown: Vec<[u32; 3]>,
    pub words: Vec<[u32; 3]>,
    /// Masks of the quads of a planned frame: a bit for each of their pixels inside the frame.
    pub quads: Vec<u32>,
    /// Number of paths of each chosen pixel of those quads.
    pub paths: Vec<u32>,
    /// Output alphas of frames with [alpha](Rig::alpha).
    pub alpha: Vec<u32>,
    /// Packed albedos of history, of contexts with albedo.
    pub albedo: Vec<u32>,
    pub stats: FrameStats,
}

impl Made {
    /// Whether the device's result is the CPU's: in every bit, or, on an adapter that rounds otherwise, the same
    /// picture ([`agree::pictures`]), with counters of as many pixels.
    ///
    /// # Errors
    /// How it differs.
    pub fn agrees(&self, cpu: &Self) -> Result<(), String> {
        if afterimage_testing::gpu::rounds_as_the_cpu() {
            let differs = |&i: &usize| {
                let is_colored = self.words.get(i) != cpu.words.get(i) || self.shown[i] != cpu.shown[i];
                is_colored || self.alpha.get(i) != cpu.alpha.get(i) || self.albedo.get(i) != cpu.albedo.get(i)
            };
            let first = (0..cpu.shown.len()).find(differs);
            let quads = self.quads.iter().zip(&cpu.quads).filter(|(gpu, cpu)| gpu != cpu).count();
            return if self == cpu { Ok(()) } else { Err(format!("first at pixel {first:?}, {quads} quads")) };
        }
        same_counts(&self.stats, &cpu.stats)?;
        agree::pictures(&self.shown, &cpu.shown)
    }
}

/// Whether the device counts as the CPU does: exactly, or, on an adapter that rounds otherwise, nearly as many pixels.
///
/// # Errors
/// How they differ.
pub fn same_counts(gpu: &FrameStats, cpu: &FrameStats) -> Result<(), String> {
    if gpu == cpu {
        return Ok(());
    }
    if afterimage_testing::gpu::rounds_as_the_cpu() {
        return Err(format!("{gpu:?}, not {cpu:?}"));
    }
    let counted = [gpu, cpu].map(|stats| [stats.replaced, stats.nonfinite, stats.rejected()]);
    agree::counts(&counted[0], &counted[1], cpu.pixels)
}

impl Rig {
    /// `None`, after a message, without an adapter.
    pub fn new(context: ContextDesc, settings: Settings) -> Option<Self> {
        Self::with_sources(context, settings, |sources| sources)
    }

    /// Several of these descriptions.
    pub fn each<const N: usize>(of: [(ContextDesc, Settings); N]) -> Option<[Self; N]> {
        let rigs: Option<Vec<_>> = of.into_iter().map(|(context, settings)| Self::new(context, settings)).collect();
        rigs?.try_into().ok()
    }

    /// With another text of the method's pass on the GPU.
    pub fn with_shader(context: ContextDesc, settings: Settings, source: &str) -> Option<Self> {
        Self::with_sources(context, settings, |sources| sources.with(method_pass(&settings), source))
    }

    /// With other texts of the passes on the GPU.
    pub fn with_sources(
        context: ContextDesc,
        settings: Settings,
        change: impl FnOnce(Sources) -> Sources,
    ) -> Option<Self> {
        let (device, queue, compiled) = idle_device()?;
        let sources = change(compiled.clone());
        let context = ContextDesc { settings, ..context };
        let made = || Afterimage::with_sources(&device, &context, TextureFormat::Rgba32Float, sources.clone());
        Some(Self {
            cpu: CpuAfterimage::new(&context).unwrap(),
            gpu: afterimage_testing::gpu::validated(&device, "new", made).unwrap(),
            textures: make_textures(&device, &context),
            scattered: false,
            drops: false,
            beside: None,
            alpha: None,
            counters: make_counters(&device),
            exposure: Exposure::Same,
            compiled: Some(compiled),
            context,
            device,
            queue,
        })
    }

    /// Changes the settings of both executors.
    pub fn set_settings(&mut self, settings: Settings) {
        self.cpu.set_settings(settings).unwrap();
        self.gpu.set_settings(&self.device, settings).unwrap();
    }

    /// Discards the history of both executors.
    pub fn forget(&mut self) {
        self.cpu.forget();
        self.gpu.forget();
    }

    /// Loses the device.
    pub fn lose(&mut self) {
        self.compiled = None;
        self.device.destroy();
    }

    /// Changes the size of both executors and of the textures.
    pub fn resize(&mut self, size: [u32; 2]) {
        self.cpu.resize(size).unwrap();
        self.gpu.resize(&self.device, size).unwrap();
        self.remake_textures(size);
    }

    /// Changes the size of both executors, which keep their history, and of the textures.
    pub fn resize_keeping_history(&mut self, size: [u32; 2]) {
        self.cpu.resize_keeping_history(size).unwrap();
        afterimage_testing::gpu::validated(&self.device, "resize", || {
            let mut encoder = self.device.create_command_encoder(&Default::default());
            self.gpu.resize_keeping_history(&self.device, &mut encoder, size).unwrap();
            submit(&self.queue, self.drops, encoder);
        });
        self.remake_textures(size);
    }

    fn remake_textures(&mut self, size: [u32; 2]) {
        self.context.size_px = size;
        self.textures = make_textures(&self.device, &self.context);
    }

    /// Whether frames are shaded by quads.
    fn is_by_quads(&self) -> bool {
        self.cpu.desc().settings.foveation.kind == FoveationKind::Quads
    }

    /// Stored history of both executors.
    pub fn histories(&self) -> [Vec<[u32; 3]>; 2] {
        [held_words(&self.cpu), self.read().words]
    }

    /// What was drawn beside the last frame: linear color as halves.
    pub fn beside(&self) -> Vec<u32> {
        self.read_texture(&self.textures[DEBUG])
    }

    /// Stores motion as halves on the device from now on.
    pub fn halve_motion(&mut self) {
        self.textures[MOTION] = make_texture(&self.device, &self.context, TextureFormat::Rg16Float, READ);
    }

    /// Sets the history of both executors.
    pub fn restore(&mut self, words: &[[u32; 3]]) {
        self.cpu.restore_history(words);
        self.restore_gpu(words);
    }

    /// Sets the history of the GPU, but for mip chains: what `read` reads.
    fn restore_gpu(&self, words: &[[u32; 3]]) {
        let (textures, len) = (self.gpu.history_textures(), words.len() / self.context.view_count as usize);
        let third = third_words(&textures);
        for (layer, words) in words.chunks(len.max(1)).enumerate() {
            let two: Vec<[u32; 2]> = words.iter().map(|w| [w[0], w[1]]).collect();
            self.write(&textures[0], layer, bytemuck::cast_slice(&two));
            if let Some(third) = third {
                let one: Vec<u32> = words.iter().map(|w| w[2]).collect();
                self.write(third, layer, bytemuck::cast_slice(&one));
            }
        }
    }

    /// Gives an adapter that rounds otherwise the CPU's history after every other frame: rounding errors do not add up,
    /// and what a frame stores is shown by the next one.
    pub fn goes_on_from(&self, index: u64, cpu: &Made) {
        if index % 2 == 1 && !afterimage_testing::gpu::rounds_as_the_cpu() {
            self.restore_gpu(&cpu.words);
        }
    }

    /// Processes a frame on both executors, which must agree: [`Made::agrees`].
    #[track_caller]
    pub fn both(&mut self, index: u64, reset: Reset, views: &[View]) -> (Made, Vec<Image<PixelTrace>>) {
        let (cpu, trace) = self.on_cpu(index, reset, views);
        let gpu = self.on_gpu(index, reset, views);
        if let Err(difference) = gpu.agrees(&cpu) {
            panic!("frame {index}: GPU and CPU differ, {difference}; {:?}, {:?}", gpu.stats, cpu.stats);
        }
        self.goes_on_from(index, &cpu);
        (cpu, trace)
    }

    pub fn on_cpu(&mut self, index: u64, reset: Reset, views: &[View]) -> (Made, Vec<Image<PixelTrace>>) {
        let images = Images::of(views);
        let frame = afterimage::cpu::Frame { reset, exposure: self.exposure, ..images.frame(index) };
        let masks = planned(&mut self.cpu, &frame);
        let quads = masks.iter().flat_map(quads_of).collect();
        let paths = match frame.mask.is_some() || masks.is_empty() {
            true => masks.iter().flat_map(quads_of).map(|mask| mask.min(1)).collect(),
            false => self.cpu.paths().iter().flat_map(paths_of).collect(),
        };
        let (output, trace, stats, alpha) = match &self.alpha {
            Some(given) => traced_alpha(&mut self.cpu, &frame, given),
            None => {
                let (output, trace, stats) = traced(&mut self.cpu, &frame);
                (output, trace, stats, vec![])
            }
        };
        let alpha = alpha.iter().flat_map(|o| o.pixels()).map(|alpha| alpha.to_bits()).collect();
        let shown = output.iter().flat_map(|o| o.pixels()).map(|c| c.map(f32::to_bits)).collect();
        let albedo = self.cpu.history().albedo().to_vec();
        (Made { shown, words: held_words(&self.cpu), quads, paths, alpha, albedo, stats }, trace)
    }

    /// Whether the executors differ on a frame: what a planted error must do.
    pub fn differs(&mut self, index: u64, reset: Reset, views: &[View]) -> bool {
        let (gpu, cpu) = (self.on_gpu(index, reset, views), self.on_cpu(index, reset, views).0);
        self.goes_on_from(index, &cpu);
        gpu.agrees(&cpu).is_err()
    }

    pub fn on_gpu(&mut self, index: u64, reset: Reset, views: &[View]) -> Made {
        self.record(index, reset, views, true, None);
        self.read()
    }

    /// Errors of both executors for a frame that they must reject.
    pub fn refusal(&mut self, view: &View) -> String {
        self.upload(std::slice::from_ref(view));
        let textures = self.textures.each_ref().map(Textures::from);
        let frame = given(view, textures, Frame::new(textures[0], std::slice::from_ref(&view.facts), 0));
        let output = &self.textures[OUTPUT];
        let mut encoder = self.device.create_command_encoder(&Default::default());
        let gpu = self.gpu.record(&self.device, &mut encoder, &frame, output).unwrap_err().to_string();
        let images = Images::of([view]);
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
        let all = (0..).zip(&self.textures).filter(|_| self.scattered);
        let all: Vec<_> = all.map(|(i, texture)| Scattered::new(&self.device, &self.queue, texture, i)).collect();
        let regions: Vec<_> = all.iter().map(Scattered::regions).collect();
        let textures: [_; 12] =
            std::array::from_fn(|i| regions.get(i).map_or((&self.textures[i]).into(), |r| Textures::Regions(r)));
        let [.., output, debug] = textures;
        let frame = Frame {
            exposure: self.exposure,
            reset,
            ..given(&views[0], textures, Frame::new(textures[0], &facts, index))
        };
        let debug = self.beside.map(|view| DebugTarget { view, output: debug });
        let target = Target { debug, counters: count.then_some(&self.counters), ..Target::new(output) };
        let is_planned = self.is_by_quads() && frame.mask.is_none();
        afterimage_testing::gpu::validated(&self.device, "record", || {
            let mut encoder = self.device.create_command_encoder(&Default::default());
            all.iter().take(OUTPUT).for_each(|input| input.copy(&mut encoder, true));
            if is_planned {
                self.gpu.plan(&self.device, &mut encoder, &frame).unwrap();
            }
            match view {
                None => self.gpu.record(&self.device, &mut encoder, &frame, target).unwrap(),
                Some(view) => self.gpu.record_view(&self.device, &mut encoder, &frame, target, view).unwrap(),
            };
            all.iter().skip(OUTPUT).for_each(|output| output.copy(&mut encoder, false));
            submit(&self.queue, self.drops, encoder);
        });
    }

    /// Fills history, all its levels, with words that are NaN in any format.
    pub fn poison(&self) {
        for texture in
            self.gpu.history_textures().into_iter().chain(self.gpu.alpha_texture()).chain(self.gpu.albedo_texture())
        {
            for level in 0..texture.mip_level_count() {
                afterimage_testing::gpu::fill_level(&self.queue, &texture, level, 0xff);
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
        let shown = self.read_texture(&self.textures[OUTPUT]);
        let history = self.gpu.history_textures();
        let two = history.first().map(|texture| self.read_texture(texture)).unwrap_or_default();
        let third = third_words(&history).map(|texture| self.read_texture(texture)).unwrap_or_default();
        let third = third.into_iter().chain(std::iter::repeat(0));
        // As it was planned last.
        let mask = self.gpu.quad_mask().map(|mask| self.read_texture(mask)).unwrap_or_default();
        let counters: Vec<u8> = afterimage_testing::gpu::read_buffer(&self.device, &self.queue, &self.counters);
        let inside = self.inside();
        let quads: Vec<u32> = mask.iter().zip(inside).map(|(word, inside)| word & inside).collect();
        Made {
            shown: shown.chunks_exact(4).map(|c| [c[0], c[1], c[2]]).collect(),
            words: two.chunks_exact(2).zip(third).map(|(w, third)| [w[0], w[1], third]).collect(),
            paths: mask.iter().zip(&quads).map(|(word, quad)| (word >> 8) & (31 * quad.min(&1))).collect(),
            quads,
            alpha: shown.chunks_exact(4).filter(|_| self.alpha.is_some()).map(|c| c[3]).collect(),
            albedo: self.gpu.albedo_texture().map(|texture| self.read_texture(&texture)).unwrap_or_default(),
            stats: FrameStats::from_counters(&counters).unwrap(),
        }
    }

    /// Masks of the quads of all views with all pixels inside the frame.
    fn inside(&self) -> Vec<u32> {
        let whole = quads_of(&Image::filled(self.context.size_px, true));
        vec![whole; self.context.view_count as usize].concat()
    }

    fn upload(&self, views: &[View]) {
        for (layer, view) in views.iter().enumerate() {
            let alpha = self.alpha.as_ref().map(|alpha| &alpha[layer]);
            for (texture, texels) in self.textures.iter().zip(texels(view, alpha)) {
                let Some(texels) = texels else { continue };
                if texture.format() == TextureFormat::Rg16Float {
                    let halves: Vec<_> = texels.iter().map(|&v| pack::half_bits(v) as u16).collect();
                    self.write(texture, layer, bytemuck::cast_slice(&halves));
                } else {
                    self.write(texture, layer, bytemuck::cast_slice(&texels));
                }
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

/// Of the textures of a history, the one with a pixel's third word: weights of reservoirs, or noise of surfaces.
fn third_words(history: &[Texture]) -> Option<&Texture> {
    let has_weights = history.get(1).is_some_and(|texture| texture.format() == TextureFormat::R32Uint);
    history.get(if has_weights { 1 } else { 2 })
}

/// Submits what an encoder has, or drops it.
fn submit(queue: &Queue, drops: bool, encoder: wgpu::CommandEncoder) {
    if !drops {
        queue.submit([encoder.finish()]);
    }
}

/// Fails unless each planted error in some passes makes the executors differ in one of `frames` frames. `frame` gives
/// a frame's reset and views.
#[track_caller]
pub fn all_caught_in<const N: usize>(
    passes: [&'static str; N],
    desc: ContextDesc,
    settings: Settings,
    frames: u64,
    planted: &[(&str, &str)],
    frame: impl Fn(u64, &mut Rig) -> (Reset, Vec<View>),
) {
    let right = passes.map(|name| SHADERS.compose(name).source);
    all_caught(&right, planted, |sources: &[String; N]| {
        let texts = passes.into_iter().zip(sources);
        let planted = |right| texts.fold(right, |all: Sources, (name, text)| all.with(name, text));
        let mut rig = Rig::with_sources(desc, settings, planted)?;
        Some((0..frames).any(|index| {
            let (reset, views) = frame(index, &mut rig);
            rig.differs(index, reset, &views)
        }))
    });
}

/// Masks of the quads of a mask of pixels.
pub fn quads_of(mask: &Image<bool>) -> Vec<u32> {
    let size = mask.size();
    let bit_of = |[x, y]: [u32; 2]| u32::from(x < size[0] && y < size[1] && pixel(mask, [x, y]));
    let of_quad = |[x, y]: [u32; 2]| (0..4).fold(0, |all, i| all | bit_of([2 * x + i % 2, 2 * y + i / 2]) << i);
    pixels(size.map(|side| side.div_ceil(2))).map(of_quad).collect()
}

/// Number of paths of each chosen pixel of each quad.
fn paths_of(paths: &Image<u8>) -> Vec<u32> {
    let size = paths.size();
    let at = |[x, y]: [u32; 2]| if x < size[0] && y < size[1] { u32::from(pixel(paths, [x, y])) } else { 0 };
    let of_quad = |[x, y]: [u32; 2]| (0..4).map(|i| at([2 * x + i % 2, 2 * y + i / 2])).max().unwrap();
    pixels(size.map(|side| side.div_ceil(2))).map(of_quad).collect()
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
            let [width, height] = [texture.width() + number % 3, texture.height() + view];
            let size = [width + origin[0], height + origin[1], view + 1];
            let usage = texture.usage() | TextureUsages::COPY_SRC | TextureUsages::COPY_DST;
            let larger = make_layers(device, size, 1, texture.format(), usage);
            afterimage_testing::gpu::fill_level(queue, &larger, 0, 0xff);
            (larger, origin)
        };
        Self { texture, places: (0..texture.depth_or_array_layers()).map(place).collect() }
    }

    /// Each view is in the last layer of its texture.
    fn regions(&self) -> Vec<Region<'_>> {
        let places = self.places.iter().map(|(texture, px)| (texture, *px, texture.depth_or_array_layers() - 1));
        places.map(|(texture, origin_px, layer)| Region { texture, origin_px, layer }).collect()
    }

    /// Copies the texture to its places, or back from them.
    fn copy(&self, encoder: &mut wgpu::CommandEncoder, scatters: bool) {
        for (view, (texture, [x, y])) in (0..).zip(&self.places) {
            let at = |x, y, z| wgpu::Origin3d { x, y, z };
            let plain = wgpu::TexelCopyTextureInfo { origin: at(0, 0, view), ..self.texture.as_image_copy() };
            let place = wgpu::TexelCopyTextureInfo { origin: at(*x, *y, view), ..texture.as_image_copy() };
            let (width, height) = (self.texture.width(), self.texture.height());
            let (from, to) = if scatters { (plain, place) } else { (place, plain) };
            encoder.copy_texture_to_texture(from, to, wgpu::Extent3d { width, height, depth_or_array_layers: 1 });
        }
    }
}

/// A buffer of counters.
pub fn make_counters(device: &Device) -> Buffer {
    device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("counters"),
        size: FrameStats::COUNTERS_BYTES,
        usage: BufferUsages::STORAGE | BufferUsages::COPY_DST | BufferUsages::COPY_SRC,
        mapped_at_creation: false,
    })
}

pub fn make_texture(device: &Device, context: &ContextDesc, format: TextureFormat, usage: TextureUsages) -> Texture {
    let [width, height] = context.size_px;
    make_layers(device, [width, height, context.view_count], 1, format, usage)
}

/// A texture of a width, height and number of layers.
pub fn make_layers(
    device: &Device,
    [width, height, depth_or_array_layers]: [u32; 3],
    sample_count: u32,
    format: TextureFormat,
    usage: TextureUsages,
) -> Texture {
    device.create_texture(&wgpu::TextureDescriptor {
        label: Some("test"),
        size: wgpu::Extent3d { width, height, depth_or_array_layers },
        mip_level_count: 1,
        sample_count,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage,
        view_formats: &[],
    })
}

/// Packed reservoirs with another weight sum.
pub fn with_w_sum(words: &[[u32; 3]], w_sum: f32) -> Vec<[u32; 3]> {
    words
        .iter()
        .map(|&w| stored_reservoir::pack(stored_reservoir::Stored { w_sum, ..stored_reservoir::unpack(w) }))
        .collect()
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

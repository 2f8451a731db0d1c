//! A frame through the simulators of both executors, and their results.

pub use crate::pass::rig::make_texture as texture;
use afterimage::internal::Sources;
use afterimage::internal::{
    ContextDesc, Foveation, FoveationKind, GpuSimulator, Pyramid, Settings, SimulatorFrame, ViewFrame,
};
use afterimage::wgpu::{Device, Queue, Texture, TextureFormat, TextureUsages};
use afterimage::{Gaze, Image, ViewGeometry};
use afterimage_testing::{Draws, agree};

/// Full-rate frames and gazes, one a view.
#[derive(Clone)]
pub struct Scene {
    pub images: Vec<Image<[f32; 3]>>,
    pub views: Vec<ViewFrame>,
}

/// Bits of foveated colors and levels of detail, view after view.
#[derive(Clone, PartialEq, Debug)]
pub struct Made {
    pub shown: Vec<[u32; 3]>,
    pub lods: Vec<u32>,
}

/// A simulator with textures of its size.
pub struct Rig {
    pub device: Device,
    pub queue: Queue,
    pub post: GpuSimulator,
    pub full: Texture,
    pub output: Texture,
    pub lod: Texture,
}

/// Of most tests.
pub const FORMAT: TextureFormat = TextureFormat::Rgba32Float;

pub fn desc(size: [u32; 2], view_count: u32, foveation: Foveation) -> ContextDesc {
    let settings = Settings { foveation, ..Settings::default() };
    ContextDesc { view_count, settings, ..ContextDesc::new(size) }
}

pub fn looking(geometry: ViewGeometry, px: [f32; 2]) -> ViewFrame {
    ViewFrame::new(geometry, Gaze::At { px })
}

impl Scene {
    /// One flat view, 70 degrees wide.
    pub fn mono(image: Image<[f32; 3]>, gaze_px: [f32; 2]) -> Self {
        let geometry = ViewGeometry::flat(image.size(), 70.0).unwrap();
        Self { images: vec![image], views: vec![looking(geometry, gaze_px)] }
    }

    /// Two off-axis eyes with their own frames and gazes.
    pub fn stereo(size: [u32; 2], gazes: [[f32; 2]; 2]) -> Self {
        let eyes = [[-1.2, 0.8], [-0.8, 1.2]].map(|tan_x| ViewGeometry::off_axis(size, tan_x, [-0.9, 1.0]).unwrap());
        Self {
            images: vec![nasty(size, "left"), nasty(size, "right")],
            views: (0..2).map(|i| looking(eyes[i], gazes[i])).collect(),
        }
    }

    pub fn on_cpu(&self, foveation: &Foveation) -> Made {
        let mut made = Made { shown: vec![], lods: vec![] };
        for (image, view) in self.images.iter().zip(&self.views) {
            let gaze = view.gaze.resolve(None, &view.geometry);
            let lods = foveation.lod_map(&view.geometry, gaze);
            let shown = foveation.render(&Pyramid::new(image.clone(), foveation.max_level()), &lods);
            made.shown.extend(shown.pixels().iter().map(|c| c.map(f32::to_bits)));
            made.lods.extend(lods.pixels().iter().map(|l| l.to_bits()));
        }
        made
    }
}

impl Made {
    /// Whether the device's result is the CPU's.
    ///
    /// # Errors
    /// How it differs.
    pub fn agrees(&self, cpu: &Self) -> Result<(), String> {
        let levels = |made: &Self| made.lods.iter().map(|&lod| [lod; 3]).collect::<Vec<_>>();
        agree::colors(&self.shown, &cpu.shown)?;
        agree::colors(&levels(self), &levels(cpu))
    }
}

impl Rig {
    /// `None`, after a message, without an adapter.
    pub fn new(desc: &ContextDesc) -> Option<Self> {
        let (device, queue) = afterimage_testing::gpu::device()?;
        Some(Self::with_sources(device, queue, desc, &Sources::default()))
    }

    pub fn with_sources(device: Device, queue: Queue, desc: &ContextDesc, sources: &Sources) -> Self {
        let read = TextureUsages::TEXTURE_BINDING | TextureUsages::COPY_DST;
        let written = TextureUsages::STORAGE_BINDING | TextureUsages::COPY_SRC;
        Self {
            post: afterimage_testing::gpu::validated(&device, "new", || {
                GpuSimulator::with_sources(&device, desc, FORMAT, sources)
            })
            .unwrap(),
            full: texture(&device, desc, FORMAT, read),
            output: texture(&device, desc, FORMAT, written),
            lod: texture(&device, desc, TextureFormat::R32Float, written),
            device,
            queue,
        }
    }

    pub fn on_gpu(&mut self, scene: &Scene) -> Made {
        self.upload(&scene.images);
        afterimage_testing::gpu::validated(&self.device, "record", || {
            let mut encoder = self.device.create_command_encoder(&Default::default());
            let frame =
                SimulatorFrame { lod: Some(&self.lod), ..SimulatorFrame::new(&self.full, &self.output, &scene.views) };
            self.post.record(&self.device, &mut encoder, &frame).unwrap();
            self.queue.submit([encoder.finish()]);
        });
        self.read()
    }

    pub fn upload(&self, images: &[Image<[f32; 3]>]) {
        for (layer, image) in images.iter().enumerate() {
            let texels: Vec<[f32; 4]> = image.pixels().iter().map(|c| [c[0], c[1], c[2], 0.25]).collect();
            afterimage_testing::gpu::write_layer(&self.queue, &self.full, layer, bytemuck::cast_slice(&texels));
        }
    }

    pub fn read(&self) -> Made {
        let shown = afterimage_testing::gpu::read_texture(&self.device, &self.queue, &self.output);
        assert!(shown.chunks_exact(4).all(|c| c[3] == 1.0_f32.to_bits()), "alpha is 1");
        Made {
            shown: shown.chunks_exact(4).map(|c| [c[0], c[1], c[2]]).collect(),
            lods: afterimage_testing::gpu::read_texture(&self.device, &self.queue, &self.lod),
        }
    }
}

/// Noise from dark to the brightest half, with non-finite pixels.
pub fn nasty(size: [u32; 2], name: &str) -> Image<[f32; 3]> {
    let mut draws = Draws::new(&format!("nasty {name}"));
    let broken = [f32::NAN, -f32::NAN, f32::from_bits(0x7fc1_2345), f32::INFINITY, f32::NEG_INFINITY, 1e30, -1e30];
    Image::from_fn(size, |_| {
        let scale = [1.0, 1.0, 1e-4, 100.0, 65504.0][draws.bits() as usize % 5];
        let low = if scale == 65504.0 { 1e4 / 65504.0 } else { -0.1 };
        let mut c = [0; 3].map(|_| scale * draws.range(low, 1.0));
        if draws.uniform() < 0.05 {
            c[draws.bits() as usize % 3] = broken[draws.bits() as usize % broken.len()];
        }
        c
    })
}

pub fn foveation(filter: FoveationKind, [rate_mid, rate_far]: [u32; 2]) -> Foveation {
    Foveation { kind: filter, rate_mid, rate_far, ..Foveation::default() }
}

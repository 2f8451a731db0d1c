//! What is shown: a picture that is foveated, or a scene that is rendered foveated, and the post-process after it.

use crate::Result;
use crate::gpu::Gpu;
use crate::space::{self, Atlas, Space};
use afterimage::gpu::{Afterimage, Frame};
use afterimage::kernel::color::{srgb_decode, srgb_encode};
use afterimage::simulator::{GpuSimulator, SimulatorFrame};
use afterimage::{ContextDesc, Filter, Gaze, Lattices, Method, Settings, ViewFrame, ViewGeometry};
use wasm_bindgen::JsError;
use wgpu::{CommandEncoder, Texture, TextureFormat, TextureUsages};

const FORMAT: TextureFormat = TextureFormat::Rgba32Float;
/// Field of view of a picture.
const HFOV_DEG: f32 = 70.0;

/// Pixels that a mean error is taken of, at least, if a frame has as many.
const MEASURED_PIXELS: u32 = 640 * 360;

/// Source of frames.
#[expect(clippy::large_enum_variant, reason = "there is one")]
enum Source {
    /// A picture, at full rate and foveated.
    Picture { full: Texture, foveated: Texture, simulator: Option<GpuSimulator> },
    /// A rendered scene, the samples of a frame, and the frame at full rate.
    Space { space: Space, atlas: Atlas, full: Atlas },
}

/// Inputs of a frame.
pub struct Inputs {
    pub color: Texture,
    /// Depth and motion.
    pub geometry: Option<[Texture; 2]>,
    pub views: [ViewFrame; 1],
}

/// The post-process after a source.
pub struct Stage {
    size_px: [u32; 2],
    desc: ContextDesc,
    source: Source,
    post: Afterimage,
    /// Without a method: what the renderer delivers.
    plain: Afterimage,
    pub output: Texture,
    pub plain_output: Texture,
    /// Share of the pixels that the last frame shaded.
    pub shaded: f32,
    index: u64,
    seconds: f32,
}

fn picture(gpu: &Gpu, size: [u32; 2]) -> Texture {
    let usage = TextureUsages::TEXTURE_BINDING
        | TextureUsages::STORAGE_BINDING
        | TextureUsages::COPY_DST
        | TextureUsages::COPY_SRC;
    gpu.texture(size, FORMAT, usage)
}

fn context(gpu: &Gpu, desc: &ContextDesc, method: Method) -> Result<Afterimage> {
    let desc = ContextDesc { settings: Settings { method, ..desc.settings }, ..*desc };
    Ok(Afterimage::new(&gpu.device, &desc, FORMAT)?)
}

impl Stage {
    /// A black picture.
    pub fn new(gpu: &Gpu, size_px: [u32; 2], settings: Settings) -> Result<Self> {
        if size_px.contains(&0) {
            return Err(JsError::new("a side of the frame is 0"));
        }
        let desc = ContextDesc { settings, ..ContextDesc::new(size_px) };
        let mut stage = Self {
            size_px,
            desc,
            source: Source::Picture { full: picture(gpu, size_px), foveated: picture(gpu, size_px), simulator: None },
            post: context(gpu, &desc, settings.method)?,
            plain: context(gpu, &desc, Method::None)?,
            output: picture(gpu, size_px),
            plain_output: picture(gpu, size_px),
            shaded: 1.0,
            index: 0,
            seconds: 0.0,
        };
        stage.restart(gpu)?;
        Ok(stage)
    }

    pub fn settings(&self) -> Settings {
        self.desc.settings
    }

    /// Description of the contexts.
    #[cfg(feature = "compare")]
    pub fn desc(&self) -> ContextDesc {
        self.desc
    }

    /// New contexts, without history.
    pub fn restart(&mut self, gpu: &Gpu) -> Result<()> {
        match &mut self.source {
            Source::Picture { simulator, .. } => {
                self.desc.depth = ContextDesc::new(self.size_px).depth;
                *simulator = match self.desc.settings.foveation.filter {
                    Filter::Sparse => None,
                    _ => Some(GpuSimulator::new(&gpu.device, &self.desc, FORMAT)?),
                };
            }
            Source::Space { .. } => {
                self.desc.depth = space::DEPTH;
                self.desc.settings.foveation.filter = Filter::Sparse;
            }
        }
        self.post = context(gpu, &self.desc, self.desc.settings.method)?;
        self.plain = context(gpu, &self.desc, Method::None)?;
        self.index = 0;
        Ok(())
    }

    pub fn configure(&mut self, gpu: &Gpu, settings: Settings) -> Result<()> {
        settings.validate()?;
        self.desc.settings = settings;
        self.restart(gpu)
    }

    pub fn show_picture(&mut self, gpu: &Gpu, rgba: &[u8]) -> Result<()> {
        let [width, height] = self.size_px;
        if rgba.len() != 4 * width as usize * height as usize {
            return Err(JsError::new("the picture has another size than the frames"));
        }
        let linear: [f32; 256] = std::array::from_fn(|byte| srgb_decode(byte as f32 * (1.0 / 255.0)));
        let texels: Vec<[f32; 4]> = rgba
            .chunks_exact(4)
            .map(|c| [linear[c[0] as usize], linear[c[1] as usize], linear[c[2] as usize], 1.0])
            .collect();
        let (full, foveated) = (picture(gpu, self.size_px), picture(gpu, self.size_px));
        let layout =
            wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(16 * width), rows_per_image: Some(height) };
        gpu.queue.write_texture(full.as_image_copy(), bytemuck::cast_slice(&texels), layout, full.size());
        self.source = Source::Picture { full, foveated, simulator: None };
        self.restart(gpu)
    }

    pub fn show_space(&mut self, gpu: &Gpu) -> Result<()> {
        let space = Space::new(gpu, self.size_px);
        self.source =
            Source::Space { space, atlas: Atlas::new(gpu, self.size_px), full: Atlas::new(gpu, self.size_px) };
        self.restart(gpu)
    }

    fn geometry(&self) -> Result<ViewGeometry> {
        match &self.source {
            Source::Picture { .. } => Ok(ViewGeometry::flat(self.size_px, HFOV_DEG)?),
            Source::Space { space, .. } => space.geometry(),
        }
    }

    /// Radius of the fovea in pixels at the middle of the view.
    pub fn fovea_radius_px(&self) -> f32 {
        let half_width = (0.5 * HFOV_DEG).to_radians().tan();
        let radius = (0.5 * self.desc.settings.foveation.fovea_deg).to_radians().tan();
        0.5 * self.size_px[0] as f32 * radius / half_width
    }

    /// Records the frame as the renderer delivers it.
    fn deliver(&mut self, gpu: &Gpu, encoder: &mut CommandEncoder, gaze_px: [f32; 2], seconds: f32) -> Result<Inputs> {
        let geometry = self.geometry()?;
        let foveation = self.desc.settings.foveation;
        let lattices = foveation.lattices(&geometry, gaze_px, self.index);
        let pixels = (self.size_px[0] * self.size_px[1]) as f32;
        let samples = |lattices: &Lattices| {
            let points = lattices.as_slice().iter().map(|l| l.points[0] * l.points[1]);
            points.sum::<u32>() as f32 / pixels
        };
        let plain = ViewFrame::new(geometry, Gaze::At { px: gaze_px });
        match &mut self.source {
            Source::Picture { full, foveated, simulator: Some(simulator) } => {
                let views = [plain];
                simulator.record(&gpu.device, encoder, &SimulatorFrame::new(full, foveated, &views))?;
                self.shaded = samples(&lattices);
                Ok(Inputs { color: foveated.clone(), geometry: None, views })
            }
            Source::Picture { full, .. } => {
                self.shaded = samples(&lattices);
                let views = [ViewFrame { lattices: Some(lattices), ..plain }];
                Ok(Inputs { color: full.clone(), geometry: None, views })
            }
            Source::Space { space, atlas, .. } => {
                let (lattices, size) = lattices.in_atlas();
                if !atlas.holds(size) {
                    let held = [atlas.color.width(), atlas.color.height()];
                    *atlas = Atlas::new(gpu, [0, 1].map(|i| held[i].max(size[i].next_multiple_of(64))));
                }
                self.shaded = samples(&lattices);
                space.record(gpu, encoder, atlas, &lattices, seconds);
                let views = [space.view(seconds, gaze_px, lattices)?];
                space.advance(seconds);
                let geometry = Some([atlas.depth.clone(), atlas.motion.clone()]);
                Ok(Inputs { color: atlas.color.clone(), geometry, views })
            }
        }
    }

    /// Records a frame; its inputs. `seconds`: time of the camera.
    pub fn record(
        &mut self,
        gpu: &Gpu,
        encoder: &mut CommandEncoder,
        gaze_px: [f32; 2],
        seconds: f32,
    ) -> Result<Inputs> {
        let inputs = self.deliver(gpu, encoder, gaze_px, seconds)?;
        let (depth, motion) = match &inputs.geometry {
            Some([depth, motion]) => (Some(depth.into()), Some(motion.into())),
            None => (None, None),
        };
        let frame = Frame { depth, motion, ..Frame::new(&inputs.color, &inputs.views, self.index) };
        self.plain.record(&gpu.device, encoder, &frame, &self.plain_output)?;
        self.post.record(&gpu.device, encoder, &frame, &self.output)?;
        self.index += 1;
        self.seconds = seconds;
        Ok(inputs)
    }

    /// PSNR in dB of what the renderer delivered and of what is shown, against the frame at full rate.
    pub async fn quality(&mut self, gpu: &Gpu) -> Result<Vec<f32>> {
        let full = match &self.source {
            Source::Picture { full, .. } => full,
            Source::Space { space, full, .. } => {
                let mut encoder = gpu.device.create_command_encoder(&Default::default());
                space.record(gpu, &mut encoder, full, &space::whole(self.size_px)?, self.seconds);
                gpu.queue.submit([encoder.finish()]);
                &full.color
            }
        };
        // Of large frames, rows that are enough for the mean: the frames shall not wait for it.
        let step = (self.size_px[0] * self.size_px[1] / MEASURED_PIXELS).max(1);
        let [full, plain, shown] = [
            gpu.read_rows(full, step).await?,
            gpu.read_rows(&self.plain_output, step).await?,
            gpu.read_rows(&self.output, step).await?,
        ];
        Ok(vec![psnr(&full, &plain), psnr(&full, &shown)])
    }
}

/// PSNR in dB of sRGB-encoded colors with alpha, clamped to \[0, 1\]; at most 99.
fn psnr(expected: &[f32], shown: &[f32]) -> f32 {
    let encoded = |v: f32| srgb_encode(v.clamp(0.0, 1.0));
    let squared = |(i, (a, b)): (usize, (&f32, &f32))| match i % 4 {
        3 => 0.0,
        _ => f64::from(encoded(*a) - encoded(*b)).powi(2),
    };
    let sum: f64 = expected.iter().zip(shown).enumerate().map(squared).sum();
    let mean = sum / (0.75 * expected.len() as f64);
    (-10.0 * mean.log10()).min(99.0) as f32
}

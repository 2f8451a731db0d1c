//! What is shown: a picture that is foveated, or a scene that is rendered foveated, and the post-process after it.

use crate::Result;
use crate::gpu::{Dispatch, Gpu};
use crate::space::{self, Images, Space};
use afterimage::gpu::{Afterimage, Frame};
use afterimage::internal::{ContextDesc, FoveationKind, GpuSimulator, Method, Settings, SimulatorFrame, ViewFrame};
use afterimage::kernel::color::{srgb_decode, srgb_encode};
use afterimage::{Gaze, ViewGeometry};
use wasm_bindgen::JsError;
use wgpu::{BindingResource, CommandEncoder, ComputePipeline, Texture, TextureFormat};

const FORMAT: TextureFormat = TextureFormat::Rgba32Float;
/// Field of view of a picture.
const HFOV_DEG: f32 = 70.0;

/// Pixels along each axis for one of which the share of shaded pixels is estimated.
const SHARE_STEP: usize = 8;
/// Pixels that a mean error is taken of, at least, if a frame has as many.
const MEASURED_PIXELS: u32 = 640 * 360;

/// Source of frames.
#[expect(clippy::large_enum_variant, reason = "there is one")]
enum Source {
    /// A picture, at full rate and foveated.
    Picture { full: Texture, foveated: Texture, simulator: Option<GpuSimulator> },
    /// A rendered scene, a frame with its chosen pixels, and the frame at full rate.
    Space { space: Space, images: Images, full: Images },
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
    /// The chosen pixels of a planned frame, for `plain`.
    mask: Texture,
    masking: ComputePipeline,
    pub output: Texture,
    pub plain_output: Texture,
    index: u64,
    gaze_px: [f32; 2],
    seconds: f32,
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
        let desc = ContextDesc { settings, keep_alpha: false, ..ContextDesc::new(size_px) };
        let module = gpu.device.create_shader_module(wgpu::include_wgsl!("../shaders/mask.wgsl"));
        let mut stage = Self {
            size_px,
            desc,
            source: Source::Picture {
                full: gpu.image(size_px, FORMAT),
                foveated: gpu.image(size_px, FORMAT),
                simulator: None,
            },
            post: context(gpu, &desc, settings.method)?,
            plain: context(gpu, &desc, Method::None)?,
            mask: gpu.image(size_px, TextureFormat::R32Float),
            masking: gpu.pipeline(&module, "pixels"),
            output: gpu.image(size_px, FORMAT),
            plain_output: gpu.image(size_px, FORMAT),
            index: 0,
            gaze_px: [0.0; 2],
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
                *simulator = match self.desc.settings.foveation.kind {
                    FoveationKind::Quads => None,
                    _ => Some(GpuSimulator::new(&gpu.device, &self.desc, FORMAT)?),
                };
            }
            Source::Space { .. } => self.desc.depth = space::DEPTH,
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
        let (full, foveated) = (gpu.image(self.size_px, FORMAT), gpu.image(self.size_px, FORMAT));
        let layout =
            wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(16 * width), rows_per_image: Some(height) };
        gpu.queue.write_texture(full.as_image_copy(), bytemuck::cast_slice(&texels), layout, full.size());
        self.source = Source::Picture { full, foveated, simulator: None };
        self.restart(gpu)
    }

    pub fn show_space(&mut self, gpu: &Gpu) -> Result<()> {
        let space = Space::new(gpu, self.size_px);
        let [images, full] = [(); 2].map(|()| Images::new(gpu, self.size_px));
        self.source = Source::Space { space, images, full };
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

    /// Records what the renderer knows of a frame before it is shaded, and pictures.
    fn begin(&mut self, gpu: &Gpu, encoder: &mut CommandEncoder, gaze_px: [f32; 2], seconds: f32) -> Result<Inputs> {
        let plain = ViewFrame::new(self.geometry()?, Gaze::At { px: gaze_px });
        match &mut self.source {
            Source::Picture { full, foveated, simulator: Some(simulator) } => {
                let views = [plain];
                simulator.record(&gpu.device, encoder, &SimulatorFrame::new(full, foveated, &views))?;
                Ok(Inputs { color: foveated.clone(), geometry: None, views })
            }
            Source::Picture { full, .. } => Ok(Inputs { color: full.clone(), geometry: None, views: [plain] }),
            Source::Space { space, images, .. } => {
                space.record_surfaces(gpu, encoder, images, seconds);
                let geometry = Some([images.depth.clone(), images.motion.clone()]);
                Ok(Inputs { color: images.color.clone(), geometry, views: [space.view(seconds, gaze_px)?] })
            }
        }
    }

    /// Whether the post-process chooses the pixels.
    pub fn is_planned(&self) -> bool {
        self.desc.settings.foveation.kind == FoveationKind::Quads
    }

    /// Records a frame; its inputs. `seconds`: time of the camera.
    pub fn record(
        &mut self,
        gpu: &Gpu,
        encoder: &mut CommandEncoder,
        gaze_px: [f32; 2],
        seconds: f32,
    ) -> Result<Inputs> {
        let inputs = self.begin(gpu, encoder, gaze_px, seconds)?;
        let (depth, motion) = match &inputs.geometry {
            Some([depth, motion]) => (Some(depth.into()), Some(motion.into())),
            None => (None, None),
        };
        let frame = Frame { depth, motion, ..Frame::new(&inputs.color, &inputs.views, self.index) };
        let mut plain = frame;
        if self.is_planned() {
            self.post.plan(&gpu.device, encoder, &frame)?;
            if let Source::Space { space, images, .. } = &self.source {
                space.record_chosen(gpu, encoder, images, &self.post, seconds);
            }
            self.record_mask(gpu, encoder);
            plain.mask = Some((&self.mask).into());
        }
        if let Source::Space { space, .. } = &mut self.source {
            space.advance(seconds);
        }
        self.plain.record(&gpu.device, encoder, &plain, &self.plain_output)?;
        self.post.record(&gpu.device, encoder, &frame, &self.output)?;
        self.index += 1;
        (self.gaze_px, self.seconds) = (gaze_px, seconds);
        Ok(inputs)
    }

    /// Records the mask of the pixels that the post-process chose: without memory the same ones are shown.
    fn record_mask(&self, gpu: &Gpu, encoder: &mut CommandEncoder) {
        let Some(quads) = self.post.quad_mask() else { return };
        let [quads, mask] = [quads, &self.mask].map(|texture| texture.create_view(&Default::default()));
        let bound = [(0, BindingResource::TextureView(&quads)), (1, BindingResource::TextureView(&mask))];
        gpu.dispatch(encoder, &self.masking, &bound, Dispatch::Pixels(self.size_px));
    }

    /// Share of the pixels that the last frame shaded.
    pub async fn shaded(&self, gpu: &Gpu) -> Result<f32> {
        if self.is_planned() {
            let chosen = gpu.read(&self.mask).await?;
            return Ok(chosen.iter().sum::<f32>() / chosen.len() as f32);
        }
        let (geometry, foveation) = (self.geometry()?, self.desc.settings.foveation);
        let [width, height] = self.size_px;
        let (mut sum, mut places) = (0.0, 0.0);
        for y in (0..height).step_by(SHARE_STEP) {
            for x in (0..width).step_by(SHARE_STEP) {
                let e_deg = geometry.eccentricity_deg([x as f32, y as f32], self.gaze_px);
                sum += (-2.0 * foveation.lod(e_deg)).exp2();
                places += 1.0;
            }
        }
        Ok(sum / places)
    }

    /// PSNR in dB of what the renderer delivered and of what is shown, against the frame at full rate.
    pub async fn quality(&mut self, gpu: &Gpu) -> Result<Vec<f32>> {
        let full = match &self.source {
            Source::Picture { full, .. } => full,
            Source::Space { space, full, .. } => {
                let mut encoder = gpu.device.create_command_encoder(&Default::default());
                space.record_everything(gpu, &mut encoder, full, self.seconds);
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

//! Planned frames: the post-process chooses the pixels that the renderer shades, and shows a picture at full rate.

mod camera;
mod desc;
mod frame;
mod share_control;
mod targets;

pub use camera::Camera;
pub use desc::{Desc, Shading};
pub use frame::{Frame, Plan, Quarter};
pub use share_control::ShareControl;
pub use targets::Targets;

use crate::error::{CreateError, FrameError, FrameValue, SettingsError};
use crate::foveation::Foveation;
use crate::gpu::{self, Prime, Recorded, Target};
use crate::settings::{Method, Settings, Smr};
use crate::view::ViewFrame;
use wgpu::{Buffer, CommandEncoder, Device, Limits, Texture, TextureViewDescriptor, TextureViewDimension};

/// The post-process for planned frames, on a GPU: it chooses the pixels that are shaded in each frame, and its history
/// gives the rest. Full rate's picture from a quarter of the pixels, or from a tenth of them around the gaze.
///
/// A renderer draws depth (and motion vectors) of the whole frame first, as for any depth prepass; then colors where
/// [`plan`](Self::plan) says. The depth test keeps the other pixels from being shaded: see [`close`](Self::close).
///
/// ```no_run
/// # use afterimage::wgpu::{self, Texture, TextureUsages};
/// # fn prepass(_: [&Texture; 2], _: [[f32; 4]; 4]) {}
/// # fn draw_colors(_: [&Texture; 2], _: [[f32; 4]; 4]) {}
/// # fn example(
/// #     device: &wgpu::Device, queue: &wgpu::Queue, [depth, motion, depth_copy, color, output]: [&Texture; 5],
/// #     clip_from_view: [[f32; 4]; 4], world_from_view: [[f32; 4]; 4],
/// # ) -> Result<(), Box<dyn std::error::Error>> {
/// use afterimage::{Afterimage, Camera, Desc, Frame, MotionConvention, Shading};
///
/// // Once: a quarter of the pixels, for a renderer with Bevy's motion vectors.
/// let mut post = Afterimage::new(device, &Desc {
///     shading: Shading::Everywhere { share: 0.25 },
///     motion: Some(MotionConvention::BEVY),
///     ..Desc::new([1920, 1080], output.format())
/// })?;
///
/// // Each frame. All of it is drawn with the jittered projection.
/// let mut encoder = device.create_command_encoder(&Default::default());
/// let jittered = post.jittered(clip_from_view);
/// prepass([depth, motion], jittered);
/// let frame = Frame { motion: Some(motion), ..Frame::new(depth, Camera::new(clip_from_view, world_from_view)) };
/// let plan = post.plan(&mut encoder, &frame)?;
/// encoder.copy_texture_to_texture(depth.as_image_copy(), depth_copy.as_image_copy(), depth.size());
/// post.close(&mut encoder, &plan, depth_copy)?;
/// draw_colors([color, depth_copy], jittered);
/// post.show(&mut encoder, plan, color, output)?;
/// queue.submit([encoder.finish()]);
/// # Ok(())
/// # }
/// ```
///
/// [`Targets`] has these textures, and the render passes that draw them.
///
/// The context counts frames and keeps the previous frame's camera. A frame may be dropped with its encoder: the frame
/// after it then starts without history, and is right.
///
/// A headset has two views ([`Desc::view_count`], [`Frame::others`]); a renderer may choose the pixels itself
/// ([`given`](Self::given)); counters and debug views are a [`Target`] of [`show`](Self::show).
#[derive(Debug)]
pub struct Afterimage {
    device: Device,
    desc: Desc,
    post: gpu::Afterimage,
    /// Number of frames that were shown.
    index: u64,
    /// Cameras of the last frame that was shown; none without history.
    previous: Vec<Camera>,
}

impl Afterimage {
    /// A context without history on `device`, which it keeps a handle of.
    ///
    /// # Errors
    /// [`CreateError`] if the description is out of range, the output format is not supported (compute shaders write
    /// it: `Rgba16Float` and `Rgba8Unorm` are, on every device), a limit of the device is too low
    /// ([`required_limits`](Self::required_limits)), or its backend cannot store history. Then nothing was made.
    pub fn new(device: &Device, desc: &Desc) -> Result<Self, CreateError> {
        let post = gpu::Afterimage::new(device, &desc.context()?, desc.output)?;
        Ok(Self { device: device.clone(), desc: *desc, post, index: 0, previous: vec![] })
    }

    /// Limits that a device needs at least for a context of this description. Request them together with what the rest
    /// of the program needs.
    pub fn required_limits(desc: &Desc) -> Limits {
        gpu::Afterimage::required_limits(&desc.unchecked())
    }

    /// Description of the context, with its current size and shading.
    pub fn desc(&self) -> &Desc {
        &self.desc
    }

    /// Jitter of the next frame's projection in pixels, each in \[-0.5, 0.5): a point at `p` without jitter is drawn at
    /// `p + jitter_px`; y down. (0, 0) without [`Desc::antialias`].
    pub fn jitter_px(&self) -> [f32; 2] {
        if self.desc.antialias { Foveation::jitter_px(self.index) } else { [0.0; 2] }
    }

    /// A perspective projection with the next frame's [jitter](Self::jitter_px), to draw all of that frame with.
    /// `clip_from_view`: as in [`Camera`].
    pub fn jittered(&self, clip_from_view: [[f32; 4]; 4]) -> [[f32; 4]; 4] {
        camera::shifted(clip_from_view, self.jitter_px(), self.desc.size_px)
    }

    /// Changes how many pixels are shaded, from the next plan on; any frame may have another share. No GPU object is
    /// made, and history stays.
    ///
    /// # Errors
    /// [`SettingsError`] if a share or an angle is out of range; then nothing changes.
    pub fn set_shading(&mut self, shading: Shading) -> Result<(), SettingsError> {
        let desc = Desc { shading, ..self.desc };
        self.post.set_settings(&self.device, desc.context()?.settings)?;
        self.desc = desc;
        Ok(())
    }

    /// Changes the size of the frame, and discards history.
    ///
    /// # Errors
    /// [`FrameError::Extent`] if a side is 0 or too large; then nothing changes.
    pub fn resize(&mut self, size_px: [u32; 2]) -> Result<(), FrameError> {
        self.post.resize(&self.device, size_px)?;
        self.desc.size_px = size_px;
        Ok(())
    }

    /// Changes the size of the frame, and resamples history to it: records a pass into `encoder`. If that is dropped,
    /// the next frame has no history. The view directions at the edges should stay the same.
    ///
    /// # Errors
    /// As for [`resize`](Self::resize).
    pub fn resize_keeping_history(
        &mut self,
        encoder: &mut CommandEncoder,
        size_px: [u32; 2],
    ) -> Result<(), FrameError> {
        self.post.resize_keeping_history(&self.device, encoder, size_px)?;
        self.desc.size_px = size_px;
        Ok(())
    }

    /// Compiles, while loading, the pipelines for frames with the same inputs and outputs, so that the first
    /// [`plan`](Self::plan) and [`show`](Self::show) do not have to. The contents of the textures do not matter.
    ///
    /// # Errors
    /// [`FrameError`] if a matrix or a value of the frame does not fit.
    pub fn prewarm<'a>(
        &self,
        frame: &Frame<'_>,
        color: &Texture,
        output: impl Into<Target<'a>>,
    ) -> Result<(), FrameError> {
        let plan = self.described(frame)?;
        self.post.prewarm(&self.device, &plan.inputs(color, None), output);
        Ok(())
    }

    /// Discards history and the last known gaze: for another scene or another user.
    pub fn forget(&mut self) {
        self.post.forget();
        self.previous.clear();
    }

    /// Bytes of the textures and buffers that the context holds between frames.
    pub fn memory_bytes(&self) -> u64 {
        self.post.memory_bytes()
    }

    /// Records, into `encoder`, the choice of the pixels of a frame, after its depth and motion vectors have been
    /// drawn. History is unchanged: a frame that is not shown can be planned again.
    ///
    /// # Errors
    /// [`FrameError`] if a texture, a matrix or a value does not fit. Then nothing was recorded.
    pub fn plan(&mut self, encoder: &mut CommandEncoder, frame: &Frame<'_>) -> Result<Plan, FrameError> {
        let mut plan = self.described(frame)?;
        self.post.plan(&self.device, encoder, &plan.inputs(frame.depth, None))?;
        if self.desc.draws_quarters && self.post.is_quarter() {
            plan.quarters = plan.cameras.iter().map(|camera| self.quarter(camera)).collect();
        }
        Ok(plan)
    }

    /// The plan of a renderer that chooses the pixels itself, in place of [`plan`](Self::plan): for checkerboards, or a
    /// tracer with a sampler of its own. `mask`: a pixel is shaded where it is above 0.5; NaN counts as 0. Any float or
    /// normalised format. Any pattern does, if it visits every pixel in some frame.
    ///
    /// # Errors
    /// [`FrameError`] if a matrix or a value of the frame does not fit.
    pub fn given(&self, frame: &Frame<'_>, mask: &Texture) -> Result<Plan, FrameError> {
        Ok(Plan { given: Some(mask.clone()), ..self.described(frame)? })
    }

    /// A frame without its quarters.
    fn described(&self, frame: &Frame<'_>) -> Result<Plan, FrameError> {
        if frame.motion.is_some() && self.desc.motion.is_none() {
            let (found, expected) = ("given".into(), "None; or say in Desc::motion which convention they have");
            return Err(FrameError::Value { value: FrameValue::Motion, view: 0, found, expected });
        }
        let cameras = [&[frame.camera], frame.others].concat();
        let (found, expected) = (cameras.len(), self.desc.view_count as usize);
        if found != expected {
            return Err(FrameError::ViewCount { found, expected });
        }
        let views = (0..).zip(&cameras).map(|(i, camera)| self.view(i, camera)).collect::<Result<_, _>>()?;
        let lists: Vec<_> = (0..expected).filter_map(|view| self.post.quad_list(view).cloned()).collect();
        let Some(mask) = self.post.quad_mask().cloned() else {
            let (found, expected) = ("missing".into(), "a context of planned frames");
            return Err(FrameError::Value { value: FrameValue::Plan, view: 0, found, expected });
        };
        Ok(Plan { cameras, lists, ..Plan::new(frame, self.index, views, mask) })
    }

    /// Records a pass that closes a depth buffer for the pixels that are not shaded: it writes the near plane's depth
    /// there, so that the depth test rejects what the renderer draws, before it is shaded. `depth`: a copy of the
    /// frame's depth, with any number of samples, with the usage `RENDER_ATTACHMENT`. Then draw the colors with a depth
    /// test that passes what is equal (`LessEqual`, or `GreaterEqual` where depth is reversed) and positions that are
    /// exactly those of the prepass (`@invariant` in WGSL).
    ///
    /// # Errors
    /// [`FrameError`] if the plan is not the last one, or if the target does not fit. Then nothing was recorded.
    pub fn close(&mut self, encoder: &mut CommandEncoder, plan: &Plan, depth: &Texture) -> Result<(), FrameError> {
        self.check(plan)?;
        let (found, expected) = (depth.depth_or_array_layers() as usize, plan.cameras.len());
        if found != expected {
            return Err(FrameError::ViewCount { found, expected });
        }
        for (view, camera) in plan.cameras.iter().enumerate() {
            let target = &depth.create_view(&TextureViewDescriptor {
                dimension: Some(TextureViewDimension::D2),
                mip_level_count: Some(1),
                base_array_layer: view as u32,
                array_layer_count: Some(1),
                ..Default::default()
            });
            let near_depth = if camera.is_reversed() { 1.0 } else { 0.0 };
            let is_half = !plan.quarters.is_empty();
            let prime = Prime { target, origin_px: [0, 0], near_depth, stencil: None, is_half };
            self.post.prime(&self.device, encoder, view, &prime)?;
        }
        Ok(())
    }

    /// Records, into `encoder`, the passes that show a planned frame: they read its colors and the history, and write
    /// `output`, a texture of the context's output format with the usage `STORAGE_BINDING`, and the history. `color`:
    /// linear color before tone mapping, of the context's size, drawn where the plan says; other pixels are not read.
    /// In a [quarter frame](Plan::quarters) give [`show_quarter`](Self::show_quarter) its small colors, too.
    ///
    /// In place of a texture, `output` may be a [`Target`], with counters of pixels
    /// ([`FrameStats`](crate::FrameStats)), a [debug view](crate::DebugView) or timestamps.
    ///
    /// # Errors
    /// [`FrameError`] if the plan is not the last one, or if a texture does not fit. Then nothing was recorded.
    pub fn show<'a>(
        &mut self,
        encoder: &mut CommandEncoder,
        plan: Plan,
        color: &Texture,
        output: impl Into<Target<'a>>,
    ) -> Result<Recorded, FrameError> {
        if !plan.quarters.is_empty() {
            let (found, expected) = ("shown as a whole".into(), "show_quarter, because the plan has a quarter");
            return Err(FrameError::Value { value: FrameValue::Plan, view: 0, found, expected });
        }
        self.record(encoder, plan, (color, None), &output.into())
    }

    /// [`show`](Self::show) of a [quarter frame](Plan::quarters): `half` has the colors that were drawn at half the
    /// width and height, `color` the fovea. With a [given](Self::given) mask `half` has a texel for each quad of 2x2
    /// pixels of which one is shaded, and `color` the other quads.
    ///
    /// # Errors
    /// As for `show`; and if the plan is not of a quarter frame.
    pub fn show_quarter<'a>(
        &mut self,
        encoder: &mut CommandEncoder,
        plan: Plan,
        [color, half]: [&Texture; 2],
        output: impl Into<Target<'a>>,
    ) -> Result<Recorded, FrameError> {
        if plan.quarters.is_empty() && plan.given.is_none() {
            let (found, expected) = ("shown as a quarter".into(), "show, because the plan has no quarter");
            return Err(FrameError::Value { value: FrameValue::Plan, view: 0, found, expected });
        }
        self.record(encoder, plan, (color, Some(half)), &output.into())
    }

    /// A doctor that finds mistakes in the frames of this context, and the line of code that mends each.
    ///
    /// # Errors
    /// [`CreateError`] if a limit of the device is too low.
    pub fn doctor(&self) -> Result<gpu::Doctor, CreateError> {
        gpu::Doctor::of_planned(&self.device, &self.desc.unchecked())
    }

    /// Records the examination of a frame by a [doctor](Self::doctor) of this context, before the frame is shown.
    /// `color` must be drawn at every pixel: leave [`close`](Self::close) out meanwhile. `words`: as for
    /// [`gpu::Doctor::record`]; give their bytes to [`gpu::Doctor::read`] when the device has written them.
    ///
    /// # Errors
    /// [`FrameError`] if the plan is not the last one, or if a texture or the buffer does not fit. Then nothing was
    /// recorded.
    pub fn examine(
        &self,
        encoder: &mut CommandEncoder,
        doctor: &mut gpu::Doctor,
        plan: &Plan,
        color: &Texture,
        words: &Buffer,
    ) -> Result<(), FrameError> {
        self.check(plan)?;
        doctor.record(&self.device, encoder, &plan.inputs(color, None), words)
    }

    fn record(
        &mut self,
        encoder: &mut CommandEncoder,
        plan: Plan,
        (color, half): (&Texture, Option<&Texture>),
        target: &Target<'_>,
    ) -> Result<Recorded, FrameError> {
        self.check(&plan)?;
        let recorded = self.post.record(&self.device, encoder, &plan.inputs(color, half), *target)?;
        self.index += 1;
        self.previous = plan.cameras;
        Ok(recorded)
    }

    /// Rejects a plan of a frame that was shown.
    fn check(&self, plan: &Plan) -> Result<(), FrameError> {
        if plan.index == self.index {
            return Ok(());
        }
        let found = format!("that of frame {}", plan.index);
        Err(FrameError::Value { value: FrameValue::Plan, view: 0, found, expected: "the last plan, once" })
    }

    /// Description of a view.
    fn view(&self, index: usize, camera: &Camera) -> Result<ViewFrame, FrameError> {
        let Camera { gaze, visible_px, .. } = *camera;
        let depth = match self.desc.has_distances {
            true => None,
            false => Some(camera.depth_convention()?),
        };
        let geometry = camera.geometry(self.desc.size_px)?;
        let view = ViewFrame { depth, visible_px, jitter_px: self.jitter_px(), ..ViewFrame::new(geometry, gaze) };
        // Without a previous frame it counts as still: no history is read.
        Ok(camera.moved_from(self.previous.get(index).unwrap_or(camera), view)?)
    }

    /// How the small view of a quarter frame is drawn.
    fn quarter(&self, camera: &Camera) -> Quarter {
        let place = Foveation::quarter_place_px(self.index).map(|v| v as f32);
        let size_px = self.desc.size_px.map(|side| side.div_ceil(2));
        // The small view's pixel (x, y) is the frame's pixel (2x, 2y) + place.
        Quarter {
            size_px,
            clip_from_view: camera::halved(camera.projection(), self.jitter_px(), self.desc.size_px, place),
        }
    }
}

impl Desc {
    /// Settings of the passes.
    fn settings(&self) -> Settings {
        let smr = if self.is_noisy { Smr::traced() } else { Smr::default() };
        let method = Method::Smr(Smr { antialias: self.antialias, ..smr });
        let foveation = self.shading.foveation(self.single_pixels);
        Settings { method, foveation, noisy: self.is_noisy, ..Settings::default() }
    }
}

//! Textures of planned frames, and the render passes that draw them.

use super::{Afterimage, Camera, Desc, Frame, Plan};
use crate::error::FrameError;
use wgpu::{
    Color, CommandEncoder, Device, Extent3d, LoadOp, Operations, RenderPass, RenderPassColorAttachment,
    RenderPassDepthStencilAttachment, RenderPassDescriptor, StoreOp, Texture, TextureDescriptor, TextureDimension,
    TextureFormat, TextureUsages, TextureView, TextureViewDescriptor, TextureViewDimension,
};

/// Textures of planned frames with the usages that the passes need, and render passes that draw them: for renderers
/// that have no such textures yet. Those that have pass their own to [`Afterimage`] instead. Distances, noise and
/// albedo need textures of their own: `Frame { albedo: Some(&albedo), ..targets.frame(camera) }`.
///
/// A frame has these steps:
///
/// ```no_run
/// # use afterimage::{Afterimage, Camera, Targets, wgpu};
/// # fn draw(_: &mut wgpu::RenderPass<'_>) {}
/// # fn frame(
/// #     post: &mut Afterimage, targets: &Targets, encoder: &mut wgpu::CommandEncoder, camera: Camera,
/// # ) -> Result<(), Box<dyn std::error::Error>> {
/// // Depth and motion vectors, colors, and what is transparent; in stereo for each view.
/// draw(&mut targets.prepass(encoder, 0, &camera));
/// let plan = post.plan(encoder, &targets.frame(camera))?;
/// targets.close(encoder, post, &plan)?;
/// draw(&mut targets.color_pass(encoder, 0, wgpu::Color::BLACK));
/// post.show(encoder, plan, &targets.color, &targets.output)?;
/// draw(&mut targets.output_pass(encoder, 0));
/// # Ok(())
/// # }
/// ```
#[derive(Debug)]
pub struct Targets {
    /// Depth buffer of every pixel, [`DEPTH`](Self::DEPTH).
    pub depth: Texture,
    /// Depth buffer that lets the planned pixels pass, [`DEPTH`](Self::DEPTH).
    pub closed: Texture,
    /// Motion vectors, [`MOTION`](Self::MOTION); none without [`Desc::motion`].
    pub motion: Option<Texture>,
    /// Colors of the planned pixels.
    pub color: Texture,
    /// The picture, in the format of [`Desc::output`].
    pub output: Texture,
}

impl Targets {
    /// Format of depth.
    pub const DEPTH: TextureFormat = TextureFormat::Depth32Float;
    /// Format of motion vectors.
    pub const MOTION: TextureFormat = TextureFormat::Rg16Float;

    /// Textures for frames of `desc`, with an array layer for each view, and colors of the format `color`. After
    /// [`Afterimage::resize`] make new ones, with [`Afterimage::desc`].
    pub fn new(device: &Device, desc: &Desc, color: TextureFormat) -> Self {
        let [width, height] = desc.size_px;
        let texture = |label, format: TextureFormat, usage: TextureUsages| {
            // Not every format that compute shaders write can be drawn to.
            let optional =
                TextureUsages::RENDER_ATTACHMENT & format.guaranteed_format_features(device.features()).allowed_usages;
            device.create_texture(&TextureDescriptor {
                label: Some(label),
                size: Extent3d { width, height, depth_or_array_layers: desc.view_count },
                mip_level_count: 1,
                sample_count: 1,
                dimension: TextureDimension::D2,
                format,
                usage: usage | optional | TextureUsages::TEXTURE_BINDING,
                view_formats: &[],
            })
        };
        Self {
            depth: texture("depth", Self::DEPTH, TextureUsages::COPY_SRC),
            closed: texture("closed depth", Self::DEPTH, TextureUsages::COPY_DST),
            motion: desc.motion.map(|_| texture("motion vectors", Self::MOTION, TextureUsages::COPY_SRC)),
            color: texture("planned colors", color, TextureUsages::COPY_SRC),
            output: texture("picture", desc.output, TextureUsages::STORAGE_BINDING | TextureUsages::COPY_SRC),
        }
    }

    /// The frame of these textures.
    pub fn frame(&self, camera: Camera) -> Frame<'_> {
        Frame { motion: self.motion.as_ref(), ..Frame::new(&self.depth, camera) }
    }

    /// A pass that draws depth and, if there are any, motion vectors of a view. Both are cleared, depth to the far
    /// plane of the camera, vectors to 0.
    pub fn prepass<'e>(&self, encoder: &'e mut CommandEncoder, view: usize, camera: &Camera) -> RenderPass<'e> {
        let motion = self.motion.as_ref().map(|motion| (motion, LoadOp::Clear(Color::TRANSPARENT)));
        let far = if camera.is_reversed() { 0.0 } else { 1.0 };
        pass(encoder, "prepass", view, motion, (&self.depth, LoadOp::Clear(far)))
    }

    /// Copies depth, and [closes](Afterimage::close) the copy for the pixels that are not planned, of all views.
    ///
    /// # Errors
    /// As for [`Afterimage::close`].
    pub fn close(&self, encoder: &mut CommandEncoder, post: &mut Afterimage, plan: &Plan) -> Result<(), FrameError> {
        self.open(encoder);
        post.close(encoder, plan, &self.closed)
    }

    /// Copies depth as it is, so that [`color_pass`](Self::color_pass) draws every pixel: for a frame at full rate, and
    /// for [`Afterimage::examine`].
    pub fn open(&self, encoder: &mut CommandEncoder) {
        let [from, to] = [&self.depth, &self.closed].map(Texture::as_image_copy);
        encoder.copy_texture_to_texture(from, to, self.depth.size());
    }

    /// A pass that draws colors of a view, cleared to `clear`, where the [closed](Self::close) depth lets them pass.
    pub fn color_pass<'e>(&self, encoder: &'e mut CommandEncoder, view: usize, clear: Color) -> RenderPass<'e> {
        let color = Some((&self.color, LoadOp::Clear(clear)));
        pass(encoder, "planned colors", view, color, (&self.closed, LoadOp::Load))
    }

    /// A pass that draws over the picture of a view after [`Afterimage::show`], with the depth of every pixel:
    /// transparent things and particles, without the jitter.
    pub fn output_pass<'e>(&self, encoder: &'e mut CommandEncoder, view: usize) -> RenderPass<'e> {
        pass(encoder, "over the picture", view, Some((&self.output, LoadOp::Load)), (&self.depth, LoadOp::Load))
    }
}

fn pass<'e>(
    encoder: &'e mut CommandEncoder,
    label: &str,
    view: usize,
    color: Option<(&Texture, LoadOp<Color>)>,
    (depth, load): (&Texture, LoadOp<f32>),
) -> RenderPass<'e> {
    let store = StoreOp::Store;
    let color = color.map(|(texture, load)| (layer(texture, view), Operations { load, store }));
    let attachment = color.as_ref().map(|(view, ops)| RenderPassColorAttachment {
        view,
        depth_slice: None,
        resolve_target: None,
        ops: *ops,
    });
    encoder.begin_render_pass(&RenderPassDescriptor {
        label: Some(label),
        color_attachments: if attachment.is_some() { std::slice::from_ref(&attachment) } else { &[] },
        depth_stencil_attachment: Some(RenderPassDepthStencilAttachment {
            view: &layer(depth, view),
            depth_ops: Some(Operations { load, store }),
            stencil_ops: None,
        }),
        ..Default::default()
    })
}

fn layer(texture: &Texture, view: usize) -> TextureView {
    texture.create_view(&TextureViewDescriptor {
        dimension: Some(TextureViewDimension::D2),
        base_array_layer: view as u32,
        array_layer_count: Some(1),
        ..Default::default()
    })
}

//! A planned frame: what is known before it is shaded, and which pixels are.

use super::Camera;
use crate::frame::{Exposure, Reset};
use crate::gpu;
use crate::view::ViewFrame;
use wgpu::{Buffer, Texture};

/// What is known of a frame before its colors are drawn. Create it with [`new`](Self::new) and `..`.
#[derive(Clone, Copy, Debug)]
pub struct Frame<'a> {
    /// Depth of every pixel, as the depth buffer holds it: a depth format or `R32Float`, with the usage
    /// `TEXTURE_BINDING`. Like all textures of several views it has an array layer for each.
    pub depth: &'a Texture,
    /// Motion vectors of every pixel in the convention of [`Desc::motion`](super::Desc::motion): `Rg16Float`,
    /// `Rg32Float` or wider. `None`: nothing moves, or only the camera.
    pub motion: Option<&'a Texture>,
    /// Camera of the first view; in stereo the left eye's.
    pub camera: Camera,
    /// Cameras of the other views, in the order of the textures' layers. Default: none.
    pub others: &'a [Camera],
    /// Whether the frame shows another scene than its predecessor, as after a cut or a teleport. Default false.
    pub is_cut: bool,
    /// Reactive mask as FSR2 has it, 0 to 1: 1 where content changes without motion vectors, such as screens and
    /// particles. Any float or normalised format.
    pub reactive: Option<&'a Texture>,
    /// Of frames that are [path-traced](super::Desc::is_noisy): the standard error of the color's luma (linear), and
    /// the number of samples that were averaged into the color. `Rg16Float`, `Rg32Float` or wider. It is drawn with the
    /// colors, and [`show`](super::Afterimage::show) reads it.
    pub noise: Option<&'a Texture>,
    /// Of frames that [have it](super::Desc::has_albedo), the albedo of every pixel: the reflectance that multiplies
    /// light, 0 to 1, diffuse plus specular, in the same primaries as the color, and 0 for the sky and for what shines
    /// itself. It is jittered like the color. Any float or normalised format with three channels. It may be drawn with
    /// the depth or with the colors: [`show`](super::Afterimage::show) reads it.
    pub albedo: Option<&'a Texture>,
    /// Exposure of the colors. Default [`Exposure::Same`].
    pub exposure: Exposure,
}

impl<'a> Frame<'a> {
    /// A frame of a moving camera, which continues its predecessor.
    pub fn new(depth: &'a Texture, camera: Camera) -> Self {
        Self {
            depth,
            motion: None,
            camera,
            others: &[],
            is_cut: false,
            reactive: None,
            noise: None,
            albedo: None,
            exposure: Exposure::Same,
        }
    }
}

/// Plan of a frame: the pixels to shade. [`Afterimage::plan`](super::Afterimage::plan) makes it, or
/// [`given`](super::Afterimage::given) of a renderer's own mask, and [`show`](super::Afterimage::show) takes it.
#[derive(Debug)]
pub struct Plan {
    pub(super) index: u64,
    pub(super) views: Vec<ViewFrame>,
    pub(super) cameras: Vec<Camera>,
    pub(super) depth: Texture,
    pub(super) motion: Option<Texture>,
    pub(super) reactive: Option<Texture>,
    pub(super) noise: Option<Texture>,
    pub(super) albedo: Option<Texture>,
    /// Mask of a renderer that chose the pixels itself.
    pub(super) given: Option<Texture>,
    pub(super) is_cut: bool,
    pub(super) exposure: Exposure,
    pub(super) mask: Texture,
    pub(super) lists: Vec<Buffer>,
    pub(super) quarters: Vec<Quarter>,
}

/// How the colors of a view of a quarter frame are drawn, outside the fovea.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Quarter {
    /// Half the view's width and height, rounded up.
    pub size_px: [u32; 2],
    /// Projection of the small view, with its jitter.
    pub clip_from_view: [[f32; 4]; 4],
}

impl Plan {
    /// A plan without lists and quarters.
    pub(super) fn new(frame: &Frame<'_>, index: u64, views: Vec<ViewFrame>, mask: Texture) -> Self {
        Self {
            index,
            views,
            cameras: vec![],
            depth: frame.depth.clone(),
            motion: frame.motion.cloned(),
            reactive: frame.reactive.cloned(),
            noise: frame.noise.cloned(),
            albedo: frame.albedo.cloned(),
            given: None,
            is_cut: frame.is_cut,
            exposure: frame.exposure,
            mask,
            lists: vec![],
            quarters: vec![],
        }
    }

    /// The shaded pixels, for compute shaders: an `R32Uint` texture with a texel for each quad of 2x2 pixels, whose
    /// bits 0 to 3 say which of its pixels are shaded, row by row, and bits 8 to 12 how many paths each of them gets
    /// where frames are [path-traced](super::Desc::is_noisy). A [given](super::Afterimage::given) mask is not in it.
    pub fn mask(&self) -> &Texture {
        &self.mask
    }

    /// The quads with shaded pixels, a list on the device for each view; usages `STORAGE`, `INDIRECT` and `COPY_SRC`.
    /// 32-bit words: at byte 0 the arguments of `draw_indirect` with 6 vertices and an instance for each quad, at byte
    /// 16 those of `dispatch_workgroups_indirect` with 64 invocations a workgroup and one for each quad, at byte 28 the
    /// number of quads, from byte 32 on the quads, x + 65536 y in quads, in no particular order.
    pub fn lists(&self) -> &[Buffer] {
        &self.lists
    }

    /// How each view is drawn if nothing is known of the frame, after a cut: the fovea as in other frames, and
    /// everything at half the width and height, too. Empty in other frames, and without
    /// [`Desc::draws_quarters`](super::Desc::draws_quarters).
    pub fn quarters(&self) -> &[Quarter] {
        &self.quarters
    }

    /// The frame as the passes take it.
    pub(super) fn inputs<'a>(&'a self, color: &'a Texture, half: Option<&'a Texture>) -> gpu::Frame<'a> {
        gpu::Frame {
            depth: Some((&self.depth).into()),
            motion: self.motion.as_ref().map(Into::into),
            reactive: self.reactive.as_ref().map(Into::into),
            noise: self.noise.as_ref().map(Into::into),
            albedo: self.albedo.as_ref().map(Into::into),
            mask: self.given.as_ref().map(Into::into),
            half: half.map(Into::into),
            reset: if self.is_cut { Reset::All } else { Reset::None },
            exposure: self.exposure,
            ..gpu::Frame::new(color, &self.views, self.index)
        }
    }
}

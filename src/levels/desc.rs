//! Description of a context for frames with levels of detail.

use super::Settings;
use crate::context::ContextDesc;
use crate::convention::{DepthConvention, MotionConvention};
use wgpu::TextureFormat;

/// Description of an [`Afterimage`](super::Afterimage): size and number of views, conventions of its inputs, format of
/// its output, and settings. Create it with [`new`](Self::new) and `..`:
///
/// ```
/// use afterimage::levels::Desc;
/// use afterimage::wgpu::TextureFormat;
/// use afterimage::{DepthConvention, MotionConvention};
///
/// let depth = DepthConvention::Reversed { near: 0.1, far: f32::INFINITY };
/// let size_px = [1920, 1080];
/// let desc = Desc { depth, motion: MotionConvention::BLENDER, ..Desc::new(size_px, TextureFormat::Rgba16Float) };
/// # let _ = desc;
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Desc {
    /// Width and height of each view in pixels, each 1 to 16384.
    pub size_px: [u32; 2],
    /// Number of views: 1 for a screen, 2 for stereo; at most 4. Default 1.
    pub view_count: u32,
    /// Format of the output: one with red, green and blue that compute shaders can write. These are `Rgba16Float`,
    /// `Rgba32Float`, `Rgba8Unorm` and `Rgba8Snorm`; `Bgra8Unorm`, `Rgba16Unorm` and `Rgba16Snorm` with their device
    /// features; `Rgb10a2Unorm` and `Rg11b10Ufloat` on adapters that can.
    pub output: TextureFormat,
    /// Convention of motion vectors. Default: previous minus current position in pixels, y down.
    pub motion: MotionConvention,
    /// Convention of depth values, for views that do not state their own
    /// ([`ViewFrame::depth`](super::ViewFrame::depth)). Default: linear distance.
    pub depth: DepthConvention,
    /// Whether the output has the color input's alpha (1 where that is not finite) instead of 1. Default true.
    pub keep_alpha: bool,
    /// Method, foveation and tunables. Default: [`Settings::steady`].
    pub settings: Settings,
}

impl Desc {
    /// One view of `size_px`, shown in textures of the format `output`, with default conventions and settings.
    pub fn new(size_px: [u32; 2], output: TextureFormat) -> Self {
        let ContextDesc { view_count, motion, depth, keep_alpha, .. } = ContextDesc::new(size_px);
        Self { size_px, view_count, output, motion, depth, keep_alpha, settings: Settings::default() }
    }

    /// The description as the passes take it.
    pub(super) fn passes(&self) -> ContextDesc {
        let Self { size_px, view_count, motion, depth, keep_alpha, settings, .. } = *self;
        ContextDesc { view_count, motion, depth, keep_alpha, settings: settings.passes(), ..ContextDesc::new(size_px) }
    }
}

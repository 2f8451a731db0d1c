//! Constants of a view for the passes of both executors.

use crate::frame::{ContextDesc, ViewFrame};
use crate::kernel::rng::{self, Purpose};
use crate::settings::Sampler;

/// Twin of `ViewUniforms` in `shaders/pass/view_uniforms.wgsl`; a test compares their layouts.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default)]
#[cfg_attr(feature = "gpu", derive(bytemuck::Pod, bytemuck::Zeroable))]
pub struct ViewUniforms {
    /// Change of a ray's x and y per pixel.
    pub ray_scale: [f32; 2],
    /// x and y of the ray through pixel (0, 0); its z is 1.
    pub ray_offset: [f32; 2],
    /// Ray through the gaze; the last element is unused.
    pub gaze_ray: [f32; 4],
    /// Third row of the current-to-previous view transform.
    pub depth_row: [f32; 4],
    /// Key of the view's random stream.
    pub key: u32,
    /// `DisparityMap::a`.
    pub disparity_a: f32,
    /// `DisparityMap::b`.
    pub disparity_b: f32,
    /// Bit 0: `DisparityMap::invert`; bit 1: `DisparityMap::clamp`.
    pub disparity_flags: u32,
    /// Vector in pixels to add to a converted motion vector, so that it contains no jitter.
    pub motion_offset: [f32; 2],
    /// First pixel of the view in the color input: x in the low half, y in the high half.
    pub color_origin: u32,
    /// The same for depth.
    pub depth_origin: u32,
    /// The same for motion vectors.
    pub motion_origin: u32,
    /// The same for the trust mask.
    pub trust_origin: u32,
    /// The same for levels of detail.
    pub lod_origin: u32,
    /// The same for noise.
    pub noise_origin: u32,
    /// The same for the output.
    pub output_origin: u32,
    /// The same for the debug view.
    pub debug_origin: u32,
    /// Padding to a multiple of 16 bytes.
    pub unused: [u32; 2],
}

/// What a context holds of a view's descriptions from frame to frame.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Held {
    /// Last known gaze position, if any.
    pub gaze_px: Option<[f32; 2]>,
    /// Jitter of this frame.
    pub jitter_px: [f32; 2],
    /// Jitter of the previous frame.
    pub previous_jitter_px: [f32; 2],
}

impl Held {
    /// After a frame with this description of the view.
    pub fn with(self, view: &ViewFrame) -> Self {
        Self {
            gaze_px: Some(view.gaze.resolve(self.gaze_px, &view.geometry)),
            jitter_px: view.jitter_px,
            previous_jitter_px: self.jitter_px,
        }
    }
}

impl ViewUniforms {
    /// Constants of view `index` of frame `frame`; `held` is that [after](Held::with) this frame.
    pub(crate) fn new(desc: &ContextDesc, view: &ViewFrame, held: &Held, index: usize, frame: u64) -> Self {
        let (ray_scale, offset) = view.geometry.scale_offset();
        let settings = &desc.settings;
        let purpose = match settings.sampler {
            Sampler::AChao => Purpose::Select,
            Sampler::AEs => Purpose::Key,
        };
        let [x, y, z] = view.geometry.ray(view.gaze.resolve(held.gaze_px, &view.geometry));
        let disparity = view.depth_convention(desc).disparity_map();
        let jitter = view.jitter_px;
        Self {
            ray_scale,
            // A pixel shows what is at its position minus the jitter.
            ray_offset: [offset[0] - jitter[0] * ray_scale[0], offset[1] - jitter[1] * ray_scale[1]],
            gaze_ray: [x, y, z, 0.0],
            depth_row: view.depth_row(),
            key: rng::stream_key(settings.seed, index as u32, purpose, frame),
            disparity_a: disparity.a,
            disparity_b: disparity.b,
            disparity_flags: u32::from(disparity.invert) | u32::from(disparity.clamp) << 1,
            motion_offset: desc.motion.jitter_offset(jitter, held.previous_jitter_px),
            ..Self::default()
        }
    }
}

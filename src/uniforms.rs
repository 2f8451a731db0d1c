//! Constants of a view for the passes of both executors.

use crate::frame::ViewFrame;
use crate::kernel::rng::{self, Purpose};
use crate::settings::{Sampler, Settings};

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
    /// Padding to a multiple of 16 bytes.
    pub unused: [u32; 3],
}

impl ViewUniforms {
    /// Constants of view `index` of frame `frame` for a gaze at `gaze_px`.
    pub fn new(view: &ViewFrame, gaze_px: [f32; 2], settings: &Settings, index: usize, frame: u64) -> Self {
        let (ray_scale, ray_offset) = view.geometry.scale_offset();
        let purpose = match settings.sampler {
            Sampler::AChao => Purpose::Select,
            Sampler::AEs => Purpose::Key,
        };
        let [x, y, z] = view.geometry.ray(gaze_px);
        Self {
            ray_scale,
            ray_offset,
            gaze_ray: [x, y, z, 0.0],
            depth_row: view.depth_row(),
            key: rng::stream_key(settings.seed, index as u32, purpose, frame),
            unused: [0; 3],
        }
    }
}

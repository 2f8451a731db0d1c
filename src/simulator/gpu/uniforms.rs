//! Uniforms of the simulators' passes. Order, offsets and sizes are checked against the WGSL by a test.

use crate::foveation::Filter;
use crate::frame::{ContextDesc, ViewFrame};
use crate::gpu::MAX_VIEWS;
use crate::uniforms::ViewUniforms;
use bytemuck::{Pod, Zeroable};

/// `FoveationUniforms` in `shaders/foveation/foveated_views.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub struct FoveationUniforms {
    /// Width and height of a view in pixels.
    pub size: [u32; 2],
    /// Coarsest level.
    pub coarsest: u32,
    /// Radius of the full-rate region.
    pub fovea_radius_deg: f32,
    /// Radius of the middle region.
    pub mid_radius_deg: f32,
    /// Width of the blends outside the radii.
    pub blend_deg: f32,
    /// How coarse the middle region is: level of detail, or standard deviation in pixels of the Gaussian at its edge.
    pub mid: f32,
    /// How coarse the frame is beyond: level of detail, or largest standard deviation in pixels.
    pub far: f32,
    /// One entry a view.
    pub views: [ViewUniforms; MAX_VIEWS],
}

impl FoveationUniforms {
    /// Uniforms of a frame whose eyes look at `gaze_px`.
    pub(super) fn new(desc: &ContextDesc, views: &[ViewFrame], gaze_px: &[[f32; 2]]) -> Self {
        let foveation = &desc.settings.foveation;
        let [mid, far] = foveation.coarseness();
        let mut uniforms = Self {
            size: desc.size_px,
            coarsest: if foveation.filter == Filter::Off { 0 } else { foveation.max_level() },
            fovea_radius_deg: foveation.fovea_radius_deg(),
            mid_radius_deg: foveation.mid_radius_deg(),
            blend_deg: foveation.blend_deg,
            mid,
            far,
            ..Self::default()
        };
        for (i, ((to, view), gaze_px)) in uniforms.views.iter_mut().zip(views).zip(gaze_px).enumerate() {
            *to = ViewUniforms::new(view, *gaze_px, &desc.settings, i, 0);
        }
        uniforms
    }
}

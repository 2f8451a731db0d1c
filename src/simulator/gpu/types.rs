//! Mirrors of the structs that the foveation passes read. Order, offsets and sizes are checked against the WGSL by a test.

use crate::foveation::{Filter, Foveation};
use crate::geometry::ViewGeometry;
use crate::gpu::MAX_VIEWS;
use bytemuck::{Pod, Zeroable};

/// `ViewConstants` in `shaders/foveation/foveated_views.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub struct ViewConstants {
    /// Slope of rays per pixel.
    pub ray_scale: [f32; 2],
    /// Ray through pixel (0, 0).
    pub ray_offset: [f32; 2],
    /// Ray through the gaze; the last element is unused.
    pub gaze_ray: [f32; 4],
}

/// `FoveationConstants` in `shaders/foveation/foveated_views.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub struct FoveationConstants {
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
    pub views: [ViewConstants; MAX_VIEWS],
}

impl FoveationConstants {
    /// Constants of a frame without its views.
    pub(super) fn new(foveation: &Foveation, size: [u32; 2]) -> Self {
        let [mid, far] = foveation.coarseness();
        Self {
            size,
            coarsest: if foveation.filter == Filter::Off { 0 } else { foveation.max_level() },
            fovea_radius_deg: foveation.fovea_radius_deg(),
            mid_radius_deg: foveation.mid_radius_deg(),
            blend_deg: foveation.blend_deg,
            mid,
            far,
            ..Self::default()
        }
    }
}

impl ViewConstants {
    /// Constants of a view whose eye looks at `gaze_px`.
    pub(super) fn new(geometry: &ViewGeometry, gaze_px: [f32; 2]) -> Self {
        let (ray_scale, ray_offset) = geometry.scale_offset();
        Self { ray_scale, ray_offset, gaze_ray: geometry.ray(gaze_px).extend(0.0).to_array() }
    }
}

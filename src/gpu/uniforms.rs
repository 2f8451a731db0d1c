//! Uniforms of a frame. A test checks order, offsets and sizes against the WGSL.

use super::Frame;
use crate::frame::{ContextDesc, Reset};
use crate::method::{inv_density_at_fovea, smr_params, wrs_params};
pub use crate::uniforms::ViewUniforms;
use bytemuck::{Pod, Zeroable};

/// Largest number of views of a context ([`ContextDesc::view_count`]) on a GPU.
pub const MAX_VIEWS: usize = 4;

/// `FrameUniforms` in `shaders/pass/inputs.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub struct FrameUniforms {
    /// Width and height of a view in pixels.
    pub size: [u32; 2],
    /// 1 if there is no history, otherwise 0.
    pub reset: u32,
    /// Low word of the frame counter.
    pub frame_low: u32,
    /// Radius of the fovea in degrees.
    pub fovea_radius_deg: f32,
    /// Scale of candidate weights outside the fovea.
    pub inv_density_at_fovea: f32,
    /// Factor of the exponential bias.
    pub exponential_survival: f32,
    /// Color difference up to which the gate value is 1, in Delta E.
    pub gate_offset: f32,
    /// Inverse of the difference, above the offset, at which the gate value is 0.
    pub inv_gate_divisor: f32,
    /// Relative tolerance of the depth test.
    pub depth_relative: f32,
    /// Slope tolerance of the depth test in pixels.
    pub depth_slope_px: f32,
    /// `DisparityMap::a`.
    pub disparity_a: f32,
    /// Factors that convert motion to internal conventions.
    pub motion_scale: [f32; 2],
    /// `DisparityMap::b`.
    pub disparity_b: f32,
    /// Bit 0: `DisparityMap::invert`; bit 1: `DisparityMap::clamp`.
    pub disparity_flags: u32,
    /// Factor on stored colors.
    pub exposure: f32,
    /// Radius of the middle region in degrees.
    pub mid_radius_deg: f32,
    /// Width of the blend outside each radius in degrees.
    pub blend_deg: f32,
    /// Level of detail in the middle region; for a Gaussian blur its standard deviation at the region's edge, in
    /// pixels.
    pub coarse_mid: f32,
    /// Level of detail in the periphery; for a Gaussian blur its largest standard deviation, in pixels.
    pub coarse_far: f32,
    /// `SmrParams::accumulate`.
    pub smr_accumulate: f32,
    /// `SmrParams::accumulate_tolerance`.
    pub smr_accumulate_tolerance: f32,
    /// `SmrParams::tolerance`.
    pub smr_tolerance: f32,
    /// One entry a view.
    pub views: [ViewUniforms; MAX_VIEWS],
}

impl FrameUniforms {
    /// Uniforms of a frame with gaze positions `gaze_px`. `has_history`: whether a frame was recorded before.
    pub(super) fn new(desc: &ContextDesc, frame: &Frame<'_>, gaze_px: &[[f32; 2]], has_history: bool) -> Self {
        let settings = &desc.settings;
        let (wrs, smr) = (wrs_params(settings), smr_params(settings));
        let [coarse_mid, coarse_far] = settings.foveation.coarseness();
        let disparity = desc.depth.disparity_map();
        let test = settings.depth_test.unwrap_or_default();
        let mut uniforms = Self {
            size: desc.size_px,
            reset: u32::from(frame.reset != Reset::None || !has_history),
            frame_low: frame.index as u32,
            fovea_radius_deg: settings.foveation.fovea_radius_deg(),
            inv_density_at_fovea: inv_density_at_fovea(settings),
            exponential_survival: wrs.exponential_survival,
            gate_offset: wrs.gate_offset,
            inv_gate_divisor: wrs.inv_gate_divisor,
            depth_relative: test.relative,
            depth_slope_px: test.slope_px,
            disparity_a: disparity.a,
            motion_scale: desc.motion.to_internal(desc.size_px),
            disparity_b: disparity.b,
            disparity_flags: u32::from(disparity.invert) | u32::from(disparity.clamp) << 1,
            exposure: frame.exposure.factor().unwrap_or(1.0),
            mid_radius_deg: settings.foveation.mid_radius_deg(),
            blend_deg: settings.foveation.blend_deg,
            coarse_mid,
            coarse_far,
            smr_accumulate: smr.accumulate,
            smr_accumulate_tolerance: smr.accumulate_tolerance,
            smr_tolerance: smr.tolerance,
            ..Self::default()
        };
        let views = uniforms.views.iter_mut().zip(frame.views).zip(gaze_px).enumerate();
        for (i, ((to, view), gaze_px)) in views {
            *to = ViewUniforms::new(view, *gaze_px, settings, i, frame.index);
        }
        uniforms
    }
}

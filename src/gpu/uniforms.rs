//! Uniforms of a frame.

use super::Frame;
use crate::context::ContextDesc;
use crate::foveation::Foveation;
use crate::frame::Reset;
use crate::method::{HistoryLayout, inv_density_at_fovea, smr_params, wrs_params};
pub use crate::uniforms::{CameraUniforms, ViewUniforms};
use crate::uniforms::{MAX_VIEWS, ViewState};
use bytemuck::{Pod, Zeroable};

/// `NO_FRAME` in `shaders/shared/inputs.wgsl`: the number of no frame.
pub(super) const NO_FRAME: u32 = u32::MAX;

/// `FrameUniforms` in `shaders/shared/inputs.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub struct FrameUniforms {
    /// Width and height of a view in pixels.
    pub size: [u32; 2],
    /// Number of the frame that history must be of, or `NO_FRAME`.
    pub past_frame: u32,
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
    /// Factor on stored colors.
    pub exposure: f32,
    /// Factors that convert motion to internal conventions.
    pub motion_scale: [f32; 2],
    /// Radius of the middle region in degrees.
    pub mid_radius_deg: f32,
    /// Width of the blend outside each radius in degrees.
    pub blend_deg: f32,
    /// Level of detail of the middle region.
    pub lod_mid: f32,
    /// Level of detail of the periphery.
    pub lod_far: f32,
    /// These three are of `SmrParams`.
    pub smr_accumulate: f32,
    pub smr_accumulate_tolerance: f32,
    pub smr_tolerance: f32,
    /// First view of the dispatch.
    pub first_view: u32,
    /// Bits of a NaN, which shaders cannot write themselves.
    pub missing: u32,
    /// Levels of the mip chains of surfaces and of noisy candidates, above the full-rate one; 0 without.
    pub mip_levels: u32,
    /// Factor on given colors.
    pub color_exposure: f32,
    /// Its inverse, a factor on shown colors.
    pub inverse_exposure: f32,
    /// Largest magnitude of a shown color.
    pub largest_shown: f32,
    /// Place in its block of the quad that is chosen first without history, in quads: x in the low half, y in the high
    /// half.
    pub first_quad: u32,
    /// Places in their blocks of the pixels of the even pattern, in the middle region and in the periphery.
    pub pattern_px: [u32; 4],
    /// Whether one pixel of a chosen quad is shaded outside the fovea.
    pub single_pixels: u32,
    /// Whether quads that are shaded in part have their color in a texture of half the size.
    pub has_half: u32,
    /// Whether quads are chosen by need.
    pub has_budget: u32,
    /// Padding to a multiple of 16 bytes.
    pub unused: u32,
    /// One entry a view.
    pub views: [ViewUniforms; MAX_VIEWS],
    /// Camera motion of each view.
    pub cameras: [CameraUniforms; MAX_VIEWS],
}

impl FrameUniforms {
    /// Uniforms of a frame, without the origins of its views and the largest shown color. `state`: state of the views
    /// after this frame. `past_frame`: number of the previous frame, or [`NO_FRAME`]. `foveation`: of this frame.
    pub(super) fn new(
        desc: &ContextDesc,
        frame: &Frame<'_>,
        state: &[ViewState],
        past_frame: u32,
        foveation: &Foveation,
    ) -> Self {
        let settings = &desc.settings;
        let (wrs, smr) = (wrs_params(settings), smr_params(settings));
        let [lod_mid, lod_far] = foveation.lods();
        let test = settings.depth_test.unwrap_or_default();
        let [first_x, first_y] = Foveation::first_quad(frame.index);
        let mut uniforms = Self {
            size: desc.size_px,
            past_frame: if frame.reset == Reset::None { past_frame } else { NO_FRAME },
            frame_low: frame.index as u32,
            fovea_radius_deg: foveation.fovea_radius_deg(),
            inv_density_at_fovea: inv_density_at_fovea(settings),
            exponential_survival: wrs.exponential_survival,
            gate_offset: wrs.gate_offset,
            inv_gate_divisor: wrs.inv_gate_divisor,
            depth_relative: test.relative,
            depth_slope_px: test.slope_px,
            motion_scale: desc.motion.to_internal(desc.size_px),
            exposure: state[0].stored_exposure(frame),
            mid_radius_deg: foveation.mid_radius_deg(),
            blend_deg: foveation.blend_deg,
            lod_mid,
            lod_far,
            smr_accumulate: smr.accumulate,
            smr_accumulate_tolerance: smr.accumulate_tolerance,
            smr_tolerance: smr.tolerance,
            missing: f32::NAN.to_bits(),
            mip_levels: match settings.history_layout() {
                HistoryLayout::Surfaces { levels, .. } => levels,
                _ => 0,
            },
            color_exposure: frame.exposure.of_colors(),
            inverse_exposure: 1.0 / frame.exposure.of_colors(),
            first_quad: first_x | first_y << 16,
            pattern_px: foveation.pattern_px(frame.index),
            single_pixels: foveation.single_pixels.into(),
            has_half: frame.half.is_some().into(),
            has_budget: (foveation.budget > 0.0).into(),
            ..Self::default()
        };
        for (i, (view, state)) in frame.views.iter().zip(state).enumerate() {
            uniforms.views[i] = ViewUniforms::new(desc, view, state, i, frame.index);
            uniforms.cameras[i] = CameraUniforms::new(desc, view, state);
        }
        uniforms
    }
}

//! Mirrors of the structs that shaders read. Order, offsets and sizes are checked against the WGSL by a test.

use bytemuck::{Pod, Zeroable};

/// Views that one frame may have: the length of `FrameConstants::views`, here and in `shaders/pass/inputs.wgsl`.
pub const MAX_VIEWS: usize = 4;

/// `ViewConstants` in `shaders/pass/inputs.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub struct ViewConstants {
    /// Slope of rays per pixel.
    pub ray_scale: [f32; 2],
    /// Ray through pixel (0, 0).
    pub ray_offset: [f32; 2],
    /// Ray through the gaze; the last element is unused.
    pub gaze_ray: [f32; 4],
    /// Third row of the current-to-previous view transform.
    pub depth_row: [f32; 4],
    /// Key of the view's random stream.
    pub key: u32,
    /// To a multiple of 16 bytes.
    pub unused: [u32; 3],
}

/// `FrameConstants` in `shaders/pass/inputs.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub struct FrameConstants {
    /// Width and height of a view in pixels.
    pub size: [u32; 2],
    /// 1: there is no past.
    pub reset: u32,
    /// Low word of the frame counter.
    pub frame_low: u32,
    /// Radius of the fovea in degrees.
    pub fovea_radius_deg: f32,
    /// Scale of candidate weights outside it.
    pub inv_density_at_fovea: f32,
    /// Factor of the exponential bias.
    pub exponential_survival: f32,
    /// Color difference that costs nothing.
    pub gate_offset: f32,
    /// One over the difference at which the gate is shut.
    pub inv_gate_divisor: f32,
    /// Relative tolerance of the depth test.
    pub depth_relative: f32,
    /// Slope tolerance of the depth test in pixels.
    pub depth_slope_px: f32,
    /// `DisparityMap::a`.
    pub disparity_a: f32,
    /// Factors that bring motion to the internal form.
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
    /// Level of detail in the middle region; for a blur its largest standard deviation there, in pixels.
    pub coarse_mid: f32,
    /// The same beyond.
    pub coarse_far: f32,
    /// `SmrParams::accumulate`.
    pub smr_accumulate: f32,
    /// `SmrParams::accumulate_tolerance`.
    pub smr_accumulate_tolerance: f32,
    /// `SmrParams::tolerance`.
    pub smr_tolerance: f32,
    /// One entry a view.
    pub views: [ViewConstants; MAX_VIEWS],
}

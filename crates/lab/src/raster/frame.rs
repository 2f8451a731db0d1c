//! Frame uniforms. Twin of `RasterFrame` in `shaders/raster/raster_frame.wgsl`.

use super::pixels::Pixels;
use super::window::Window;
use crate::view::View;
use bytemuck::{Pod, Zeroable};
use glam::DVec3;

/// Camera: projects points relative to the eye to homogeneous pixels.
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[repr(C)]
struct Eye {
    high: [f32; 4],
    low: [f32; 4],
    x: [f32; 4],
    y: [f32; 4],
    along: [f32; 4],
}

/// Uniforms of a frame.
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[repr(C)]
pub(super) struct FrameUniforms {
    current: Eye,
    previous: Eye,
    previous_px_from_px: [[f32; 4]; 3],
    corner: [f32; 4],
    right: [f32; 4],
    down: [f32; 4],
    size: [f32; 2],
    near: f32,
    texture_bias: f32,
    first_px: [f32; 2],
    origin: [f32; 2],
    step: f32,
    per_step: f32,
    unused: [f32; 2],
}

impl Eye {
    fn of(view: &View, pixels: &Pixels) -> Self {
        let at = view.world_from_camera().w_axis.truncate();
        let high = at.as_vec3();
        let low = at - high.as_dvec3();
        let [x, y, along] = pixels.rows.map(row);
        Self { high: high.extend(0.0).to_array(), low: row(low), x, y, along }
    }
}

fn row(v: DVec3) -> [f32; 4] {
    v.as_vec3().extend(0.0).to_array()
}

impl FrameUniforms {
    /// Uniforms of the pixels of `window`, for camera `view`, previous camera `previous` and near plane `near` in
    /// metres.
    pub fn new(view: &View, previous: &View, near: f32, window: &Window) -> Self {
        let (current_px, previous_px) = (Pixels::of(view), Pixels::of(previous));
        let previous_px_from_px = [current_px.right, current_px.down, current_px.corner]
            .map(|d| row(DVec3::from(previous_px.rows.map(|r| r.dot(d)))));
        Self {
            current: Eye::of(view, &current_px),
            previous: Eye::of(previous, &previous_px),
            previous_px_from_px,
            corner: row(current_px.corner),
            right: row(current_px.right),
            down: row(current_px.down),
            size: window.size.map(|s| s as f32),
            near,
            texture_bias: if window.is_point { -window.step.log2() } else { 0.0 },
            first_px: window.first_px,
            origin: window.origin,
            step: window.step,
            per_step: window.step.recip(),
            unused: [0.0; 2],
        }
    }
}

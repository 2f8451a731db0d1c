//! Orthographic cameras: strategy games, editors.
//!
//! The post-process compares distances by their ratio, as perspective asks for. Parallel rays have no such measure: it
//! gets an exponential of their depth instead. One step of depth is then the same ratio everywhere, and a camera that
//! moves along its view axis, or turns a little, is a factor.

use afterimage::internal::ViewFrame;
use afterimage::{DepthConvention, Gaze, ViewGeometry};
use bevy::math::{Mat4, UVec2, Vec2};

/// Exponents from the far plane to the near one, `SPAN` of the shader: of what history holds, 2^-32 to 2^32. The depth
/// test's 2 % are then a 2000th of the way between the planes.
const SPAN: f64 = 40.0;

/// Visual angle of the view's width, for regions of foveation: that of a screen.
const WIDTH_DEG: f32 = 40.0;

/// Whether rays of a projection are parallel.
pub(crate) fn is_orthographic(clip_from_view: Mat4) -> bool {
    clip_from_view.z_axis.w == 0.0
}

/// Convention of the depth that the shader makes.
pub(crate) fn depth_convention(clip_from_view: Mat4) -> Result<DepthConvention, String> {
    if clip_from_view.z_axis.z > 0.0 && clip_from_view.is_finite() {
        return Ok(DepthConvention::Reversed { near: (-0.5 * SPAN).exp() as f32, far: f32::INFINITY });
    }
    Err("its depth is not reversed, as Bevy's is".into())
}

/// The view of a camera with its motion, from the transforms from the world to clip space: of this frame, and of the
/// previous one.
pub(crate) fn view(size: UVec2, gaze: Gaze, now: Mat4, past: Option<Mat4>) -> Result<ViewFrame, String> {
    let geometry = ViewGeometry::flat(size.into(), WIDTH_DEG).map_err(|error| error.to_string())?;
    let view = ViewFrame::new(geometry, gaze);
    let Some(past) = past else { return Ok(view) };
    // Change of depth by position in clip space. Depth itself is that of the middle.
    let [x, y, depth, constant] = (past.as_dmat4() * now.as_dmat4().inverse()).row(2).to_array();
    let [half_width, half_height, _] = geometry.ray([size.x as f32 - 0.5, size.y as f32 - 0.5]).map(f64::from);
    let factor = (-SPAN * (constant + 0.5 * (depth - 1.0))).exp();
    let row = [-SPAN * x / half_width, SPAN * y / half_height, 1.0, 0.0].map(|v| (factor * v) as f32);
    let mut motion = Mat4::IDENTITY.to_cols_array_2d();
    motion[2] = row;
    // Matrices that cannot be inverted, as of a camera scaled to 0, have no motion.
    let previous_from_current = row.iter().all(|v| v.is_finite()).then_some(motion);
    Ok(ViewFrame { previous_from_current, ..view })
}

/// A projection whose image is moved by a part of a pixel. Bevy's `TemporalJitter` shears it: it moves what is near
/// less than what is far.
pub(crate) fn jittered(mut clip_from_view: Mat4, size: UVec2, jitter_px: Vec2) -> Mat4 {
    let shift = Vec2::new(2.0, -2.0) * jitter_px / size.as_vec2();
    clip_from_view.w_axis += shift.extend(0.0).extend(0.0);
    clip_from_view
}

#[cfg(test)]
#[path = "../tests/unit/orthographic.rs"]
mod tests;

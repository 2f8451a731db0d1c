//! An engine's matrices: what a projection, a view and a pose say about rays and about the camera's motion.
//!
//! All sums are in doubles: at a thousand metres from the origin, a float keeps few digits of the motion of a frame.

use crate::error::SettingsError;
use glam::{DMat3, DMat4, DVec3, DVec4};
use std::fmt::Debug;

/// Matrix by columns, of `f32` or `f64`.
type Columns<T> = [[T; 4]; 4];

/// Largest part of a projection's scale that counts as rounding, where a projection has 0.
const ROUNDING: f64 = 1e-4;
/// Largest translation that counts as rounding, in units of the view.
const SHIFT_ROUNDING: f64 = 1e-3;
/// Largest dependence of a depth value on x and y that counts as rounding.
const DEPTH_ROUNDING: f64 = 1e-6;
/// Tolerance of rotations: of lengths, and of products of perpendicular vectors.
const TURN_ROUNDING: f64 = 1e-3;
/// Largest turn of an orthographic camera that counts as rounding.
pub(crate) const ORTHOGRAPHIC_TURN: f32 = 1e-5;

fn refuse<T: Debug, R>(setting: &'static str, columns: Columns<T>, expected: &str) -> Result<R, SettingsError> {
    Err(SettingsError { setting, found: format!("{columns:?}"), expected: expected.into() })
}

fn doubles<T: Copy + Into<f64>>(columns: Columns<T>) -> DMat4 {
    DMat4::from_cols_array_2d(&columns.map(|column| column.map(Into::into)))
}

/// Perspective projection: clip x is `scale * x - shift * z`, clip w is `-z`; y up, -z forward.
pub(crate) struct Projection {
    pub scale: [f64; 2],
    pub shift: [f64; 2],
    /// Whether the near plane is not parallel to the view plane, so that depth values depend on x and y, too.
    pub is_oblique: bool,
}

impl Projection {
    /// The projection of a matrix. Its row of depth may hold anything.
    pub fn of<T: Copy + Into<f64> + Debug>(columns: Columns<T>) -> Result<Self, SettingsError> {
        let refuse = |expected| refuse("clip_from_view", columns, expected);
        let matrix = doubles(columns);
        if !matrix.is_finite() {
            return refuse("finite numbers");
        }
        let [x, y, z, w] = matrix.to_cols_array_2d();
        let is_small = |value: f64, scale: f64| value.abs() <= ROUNDING * scale.abs();
        let is_one = |value: f64| (value - 1.0).abs() <= ROUNDING;
        if is_one(w[2].abs()) && !is_one(z[3].abs()) {
            return refuse("a matrix stored by columns; transpose this one");
        }
        if is_small(z[3], w[3]) && w[3] != 0.0 {
            return refuse(
                "a perspective projection; this one is orthographic: give ViewGeometry::flat for the gaze, and \
                 ViewFrame::posed for the camera's motion",
            );
        }
        let looks_ahead = is_small(x[3], z[3]) && is_small(y[3], z[3]);
        if looks_ahead && z[3] > 0.0 {
            return refuse("a right-handed projection with -z forward; negate the third column of a left-handed one");
        }
        if looks_ahead && is_one(-z[3]) && x[0] > 0.0 && y[1] < 0.0 {
            return refuse("clip space with y up; negate the second column of a projection for y down");
        }
        if looks_ahead && is_one(-z[3]) && x[0] < 0.0 && y[1] > 0.0 {
            return refuse(
                "clip space with x to the right; negate the first column of a mirrored projection, and mirror the \
                 view instead",
            );
        }
        let is_alone = looks_ahead && is_one(-z[3]) && is_small(x[1], x[0]) && is_small(y[0], y[1]);
        let is_shifted = [w[0] / x[0], w[1] / y[1], w[3]].iter().any(|shift| shift.abs() > SHIFT_ROUNDING);
        if !is_alone || is_shifted || x[0] <= 0.0 || y[1] <= 0.0 {
            return refuse("a perspective projection alone, not multiplied by a view");
        }
        let is_oblique = x[2].abs().max(y[2].abs()) > DEPTH_ROUNDING;
        Ok(Self { scale: [x[0] / -z[3], y[1] / -z[3]], shift: [z[0] / -z[3], z[1] / -z[3]], is_oblique })
    }
}

/// Transform from this frame's view space (x right, y down, z forward) to the previous frame's, by rows, from a
/// projection and two view-projection matrices (y up, -z forward, by columns).
pub(crate) fn camera_motion<T: Copy + Into<f64> + Debug + PartialEq>(
    clip_from_view: Columns<T>,
    clip_from_world: Columns<T>,
    previous_clip_from_world: Columns<T>,
) -> Result<[[f32; 4]; 4], SettingsError> {
    let projection = Projection::of(clip_from_view)?;
    let (current, scale) = view_of("clip_from_world", clip_from_world)?;
    let is_same = |i: usize| (scale[i] / projection.scale[i] - 1.0).abs() <= TURN_ROUNDING;
    if !(is_same(0) && is_same(1)) {
        return refuse("clip_from_world", clip_from_world, VIEW_EXPECTED);
    }
    // Its field of view may be another one.
    let (previous, _) = view_of("previous_clip_from_world", previous_clip_from_world)?;
    if clip_from_world == previous_clip_from_world {
        return Ok(rows_y_down(DMat4::IDENTITY));
    }
    let motion = previous * current.inverse();
    if motion.determinant() <= 0.0 {
        let expected = "both views mirrored or neither; a cut between them needs Reset::All";
        return refuse("previous_clip_from_world", previous_clip_from_world, expected);
    }
    Ok(rows_y_down(motion))
}

const VIEW_EXPECTED: &str = "finite numbers: clip_from_view times a view of a rotation, a translation and a scale";

/// The view of a product of a projection and a view, and the projection's scale. The product's rows of x, y and w say
/// it all. The row of depth is not read, so that near and far planes and oblique ones do not matter.
fn view_of<T: Copy + Into<f64> + Debug>(
    setting: &'static str,
    columns: Columns<T>,
) -> Result<(DMat4, [f64; 2]), SettingsError> {
    let matrix = doubles(columns);
    let back = -matrix.row(3);
    let size = back.truncate().length();
    let axis = back / size;
    // Clip x is `scale * x - shift * z`. The view's x is perpendicular to its z.
    let across = |row: DVec4| row - axis * row.truncate().dot(axis.truncate());
    let [x, y] = [0, 1].map(|i| across(matrix.row(i)));
    let scale = [x, y].map(|row| row.truncate().length() / size);
    let (x, y) = (x / scale[0], y / scale[1]);
    let view = DMat4::from_cols(x, y, back, DVec4::W).transpose();
    let skew = x.truncate().dot(y.truncate()).abs() / (size * size);
    // NaN fails each comparison.
    if matrix.is_finite() && size > 0.0 && scale.iter().all(|s| *s > 0.0) && skew <= TURN_ROUNDING {
        return Ok((view, scale));
    }
    refuse(setting, columns, VIEW_EXPECTED)
}

/// The same from two poses: the transforms from this frame's view space and from the previous frame's to the world.
pub(crate) fn pose_motion<T: Copy + Into<f64> + Debug + PartialEq>(
    world_from_view: Columns<T>,
    previous_world_from_view: Columns<T>,
) -> Result<[[f32; 4]; 4], SettingsError> {
    let current = checked_pose("world_from_view", world_from_view)?;
    let previous = checked_pose("previous_world_from_view", previous_world_from_view)?;
    if world_from_view == previous_world_from_view {
        return Ok(rows_y_down(DMat4::IDENTITY));
    }
    Ok(rows_y_down(previous.inverse() * current))
}

/// The matrix as a pose, if it is one: a rotation and a translation.
pub(crate) fn checked_pose<T: Copy + Into<f64> + Debug>(
    setting: &'static str,
    columns: Columns<T>,
) -> Result<DMat4, SettingsError> {
    let refuse = |expected| refuse(setting, columns, expected);
    let pose = doubles(columns);
    if !pose.is_finite() {
        return refuse("a rotation and a translation of finite numbers");
    }
    if pose.row(3) != DVec4::W {
        return refuse("a rotation and a translation, stored by columns; transpose a matrix that is stored by rows");
    }
    let rotation = DMat3::from_mat4(pose);
    if !(rotation.transpose() * rotation).abs_diff_eq(DMat3::IDENTITY, TURN_ROUNDING) {
        return refuse("a rotation and a translation without scale; normalise the quaternion of a pose");
    }
    if rotation.determinant() < 0.0 {
        return refuse("a rotation and a translation that do not mirror; ViewFrame::moved takes a mirror's matrices");
    }
    Ok(pose)
}

/// Converts a motion between view spaces with y up and -z forward to view spaces with y down and z forward, by rows.
fn rows_y_down(previous_from_current: DMat4) -> [[f32; 4]; 4] {
    let flip = DMat4::from_diagonal(DVec3::new(1.0, -1.0, -1.0).extend(1.0));
    let rows = (flip * previous_from_current * flip).transpose();
    rows.to_cols_array_2d().map(|row| row.map(|v| v as f32))
}

//! Projection between directions and pixels.

use crate::view::View;
use glam::DVec3;

/// Projection in f64: rows from direction to homogeneous pixels, and columns from pixels to direction.
pub(super) struct Pixels {
    pub rows: [DVec3; 3],
    pub corner: DVec3,
    pub right: DVec3,
    pub down: DVec3,
}

impl Pixels {
    pub fn of(view: &View) -> Self {
        let m = view.world_from_camera();
        let (right, below, ahead) = (m.x_axis.truncate(), -m.y_axis.truncate(), -m.z_axis.truncate());
        let (scale, offset) = view.geometry().scale_offset();
        let [sx, sy] = scale.map(f64::from);
        let [ox, oy] = offset.map(f64::from);
        Self {
            rows: [right / sx - ahead * (ox / sx), below / sy - ahead * (oy / sy), ahead],
            corner: right * ox + below * oy + ahead,
            right: right * sx,
            down: below * sy,
        }
    }
}

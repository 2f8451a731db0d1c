//! Pose of a head.

use glam::{DMat4, DQuat, DVec3};

/// Largest distance of a head from its origin in metres: 1000 km, beyond which `f32` positions jump by centimetres.
const FARTHEST_M: f32 = 1e6;

/// Largest difference of a quaternion's length from 1. The error of rounding to four digits is smaller.
const UNIT_TOLERANCE: f64 = 1e-3;

/// Position of the point between the eyes, and orientation of the head, in a space at rest: x right, y up, -z ahead
/// (the axes of OpenXR, WebXR and glTF cameras). Gravity points along -y.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HeadPose {
    /// Position in metres.
    pub position_m: [f32; 3],
    /// Unit quaternion x, y, z, w of the rotation from the head's axes to the space. Its length may differ from 1 by a
    /// thousandth.
    pub orientation: [f32; 4],
}

impl HeadPose {
    /// Requirements on a pose, for errors.
    pub(super) const EXPECTED: &str = "expected metres, at most a million, and a unit quaternion x, y, z, w";

    /// Pose of a head that is at `position_m` and turned by `orientation`.
    pub(super) fn new(position_m: DVec3, orientation: DQuat) -> Self {
        Self {
            position_m: position_m.to_array().map(|v| v as f32),
            orientation: orientation.to_array().map(|v| v as f32),
        }
    }

    /// Transform from the head's axes to the space.
    pub fn space_from_head(&self) -> DMat4 {
        DMat4::from_rotation_translation(self.rotation(), self.position())
    }

    /// The pose at the share `at` of the way to `other`, 0 to 1: straight, and by the shortest rotation at a constant
    /// speed.
    #[must_use]
    pub fn towards(&self, other: &Self, at: f64) -> Self {
        Self::new(self.position().lerp(other.position(), at), self.rotation().slerp(other.rotation(), at))
    }

    fn position(&self) -> DVec3 {
        DVec3::from(self.position_m.map(f64::from))
    }

    fn rotation(&self) -> DQuat {
        DQuat::from_array(self.orientation.map(f64::from)).normalize()
    }

    /// Problem with the pose, if there is one.
    pub(super) fn fault(&self) -> Option<String> {
        let [x, y, z] = self.position_m;
        if !self.position_m.iter().all(|v| v.abs() <= FARTHEST_M) {
            return Some(format!("the head is at {x}, {y}, {z} m"));
        }
        let length = DQuat::from_array(self.orientation.map(f64::from)).length();
        let is_unit = (length - 1.0).abs() <= UNIT_TOLERANCE;
        (!is_unit).then(|| format!("the head's quaternion has the length {length:.4}"))
    }
}

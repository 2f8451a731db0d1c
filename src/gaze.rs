//! Gaze: where the eye looks in a view.

use crate::camera::checked_pose;
use crate::geometry::ViewGeometry;
use glam::DVec3;
use std::fmt::Debug;

/// Gaze: where the eye looks in a view. Default: [`Lost`](Self::Lost). Example:
/// [`ViewFrame`](crate::levels::ViewFrame).
///
/// A gaze that is not finite counts as lost.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub enum Gaze {
    /// Position in pixels, which may lie outside the view.
    At {
        /// (0, 0) is the centre of the top-left pixel, y down.
        px: [f32; 2],
    },
    /// Position in texture coordinates, which may lie outside the view.
    Uv {
        /// (0, 0) is the top-left corner of the view, (1, 1) its bottom-right corner.
        uv: [f32; 2],
    },
    /// Direction from the eye, as eye trackers deliver it. Counts as lost if it points backwards.
    Direction {
        /// Direction in view space, of any length: x right, y down, z forward. For view spaces with y up and z backward
        /// (OpenXR, glTF, Bevy) negate y and z.
        view: [f32; 3],
    },
    /// Unknown in this frame (blink, lost tracking): the last known position is used; before the first one, the middle
    /// of the view.
    #[default]
    Lost,
}

impl Gaze {
    /// This gaze if the eye tracker's `confidence`, 0 to 1, is at least `least`, otherwise [`Lost`](Self::Lost).
    /// Trackers report low confidence in blinks, when positions jump by many degrees; 0.5 suits most.
    ///
    /// ```
    /// use afterimage::Gaze;
    ///
    /// let gaze = Gaze::Uv { uv: [0.4, 0.6] };
    /// assert_eq!(gaze.if_confident(0.9, 0.5), gaze);
    /// assert_eq!(gaze.if_confident(0.1, 0.5), Gaze::Lost);
    /// ```
    pub fn if_confident(self, confidence: f32, least: f32) -> Self {
        // A NaN fails the comparison and counts as no confidence.
        if confidence >= least { self } else { Self::Lost }
    }

    /// The gaze of one eye, or of one view, from a ray in world space. A headset's eye tracker reports one combined
    /// ray; this gives each of the two views its own gaze. `distance`: how far along the ray the eyes look, in the
    /// units of `origin`. Use the distance of the surface under the gaze, or the distance at which the rays of the two
    /// eyes meet; infinite is allowed. `world_from_view`: pose of the view, a rotation and a translation by columns; y
    /// up, -z forward, as in OpenXR. A ray, a distance or a pose that is not finite or not in that form counts as
    /// [`Lost`](Self::Lost). `T` is `f32` or `f64`: far from the world's origin a float holds no centimetres.
    ///
    /// ```
    /// use afterimage::Gaze;
    ///
    /// // An eye 3 cm to the left of the tracker's origin sees a point 1 m ahead to its right.
    /// let left_eye = [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [-0.03, 0.0, 0.0, 1.0]];
    /// let near = Gaze::on_ray([0.0; 3], [0.0, 0.0, -1.0], 1.0, left_eye);
    /// assert_eq!(near, Gaze::Direction { view: [0.03, 0.0, 1.0] });
    /// let far = Gaze::on_ray([0.0; 3], [0.0, 0.0, -1.0], f32::INFINITY, left_eye);
    /// assert_eq!(far, Gaze::Direction { view: [0.0, 0.0, 1.0] });
    /// ```
    pub fn on_ray<T: Copy + Into<f64> + Debug>(
        origin: [T; 3],
        direction: [T; 3],
        distance: f32,
        world_from_view: [[T; 4]; 4],
    ) -> Self {
        let Ok(pose) = checked_pose("world_from_view", world_from_view) else { return Self::Lost };
        let double = |vector: [T; 3]| DVec3::from(vector.map(Into::into));
        let (origin, direction) = (double(origin), double(direction).normalize_or_zero());
        let view_from_world = pose.inverse();
        let seen = if distance == f32::INFINITY {
            view_from_world.transform_vector3(direction)
        } else {
            view_from_world.transform_point3(origin + f64::from(distance) * direction)
        };
        let is_known = seen.is_finite() && direction != DVec3::ZERO && distance >= 0.0;
        // y is down and z forward here.
        if is_known {
            Self::Direction { view: (seen * DVec3::new(1.0, -1.0, -1.0)).as_vec3().into() }
        } else {
            Self::Lost
        }
    }

    /// Position of the gaze in pixels of a view of `geometry`; `None` if the gaze is lost or not finite. Clamped to
    /// +-1e6 pixels, so that angles stay finite.
    pub(crate) fn known_px(self, geometry: &ViewGeometry) -> Option<[f32; 2]> {
        let px = match self {
            Self::At { px } => Some(px),
            Self::Uv { uv } => {
                let size = geometry.size_px();
                Some([uv[0] * size[0] as f32 - 0.5, uv[1] * size[1] as f32 - 0.5])
            }
            Self::Direction { view } => geometry.project(view),
            Self::Lost => None,
        };
        px.filter(|px| px[0].is_finite() && px[1].is_finite()).map(|px| px.map(|v| v.clamp(-1e6, 1e6)))
    }

    /// Position in pixels to use: this one if it is known, else `last_px`, else the middle of the view.
    pub fn resolve(self, last_px: Option<[f32; 2]>, geometry: &ViewGeometry) -> [f32; 2] {
        let middle = geometry.size_px().map(|s| 0.5 * s as f32 - 0.5);
        self.known_px(geometry).or(last_px).unwrap_or(middle)
    }
}

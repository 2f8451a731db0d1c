//! Stereo views and the gaze of each eye.
//!
//! The eyes are half the interpupillary distance left and right of the head's view. They share its pixels and angles,
//! and their axes are parallel to its own, as in headset displays. The gaze target is a point in space, which projects
//! to a different pixel in each eye: at depth z the two are ipd f / z pixels apart (f: focal length in pixels), and
//! coincide at infinity.

use super::surfaces::first_surface;
use super::world::World;
use afterimage_lab::kernel::direction::unit;
use afterimage_lab::scene::effects::Effects;
use afterimage_lab::view::View;
use glam::DVec3;

/// Gaze target that both eyes share.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum GazePoint {
    /// Point in world space, metres.
    At(DVec3),
    /// Point at infinity in a world-space direction.
    Far(DVec3),
}

impl GazePoint {
    /// Gaze target behind a pixel of the head's view, found with one ray: the first surface as in
    /// [`Surfaces`](super::surfaces::Surfaces), or a point at infinity. A gaze that is not finite means the centre of
    /// the frame.
    pub fn seen(world: &World, head: &View, gaze_px: [f32; 2], effects: Effects) -> Self {
        let middle = head.geometry().size_px().map(|s| 0.5 * (s as f32 - 1.0));
        let px = if gaze_px.iter().all(|v| v.is_finite()) { gaze_px } else { middle };
        let rays = head.rays();
        let direction = unit(rays.corner + rays.right * px[0] + rays.down * px[1]);
        match first_surface(world, rays.origin, direction, effects) {
            Some(surface) => Self::At(surface.current),
            None => Self::Far(direction.as_dvec3()),
        }
    }

    /// Pixel of the target in an eye's view, possibly off the frame. `None` behind the eye; callers should keep the
    /// last pixel.
    pub fn px(self, eye: &View) -> Option<[f32; 2]> {
        let px = match self {
            Self::At(point) => eye.project(point).map(|(px, _)| px),
            Self::Far(direction) => eye.project_direction(direction),
        };
        px.map(|px| px.map(|v| v as f32)).filter(|px| px.iter().all(|v| v.is_finite()))
    }
}

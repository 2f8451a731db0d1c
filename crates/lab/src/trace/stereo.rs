//! Two eyes that look at one point.
//!
//! The eyes stand half the distance of the pupils to the left and the right of a head's view, with its pixels and angles and their axes
//! parallel to its own, as displays of a headset have them. What is looked at is a point in space, which each eye sees at a pixel of its
//! own: at depth z the two are ipd f / z pixels apart, with f pixels of focal length, and none where there is nothing.

use super::effects::Effects;
use super::surfaces::first_surface;
use super::view::View;
use super::world::World;
use crate::kernel::direction::unit;
use glam::{DMat4, DVec3};

/// What both eyes look at.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum GazePoint {
    /// A place in world space, metres.
    At(DVec3),
    /// What is infinitely far in a direction of world space.
    Far(DVec3),
}

impl View {
    /// What the left and the right eye of someone see whose pupils are `ipd_m` metres apart and whose head is here: all pixels of
    /// the view, from half of that to either side.
    pub fn stereo(&self, ipd_m: f64) -> [Self; 2] {
        [-0.5, 0.5].map(|side| {
            let aside = DMat4::from_translation(DVec3::X * (side * ipd_m));
            Self::new(*self.geometry(), self.world_from_camera() * aside)
        })
    }
}

impl GazePoint {
    /// What `world` has at a place of the head's view (pixels; one that is no number is the middle), by one ray: the first surface as
    /// [`Surfaces`](super::surfaces::Surfaces) has it, or what is far away.
    pub fn seen(world: &World, head: &View, gaze_px: [f32; 2], effects: Effects) -> Self {
        let middle = head.geometry().size_px().map(|s| 0.5 * (s as f32 - 1.0));
        let px = if gaze_px.iter().all(|v| v.is_finite()) { gaze_px } else { middle };
        let rays = head.rays();
        let direction = unit(rays.corner + rays.right * px[0] + rays.down * px[1]);
        match first_surface(world, rays.origin, direction, effects) {
            Some(surface) => Self::At(surface.at),
            None => Self::Far(direction.as_dvec3()),
        }
    }

    /// Where an eye sees it, pixels, on its frame or off it. `None` behind the eye, which has no pixel for it: hold the last.
    pub fn px(self, eye: &View) -> Option<[f32; 2]> {
        let px = match self {
            Self::At(point) => eye.project(point).map(|(px, _)| px),
            Self::Far(direction) => eye.project_direction(direction),
        };
        px.map(|px| px.map(|v| v as f32)).filter(|px| px.iter().all(|v| v.is_finite()))
    }
}

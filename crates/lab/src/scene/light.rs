//! Lights that are not triangles: punctual ones (KHR_lights_punctual) and what surrounds the scene.

use afterimage::Image;
use glam::Vec3;

/// A light without extent.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PunctualLight {
    /// What it is.
    pub kind: PunctualKind,
    /// World position in metres. A directional light has none.
    pub position: Vec3,
    /// Where it shines to, of length 1. A point light shines everywhere.
    pub direction: Vec3,
    /// Linear color times intensity: radiant intensity of point and spot lights (glTF's candela taken as W/sr), irradiance of
    /// directional ones (lux taken as W/m^2).
    pub intensity: [f32; 3],
    /// Metres beyond which it does not reach; infinity: everywhere.
    pub range: f32,
}

/// Kinds of punctual lights.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PunctualKind {
    /// From infinitely far.
    Directional,
    /// From a point, all around.
    Point,
    /// From a point, within a cone: full inside the inner angle, none outside the outer one.
    Spot {
        /// Cosine of the inner half angle.
        cos_inner: f32,
        /// Cosine of the outer half angle, below that of the inner one.
        cos_outer: f32,
    },
}

/// What rays see that hit nothing.
#[derive(Clone, Debug, PartialEq)]
pub enum Environment {
    /// The same radiance from everywhere; black for none.
    Constant([f32; 3]),
    /// Radiance by direction: longitude along x, the middle column towards -z, latitude along y, up on top.
    Map(Image<[f32; 3]>),
}

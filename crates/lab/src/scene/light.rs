//! Lights that are not triangles: punctual lights (KHR_lights_punctual) and the environment.

use afterimage::Image;
use glam::Vec3;

/// A light without extent.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PunctualLight {
    /// Directional, point or spot.
    pub kind: PunctualKind,
    /// World position in metres; not used for directional lights.
    pub position: Vec3,
    /// Unit direction that the light shines in; not used for point lights.
    pub direction: Vec3,
    /// Linear color times intensity: radiant intensity of point and spot lights (glTF's candela taken as W/sr),
    /// irradiance of directional ones (lux taken as W/m^2).
    pub intensity: [f32; 3],
    /// Range in metres; infinity for no limit.
    pub range: f32,
}

impl PunctualLight {
    /// A directional light that shines along `direction`.
    pub(crate) fn sun(direction: Vec3, intensity: [f32; 3]) -> Self {
        let direction = direction.normalize();
        Self { kind: PunctualKind::Directional, position: Vec3::ZERO, direction, intensity, range: f32::INFINITY }
    }
}

/// Kinds of punctual lights.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PunctualKind {
    /// A light at infinity.
    Directional,
    /// A point that radiates equally in all directions.
    Point,
    /// A point that radiates into a cone: full intensity inside the inner angle, none outside the outer one.
    Spot {
        /// Cosine of the inner half angle.
        cos_inner: f32,
        /// Cosine of the outer half angle, below that of the inner one.
        cos_outer: f32,
    },
}

/// Radiance of rays that hit nothing.
#[derive(Clone, Debug, PartialEq)]
pub enum Environment {
    /// Constant radiance; black for no environment.
    Constant([f32; 3]),
    /// Equirectangular map of radiance: longitude along x with -z in the middle column, latitude along y with up at the
    /// top.
    Map(Image<[f32; 3]>),
}

//! Falloff of punctual lights, and the parametrization of environment maps.

use afterimage::kernel::approx::{atan2_upper, sin_cos_turns};
use glam::Vec3;
use std::f32::consts::FRAC_1_PI;

/// Factor from a point or spot light's intensity to irradiance at `distance`, 1/m^2: inverse square with a window that
/// ends at `range` (KHR_lights_punctual; infinite range: no window). Distances below 1 mm are clamped.
#[inline]
pub fn distance_falloff(distance: f32, range: f32) -> f32 {
    let ratio = distance / range;
    let squared = ratio * ratio;
    let window = (1.0 - squared * squared).clamp(0.0, 1.0);
    let near = distance.max(1e-3);
    window / (near * near)
}

/// Share of a spot light's intensity at an angle to its axis, with all angles as cosines (KHR_lights_punctual).
#[inline]
pub fn cone_falloff(cos_angle: f32, cos_inner: f32, cos_outer: f32) -> f32 {
    let t = ((cos_angle - cos_outer) / (cos_inner - cos_outer).max(1e-3)).clamp(0.0, 1.0);
    t * t
}

/// Environment map coordinates of a unit direction, both in \[0, 1\]: longitude (0.5 at -z, growing towards +x) and
/// angle from +y.
#[inline]
pub fn map_coordinates(direction: Vec3) -> [f32; 2] {
    let across = (direction.x * direction.x + direction.z * direction.z).sqrt();
    let longitude = atan2_upper(direction.x.abs(), -direction.z) * (0.5 * FRAC_1_PI);
    let u = if direction.x < 0.0 { 0.5 - longitude } else { 0.5 + longitude };
    [u, atan2_upper(across, direction.y) * FRAC_1_PI]
}

/// Unit direction of environment map coordinates, and the sine of its angle from the y axis.
#[inline]
pub fn map_direction(u: f32, v: f32) -> (Vec3, f32) {
    let [sin_longitude, cos_longitude] = sin_cos_turns(u - 0.5);
    let [sin_latitude, cos_latitude] = sin_cos_turns(0.5 * v);
    let sine = sin_latitude.max(0.0);
    (Vec3::new(sin_longitude * sine, cos_latitude, -(cos_longitude * sine)), sine)
}

/// Density in 1/sr of a uniform point in a texel that is picked with `probability` among `texels` texels.
#[inline]
pub fn map_pdf(probability: f32, texels: f32, sine: f32) -> f32 {
    probability * texels / (MAP_AREA * sine.max(1e-6))
}

/// Twice pi squared: range of longitude times range of the angle from the axis.
const MAP_AREA: f32 = 19.739_208;

//! Light that arrives from punctual lights, triangles and all around.

use afterimage::kernel::approx::{atan2_upper, sin_cos_turns};
use glam::Vec3;
use std::f32::consts::FRAC_1_PI;

/// Share of its intensity that a point or spot light sends over `distance`, 1/m^2: the inverse square, windowed so that it ends
/// at `range` (KHR_lights_punctual; infinity: it never ends). Distances below a millimetre count as one.
#[inline]
pub fn distance_falloff(distance: f32, range: f32) -> f32 {
    let ratio = distance / range;
    let squared = ratio * ratio;
    let window = (1.0 - squared * squared).clamp(0.0, 1.0);
    let near = distance.max(1e-3);
    window / (near * near)
}

/// Share of a spot light's intensity at an angle to its axis, all angles as cosines (KHR_lights_punctual).
#[inline]
pub fn cone_falloff(cos_angle: f32, cos_inner: f32, cos_outer: f32) -> f32 {
    let t = ((cos_angle - cos_outer) / (cos_inner - cos_outer).max(1e-3)).clamp(0.0, 1.0);
    t * t
}

/// Place in the environment map of a direction of length 1, both in \[0, 1\]: longitude, 0.5 towards -z and growing towards +x;
/// angle from +y.
#[inline]
pub fn map_coordinates(direction: Vec3) -> [f32; 2] {
    let across = (direction.x * direction.x + direction.z * direction.z).sqrt();
    let longitude = atan2_upper(direction.x.abs(), -direction.z) * (0.5 * FRAC_1_PI);
    let u = if direction.x < 0.0 { 0.5 - longitude } else { 0.5 + longitude };
    [u, atan2_upper(across, direction.y) * FRAC_1_PI]
}

/// Direction of a place in the environment map, and the sine of its angle from the axis.
#[inline]
pub fn map_direction(u: f32, v: f32) -> (Vec3, f32) {
    let [sin_longitude, cos_longitude] = sin_cos_turns(u - 0.5);
    let [sin_latitude, cos_latitude] = sin_cos_turns(0.5 * v);
    let sine = sin_latitude.max(0.0);
    (Vec3::new(sin_longitude * sine, cos_latitude, -(cos_longitude * sine)), sine)
}

/// Density over directions, 1/sr, of a uniform point in one of `texels` texels of a map, probability with probability `probability`.
#[inline]
pub fn map_pdf(probability: f32, texels: f32, sine: f32) -> f32 {
    probability * texels / (MAP_AREA * sine.max(1e-6))
}

/// Twice the square of pi: longitudes times angles from the axis.
const MAP_AREA: f32 = 19.739_208;

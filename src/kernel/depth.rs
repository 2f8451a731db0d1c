//! Is this the same surface? Depth as disparity 1/z: affine in every perspective depth buffer, linear over planes, 0 for the
//! sky.

/// Turns a stored depth value into a disparity: `a * stored + b`, or its inverse.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DisparityMap {
    /// Factor of the stored value.
    pub a: f32,
    /// Offset.
    pub b: f32,
    /// The stored value, after factor and offset, is a distance.
    pub invert: bool,
    /// Clamp the stored value to \[0, 1\] first (depth buffers; not distances).
    pub clamp: bool,
}

/// Stands for "no usable depth": never the same surface as anything.
pub const INVALID_DISPARITY: f32 = -1.0;

/// Disparity of a stored depth value: >= 0, 0 where there is nothing, or [`INVALID_DISPARITY`] for NaN and for distances
/// that are not positive.
#[inline]
pub fn disparity(stored: f32, map: DisparityMap) -> f32 {
    let is_nan = stored.to_bits() & 0x7fff_ffff > 0x7f80_0000;
    if is_nan {
        return INVALID_DISPARITY;
    }
    let value = if map.clamp { stored.clamp(0.0, 1.0) } else { stored };
    let v = map.a * value + map.b;
    if !map.invert {
        return if v > 0.0 { v } else { 0.0 };
    }
    // Neither 1/0 nor 1/inf is left to the device.
    if v < 1e-30 {
        INVALID_DISPARITY
    } else if v > 1e30 {
        0.0
    } else {
        1.0 / v
    }
}

/// Row of the current-to-previous view transform that gives the previous distance, folded with the ray of a pixel:
/// `z_previous = z * stretch + shift`.
///
/// `stretch = m20 * ray.x + m21 * ray.y + m22`, `shift = m23`.
#[inline]
pub fn previous_disparity(disparity: f32, stretch: f32, shift: f32) -> f32 {
    if disparity < 0.0 {
        return INVALID_DISPARITY;
    }
    let denominator = stretch + shift * disparity;
    // The point was behind the previous camera.
    if denominator <= 1e-6 {
        return INVALID_DISPARITY;
    }
    disparity / denominator
}

/// Whether a stored and an expected disparity belong to one surface: they differ by at most `relative` of the larger one
/// plus `slope`, the surface's own change over the distance that reprojection may be off.
#[inline]
pub fn same_surface(expected: f32, stored: f32, relative: f32, slope: f32) -> bool {
    if expected < 0.0 || stored < 0.0 {
        return false;
    }
    (expected - stored).abs() <= relative * expected.max(stored) + slope
}

/// How much the surface at pixel (`x`, `y`) of an image of `size` changes its disparity from pixel to pixel, both axes together.
/// `at` reads a disparity; its invalid ones are ignored. Planes give the same everywhere. WGSL has no readers: there it is a loop
/// in the pass.
#[inline]
pub fn slope(x: u32, y: u32, size: [u32; 2], at: impl Fn(u32, u32) -> f32) -> f32 {
    let tap = |inside: bool, x: u32, y: u32| {
        if inside { at(x, y) } else { INVALID_DISPARITY }
    };
    let left = tap(x > 0, x.wrapping_sub(1), y);
    let right = tap(x + 1 < size[0], x + 1, y);
    let up = tap(y > 0, x, y.wrapping_sub(1));
    let down = tap(y + 1 < size[1], x, y + 1);
    let center = at(x, y);
    one_sided_slope(center, left, right) + one_sided_slope(center, up, down)
}

/// Change of disparity over one pixel along an axis, from both neighbours: the smaller one-sided difference, so that a
/// silhouette on one side does not count as slope, and 0 where the pixel is higher or lower than both, as a wire is. A
/// neighbour that is missing or invalid is ignored.
#[inline]
pub fn one_sided_slope(center: f32, before: f32, after: f32) -> f32 {
    let back = center - before;
    let ahead = after - center;
    match (before >= 0.0, after >= 0.0) {
        (true, true) if back * ahead > 0.0 => back.abs().min(ahead.abs()),
        (true, false) => back.abs(),
        (false, true) => ahead.abs(),
        _ => 0.0,
    }
}

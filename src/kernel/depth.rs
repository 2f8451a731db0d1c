//! Depth test: whether stored history belongs to the surface of a pixel.
//!
//! Depth is compared as disparity 1/z: affine in every perspective depth buffer, linear over planes, 0 for the sky.

/// Map from a stored depth value to a disparity: `a * stored + b`, or its inverse.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DisparityMap {
    /// Factor of the stored value.
    pub a: f32,
    /// Offset.
    pub b: f32,
    /// The stored value, after factor and offset, is a distance.
    pub invert: bool,
    /// Clamp the stored value to \[0, 1\] first: for depth buffers, not for distances.
    pub clamp: bool,
}

impl DisparityMap {
    /// `flags` of the WGSL struct.
    pub fn flags(self) -> u32 {
        u32::from(self.invert) | u32::from(self.clamp) << 1
    }
}

/// Disparity of a pixel without usable depth: fails every depth test.
pub const INVALID_DISPARITY: f32 = -1.0;

/// Disparity of a stored depth value, at least 0; 0 for infinite distance. [`INVALID_DISPARITY`] for NaN and for
/// distances that are not positive.
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
    // Devices may differ on 1/0 and 1/inf.
    if v < 1e-30 {
        INVALID_DISPARITY
    } else if v > 1e30 {
        0.0
    } else {
        1.0 / v
    }
}

/// Distance of a disparity, the inverse of [`disparity`]; negative for [`INVALID_DISPARITY`].
#[inline]
pub fn distance_of(disparity: f32) -> f32 {
    if disparity < 0.0 {
        return -1.0;
    }
    // Devices may differ on 1/0.
    1.0 / disparity.max(1e-31)
}

/// Disparity that the surface of a pixel had in the previous frame's view, from `z_previous = z * stretch + shift`;
/// with `m` the current-to-previous view transform, `stretch = m20 * ray.x + m21 * ray.y + m22` and `shift = m23`.
/// [`INVALID_DISPARITY`] if the point was behind the previous camera.
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

/// Whether a stored and an expected disparity belong to one surface: they differ by at most `relative` of the larger
/// one plus `slope`, the surface's own change of disparity over the reprojection error.
#[inline]
pub fn same_surface(expected: f32, stored: f32, relative: f32, slope: f32) -> bool {
    if expected < 0.0 || stored < 0.0 {
        return false;
    }
    (expected - stored).abs() <= relative * expected.max(stored) + slope
}

/// Slope of the surface at pixel (`x`, `y`) of an image of `size`: change of disparity a pixel, summed over both axes.
/// Constant on a plane. `at` reads a disparity; invalid ones are ignored. WGSL has no closures: there the pass has a
/// loop instead.
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

/// Change of disparity over one pixel along an axis: the smaller of the two one-sided differences, so that a silhouette
/// on one side does not count as slope. 0 where the pixel is nearer or farther than both neighbours, as a thin wire is.
/// A neighbour that is missing or invalid is ignored.
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

//! Building blocks of the textures: integer hashes, value noise, and step functions averaged over a sample's footprint.
//!
//! Functions take the footprint `w`, the width in texture units that one color sample covers, and return the mean over
//! it. Such prefiltered textures do not alias where they are finer than the pixels.

use glam::{Vec2, Vec3};

/// A 32-bit hash of a lattice point.
#[inline]
pub(super) fn hash(x: i32, y: i32, seed: u32) -> u32 {
    let mut h = (x as u32)
        .wrapping_mul(0x9e37_79b1)
        .wrapping_add((y as u32).wrapping_mul(0x85eb_ca77))
        .wrapping_add(seed.wrapping_mul(0xc2b2_ae3d));
    h ^= h >> 15;
    h = h.wrapping_mul(0x2c1b_3c6d);
    h ^= h >> 12;
    h = h.wrapping_mul(0x297a_2d39);
    h ^ (h >> 15)
}

/// The hash as a number in [0, 1).
#[inline]
pub(super) fn unit(x: i32, y: i32, seed: u32) -> f32 {
    (hash(x, y, seed) >> 8) as f32 * (1.0 / 16_777_216.0)
}

/// Integer and fractional part of `x`, rounded down. Not `f32::floor`: on baseline x86 it calls the C library.
#[inline]
pub(super) fn split(x: f32) -> (i32, f32) {
    let truncated = x as i32;
    let whole = truncated - i32::from((truncated as f32) > x);
    (whole, x - whole as f32)
}

/// Both coordinates rounded down.
#[inline]
pub(super) fn floor2(p: Vec2) -> Vec2 {
    Vec2::new(split(p.x).0 as f32, split(p.y).0 as f32)
}

#[inline]
fn lerp(a: f32, b: f32, t: f32) -> f32 {
    a + (b - a) * t
}

/// 0 below `a`, 1 above `b`, smooth in between.
#[inline]
pub(super) fn smoothstep(a: f32, b: f32, x: f32) -> f32 {
    let t = ((x - a) / (b - a)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// Hash values in [0, 1) at the four lattice points around a cell, top row first. The four hashes share most of their
/// arithmetic, and one round less than in [`hash`] is enough for interpolated values.
#[inline]
fn corners(x: i32, y: i32, seed: u32) -> [f32; 4] {
    const X: u32 = 0x9e37_79b1;
    const Y: u32 = 0x85eb_ca77;
    let base = (x as u32)
        .wrapping_mul(X)
        .wrapping_add((y as u32).wrapping_mul(Y))
        .wrapping_add(seed.wrapping_mul(0xc2b2_ae3d));
    [0, X, Y, X.wrapping_add(Y)].map(|step| {
        let mut h = base.wrapping_add(step);
        h = (h ^ (h >> 15)).wrapping_mul(0x2c1b_3c6d);
        h ^= h >> 13;
        // The conversion is signed, because baseline x86 has no unsigned one.
        (h >> 8) as i32 as f32 * (1.0 / 16_777_216.0)
    })
}

/// Value noise in [0, 1] with one lattice point per unit.
#[inline]
pub(super) fn noise(p: Vec2, seed: u32) -> f32 {
    let ((x, fx), (y, fy)) = (split(p.x), split(p.y));
    let f = Vec2::new(fx, fy);
    let s = f * f * (Vec2::splat(3.0) - 2.0 * f);
    let [a, b, c, d] = corners(x, y, seed);
    lerp(lerp(a, b, s.x), lerp(c, d, s.x), s.y)
}

/// Value noise in [0, 1] in three dimensions.
pub(super) fn noise3(p: Vec3, seed: u32) -> f32 {
    let ((x, fx), (y, fy), (z, fz)) = (split(p.x), split(p.y), split(p.z));
    let f = Vec3::new(fx, fy, fz);
    let s = f * f * (Vec3::splat(3.0) - 2.0 * f);
    let plane = |z: i32| {
        let seed = seed.wrapping_add((z as u32).wrapping_mul(0x27d4_eb2f));
        let [a, b, c, d] = corners(x, y, seed);
        lerp(lerp(a, b, s.x), lerp(c, d, s.x), s.y)
    };
    lerp(plane(z), plane(z + 1), s.z)
}

/// Remaining contrast of a feature of period 1 under a footprint `w`: 1 below 0.35, 0 from 1 on.
#[inline]
pub(super) fn surviving(w: f32) -> f32 {
    1.0 - smoothstep(0.35, 1.0, w)
}

/// Sum of `octaves` noises, each twice as fine and half as strong; in [0, 1] around 0.5. Octaves finer than `w` fade
/// out.
pub(super) fn fbm(p: Vec2, w: f32, octaves: u32, seed: u32) -> f32 {
    sum_of_octaves(w, octaves, |frequency, octave| noise(p * frequency, seed + octave))
}

/// Sum of `octaves` three-dimensional noises, like [`fbm`].
pub(super) fn fbm3(p: Vec3, w: f32, octaves: u32, seed: u32) -> f32 {
    sum_of_octaves(w, octaves, |frequency, octave| noise3(p * frequency, seed + octave))
}

#[inline(always)]
fn sum_of_octaves(w: f32, octaves: u32, noise: impl Fn(f32, u32) -> f32) -> f32 {
    let (mut sum, mut amplitude, mut frequency) = (0.5, 0.5, 1.0);
    for octave in 0..octaves {
        let kept = surviving(0.5 * w * frequency);
        if kept <= 0.0 {
            break;
        }
        sum += amplitude * kept * (noise(frequency, octave) - 0.5);
        amplitude *= 0.5;
        frequency *= 2.0;
    }
    sum
}

/// Pulse train averaged over a footprint: share of [x - w/2, x + w/2] covered by [n, n + duty] over all integers n.
/// Exact for any `w`.
#[inline]
pub(super) fn pulse(x: f32, duty: f32, w: f32) -> f32 {
    let w = w.max(1e-4);
    let integral = |x: f32| {
        let (cell, rest) = split(x);
        cell as f32 * duty + rest.min(duty)
    };
    ((integral(x + 0.5 * w) - integral(x - 0.5 * w)) / w).clamp(0.0, 1.0)
}

/// Antialiased step: share of the footprint inside an edge at signed distance `d`, negative inside.
#[inline]
pub(super) fn inside(d: f32, w: f32) -> f32 {
    (0.5 - d / w.max(1e-5)).clamp(0.0, 1.0)
}

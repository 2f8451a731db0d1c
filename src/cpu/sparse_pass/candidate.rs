//! Candidate of a pixel: the samples around it, and their light.

use super::view::NO_NOISE;
use crate::kernel::noise::Noise;
use crate::kernel::resample::codes_between;
use crate::kernel::sparse::{BY_NEIGHBOURS, Lit, SAMPLE_RELATIVE};
use glam::Vec3;

/// [`codes_between`] of the samples that are interpolated for a pixel with the disparity `disparity`.
#[inline(always)]
pub(super) fn sample_codes(disparity: f32) -> [u32; 2] {
    codes_between(disparity, 1.0 - SAMPLE_RELATIVE, 1.0 / (1.0 - SAMPLE_RELATIVE))
}

/// Candidate of a pixel.
pub(super) struct Candidate {
    pub color: Vec3,
    pub usable: bool,
    pub lod: f32,
    /// Smallest and largest color of the samples around the pixel.
    pub range: [Vec3; 2],
    pub gain: Vec3,
    pub fit: f32,
    pub noise: Noise,
    /// Whether the candidate is this pixel's own sample.
    pub is_own: bool,
}

impl Candidate {
    pub const NONE: Self = Self {
        color: Vec3::ZERO,
        usable: false,
        lod: 0.0,
        range: [Vec3::ZERO; 2],
        gain: Vec3::ONE,
        fit: 1.0,
        noise: NO_NOISE,
        is_own: false,
    };
}

/// Sums over the samples around a pixel.
#[derive(Default)]
pub(super) struct Sums {
    pub color: Vec3,
    pub weight: f32,
    pub gain: Vec3,
    pub fit: f32,
    pub valid: f32,
}

impl Sums {
    #[inline(always)]
    pub fn add(&mut self, color: Vec3, weight: f32, lit: Lit) {
        let known = weight * if lit.is_own { 1.0 } else { BY_NEIGHBOURS };
        self.color += color * weight;
        self.weight += weight;
        self.gain += lit.gain * known;
        self.fit += lit.fit * known;
        self.valid += known;
    }
}

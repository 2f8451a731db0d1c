//! Candidate of a pixel: the samples around it, and their light.

use super::view::NO_NOISE;
use crate::kernel::noise::Noise;
use crate::kernel::resample::codes_between;
use crate::kernel::sparse_smr::{BY_NEIGHBOURS, Lit, Observation, SAMPLE_RELATIVE};
use crate::notes::{NoteStage, Notes};
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

    #[inline(always)]
    pub fn note(&self, notes: &mut impl Notes) {
        notes.note(NoteStage::Candidate, "color", self.color, "linear light");
        notes.note(NoteStage::Candidate, "usable", self.usable, "");
        notes.note(NoteStage::Candidate, "the pixel's own sample", self.is_own, "");
        notes.note(NoteStage::Candidate, "level of detail", self.lod, "log2 px");
        notes.note(NoteStage::Candidate, "smallest of the samples around", self.range[0], "linear light");
        notes.note(NoteStage::Candidate, "largest of the samples around", self.range[1], "linear light");
        notes.note(
            NoteStage::Candidate,
            "noise",
            [self.noise.samples, self.noise.variance],
            "samples, variance of one",
        );
        notes.note(NoteStage::Light, "gain", self.gain, "");
    }
}

/// A sample around a pixel, its light, and its comparison with history.
pub(super) fn note_sample(
    notes: &mut impl Notes,
    [x, y]: [u32; 2],
    weight: f32,
    color: Vec3,
    lit: Lit,
    observed: Option<Observation>,
) {
    let values = [x as f32, y as f32, weight, color.x, color.y, color.z];
    notes.note(NoteStage::Candidate, "sample", values, "x y px, weight, linear light");
    let values = [x as f32, y as f32, lit.gain.x, lit.gain.y, lit.gain.z, lit.fit, lit.own_fit];
    notes.note(NoteStage::Light, "sample", values, "x y px, gain, fit around it, fit of its own");
    if let Some(Observation { history, error, confidence, .. }) = observed {
        let values = [x as f32, y as f32, history.x, history.y, history.z, error, confidence];
        notes.note(
            NoteStage::Comparison,
            "history at sample",
            values,
            "x y px, linear light, expected difference (100 from black to white), confidence",
        );
    }
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

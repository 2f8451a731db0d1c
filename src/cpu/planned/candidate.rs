//! Candidate of a pixel: the samples around it, and the rectification of history at them.

use super::view::NO_NOISE;
use crate::kernel::candidate::{Borrowed, SampleSums, borrow_around, is_beside, sample_mean};
use crate::kernel::demodulation::AlbedoChange;
use crate::kernel::noise::Noise;
use crate::kernel::reconstruction::{Observation, Rectification};
use crate::notes::{NoteStage, Notes};
use glam::{Vec3, Vec4};

pub(super) struct Candidate {
    pub color: Vec3,
    pub usable: bool,
    pub lod: f32,
    /// Smallest and largest color of the samples around the pixel.
    pub range: [Vec3; 2],
    pub gain: Vec3,
    pub fit: f32,
    pub noise: Noise,
    pub alpha: f32,
    /// Whether the candidate is this pixel's own sample.
    pub is_own: bool,
    /// Color of the sample of the pixel's surface beside it, if there is one.
    pub beside: Option<Vec3>,
    /// Of frames with albedo.
    pub albedo: AlbedoChange,
    /// Of a noisy pixel with a sample: mean of all samples around it, its own included, and the mean variance of one.
    pub around: Vec4,
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
        alpha: 1.0,
        is_own: false,
        beside: None,
        albedo: AlbedoChange::NONE,
        around: Vec4::ZERO,
    };

    /// Candidate of a pixel outside the fovea from the samples around it; `own`: color and alpha of its own sample, and
    /// the fit of history there.
    #[inline(always)]
    pub fn of_samples(sums: SampleSums, coarsest: f32, own: Option<(Vec3, f32, f32)>) -> Self {
        if sums.weight == 0.0 {
            return Self::NONE;
        }
        let mean = sample_mean(sums, coarsest);
        let (color, alpha, center_fit) = own.unwrap_or((mean.color, mean.alpha, 1.0));
        Self {
            color,
            usable: true,
            lod: if own.is_some() { 0.0 } else { mean.lod },
            range: [sums.lowest, sums.highest],
            gain: mean.gain,
            fit: mean.fit.min(center_fit),
            alpha,
            is_own: own.is_some(),
            beside: is_beside(sums).then_some(sums.beside),
            ..Self::NONE
        }
    }

    /// The noisy sample of a pixel whose history is a mean of `past` samples, with its share of the mean around it.
    #[inline(always)]
    pub fn borrowing(self, past: f32) -> Self {
        let Borrowed { color, noise } = borrow_around(self.color, self.noise, self.around, past);
        Self { color, noise, ..self }
    }

    /// With the texture of the pixel's own albedo.
    #[inline(always)]
    pub fn textured(self, albedo: AlbedoChange) -> Self {
        Self { albedo, ..self.times(albedo.factor) }
    }

    /// With a factor on its colors.
    #[inline(always)]
    pub fn times(self, factor: Vec3) -> Self {
        Self {
            color: self.color * factor,
            range: self.range.map(|color| color * factor),
            beside: self.beside.map(|color| color * factor),
            ..self
        }
    }

    #[inline(always)]
    pub fn note(&self, notes: &mut impl Notes) {
        notes.note(NoteStage::Candidate, "color", self.color, "linear light");
        notes.note(NoteStage::Candidate, "usable", self.usable, "");
        notes.note(NoteStage::Candidate, "the pixel's own sample", self.is_own, "");
        notes.note(NoteStage::Candidate, "level of detail", self.lod, "log2 px");
        notes.note(NoteStage::Candidate, "smallest of the samples around", self.range[0], "linear light");
        notes.note(NoteStage::Candidate, "largest of the samples around", self.range[1], "linear light");
        let noise = [self.noise.samples, self.noise.variance];
        notes.note(NoteStage::Candidate, "noise", noise, "samples, variance of one");
        notes.note(NoteStage::Light, "gain", self.gain, "");
    }
}

/// A sample around a pixel, the rectification at it, and its comparison with history.
pub(super) fn note_sample(
    notes: &mut impl Notes,
    [x, y]: [u32; 2],
    weight: f32,
    color: Vec3,
    r: Rectification,
    observed: Option<Observation>,
) {
    let values = [x as f32, y as f32, weight, color.x, color.y, color.z];
    notes.note(NoteStage::Candidate, "sample", values, "x y px, weight, linear light");
    let values = [x as f32, y as f32, r.gain.x, r.gain.y, r.gain.z, r.fit, r.center_fit];
    notes.note(NoteStage::Light, "sample", values, "x y px, gain, fit around it, fit of its own");
    if let Some(Observation { history, error, confidence, .. }) = observed {
        let values = [x as f32, y as f32, history.x, history.y, history.z, error, confidence];
        let unit = "x y px, linear light, expected difference (100 from black to white), confidence";
        notes.note(NoteStage::Comparison, "history at sample", values, unit);
    }
}

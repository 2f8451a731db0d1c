//! Candidate of a pixel: the samples around it, and their light.

use super::view::NO_NOISE;
use crate::kernel::antialias::BESIDE_PX2;
use crate::kernel::color::luma;
use crate::kernel::demodulation::AlbedoChange;
use crate::kernel::noise::{Noise, borrowed};
use crate::kernel::resample::codes_between;
use crate::kernel::sparse_smr::{BY_NEIGHBOURS, Lit, OTHER_SURFACE, Observation, SAMPLE_RELATIVE, candidate_level};
use crate::notes::{NoteStage, Notes};
use glam::Vec3;

/// [`codes_between`] of the samples that are interpolated for a pixel with the disparity `disparity`.
#[inline(always)]
pub(super) fn sample_codes(disparity: f32) -> [u32; 2] {
    codes_between(disparity, 1.0 - SAMPLE_RELATIVE, 1.0 / (1.0 - SAMPLE_RELATIVE))
}

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
    pub around: (Vec3, f32),
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
        around: (Vec3::ZERO, 0.0),
    };

    /// The noisy sample of a pixel whose history is a mean of `past` samples, with its share of the mean around it. Its
    /// variance takes its share, too: a pixel whose samples all missed a lamp would call its neighbours' light a
    /// change.
    #[inline(always)]
    pub fn borrowing(self, past: f32) -> Self {
        let (mean, variance) = self.around;
        let share = borrowed(past, Noise { variance, ..self.noise }, luma(mean));
        let variance = self.noise.variance + (variance - self.noise.variance) * share;
        let noise = Noise { variance, ..self.noise };
        Self { color: self.color + (mean - self.color) * share, noise, ..self }
    }

    /// With the texture of the pixel's own albedo.
    #[inline(always)]
    pub fn textured(self, albedo: AlbedoChange) -> Self {
        Self {
            color: self.color * albedo.factor,
            range: self.range.map(|color| color * albedo.factor),
            beside: self.beside.map(|color| color * albedo.factor),
            albedo,
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
        let unit = "x y px, linear light, expected difference (100 from black to white), confidence";
        notes.note(NoteStage::Comparison, "history at sample", values, unit);
    }
}

/// Sums over the samples around a pixel.
pub(super) struct Sums {
    color: Vec3,
    alpha: f32,
    weight: f32,
    gain: Vec3,
    fit: f32,
    valid: f32,
    /// Smallest and largest color.
    range: [Vec3; 2],
    /// Squared distance in pixels of the nearest sample of the pixel's surface.
    pub nearest_px2: f32,
    /// Color of this sample, the first of equally near ones.
    nearest: Vec3,
    /// Color and alpha of the pixel's own sample, and the fit of history there.
    pub own: Option<(Vec3, f32, f32)>,
}

impl Sums {
    pub const NOTHING: Self = Self {
        color: Vec3::ZERO,
        alpha: 0.0,
        weight: 0.0,
        gain: Vec3::ZERO,
        fit: 0.0,
        valid: 0.0,
        range: [Vec3::splat(f32::MAX), Vec3::ZERO],
        nearest_px2: f32::MAX,
        nearest: Vec3::ZERO,
        own: None,
    };

    /// Adds a sample with the weight `share` by its place, and returns its weight. `alike`: whether it shows the
    /// pixel's surface.
    #[inline(always)]
    pub fn add(&mut self, (color, alpha): (Vec3, f32), lit: Lit, share: f32, px2: f32, alike: bool) -> f32 {
        let weight = share * if alike { 1.0 } else { OTHER_SURFACE };
        let known = weight * if lit.is_own { 1.0 } else { BY_NEIGHBOURS };
        self.color += color * weight;
        self.alpha += alpha * weight;
        self.weight += weight;
        self.gain += lit.gain * known;
        self.fit += lit.fit * known;
        self.valid += known;
        self.range = [self.range[0].min(color), self.range[1].max(color)];
        if alike && px2 < self.nearest_px2 {
            (self.nearest_px2, self.nearest) = (px2, color);
        }
        weight
    }

    /// Whether a sample shows the pixel's surface.
    #[inline(always)]
    pub fn has_surface(&self) -> bool {
        self.nearest_px2 < f32::MAX
    }

    /// Candidate of the pixel, without noise, where samples have a distance of 2^`level` pixels.
    #[inline(always)]
    pub fn candidate(self, level: u32) -> Candidate {
        if self.weight == 0.0 {
            return Candidate::NONE;
        }
        let coarsest = level as f32;
        let inverse = 1.0 / self.weight;
        let (color, alpha, own_fit) = self.own.unwrap_or((self.color * inverse, self.alpha * inverse, 1.0));
        Candidate {
            color,
            usable: true,
            lod: match self.nearest_px2 {
                f32::MAX => coarsest + 1.0,
                px2 => candidate_level(px2.sqrt(), coarsest),
            },
            range: self.range,
            gain: self.gain * (1.0 / self.valid),
            fit: (self.fit * (1.0 / self.valid)).min(own_fit),
            noise: NO_NOISE,
            alpha,
            is_own: self.own.is_some(),
            beside: (self.nearest_px2 <= BESIDE_PX2).then_some(self.nearest),
            albedo: AlbedoChange::NONE,
            around: (Vec3::ZERO, 0.0),
        }
    }
}

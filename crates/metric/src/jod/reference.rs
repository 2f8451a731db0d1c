//! Reference frames, prepared once for all tests.

use super::constants::LEAST_NITS;
use super::{CHANNELS, Viewing};
use crate::csf::SensitivityAt;
use crate::pyramid::{Doubler, Levels, Plane, ROWS};
use crate::temporal::{Memory, TemporalFilters};
use afterimage::Image;
use pulp::{Arch, Simd, WithSimd};
use rayon::prelude::*;
use std::sync::Arc;

/// The reference, frame by frame.
#[derive(Clone, Debug)]
pub struct ReferenceVideo {
    viewing: Viewing,
    filters: Arc<TemporalFilters>,
    bands: Vec<[SensitivityAt; CHANNELS]>,
    memory: Memory,
    gaze_px: [f32; 2],
}

/// A reference frame, ready to be compared with any number of tests.
#[derive(Clone, Debug)]
pub struct ReferenceFrame {
    pub(super) viewing: Viewing,
    pub(super) filters: Arc<TemporalFilters>,
    /// Eccentricity of each pixel of the frame in degrees.
    pub(super) ecc_deg: Image<f32>,
    pub(super) bands: Vec<ReferenceBand>,
    /// What the pyramid's bands leave: the coarsest level of both channels.
    pub(super) base: [Plane; CHANNELS],
}

/// A band of a reference frame.
#[derive(Clone, Debug)]
pub(super) struct ReferenceBand {
    /// Contrast in multiples of its threshold.
    pub contrast: [Plane; CHANNELS],
    /// Contrast sensitivity.
    pub sensitivity: [Plane; CHANNELS],
    /// Luminance in cd/m2 to which the eye is adapted.
    pub adapted_nits: Plane,
}

impl ReferenceVideo {
    /// A video that is seen as `viewing` says.
    pub fn new(viewing: Viewing) -> Self {
        let [width, height] = viewing.geometry.size_px().map(|s| s as f32);
        Self {
            filters: Arc::new(TemporalFilters::new(viewing.fps)),
            bands: viewing.bands(),
            memory: Memory::default(),
            gaze_px: [0.5 * width, 0.5 * height],
            viewing,
        }
    }

    /// Takes the next frame, sRGB-encoded, with the gaze in pixels, which may lie outside; `None` where tracking is
    /// lost: the last gaze holds, and the middle before there is one.
    ///
    /// # Panics
    /// If the size is not that of the geometry.
    pub fn push(&mut self, encoded: &Image<[f32; 3]>, gaze_px: Option<[f32; 2]>) -> ReferenceFrame {
        self.gaze_px = gaze_px.filter(|g| g.iter().all(|v| v.is_finite())).unwrap_or(self.gaze_px);
        let ecc_deg = self.viewing.geometry.eccentricity_map(self.gaze_px);
        self.push_at(encoded, ecc_deg)
    }

    /// As [`Self::push`], with the eccentricity of each pixel in degrees.
    ///
    /// # Panics
    /// If a size is not that of the geometry.
    pub fn push_at(&mut self, encoded: &Image<[f32; 3]>, ecc_deg: Image<f32>) -> ReferenceFrame {
        let size = self.viewing.geometry.size_px();
        assert!(encoded.size() == size && ecc_deg.size() == size, "frames have the size of the geometry");
        let channels = self.memory.advance(encoded, self.viewing.display, &self.filters);
        let levels = channels.map(|plane| Levels::new(plane, self.bands.len()));
        let bands = (0..self.bands.len()).map(|level| self.band(&levels, level, &ecc_deg)).collect();
        let base = levels.map(Levels::into_coarsest);
        ReferenceFrame { viewing: self.viewing, filters: self.filters.clone(), ecc_deg, bands, base }
    }

    fn band(&self, levels: &[Levels; CHANNELS], level: usize, ecc_deg: &Image<f32>) -> ReferenceBand {
        let fine = levels.each_ref().map(|l| l.at(level));
        let coarse = levels.each_ref().map(|l| l.at(level + 1));
        let seen = self.sensitivities(coarse[0], level, ecc_deg);
        let [mut c0, mut c1, mut s0, mut s1, mut adapted_nits] = [0; 5].map(|_| fine[0].like());
        let rows = ROWS * fine[0].width;
        (
            c0.values.par_chunks_mut(rows),
            c1.values.par_chunks_mut(rows),
            s0.values.par_chunks_mut(rows),
            s1.values.par_chunks_mut(rows),
            adapted_nits.values.par_chunks_mut(rows),
        )
            .into_par_iter()
            .enumerate()
            .for_each(|(strip, (c0, c1, s0, s1, adapted_nits))| {
                Arch::new().dispatch(Prepare {
                    fine,
                    coarse,
                    seen: &seen,
                    first: strip * ROWS,
                    contrast: [c0, c1],
                    sensitivity: [s0, s1],
                    adapted_nits,
                });
            });
        ReferenceBand { contrast: [c0, c1], sensitivity: [s0, s1], adapted_nits }
    }
}

impl ReferenceVideo {
    /// Sensitivity of both channels in band `level`, at the resolution of the level below it: both luminance, which is
    /// that level, and eccentricity change slowly.
    fn sensitivities(&self, coarse: &Plane, level: usize, ecc_deg: &Image<f32>) -> [Plane; CHANNELS] {
        let [mut s0, mut s1] = [0; 2].map(|_| coarse.like());
        let rows = ROWS * coarse.width;
        (s0.values.par_chunks_mut(rows), s1.values.par_chunks_mut(rows)).into_par_iter().enumerate().for_each(
            |(strip, (s0, s1))| {
                let Self { viewing, bands, .. } = self;
                let (curves, first, level) = (&bands[level], strip * ROWS, level + 1);
                Arch::new().dispatch(Sense { viewing, coarse, curves, level, first, ecc_deg, sensitivity: [s0, s1] });
            },
        );
        [s0, s1]
    }
}

/// Rows of the sensitivity of a band.
struct Sense<'a> {
    viewing: &'a Viewing,
    coarse: &'a Plane,
    curves: &'a [SensitivityAt; CHANNELS],
    level: usize,
    first: usize,
    ecc_deg: &'a Image<f32>,
    sensitivity: [&'a mut [f32]; CHANNELS],
}

impl WithSimd for Sense<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Self { viewing, coarse, curves, level, first, ecc_deg, sensitivity } = self;
        let width = coarse.width;
        let [mut e_deg, mut times] = [0; 2].map(|_| vec![0.0; width]);
        let [s0, s1] = sensitivity;
        for (i, (s0, s1)) in s0.chunks_exact_mut(width).zip(s1.chunks_exact_mut(width)).enumerate() {
            let y = first + i;
            ecc_row(ecc_deg, level, y, &mut e_deg);
            for (x, times) in times.iter_mut().enumerate() {
                *times = viewing.pixels_per_degree_times([x, y].map(|v| ((v << level) as f32) + 0.5));
            }
            for (c, sensitivity) in [s0, s1].into_iter().enumerate() {
                let of = sensitivity.iter_mut().zip(coarse.row(y)).zip(e_deg.iter().zip(&times));
                for ((sensitivity, &nits), (&e_deg, &times)) in of {
                    *sensitivity = curves[c].sensitivity(nits.max(LEAST_NITS), e_deg, times);
                }
            }
        }
    }
}

/// Eccentricity at pixel (`x`, `y`) of a level of the pyramid, from that of the frame's pixels.
#[inline(always)]
pub(super) fn ecc_row(ecc_deg: &Image<f32>, level: usize, y: usize, out: &mut [f32]) {
    let row = ecc_deg.row((y << level).min(ecc_deg.height() - 1));
    for (x, e) in out.iter_mut().enumerate() {
        *e = row[(x << level).min(row.len() - 1)];
    }
}

/// Rows of a band of the reference.
struct Prepare<'a> {
    fine: [&'a Plane; CHANNELS],
    coarse: [&'a Plane; CHANNELS],
    /// Sensitivity at half the size.
    seen: &'a [Plane; CHANNELS],
    first: usize,
    contrast: [&'a mut [f32]; CHANNELS],
    sensitivity: [&'a mut [f32]; CHANNELS],
    adapted_nits: &'a mut [f32],
}

impl WithSimd for Prepare<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Self { fine, coarse, seen, first, contrast, sensitivity, adapted_nits } = self;
        let width = fine[0].width;
        let mut low = vec![0.0; width];
        let mut doubler = Doubler::new(coarse[0].width);
        for (i, nits) in adapted_nits.chunks_exact_mut(width).enumerate() {
            doubler.row(coarse[0], first + i, nits);
            nits.iter_mut().for_each(|v| *v = v.max(LEAST_NITS));
        }
        for (c, (contrast, sensitivity)) in contrast.into_iter().zip(sensitivity).enumerate() {
            let rows = contrast.chunks_exact_mut(width).zip(sensitivity.chunks_exact_mut(width));
            for (i, ((contrast, sensitivity), nits)) in rows.zip(adapted_nits.chunks_exact(width)).enumerate() {
                let y = first + i;
                doubler.row(coarse[c], y, &mut low);
                doubler.row(&seen[c], y, sensitivity);
                let fine = fine[c].row(y);
                for x in 0..width {
                    // Contrast is relative to the luminance of the surroundings. Operations have the
                    // order of those in `compare`, so that equal frames have equal bits.
                    contrast[x] = sensitivity[x] * (fine[x] - low[x]) * (1.0 / nits[x]);
                }
            }
        }
    }
}

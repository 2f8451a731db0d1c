//! Test frames against reference frames: contrast difference, masking, and sums by band and eccentricity.

use super::constants::{ADAPTATION_SHARE, LEAST_NITS, MASK_GAIN, MOST};
use super::pool::{self, FrameSums, VideoScore};
use super::reference::{ReferenceBand, ecc_row};
use super::{CHANNELS, ReferenceFrame, Viewing};
use crate::band::Band;
use crate::pyramid::{Doubler, Levels, Plane, ROWS};
use crate::temporal::Memory;
use afterimage::Image;
use pulp::{Arch, Simd, WithSimd};
use rayon::prelude::*;

/// The frames of one test, compared with a reference.
#[derive(Clone, Debug, Default)]
pub struct TestVideo {
    memory: Memory,
    frames: Vec<FrameSums>,
    last: Option<LastFrame>,
}

/// Masked differences of the last frame.
#[derive(Clone, Debug)]
struct LastFrame {
    viewing: Viewing,
    bands: Vec<[Plane; CHANNELS]>,
}

impl TestVideo {
    /// Compares the next frame, sRGB-encoded, with the reference of the same time, and returns the frame's own score:
    /// that of a video in which every frame differs as much.
    ///
    /// # Panics
    /// If the sizes differ.
    pub fn push(&mut self, reference: &ReferenceFrame, encoded: &Image<[f32; 3]>) -> VideoScore {
        let ReferenceFrame { viewing, filters, ecc_deg, bands, base } = reference;
        assert_eq!(encoded.size(), viewing.geometry.size_px(), "test and reference have one size");
        let channels = self.memory.advance(encoded, viewing.display, filters);
        let levels = channels.map(|plane| Levels::new(plane, bands.len()));
        let mut sums = FrameSums::default();
        let mut differences = Vec::with_capacity(bands.len());
        for (level, band) in bands.iter().enumerate() {
            let (planes, means) = compare(band, &levels, level, ecc_deg);
            sums.bands.push(means);
            differences.push(planes);
        }
        sums.base = base_difference(base, &levels.map(Levels::into_coarsest), bands.len(), ecc_deg);
        let score = pool::frame_score(&sums);
        self.frames.push(sums);
        self.last = Some(LastFrame { viewing: *viewing, bands: differences });
        score
    }

    /// Forgets the scores of the frames so far, but not the state of the temporal filters: the next frame continues the
    /// video.
    pub fn restart(&mut self) {
        self.frames.clear();
    }

    /// Score of the frames so far; `None` before the first.
    pub fn score(&self) -> Option<VideoScore> {
        pool::video_score(&self.frames)
    }

    /// Where the last frame differs: JOD that would be lost if all of the frame differed as much as it does there.
    /// `None` before the first frame.
    pub fn heat_map(&self) -> Option<Image<f32>> {
        let LastFrame { viewing, bands } = self.last.as_ref()?;
        let mut sums: Option<Plane> = None;
        for band in bands.iter().rev() {
            let mut here = band[0].like();
            if let Some(coarse) = sums {
                let mut doubler = Doubler::new(coarse.width);
                let width = here.width;
                for (y, row) in here.values.chunks_exact_mut(width).enumerate() {
                    doubler.row(&coarse, y, row);
                }
            }
            for (i, sum) in here.values.iter_mut().enumerate() {
                *sum += pool::local(band.each_ref().map(|plane| plane.values[i]));
            }
            sums = Some(here);
        }
        let losses = sums?.values.into_iter().map(pool::local_loss).collect();
        Image::from_pixels(viewing.geometry.size_px(), losses).ok()
    }
}

/// Masked differences of a band, and their means by eccentricity.
fn compare(
    band: &ReferenceBand,
    levels: &[Levels; CHANNELS],
    level: usize,
    ecc_deg: &Image<f32>,
) -> ([Plane; CHANNELS], [[pool::Mean; 3]; CHANNELS]) {
    let fine = levels.each_ref().map(|l| l.at(level));
    let coarse = levels.each_ref().map(|l| l.at(level + 1));
    let [mut d0, mut d1] = [0; 2].map(|_| fine[0].like());
    let rows = ROWS * fine[0].width;
    let strips: Vec<[[pool::Mean; 3]; CHANNELS]> = (d0.values.par_chunks_mut(rows), d1.values.par_chunks_mut(rows))
        .into_par_iter()
        .enumerate()
        .map(|(strip, (d0, d1))| {
            let first = strip * ROWS;
            Arch::new().dispatch(Compare { band, fine, coarse, level, first, ecc_deg, difference: [d0, d1] })
        })
        .collect();
    // In the order of the strips, so that sums do not depend on the number of threads.
    let mut means = [[pool::Mean::default(); 3]; CHANNELS];
    for strip in &strips {
        for (mean, part) in means.as_flattened_mut().iter_mut().zip(strip.as_flattened()) {
            mean.merge(*part);
        }
    }
    ([d0, d1], means)
}

/// Rows of a band to compare.
struct Compare<'a> {
    band: &'a ReferenceBand,
    fine: [&'a Plane; CHANNELS],
    coarse: [&'a Plane; CHANNELS],
    level: usize,
    first: usize,
    ecc_deg: &'a Image<f32>,
    difference: [&'a mut [f32]; CHANNELS],
}

impl WithSimd for Compare<'_> {
    type Output = [[pool::Mean; 3]; CHANNELS];

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> Self::Output {
        let Self { band, fine, coarse, level, first, ecc_deg, difference } = self;
        let width = fine[0].width;
        let [mut low, mut per_nit, mut e_deg] = [0; 3].map(|_| vec![0.0; width]);
        let mut doubler = Doubler::new(coarse[0].width);
        let mut means = [[pool::Mean::default(); 3]; CHANNELS];
        let [d0, d1] = difference;
        for (i, (d0, d1)) in d0.chunks_exact_mut(width).zip(d1.chunks_exact_mut(width)).enumerate() {
            let y = first + i;
            ecc_row(ecc_deg, level, y, &mut e_deg);
            for (c, difference) in [d0, d1].into_iter().enumerate() {
                doubler.row(coarse[c], y, &mut low);
                if c == 0 {
                    for (per_nit, (own, nits)) in per_nit.iter_mut().zip(low.iter().zip(band.adapted_nits.row(y))) {
                        *per_nit = 1.0 / (nits + ADAPTATION_SHARE * (own.max(LEAST_NITS) - nits));
                    }
                }
                let (fine, sensitivity, contrast) =
                    (fine[c].row(y), band.sensitivity[c].row(y), band.contrast[c].row(y));
                for x in 0..width {
                    let test = sensitivity[x] * (fine[x] - low[x]) * per_nit[x];
                    difference[x] = masked(test, contrast[x], c);
                }
                add_by_band(&mut means[c], difference, &e_deg);
            }
        }
        means
    }
}

/// Visible difference of two contrasts in multiples of their threshold, to the power p.
#[inline(always)]
fn masked(test: f32, reference: f32, channel: usize) -> f32 {
    // Mutual masking: only what both videos show can hide the difference.
    let mask = MASK_GAIN[channel] * test.abs().min(reference.abs());
    let [difference, squared_mask] = [(test - reference) * (test - reference), mask * mask];
    // The exponents 4 of the difference and 4.5 of the mask need no more than products and a root.
    let seen = difference * difference / (1.0 + squared_mask * squared_mask * mask.sqrt());
    seen / (1.0 + seen * (1.0 / MOST[channel]))
}

/// Adds the values of a row by band of eccentricity.
#[inline(always)]
fn add_by_band(means: &mut [pool::Mean; 3], values: &[f32], e_deg: &[f32]) {
    let mut rest = values;
    for run in e_deg.chunk_by(|a, b| Band::of(*a) == Band::of(*b)) {
        let (of_run, after) = rest.split_at(run.len());
        means[Band::of(run[0]) as usize].add_all(of_run);
        rest = after;
    }
}

/// Mean squared Weber contrast between the coarsest levels, by eccentricity.
fn base_difference(
    reference: &[Plane; CHANNELS],
    test: &[Plane; CHANNELS],
    level: usize,
    ecc_deg: &Image<f32>,
) -> [[pool::Mean; 3]; CHANNELS] {
    let width = reference[0].width;
    let mut e_deg = vec![0.0; width];
    let mut means = [[pool::Mean::default(); 3]; CHANNELS];
    for y in 0..reference[0].height {
        ecc_row(ecc_deg, level, y, &mut e_deg);
        let nits: Vec<f32> = reference[0].row(y).iter().zip(test[0].row(y)).map(|(r, t)| r.max(*t)).collect();
        for (c, means) in means.iter_mut().enumerate() {
            let pairs = reference[c].row(y).iter().zip(test[c].row(y)).zip(&nits);
            let squared: Vec<f32> = pairs
                .map(|((r, t), nits)| {
                    let weber = (t - r) / nits.max(LEAST_NITS);
                    weber * weber
                })
                .collect();
            add_by_band(means, &squared, &e_deg);
        }
    }
    means
}

//! Quads of a view that are shaded, and the shaded quads around each quad. Mathematics: `src/kernel/quads.rs`.

use crate::foveation::Foveation;
use crate::frame::Exposure;
use crate::image::Image;
use crate::kernel::candidate::distance_weight;
use crate::kernel::quads::{
    NOWHERE, REACH, RUN_QUADS, WHOLE, first_of, last_of, nearest_px, neighbour_offset, octant_offsets, place_in_quad,
    quadrant_of, sample_code, sample_offset, window,
};
use crate::kernel::sanitize;
use crate::parallel::collect;
use glam::Vec3;

/// Squared distance of two pixels along an axis.
#[inline(always)]
pub(super) fn offset_px2(a: u32, b: u32) -> f32 {
    let offset = a as f32 - b as f32;
    offset * offset
}

#[derive(Clone, Debug)]
pub(super) struct Quads {
    size_px: [u32; 2],
    /// Mask of each quad: the pixels that are shaded.
    masks: Image<u32>,
    /// Region of each quad.
    regions: Image<u32>,
    /// log2 of the distance of the pattern's quads in pixels, by region.
    levels: [u32; 3],
    /// Codes of neighbours: of the nearest shaded quad in each octant, for shaded quads; otherwise in each quadrant.
    around: Vec<[u32; 2]>,
}

impl Quads {
    /// `levels`: log2 of the distance of samples in pixels, by region.
    pub fn new(size_px: [u32; 2], masks: Image<u32>, regions: Image<u32>, levels: [u32; 3]) -> Self {
        let runs = runs(&masks);
        let [columns, rows] = masks.size();
        let around = collect(columns * rows, |i| {
            let at = [i % columns, i / columns];
            if masks.at(at[0] as usize, at[1] as usize) != 0 { octants(&runs, at) } else { quadrants(&runs, at) }
        });
        Self { size_px, masks, regions, levels, around }
    }

    /// Levels of the regions of a frame with this foveation. Noisy samples are compared with history in the fovea, too.
    pub fn levels(foveation: &Foveation, is_noisy: bool) -> [u32; 3] {
        [u32::from(is_noisy), foveation.rate_mid.ilog2(), foveation.rate_far.ilog2()]
    }

    pub fn pixels(&self) -> Image<bool> {
        Image::from_fn(self.size_px, |[x, y]| self.is_shaded([x, y]))
    }

    #[inline(always)]
    pub fn is_shaded(&self, [x, y]: [u32; 2]) -> bool {
        self.mask([x / 2, y / 2]) >> place_in_quad([x, y]) & 1 == 1
    }

    /// Shaded pixels of a quad.
    #[inline(always)]
    pub fn mask(&self, [x, y]: [u32; 2]) -> u32 {
        self.masks.at(x as usize, y as usize)
    }

    /// log2 of the distance of the pattern's quads in pixels, where a pixel lies; 0 in the fovea.
    #[inline(always)]
    pub fn level_at(&self, [x, y]: [u32; 2]) -> u32 {
        self.levels[self.regions.at(x as usize / 2, y as usize / 2) as usize]
    }

    /// Number of quads along x and y.
    pub fn size(&self) -> [u32; 2] {
        self.masks.size()
    }

    #[inline(always)]
    pub fn index([x, y]: [u32; 2], columns: u32) -> usize {
        (y * columns + x) as usize
    }

    /// Nearest shaded quads around a quad, by sector; at most eight for shaded quads, four for others.
    #[inline(always)]
    pub fn around(&self, quad: [u32; 2]) -> impl Iterator<Item = [u32; 2]> + use<> {
        let words = self.around[Self::index(quad, self.masks.size()[0])];
        (0..8).filter_map(move |i| {
            let code = words[i >> 2] >> (8 * (i & 3)) & 255;
            let [x, y] = neighbour_offset(code);
            (code != NOWHERE).then(|| [quad[0].wrapping_add_signed(x), quad[1].wrapping_add_signed(y)])
        })
    }
}

impl Quads {
    /// Samples that stand for a pixel. In a quad with all of its samples these are its pixels; in a quad without any,
    /// the nearest sample of each quad around it; otherwise the pixel's own sample, and the nearest other one of each
    /// quadrant.
    #[inline(always)]
    pub fn samples_around(&self, px: [u32; 2]) -> impl Iterator<Item = [u32; 2]> + use<> {
        let quad = px.map(|v| v / 2);
        let mask = self.mask(quad);
        let mut found = [[u32::MAX; 2]; 5];
        if mask == WHOLE {
            for (place, at) in (0..).zip(&mut found[..4]) {
                let px_of_quad = [2 * quad[0] + (place & 1), 2 * quad[1] + (place >> 1)];
                *at = if (0..2).all(|i| px_of_quad[i] < self.size_px[i]) { px_of_quad } else { *at };
            }
        } else if mask == 0 {
            self.around(quad).zip(&mut found).for_each(|(other, at)| *at = self.nearest_of(other, px));
        } else {
            let codes = self.codes_around(px, quad, mask);
            for (at, code) in found.iter_mut().zip(codes).filter(|(_, code)| *code != u32::MAX) {
                let [x, y] = sample_offset(code);
                *at = [px[0].wrapping_add_signed(x), px[1].wrapping_add_signed(y)];
            }
        }
        found.into_iter().filter(|at| at[0] != u32::MAX)
    }

    /// Samples that stand for a noisy pixel, of which more are better: those of its quad, and the nearest one of each
    /// quad around it.
    #[inline(always)]
    pub fn all_samples_around(&self, px: [u32; 2]) -> impl Iterator<Item = [u32; 2]> {
        let quad = px.map(|v| v / 2);
        let mask = self.mask(quad);
        let own = (0..4).filter(move |place| mask >> place & 1 == 1);
        let own = own.map(move |place| [2 * quad[0] + (place & 1), 2 * quad[1] + (place >> 1)]);
        let own = own.filter(|at| (0..2).all(|i| at[i] < self.size_px[i]));
        own.chain(self.around(quad).map(move |other| self.nearest_of(other, px)))
    }

    /// The sample nearest to a pixel, the first of equally near ones; `None` without any around it.
    #[inline(always)]
    pub fn nearest_sample(&self, px: [u32; 2]) -> Option<[u32; 2]> {
        if self.is_shaded(px) {
            return Some(px);
        }
        let px2 = |at: &[u32; 2]| offset_px2(at[0], px[0]) + offset_px2(at[1], px[1]);
        self.samples_around(px).min_by(|a, b| px2(a).total_cmp(&px2(b)))
    }

    /// Codes of the nearest sample of each quadrant around a pixel, and of its own sample, in a quad with some samples.
    #[inline(always)]
    fn codes_around(&self, px: [u32; 2], quad: [u32; 2], mask: u32) -> [u32; 5] {
        let mut codes = [u32::MAX; 5];
        let of_quad = (0..4).filter(|place| mask >> place & 1 == 1);
        let of_quad = of_quad.map(|place| [2 * quad[0] + (place & 1), 2 * quad[1] + (place >> 1)]);
        for at in of_quad.chain(self.around(quad).map(|other| self.nearest_of(other, px))) {
            let [x, y] = [0, 1].map(|i| at[i].wrapping_sub(px[i]) as i32);
            let code = &mut codes[if at == px { 4 } else { quadrant_of(x, y) as usize }];
            *code = (*code).min(sample_code(x, y));
        }
        codes
    }

    /// The shaded pixel of a quad that is nearest to a pixel.
    #[inline(always)]
    fn nearest_of(&self, quad: [u32; 2], px: [u32; 2]) -> [u32; 2] {
        match self.mask(quad) {
            WHOLE => [0, 1].map(|i| px[i].clamp(2 * quad[i], 2 * quad[i] + 1).min(self.size_px[i] - 1)),
            mask => nearest_px(mask, quad, px),
        }
    }

    /// Color of a pixel: its own if it is shaded, otherwise a mean of the shaded quads around it by the inverse squared
    /// distance, in the unit of the color input.
    pub fn filled(&self, [color, half]: [Option<&Image<[f32; 3]>>; 2], px: [u32; 2], exposure: Exposure) -> [f32; 3] {
        let given_at = |px: [u32; 2]| {
            let [x, y] = px.map(|v| v as usize);
            let half = half.filter(|_| self.mask(px.map(|v| v / 2)) != WHOLE).map(|half| half.at(x / 2, y / 2));
            half.or(color.map(|color| color.at(x, y))).unwrap_or([f32::NAN; 3])
        };
        if self.is_shaded(px) {
            return given_at(px);
        }
        let (mut sum, mut weight) = (Vec3::ZERO, 0.0);
        for [x, y] in self.samples_around(px) {
            let given = Vec3::from(given_at([x, y]));
            let (color, usable) = sanitize::color(given * exposure.of_colors());
            if usable {
                let w = distance_weight(offset_px2(x, px[0]) + offset_px2(y, px[1]));
                sum += color * w;
                weight += w;
            }
        }
        if weight == 0.0 {
            return [f32::NAN; 3];
        }
        ((sum * (1.0 / weight)) * (1.0 / exposure.of_colors())).to_array()
    }
}

/// Shaded quads of each run and beside it, as bits.
fn runs(masks: &Image<u32>) -> Image<u32> {
    let [columns, rows] = masks.size();
    Image::from_fn_parallel([columns.div_ceil(RUN_QUADS), rows], |[run, y]| {
        (0..2 * RUN_QUADS).fold(0, |word, i| {
            let x = (run * RUN_QUADS + i).wrapping_sub(REACH as u32);
            word | u32::from(x < columns && masks.at(x as usize, y as usize) != 0) << i
        })
    })
}

/// The shaded quads within reach of a quad in the row that is `y` below.
fn window_at(runs: &Image<u32>, at: [u32; 2], y: i32) -> u32 {
    let row = at[1].wrapping_add_signed(y);
    if y >= REACH || row >= runs.size()[1] {
        return 0;
    }
    window(runs.at((at[0] / RUN_QUADS) as usize, row as usize), at[0])
}

/// Whether rows that are `rows` away may have nearer quads than the best ones, given by their codes.
fn may_improve(best: &[u32], rows: i32) -> bool {
    best.iter().any(|code| (rows * rows) as u32 <= code >> 8)
}

/// Codes of the nearest shaded quads around a quad, by quadrant. The half-axis that begins a quadrant belongs to it.
fn quadrants(runs: &Image<u32>, at: [u32; 2]) -> [u32; 2] {
    let own = window_at(runs, at, 0);
    let mut best = [first_of(own, 1, 7, 0), u32::MAX, last_of(own, -8, -1, 0), u32::MAX];
    for rows in 1..=REACH {
        if !may_improve(&best, rows) {
            break;
        }
        let [below, above] = [rows, -rows].map(|y| window_at(runs, at, y));
        let found = [
            first_of(below, 1, 7, rows),
            last_of(below, -8, 0, rows),
            last_of(above, -8, -1, -rows),
            first_of(above, 0, 7, -rows),
        ];
        best = [0, 1, 2, 3].map(|i| best[i].min(found[i]));
    }
    [codes(best), codes([u32::MAX; 4])]
}

/// Codes of the nearest shaded quads around a quad, by octant.
fn octants(runs: &Image<u32>, at: [u32; 2]) -> [u32; 2] {
    let own = window_at(runs, at, 0);
    let mut best = [u32::MAX; 8];
    (best[0], best[4]) = (first_of(own, 1, 7, 0), last_of(own, -8, -1, 0));
    for rows in 1..=REACH {
        if !may_improve(&best, rows) {
            break;
        }
        let [vertical, horizontal] = octant_offsets(rows);
        for (y, [right, middle, left]) in [(rows, [1, 2, 3]), (-rows, [7, 6, 5])] {
            let row = window_at(runs, at, y);
            let mut found = |octant: usize, code: u32| best[octant] = best[octant].min(code);
            found(0, first_of(row, horizontal, 7, y));
            found(right, first_of(row, vertical + 1, (horizontal - 1).min(7), y));
            found(middle, first_of(row, 0, vertical, y).min(last_of(row, -vertical, 0, y)));
            found(left, last_of(row, (1 - horizontal).max(-8), -vertical - 1, y));
            found(4, last_of(row, -8, -horizontal, y));
        }
    }
    [codes([best[0], best[1], best[2], best[3]]), codes([best[4], best[5], best[6], best[7]])]
}

/// A word of the codes of four neighbours.
fn codes(best: [u32; 4]) -> u32 {
    let code = |code: u32| if code == u32::MAX { NOWHERE } else { code & 255 };
    (0..4).fold(0, |word, i| word | code(best[i]) << (8 * i))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kernel::quads::neighbour;
    use crate::kernel::rng::bits;

    /// Codes of the nearest shaded quads by sector, from all quads within reach.
    fn search(masks: &Image<u32>, at: [u32; 2], sector: impl Fn(i32, i32) -> usize) -> [u32; 2] {
        let mut best = [u32::MAX; 8];
        for (x, y) in (-REACH..REACH).flat_map(|y| (-REACH..REACH).map(move |x| (x, y))).filter(|o| *o != (0, 0)) {
            let [u, v] = [at[0].wrapping_add_signed(x), at[1].wrapping_add_signed(y)];
            if u < masks.size()[0] && v < masks.size()[1] && masks.at(u as usize, v as usize) != 0 {
                let of_sector = &mut best[sector(x, y)];
                *of_sector = (*of_sector).min(neighbour(x, y));
            }
        }
        [codes([best[0], best[1], best[2], best[3]]), codes([best[4], best[5], best[6], best[7]])]
    }

    fn quadrant(x: i32, y: i32) -> usize {
        match (x, y) {
            (1.., 0..) => 0,
            (..=0, 1..) => 1,
            (..0, ..=0) => 2,
            _ => 3,
        }
    }

    fn octant(x: i32, y: i32) -> usize {
        let angle = f64::from(y).atan2(f64::from(x)) / std::f64::consts::FRAC_PI_4;
        (angle.round() as i32).rem_euclid(8) as usize
    }

    /// Rows are searched from the nearest on; all quads within reach say what must be found.
    #[test]
    fn the_nearest_quads_of_each_sector_are_found() {
        for (seed, every) in [1, 2, 5, 17, 60, 400].into_iter().enumerate() {
            let size = [53, 38];
            let masks = Image::from_fn(size, |[x, y]| u32::from(bits(x, y, seed as u32, 9).is_multiple_of(every)));
            let runs = runs(&masks);
            for at in (0..size[1]).flat_map(|y| (0..size[0]).map(move |x| [x, y])) {
                assert_eq!(quadrants(&runs, at), search(&masks, at, quadrant), "1 in {every}, {at:?}");
                assert_eq!(octants(&runs, at), search(&masks, at, octant), "1 in {every}, {at:?}");
            }
        }
    }
}

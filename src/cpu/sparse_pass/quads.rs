//! Quads of a view that are shaded, and the shaded quads around each quad. Mathematics: `src/kernel/quads.rs`.

use crate::foveation::Foveation;
use crate::frame::Exposure;
use crate::image::Image;
use crate::kernel::quads::{NOWHERE, REACH, RUN_QUADS, first_of, last_of, neighbour_offset, octant_offsets, window};
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
pub(in crate::cpu) struct Quads {
    size_px: [u32; 2],
    shaded: Image<bool>,
    /// Region of each quad.
    regions: Image<u32>,
    /// log2 of the distance of the pattern's quads in pixels, by region.
    levels: [u32; 3],
    /// Codes of neighbours: of the nearest shaded quad in each octant, for shaded quads; otherwise in each quadrant.
    around: Vec<[u32; 2]>,
}

impl Quads {
    pub fn new(foveation: &Foveation, size_px: [u32; 2], shaded: Image<bool>, regions: Image<u32>) -> Self {
        let runs = runs(&shaded);
        let [columns, rows] = shaded.size();
        let around = collect(columns * rows, |i| {
            let at = [i % columns, i / columns];
            if shaded.at(at[0] as usize, at[1] as usize) { octants(&runs, at) } else { quadrants(&runs, at) }
        });
        let levels = [0, foveation.rate_mid.ilog2(), foveation.rate_far.ilog2()];
        Self { size_px, shaded, regions, levels, around }
    }

    pub fn pixels(&self) -> Image<bool> {
        Image::from_fn(self.size_px, |[x, y]| self.is_shaded([x, y]))
    }

    #[inline(always)]
    pub fn is_shaded(&self, [x, y]: [u32; 2]) -> bool {
        self.shaded.at(x as usize / 2, y as usize / 2)
    }

    /// log2 of the distance of the pattern's quads in pixels, where a pixel lies; 0 in the fovea.
    #[inline(always)]
    pub fn level_at(&self, [x, y]: [u32; 2]) -> u32 {
        self.levels[self.regions.at(x as usize / 2, y as usize / 2) as usize]
    }

    /// Number of quads along x and y.
    pub fn size(&self) -> [u32; 2] {
        self.shaded.size()
    }

    #[inline(always)]
    pub fn index([x, y]: [u32; 2], columns: u32) -> usize {
        (y * columns + x) as usize
    }

    /// Nearest shaded quads around a quad, by sector; at most eight for shaded quads, four for others.
    #[inline(always)]
    pub fn around(&self, quad: [u32; 2]) -> impl Iterator<Item = [u32; 2]> + use<> {
        let words = self.around[Self::index(quad, self.shaded.size()[0])];
        (0..8).filter_map(move |i| {
            let code = words[i >> 2] >> (8 * (i & 3)) & 255;
            let [x, y] = neighbour_offset(code);
            (code != NOWHERE).then(|| [quad[0].wrapping_add_signed(x), quad[1].wrapping_add_signed(y)])
        })
    }
}

impl Quads {
    /// Color of a pixel: its own if it is shaded, otherwise a mean of the shaded quads around it by the inverse squared
    /// distance, in the unit of the color input.
    pub fn filled(&self, color: &Image<[f32; 3]>, px: [u32; 2], exposure: Exposure) -> [f32; 3] {
        if self.is_shaded(px) {
            return color.at(px[0] as usize, px[1] as usize);
        }
        let (mut sum, mut weight) = (Vec3::ZERO, 0.0);
        for quad in self.around(px.map(|v| v / 2)) {
            let [x, y] = nearest_px(quad, px, self.size_px);
            let given = Vec3::from(color.at(x as usize, y as usize));
            let (color, usable) = sanitize::color(given * exposure.of_colors());
            if usable {
                let w = 1.0 / (offset_px2(x, px[0]) + offset_px2(y, px[1]));
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

/// Pixel of a quad that is nearest to another pixel.
#[inline(always)]
pub(super) fn nearest_px(quad: [u32; 2], px: [u32; 2], size_px: [u32; 2]) -> [u32; 2] {
    [0, 1].map(|i| px[i].clamp(2 * quad[i], 2 * quad[i] + 1).min(size_px[i] - 1))
}

/// Shaded quads of each run and beside it, as bits.
fn runs(shaded: &Image<bool>) -> Image<u32> {
    let [columns, rows] = shaded.size();
    Image::from_fn_parallel([columns.div_ceil(RUN_QUADS), rows], |[run, y]| {
        (0..2 * RUN_QUADS).fold(0, |word, i| {
            let x = (run * RUN_QUADS + i).wrapping_sub(REACH as u32);
            word | u32::from(x < columns && shaded.at(x as usize, y as usize)) << i
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
    fn search(shaded: &Image<bool>, at: [u32; 2], sector: impl Fn(i32, i32) -> usize) -> [u32; 2] {
        let mut best = [u32::MAX; 8];
        for (x, y) in (-REACH..REACH).flat_map(|y| (-REACH..REACH).map(move |x| (x, y))).filter(|o| *o != (0, 0)) {
            let [u, v] = [at[0].wrapping_add_signed(x), at[1].wrapping_add_signed(y)];
            if u < shaded.size()[0] && v < shaded.size()[1] && shaded.at(u as usize, v as usize) {
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
            let shaded = Image::from_fn(size, |[x, y]| bits(x, y, seed as u32, 9).is_multiple_of(every));
            let runs = runs(&shaded);
            for at in (0..size[1]).flat_map(|y| (0..size[0]).map(move |x| [x, y])) {
                assert_eq!(quadrants(&runs, at), search(&shaded, at, quadrant), "1 in {every}, {at:?}");
                assert_eq!(octants(&runs, at), search(&shaded, at, octant), "1 in {every}, {at:?}");
            }
        }
    }
}

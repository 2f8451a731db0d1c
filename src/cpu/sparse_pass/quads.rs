//! Quads of a view that are shaded, and the shaded quads around each quad. Mathematics: `src/kernel/quads.rs`.

use crate::foveation::Foveation;
use crate::image::Image;
use crate::kernel::quads::{BLOCK, NOWHERE, neighbour, neighbour_offset, octant, quadrant};
use crate::kernel::sanitize;
use crate::parallel::collect;
use glam::Vec3;

/// Squared distance of two pixels along an axis.
#[inline(always)]
pub(super) fn offset_px2(a: u32, b: u32) -> f32 {
    let offset = a as f32 - b as f32;
    offset * offset
}

/// Quads of a view.
#[derive(Clone, Debug)]
pub(in crate::cpu) struct Quads {
    /// Width and height in pixels.
    size_px: [u32; 2],
    /// Whether each quad is shaded.
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
        let blocks = blocks(&shaded);
        let [columns, rows] = shaded.size();
        let around = collect(columns * rows, |i| {
            let at = [i % columns, i / columns];
            if shaded.at(at[0] as usize, at[1] as usize) {
                search(&blocks, at, octant)
            } else {
                search(&blocks, at, quadrant)
            }
        });
        let levels = [0, foveation.rate_mid.ilog2(), foveation.rate_far.ilog2()];
        Self { size_px, shaded, regions, levels, around }
    }

    /// Whether each pixel is shaded.
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
    /// distance.
    pub fn filled(&self, color: &Image<[f32; 3]>, px: [u32; 2]) -> [f32; 3] {
        if self.is_shaded(px) {
            return color.at(px[0] as usize, px[1] as usize);
        }
        let (mut sum, mut weight) = (Vec3::ZERO, 0.0);
        for quad in self.around(px.map(|v| v / 2)) {
            let [x, y] = nearest_px(quad, px, self.size_px);
            let (color, usable) = sanitize::color(Vec3::from(color.at(x as usize, y as usize)));
            if usable {
                let w = 1.0 / (offset_px2(x, px[0]) + offset_px2(y, px[1]));
                sum += color * w;
                weight += w;
            }
        }
        if weight == 0.0 { [f32::NAN; 3] } else { (sum * (1.0 / weight)).to_array() }
    }
}

/// Pixel of a quad that is nearest to another pixel.
#[inline(always)]
pub(super) fn nearest_px(quad: [u32; 2], px: [u32; 2], size_px: [u32; 2]) -> [u32; 2] {
    [0, 1].map(|i| px[i].clamp(2 * quad[i], 2 * quad[i] + 1).min(size_px[i] - 1))
}

/// Shaded quads of each block, as bits.
fn blocks(shaded: &Image<bool>) -> Image<u32> {
    let [columns, rows] = shaded.size();
    Image::from_fn_parallel([columns.div_ceil(BLOCK), rows.div_ceil(BLOCK)], |[x, y]| {
        (0..BLOCK * BLOCK).fold(0, |word, i| {
            let at = [x * BLOCK + i % BLOCK, y * BLOCK + i / BLOCK];
            let is_shaded = at[0] < columns && at[1] < rows && shaded.at(at[0] as usize, at[1] as usize);
            word | u32::from(is_shaded) << i
        })
    })
}

/// Codes of the nearest shaded quads around a quad, by sector.
fn search(blocks: &Image<u32>, at: [u32; 2], sector: impl Fn(i32, i32) -> u32) -> [u32; 2] {
    let [columns, rows] = blocks.size();
    let mut best = [u32::MAX; 8];
    for tap in 0..25 {
        let [x, y] = [(at[0] / BLOCK + tap % 5).wrapping_sub(2), (at[1] / BLOCK + tap / 5).wrapping_sub(2)];
        if x >= columns || y >= rows {
            continue;
        }
        let mut left = blocks.at(x as usize, y as usize);
        while left != 0 {
            let bit = left.trailing_zeros();
            left &= left - 1;
            let offset =
                [(x * BLOCK + bit % BLOCK) as i32 - at[0] as i32, (y * BLOCK + bit / BLOCK) as i32 - at[1] as i32];
            if offset != [0, 0] {
                let of_sector = &mut best[sector(offset[0], offset[1]) as usize];
                *of_sector = (*of_sector).min(neighbour(offset[0], offset[1]));
            }
        }
    }
    let code = |i: usize| if best[i] == u32::MAX { NOWHERE } else { best[i] & 255 };
    [0, 4].map(|first| (0..4).fold(0, |word, i| word | code(first + i) << (8 * i)))
}

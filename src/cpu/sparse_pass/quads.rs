//! Quads of a view that are shaded: the plan of a frame, and the shaded quads around each quad. Mathematics:
//! `src/kernel/quads.rs`.

use super::pixel::offset_px2;
use super::view::View;
use crate::foveation::Foveation;
use crate::image::Image;
use crate::kernel::antialias::mean_of;
use crate::kernel::kept::{code_word, is_empty, unpack_full};
use crate::kernel::matched::root_difference;
use crate::kernel::quads::{
    BLOCK, IN_FOVEA, IN_MIDDLE, KEYS, NOWHERE, acuity, asked_px, budget_quads, in_pattern, in_turn, need, neighbour,
    neighbour_offset, octant, quad_key, quadrant, region, share_in_block, threshold,
};
use crate::kernel::reproject::nearest;
use crate::kernel::resample::{has_code, tap_codes};
use crate::kernel::sanitize;
use crate::parallel::collect;
use glam::Vec3;

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
    fn new(foveation: &Foveation, size_px: [u32; 2], shaded: Image<bool>, regions: Image<u32>) -> Self {
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

impl View<'_> {
    /// Chooses the quads of a frame. `has_memory`: whether the method has history to choose by.
    pub(super) fn plan_quads(&self, foveation: &Foveation, index: u64, has_memory: bool) -> Quads {
        let size = self.inputs.size.map(|side| side.div_ceil(2));
        let radii = [foveation.fovea_radius_deg(), foveation.mid_radius_deg()];
        let regions = Image::from_fn_parallel(size, |[x, y]| {
            let e_deg = self.inputs.eccentricity_deg(self.inputs.ray(2 * x, 2 * y));
            region(e_deg, radii[0], radii[1])
        });
        let pattern = Pattern::new(foveation, index);
        let even = Image::from_fn_parallel(size, |quad| {
            let region = regions.at(quad[0] as usize, quad[1] as usize);
            self.is_visible_quad(quad) && pattern.has(quad, region)
        });
        let needs = Image::from_fn_parallel(size, |quad| {
            let [x, y] = quad.map(|v| v as usize);
            if !has_memory || even.at(x, y) || regions.at(x, y) == IN_FOVEA { 0.0 } else { self.need_of(quad) }
        });
        let keys = Image::from_fn_parallel(size, |[x, y]| {
            let in_block = [0, 1, 2, 3].map(|i| [x & !1 | i & 1, y & !1 | i >> 1]);
            let is_inside = |[u, v]: [u32; 2]| u < size[0] && v < size[1];
            let of_block = in_block.map(|q| if is_inside(q) { needs.at(q[0] as usize, q[1] as usize) } else { 0.0 });
            let own = (x & 1 | (y & 1) << 1) as usize;
            let need = of_block[own] * share_in_block(of_block, own);
            quad_key(need, x, y, self.frame_low, self.inputs.uniforms.key)
        });
        let mut counts = vec![0; KEYS as usize];
        for &key in keys.pixels() {
            counts[key as usize] += 1;
        }
        let least = threshold(&counts, budget_quads(foveation.budget, size));
        let shaded = Image::from_fn_parallel(size, |[x, y]| {
            let (x, y) = (x as usize, y as usize);
            even.at(x, y) || keys.at(x, y) >= least
        });
        Quads::new(foveation, self.inputs.size, shaded, regions)
    }

    fn is_visible_quad(&self, [x, y]: [u32; 2]) -> bool {
        let [width, height] = self.inputs.size;
        (0..4)
            .map(|i| [2 * x + i % 2, 2 * y + i / 2])
            .any(|[x, y]| x < width && y < height && self.inputs.is_visible(x, y))
    }

    /// Need of a quad outside the fovea.
    fn need_of(&self, [x, y]: [u32; 2]) -> f32 {
        let [width, height] = self.inputs.size;
        let [u, v] = asked_px(x, y, self.frame_low);
        if u >= width || v >= height || !self.inputs.is_visible(u, v) {
            return 0.0;
        }
        self.need_at([u, v]) * acuity(self.inputs.eccentricity_deg(self.inputs.ray(2 * x, 2 * y)))
    }

    /// Need of a pixel, from the four stored samples around its previous position.
    fn need_at(&self, [x, y]: [u32; 2]) -> f32 {
        let nothing = need(-1.0, 1.0, 0.0);
        let inputs = &self.inputs;
        if inputs.reset || self.words.is_empty() {
            return nothing;
        }
        let motion = inputs.motion(x, y);
        let trusted = inputs.trust(x, y).is_none_or(|trust| sanitize::trust(trust) > 0.0);
        if nearest(x, y, motion, inputs.size).is_err() || !trusted {
            return nothing;
        }
        let codes = tap_codes(inputs.expected_disparity(x, y, inputs.disparity(x, y)));
        let at = [x as f32 + motion[0], y as f32 + motion[1]];
        let first = at.map(|v| v.floor());
        let mut best = (f32::MAX, -1.0, 1.0);
        let (mut low, mut high) = (Vec3::splat(f32::MAX), Vec3::ZERO);
        for tap in 0..4 {
            let [tx, ty] = [first[0] + (tap & 1) as f32, first[1] + (tap >> 1) as f32];
            let words = self.stored_words(tx as i32, ty as i32);
            if is_empty(words) || (inputs.tests_depth() && !has_code(code_word(words), codes)) {
                continue;
            }
            let stored = unpack_full(words);
            (low, high) = (low.min(stored.color), high.max(stored.color));
            let px2 = (tx - at[0]) * (tx - at[0]) + (ty - at[1]) * (ty - at[1]);
            if px2 < best.0 {
                let mean = mean_of(stored.lod);
                best = if self.antialiases { (px2, mean.lod, mean.samples) } else { (px2, stored.lod, 1.0) };
            }
        }
        need(best.1, best.2, root_difference(low, high))
    }
}

/// The even pattern of a frame.
struct Pattern {
    /// Distance of its quads in quads, in the middle region and in the periphery.
    steps: [u32; 2],
    offsets: [[u32; 2]; 2],
    turn: u32,
}

impl Pattern {
    fn new(foveation: &Foveation, index: u64) -> Self {
        let steps = [foveation.rate_mid, foveation.rate_far].map(|rate| rate / 2);
        let [mid_x, mid_y, far_x, far_y] = foveation.quad_offsets(index);
        let offsets = [[mid_x, mid_y], [far_x, far_y]];
        Self { steps, offsets, turn: (index & 1) as u32 }
    }

    fn has(&self, [x, y]: [u32; 2], region: u32) -> bool {
        match region {
            IN_FOVEA => true,
            IN_MIDDLE => in_pattern(x, y, self.steps[0], self.offsets[0]),
            _ => in_pattern(x, y, self.steps[1], self.offsets[1]) && in_turn(x, y, self.steps[1], self.turn),
        }
    }
}

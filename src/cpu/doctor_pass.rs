//! Evidence on the inputs of a view. Twins: `shaders/shared/doctor_roots_pass.wgsl` ([`root_means`]) and
//! `shaders/shared/doctor_pass.wgsl` ([`words`]).

use crate::doctor::{StillSurfaces, Tile};
use crate::image::Image;
use crate::kernel::depth::disparity;
use crate::kernel::doctor::*;
use crate::kernel::reproject::camera_vector;
use crate::kernel::{color, foveate, sanitize};
use crate::parallel::collect;
use glam::Vec2;

pub(super) struct Examined<'a> {
    pub color: &'a Image<[f32; 3]>,
    /// Factor on its colors.
    pub exposure: f32,
    pub depth: Option<&'a Image<f32>>,
    pub motion: Option<&'a Image<[f32; 2]>>,
    /// [`root_means`] of this frame and of the previous one.
    pub now: &'a Image<f32>,
    pub past: &'a Image<f32>,
    /// Maps of the hypotheses.
    pub maps: &'a [[f32; 4]],
    /// What the camera saw of surfaces that stand still, if its motion is known.
    pub still: Option<StillSurfaces>,
}

/// Roots of the mean signal of 2x2 pixels of colors times `exposure`.
pub(super) fn root_means(color: &Image<[f32; 3]>, exposure: f32) -> Image<f32> {
    let size = color.size();
    Image::from_fn_parallel(size.map(|s| foveate::level_len(s, 1)), |[x, y]| {
        let at = |dx: u32, dy: u32| {
            let [x, y] = [(2 * x + dx).min(size[0] - 1), (2 * y + dy).min(size[1] - 1)];
            signal(color.at(x as usize, y as usize)[1] * exposure)
        };
        root_mean(at(0, 0), at(1, 0), at(0, 1), at(1, 1))
    })
}

pub(super) fn words(examined: &Examined<'_>, tiles: &[Tile]) -> Vec<u32> {
    collect(tiles.len() as u32, |i| examined.tile(&tiles[i as usize])).into_flattened()
}

impl Examined<'_> {
    fn tile(&self, tile: &Tile) -> [u32; WORDS as usize] {
        let mut words = [0; WORDS as usize];
        let half = TILE_PX / 2;
        for j in 0..half {
            for i in 0..half {
                let first = [tile.origin_px[0] + 2 * i, tile.origin_px[1] + 2 * j];
                self.match_sample(first, tile.lattice_level, &mut words);
                self.match_distances(first, tile.lattice_level, &mut words);
                for (dx, dy) in [(0, 0), (1, 0), (0, 1), (1, 1)] {
                    self.add_pixel([first[0] + dx, first[1] + dy], &mut words);
                }
            }
        }
        self.copy_middle(tile.origin_px.map(|o| o + half), &mut words);
        words
    }

    /// Compares the frame at the pixel `px` with the previous frame at the position that each hypothesis predicts.
    fn match_sample(&self, px: [u32; 2], level: u32, words: &mut [u32]) {
        let Some(motion) = self.motion else { return };
        let stored = motion.at(px[0] as usize, px[1] as usize);
        if !(sanitize::is_finite(stored[0]) && sanitize::is_finite(stored[1])) {
            return;
        }
        let stored = stored.map(stored_motion);
        let at = px.map(|p| (p / 2) as f32);
        let shown = lookup(self.now, at, level);
        words[MATCHED as usize] += 1;
        for (h, map) in self.maps.iter().enumerate() {
            let [x, y] = if map[2] > 0.0 { [stored[1], stored[0]] } else { stored };
            let predicted = lookup(self.past, [at[0] + x * map[0], at[1] + y * map[1]], level);
            words[ERRORS as usize + h] += fixed((shown - predicted).abs());
        }
    }

    /// Compares the frame at the pixel `px` with the previous frame where the camera saw the pixel's surface, at the
    /// distance of each hypothesis.
    fn match_distances(&self, px: [u32; 2], level: u32, words: &mut [u32]) {
        let (Some(still), Some(depth)) = (&self.still, self.depth) else { return };
        let motion = still.camera.motion();
        let stored = disparity(depth.at(px[0] as usize, px[1] as usize), still.disparity);
        if stored <= motion.sky {
            return;
        }
        let at = px.map(|p| (p / 2) as f32);
        let ray = Vec2::new(px[0] as f32, px[1] as f32) * Vec2::from(still.ray_scale) + Vec2::from(still.ray_offset);
        let shown = lookup(self.now, at, level);
        words[PLACED as usize] += 1;
        for i in 0..DISTANCES {
            let moved = camera_vector(ray, stored * disparity_factor(i), motion) + Vec2::from(still.jitter_px);
            let predicted = lookup(self.past, [at[0] + moved.x * 0.5, at[1] + moved.y * 0.5], level);
            words[(DISTANCE_ERRORS + i) as usize] += fixed((shown - predicted).abs());
        }
    }

    /// Adds the differences of a pixel from its neighbours along both axes.
    fn add_pixel(&self, px: [u32; 2], words: &mut [u32]) {
        let at = self.signal(px, 0, 0);
        words[SIGNAL as usize] += fixed(at);
        words[CODES as usize] += u32::from(is_code(at));
        let green = self.color.at(px[0] as usize, px[1] as usize)[1];
        words[BROKEN as usize] += u32::from(!sanitize::is_finite(green));
        for axis in 0..2 {
            let tap = |offset: i32| self.signal(px, axis, offset);
            let (before, after) = (tap(-1), tap(1));
            let mut add = |word: u32, difference: f32| words[word as usize] += fixed(difference);
            add(STEPS + boundary_class(px[axis]), (at - before).abs());
            let kink = kink_class(px[axis]);
            add(BENDS + kink, bend(before, at, after));
            let [before, at_decoded, after] = [before, at, after].map(color::srgb_decode);
            add(DECODED_BENDS + kink, bend(before, at_decoded, after));
            for i in 0..WIDE {
                let reach = 2 << i;
                add(WIDE_BENDS + i, bend(tap(-reach), at, tap(reach)));
            }
        }
    }

    fn signal(&self, px: [u32; 2], axis: usize, offset: i32) -> f32 {
        let mut at = px;
        let last = self.color.size()[axis] as i32 - 1;
        at[axis] = (px[axis] as i32 + offset).clamp(0, last) as u32;
        signal(self.color.at(at[0] as usize, at[1] as usize)[1] * self.exposure)
    }

    /// Copies stored depths and motion.
    fn copy_middle(&self, middle: [u32; 2], words: &mut [u32]) {
        let [x, y] = middle.map(|m| m as usize);
        let step = DEPTH_STEP_PX as usize;
        if let Some(depth) = self.depth {
            let taps = [(x, y), (x - step, y), (x + step, y), (x, y - step), (x, y + step)];
            for (word, (x, y)) in (DEPTH..).zip(taps) {
                words[word as usize] = kept_bits(depth.at(x, y));
            }
        }
        if let Some(motion) = self.motion {
            for (word, v) in (MOTION..).zip(motion.at(x, y)) {
                words[word as usize] = kept_bits(v);
            }
        }
    }
}

/// Root at a position in texels: a spline over the points of a lattice.
fn lookup(roots: &Image<f32>, at: [f32; 2], level: u32) -> f32 {
    let axis = |i: usize| {
        let len = roots.size()[i];
        let count = lattice_len(len, level);
        let (near, fraction) = foveate::split(lattice_coordinate(at[i], level), count);
        let points = [near.max(1) - 1, near, (near + 1).min(count - 1), (near + 2).min(count - 1)];
        (points.map(|point| lattice_texel(point, level, len) as usize), fraction)
    };
    let ((columns, across), (rows, down)) = (axis(0), axis(1));
    spline(rows.map(|y| spline(columns.map(|x| roots.at(x, y)), across)), down)
}

//! History resampled to another size. Twins: `shaders/levels/resize_{surfaces,reservoirs}_pass.wgsl`,
//! `shaders/planned/resize_sparse_pass.wgsl`.

use crate::kernel::antialias::{Mean, mean_of, stored_lod};
use crate::kernel::pack::tap_codes;
use crate::kernel::resample::{gather_around, resolve, sharp_sum, surface_tap, taps_around};
use crate::kernel::resize::{old_position, resized_lod};
use crate::kernel::sanitize::MAX_HALF;
use crate::kernel::stored_sample::{StoredSample, moved_stored, resized_stored, unpack_stored};
use crate::kernel::surface::{Surface, pack_surface, unpack_surface};
use crate::parallel::collect;
use crate::resize::Resize;
use glam::{Vec2, Vec3};

impl Resize {
    /// `values` of one view of the old size, at the nearest pixel of each pixel of the new size.
    pub(super) fn nearest<T: Copy + Send + Sync>(&self, values: &[T]) -> Vec<T> {
        self.map(|x, y| values[self.index(self.nearest_to(self.old_position_of(x, y)))])
    }

    /// Packed surfaces of one view of the new size, from those of the old size.
    pub(super) fn surfaces(&self, words: &[[u32; 2]]) -> Vec<[u32; 2]> {
        self.map(|x, y| {
            let position = self.old_position_of(x, y);
            let nearest = unpack_surface(words[self.index(self.nearest_to(position))]);
            if nearest.lod < 0.0 {
                return pack_surface(Surface { color: Vec3::ZERO, ..nearest });
            }
            let whole = position.map(f32::floor);
            let fraction = [position[0] - whole[0], position[1] - whole[1]];
            let taps = taps_around(whole.map(|v| v as i32), fraction, self.old_size_px);
            let (codes, any_code) = (tap_codes(nearest.disparity), nearest.disparity < 0.0);
            let gathered =
                gather_around(&taps, |at| surface_tap(words[self.index(at.map(|v| v as u32))], codes, any_code));
            let resampled = resolve(gathered, sharp_sum(&taps), nearest);
            pack_surface(Surface {
                color: resampled.sharp.min(Vec3::splat(MAX_HALF)),
                lod: resized_lod(resampled.lod, self.lod_shift),
                disparity: nearest.disparity,
            })
        })
    }

    /// Packed stored samples of one view of the new size, from those of the old size. `means`: they are means of
    /// samples.
    pub(super) fn sparse(&self, words: &[[u32; 2]], means: bool) -> Vec<[u32; 2]> {
        let scale = Vec2::new(1.0 / self.ratio[0], 1.0 / self.ratio[1]);
        self.map(|x, y| {
            let position = self.old_position_of(x, y);
            let at = self.nearest_to(position);
            let texel_px = Vec2::new(at[0] as f32 - position[0], at[1] as f32 - position[1]);
            let old = words[self.index(at)];
            let kept = |stored| resized_stored(old, stored);
            let mut stored = unpack_stored(old);
            if !means {
                return kept(moved_stored(stored, texel_px, scale, self.lod_shift));
            }
            let mean = mean_of(stored.lod);
            stored.lod = mean.lod;
            let moved = moved_stored(stored, texel_px, scale, self.lod_shift);
            kept(StoredSample { lod: stored_lod(Mean { lod: moved.lod, ..mean }, [0.5; 2]), ..moved })
        })
    }

    fn map<T: Send>(&self, pixel: impl Fn(u32, u32) -> T + Sync) -> Vec<T> {
        let [width, height] = self.size_px;
        collect(width * height, |i| pixel(i % width, i / width))
    }

    fn index(&self, [x, y]: [u32; 2]) -> usize {
        y as usize * self.old_size_px[0] as usize + x as usize
    }

    fn old_position_of(&self, x: u32, y: u32) -> [f32; 2] {
        let [width, height] = self.old_size_px;
        [old_position(x, self.ratio[0], width), old_position(y, self.ratio[1], height)]
    }

    fn nearest_to(&self, position: [f32; 2]) -> [u32; 2] {
        let [width, height] = self.old_size_px;
        [((position[0] + 0.5) as u32).min(width - 1), ((position[1] + 0.5) as u32).min(height - 1)]
    }
}

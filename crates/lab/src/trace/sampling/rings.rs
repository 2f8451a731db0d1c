//! Rings of lattices around the gaze, and blending between neighbouring rings.

use super::circle::{Circle, runs};
use super::fill::{Filter, value_at};
use super::lattice::Lattice;
use crate::trace::film::Film;
use afterimage::Image;
use glam::Vec3;
use std::ops::Range;

/// The area between two circles around the gaze.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Ring {
    pub lattice: Lattice,
    /// Samples per point.
    pub samples: u32,
    /// Radius in pixels where the blend to the next ring begins; infinity for the last ring.
    pub radius_px: f32,
    /// Width of the blend to the next ring, in pixels.
    pub blend_px: f32,
    pub filter: Filter,
    /// Visible part of the frame.
    pub lens: Circle,
}

impl Ring {
    /// A single ring over the whole frame, with `samples` per pixel.
    pub fn everywhere(size_px: [u32; 2], samples: u32) -> Self {
        let lattice = Lattice::blocks(1, size_px);
        Self {
            lattice,
            samples,
            radius_px: f32::INFINITY,
            blend_px: 0.0,
            filter: Filter::Linear,
            lens: Circle::EVERYTHING,
        }
    }

    /// Lattice points that some pixel of the ring or of its blends reads: columns and row of each run, ordered by row.
    pub fn targets(
        &self,
        rings: &[Self],
        index: usize,
        gaze_px: [f32; 2],
    ) -> impl Iterator<Item = (Range<u32>, u32)> + use<> {
        let reach_px = self.filter.reach_px(&self.lattice);
        let around = |radius_px| Circle { center_px: gaze_px, radius_px };
        let outer = around(self.radius_px + self.blend_px).grown(reach_px);
        let inner = around(index.checked_sub(1).map_or(f32::NEG_INFINITY, |i| rings[i].radius_px)).shrunk(reach_px);
        let (lens, lattice) = (self.lens.grown(reach_px), self.lattice);
        (0..lattice.points[1]).flat_map(move |y| runs([outer, lens], inner, &lattice, y).map(|run| (run, y)))
    }
}

/// Blends the rings into one frame; returns its color and level of detail. Black outside the lens.
pub(super) fn blend(
    rings: &[Ring],
    films: &[Film],
    size_px: [u32; 2],
    gaze_px: [f32; 2],
) -> (Image<[f32; 3]>, Image<f32>) {
    let pixels = Image::from_fn_parallel(size_px, |[x, y]| {
        let px = [x as f32, y as f32];
        let lens = rings[0].lens;
        if lens.radius_px.is_finite() && lens.distance_px(px) > lens.radius_px {
            return (Vec3::ZERO, (rings[rings.len() - 1].lattice.step as f32).log2());
        }
        let distance = (px[0] - gaze_px[0]).hypot(px[1] - gaze_px[1]);
        let i = rings.iter().position(|r| distance < r.radius_px + r.blend_px).unwrap_or(rings.len() - 1);
        let of = |i: usize| value_at(&films[i], &rings[i].lattice, px, rings[i].filter);
        let lod = |i: usize| (rings[i].lattice.step as f32).log2();
        let t = ((distance - rings[i].radius_px) / rings[i].blend_px.max(1e-6)).clamp(0.0, 1.0);
        // The last ring has no outer blend.
        if t > 0.0 { (of(i) * (1.0 - t) + of(i + 1) * t, lod(i) * (1.0 - t) + lod(i + 1) * t) } else { (of(i), lod(i)) }
    });
    (pixels.map(|(color, _)| color.to_array()), pixels.map(|(_, lod)| lod))
}

/// Noise of the blended frame: that of the nearest point in the ring with the larger weight. 0 outside the lens, where
/// black is exact.
pub(super) fn noise(rings: &[Ring], films: &[Film], size_px: [u32; 2], gaze_px: [f32; 2]) -> Image<[f32; 2]> {
    Image::from_fn_parallel(size_px, |[x, y]| {
        let px = [x as f32, y as f32];
        let distance = (px[0] - gaze_px[0]).hypot(px[1] - gaze_px[1]);
        let i = rings.iter().position(|r| distance < r.radius_px + 0.5 * r.blend_px).unwrap_or(rings.len() - 1);
        let (lattice, at) = (&rings[i].lattice, rings[i].lattice.coordinate(px));
        films[i].noise_at([0, 1].map(|k| (at[k].round().max(0.0) as u32).min(lattice.points[k].saturating_sub(1))))
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::trace::film::Moments;
    use crate::trace::sampling::{Layers, Regions};
    use afterimage::ViewGeometry;
    use rand::{RngExt, SeedableRng};
    use rand_pcg::Pcg64;

    /// A film with one sample at each point, with a different value at each.
    fn film_of(ring: &Ring, points: impl Iterator<Item = [u32; 2]>) -> Film {
        let mut film = Film::new(ring.lattice.points);
        let width = film.moments.width();
        for [x, y] in points {
            let mean = Vec3::new(1.0 + x as f32, 1.0 + y as f32, ((x * 7 + y * 13) % 31) as f32);
            film.moments.pixels_mut()[y as usize * width + x as usize] =
                Moments { mean, count: 1, ..Moments::default() };
        }
        film
    }

    #[test]
    fn what_is_no_target_is_not_looked_at() {
        let mut rng = Pcg64::seed_from_u64(3);
        let (mut targets, mut points) = (0, 0);
        for case in 0..120 {
            let size_px = [rng.random_range(20..150), rng.random_range(20..110)];
            let geometry = ViewGeometry::flat(size_px, rng.random_range(15.0..70.0)).unwrap();
            let gaze_px = size_px.map(|s| rng.random_range(-30.0..s as f32 + 30.0));
            let rings = if case % 2 == 0 {
                let blocks = [rng.random_range(1..5), rng.random_range(1..8)];
                Regions { blocks, radius_scale: rng.random_range(0.2..1.5), ..Regions::default() }.rings(&geometry)
            } else {
                let steps = [1, 2, 3, 4].map(|step| rng.random_range(1..=step));
                let lens_deg = (case % 4 == 1).then(|| rng.random_range(5.0..40.0));
                Layers { radii_deg: [2.0, 5.0, 9.0], steps, lens_deg }.rings(&geometry, gaze_px, 1)
            };
            let all = |ring: &Ring| film_of(ring, (0..ring.lattice.points[1]).flat_map(|y| row(ring, y)));
            let some = |(i, ring): (usize, &Ring)| {
                film_of(ring, ring.targets(&rings, i, gaze_px).flat_map(|(run, y)| run.map(move |x| [x, y])))
            };
            let films: [Vec<Film>; 2] = [rings.iter().map(all).collect(), rings.iter().enumerate().map(some).collect()];
            let [expected, found] = films.each_ref().map(|films| blend(&rings, films, size_px, gaze_px).0);
            assert!(expected == found, "case {case}: {rings:?}, gaze {gaze_px:?}");
            let [of_all, of_some] =
                films.map(|films| films.iter().flat_map(|f| f.moments.pixels()).filter(|m| m.count > 0).count());
            points += of_all;
            targets += of_some;
        }
        println!("{targets} targets of {points} points");
        assert!(targets * 3 < points * 2);
    }

    fn row(ring: &Ring, y: u32) -> impl Iterator<Item = [u32; 2]> + use<> {
        (0..ring.lattice.points[0]).map(move |x| [x, y])
    }
}

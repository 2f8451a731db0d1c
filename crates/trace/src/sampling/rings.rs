//! Rings of lattices around the gaze, and blending between neighbouring rings.

use super::circle::{Circle, runs};
use super::fill::{Around, Filter, value_at};
use crate::film::Film;
use afterimage::Image;
use afterimage_lab::view::Lattice;
use glam::Vec3;
use rayon::prelude::*;
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
        gaze: Circle,
    ) -> impl Iterator<Item = (Range<u32>, u32)> + use<> {
        let reach_px = self.filter.reach_px(&self.lattice);
        let around = |radius_px| Circle { radius_px, ..gaze };
        let outer = around(self.radius_px + self.blend_px).grown(reach_px);
        let inner = around(index.checked_sub(1).map_or(f32::NEG_INFINITY, |i| rings[i].radius_px)).shrunk(reach_px);
        let (lens, lattice) = (self.lens.grown(reach_px), self.lattice);
        (0..lattice.points[1]).flat_map(move |y| runs([outer, lens], inner, &lattice, y).map(|run| (run, y)))
    }
}

/// The rings of a frame as one: color, level of detail, and noise, at every pixel.
pub(super) struct Blended {
    pub color: Image<[f32; 3]>,
    pub lod: Image<f32>,
    pub noise: Image<[f32; 2]>,
}

/// Distance in pixels from the borders of rings within which a pixel's distance to the gaze is computed. Farther away,
/// the closed-form runs of a row give its ring. It is larger than any rounding error.
const MARGIN_PX: f32 = 1e-3;

/// Blends the rings into one frame. Outside the lens, black without noise.
pub(super) fn blend(rings: &[Ring], films: &[Film], size_px: [u32; 2], gaze: Circle) -> Blended {
    let blend = Blend::new(rings, films, size_px, gaze);
    let mut color = Image::filled(size_px, [0.0; 3]);
    let mut lod = Image::filled(size_px, 0.0);
    let mut noise = Image::filled(size_px, [0.0; 2]);
    let width = size_px[0].max(1) as usize;
    let rows = color.pixels_mut().par_chunks_mut(width).zip(lod.pixels_mut().par_chunks_mut(width));
    rows.zip(noise.pixels_mut().par_chunks_mut(width)).zip(0..size_px[1]).for_each(|(((color, lod), noise), y)| {
        let row = blend.row(y);
        let mut set = |x: u32, value: (Vec3, f32, [f32; 2])| {
            let x = x as usize;
            (color[x], lod[x], noise[x]) = (value.0.to_array(), value.1, value.2);
        };
        let mut done = 0;
        for (columns, i) in blend.runs(y) {
            (done..columns.start).for_each(|x| set(x, blend.near_border([x, y], &row)));
            done = columns.end;
            columns.for_each(|x| set(x, blend.within(i, x, &row)));
        }
        (done..size_px[0]).for_each(|x| set(x, blend.near_border([x, y], &row)));
    });
    Blended { color, lod, noise }
}

/// Constants of a blend, shared by all of its pixels.
struct Blend<'a> {
    rings: &'a [Ring],
    films: &'a [Film],
    /// Noise of each point of each ring.
    noise: Vec<Image<[f32; 2]>>,
    /// Points of each ring around the columns of the frame.
    columns: Vec<Vec<Around>>,
    lods: Vec<f32>,
    pixels: Lattice,
    gaze: Circle,
}

impl<'a> Blend<'a> {
    fn new(rings: &'a [Ring], films: &'a [Film], size_px: [u32; 2], gaze: Circle) -> Self {
        let columns = |ring: &Ring| (0..size_px[0]).map(|x| Around::new(&ring.lattice, 0, x)).collect();
        Self {
            rings,
            films,
            noise: films.iter().map(Film::noise).collect(),
            columns: rings.iter().map(columns).collect(),
            lods: rings.iter().map(|ring| (ring.lattice.step as f32).log2()).collect(),
            pixels: Lattice::blocks(1, size_px),
            gaze,
        }
    }

    /// Points of each ring around a row of the frame.
    fn row(&self, y: u32) -> Vec<Around> {
        self.rings.iter().map(|ring| Around::new(&ring.lattice, 1, y)).collect()
    }

    /// Runs of pixels of a row that lie in one ring alone, with the index of that ring, from left to right.
    fn runs(&self, y: u32) -> Vec<(Range<u32>, usize)> {
        let around = |radius_px| Circle { radius_px, ..self.gaze };
        let mut beyond = around(f32::NEG_INFINITY);
        let mut found = vec![];
        for (i, ring) in self.rings.iter().enumerate() {
            let inside = [around(ring.radius_px), ring.lens].map(|circle| circle.shrunk(MARGIN_PX));
            let runs = runs(inside, beyond.grown(MARGIN_PX), &self.pixels, y);
            found.extend(runs.into_iter().filter(|run| !run.is_empty()).map(|run| (run, i)));
            beyond.radius_px = beyond.radius_px.max(ring.radius_px + ring.blend_px);
        }
        found.sort_by_key(|(run, _)| run.start);
        found
    }

    /// Color, level of detail and noise at a pixel that lies in ring `i` alone.
    #[inline]
    fn within(&self, i: usize, x: u32, row: &[Around]) -> (Vec3, f32, [f32; 2]) {
        (self.value(i, x, row), self.lods[i], self.noise_of(i, x, row))
    }

    #[inline]
    fn value(&self, i: usize, x: u32, row: &[Around]) -> Vec3 {
        value_at(&self.films[i], self.rings[i].filter, &self.columns[i][x as usize], &row[i])
    }

    /// Noise of the nearest point of a ring; 0 where it was not traced.
    #[inline]
    fn noise_of(&self, i: usize, x: u32, row: &[Around]) -> [f32; 2] {
        self.films[i].of_window(&self.noise[i], [self.columns[i][x as usize].nearest, row[i].nearest])
    }

    /// Color, level of detail and noise at any pixel. The noise comes from the ring with the larger weight.
    fn near_border(&self, [x, y]: [u32; 2], row: &[Around]) -> (Vec3, f32, [f32; 2]) {
        let px = [x as f32, y as f32];
        let distance = self.gaze.distance_px(px);
        let last = self.rings.len() - 1;
        let ring_within =
            |share: f32| self.rings.iter().position(|r| distance < r.radius_px + share * r.blend_px).unwrap_or(last);
        let noise = self.noise_of(ring_within(0.5), x, row);
        let lens = self.rings[0].lens;
        if lens.radius_px.is_finite() && lens.distance_px(px) > lens.radius_px {
            return (Vec3::ZERO, self.lods[last], noise);
        }
        let i = ring_within(1.0);
        let t = ((distance - self.rings[i].radius_px) / self.rings[i].blend_px.max(1e-6)).clamp(0.0, 1.0);
        let own = self.value(i, x, row);
        // The last ring has no outer blend.
        if t > 0.0 {
            let mixed = |a: f32, b: f32| a * (1.0 - t) + b * t;
            (own * (1.0 - t) + self.value(i + 1, x, row) * t, mixed(self.lods[i], self.lods[i + 1]), noise)
        } else {
            (own, self.lods[i], noise)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::film::Moments;
    use crate::sampling::{Layers, Regions, points};
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

    /// Films of the targets of each ring.
    fn films_of(rings: &[Ring], gaze_px: [f32; 2]) -> Vec<Film> {
        let gaze = Circle::around(gaze_px);
        let film = |(i, ring): (usize, &Ring)| film_of(ring, points(ring.targets(rings, i, gaze)));
        rings.iter().enumerate().map(film).collect()
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
            let films: [Vec<Film>; 2] = [rings.iter().map(all).collect(), films_of(&rings, gaze_px)];
            let [expected, found] =
                films.each_ref().map(|films| blend(&rings, films, size_px, Circle::around(gaze_px)).color);
            assert!(expected == found, "case {case}: {rings:?}, gaze {gaze_px:?}");
            let [of_all, of_some] =
                films.map(|films| films.iter().flat_map(|f| f.moments.pixels()).filter(|m| m.count > 0).count());
            points += of_all;
            targets += of_some;
        }
        println!("{targets} targets of {points} points");
        assert!(targets * 3 < points * 2);
    }

    #[test]
    fn runs_are_what_a_look_at_every_pixel_finds() {
        let mut rng = Pcg64::seed_from_u64(11);
        let (mut pixels, mut of_runs) = (0, 0);
        for case in 0..400 {
            let size_px: [u32; 2] = [rng.random_range(1..150), rng.random_range(1..110)];
            let geometry = ViewGeometry::flat(size_px, rng.random_range(15.0..70.0)).unwrap();
            let reach = if case % 10 == 0 { 1e6 } else { 40.0 };
            let gaze_px = size_px.map(|s| rng.random_range(-reach..s as f32 + reach));
            let rings = if case % 2 == 0 {
                let blocks = [rng.random_range(1..5), rng.random_range(1..8)];
                // The patterns include regions without a fovea, and regions whose middle consists of blends alone.
                Regions { blocks, radius_scale: f32::from(case % 5 != 0), ..Regions::default() }.rings(&geometry)
            } else {
                let lens_deg = (case % 4 == 1).then(|| rng.random_range(5.0..40.0));
                Layers { radii_deg: [2.0, 2.1, 9.0], steps: [1, 2, 3, 4], lens_deg }.rings(&geometry, gaze_px, 1)
            };
            let films = films_of(&rings, gaze_px);
            let made = blend(&rings, &films, size_px, Circle::around(gaze_px));
            let plain = Blend::new(&rings, &films, size_px, Circle::around(gaze_px));
            for y in 0..size_px[1] {
                let row = plain.row(y);
                of_runs += plain.runs(y).iter().map(|(run, _)| run.len()).sum::<usize>();
                for x in 0..size_px[0] {
                    let at = [x as usize, y as usize];
                    let found = (made.color.at(at[0], at[1]), made.lod.at(at[0], at[1]), made.noise.at(at[0], at[1]));
                    let (color, lod, noise) = plain.near_border([x, y], &row);
                    assert_eq!(found, (color.to_array(), lod, noise), "case {case}, pixel {x}, {y}: {rings:?}");
                    assert_eq!(noise, films_noise(&rings, &films, [x, y], gaze_px));
                    pixels += 1;
                }
            }
        }
        println!("{of_runs} of {pixels} pixels lie in runs");
        assert!(of_runs * 2 > pixels);
    }

    /// Noise of a pixel from the definition.
    fn films_noise(rings: &[Ring], films: &[Film], px: [u32; 2], gaze_px: [f32; 2]) -> [f32; 2] {
        let px = px.map(|v| v as f32);
        let distance = (px[0] - gaze_px[0]).hypot(px[1] - gaze_px[1]);
        let i = rings.iter().position(|r| distance < r.radius_px + 0.5 * r.blend_px).unwrap_or(rings.len() - 1);
        let (lattice, at) = (&rings[i].lattice, rings[i].lattice.coordinate(px));
        films[i].noise_at([0, 1].map(|k| (at[k].round().max(0.0) as u32).min(lattice.points[k].saturating_sub(1))))
    }

    fn row(ring: &Ring, y: u32) -> impl Iterator<Item = [u32; 2]> + use<> {
        (0..ring.lattice.points[0]).map(move |x| [x, y])
    }
}

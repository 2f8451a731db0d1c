//! Circles on a frame, and the lattice points inside them, row by row.

use afterimage_lab::view::Lattice;
use std::ops::Range;

/// A circle on the frame. With infinite radius it contains everything, with a negative radius nothing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Circle {
    pub center_px: [f32; 2],
    pub radius_px: f32,
}

impl Circle {
    /// The circle that contains everything.
    pub const EVERYTHING: Self = Self { center_px: [0.0; 2], radius_px: f32::INFINITY };

    /// A circle of radius 0, from which those around it are made.
    pub fn around(center_px: [f32; 2]) -> Self {
        Self { center_px, radius_px: 0.0 }
    }

    /// The circle enlarged by `by_px`, plus the rounding error of single precision at its edge.
    pub fn grown(self, by_px: f32) -> Self {
        Self { radius_px: self.radius_px + by_px + self.rounding_px(), ..self }
    }

    /// The circle reduced by `by_px`, plus the rounding error of single precision at its edge.
    pub fn shrunk(self, by_px: f32) -> Self {
        Self { radius_px: self.radius_px - by_px - self.rounding_px(), ..self }
    }

    /// Rounding error of single precision at the edge, in pixels. Infinite radii stay infinite.
    fn rounding_px(&self) -> f32 {
        if self.radius_px.is_finite() { 4.0 * f32::EPSILON * self.radius_px.abs() } else { 0.0 }
    }

    /// Distance of a pixel from the centre, in pixels.
    pub fn distance_px(&self, px: [f32; 2]) -> f32 {
        (px[0] - self.center_px[0]).hypot(px[1] - self.center_px[1])
    }

    /// Points of a lattice row inside the circle.
    pub fn chord(&self, lattice: &Lattice, row: u32) -> Range<u32> {
        let [cx, cy] = self.center_px.map(f64::from);
        let [x0, y0] = lattice.first_px.map(f64::from);
        let (radius, step) = (f64::from(self.radius_px), f64::from(lattice.step));
        let down = y0 + f64::from(row) * step - cy;
        if radius < down.abs() {
            return 0..0;
        }
        let half = ((radius - down) * (radius + down)).sqrt();
        // Float to integer conversion saturates, so points left of the first become 0.
        let first = ((cx - half - x0) / step).ceil() as u32;
        let beyond = ((cx + half - x0) / step + 1.0).floor() as u32;
        first..beyond.min(lattice.points[0]).max(first)
    }
}

/// Points of a lattice row inside both `outer` circles and outside `inner`: up to two runs.
pub(super) fn runs(outer: [Circle; 2], inner: Circle, lattice: &Lattice, row: u32) -> [Range<u32>; 2] {
    let [a, b] = outer.map(|circle| circle.chord(lattice, row));
    let (start, end) = (a.start.max(b.start), a.end.min(b.end));
    let excluded = inner.chord(lattice, row);
    if excluded.is_empty() {
        return [start..end, 0..0];
    }
    [start..end.min(excluded.start), start.max(excluded.end)..end]
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{RngExt, SeedableRng};
    use rand_pcg::Pcg64;

    /// Reference test of one point; `None` if it is so near a circle that rounding decides.
    fn is_inside(outer: [Circle; 2], inner: Circle, px: [f64; 2]) -> Option<bool> {
        let inside = |circle: Circle| {
            let [cx, cy] = circle.center_px.map(f64::from);
            let (distance, radius) = ((px[0] - cx).hypot(px[1] - cy), f64::from(circle.radius_px));
            ((distance - radius).abs() > 1e-9 * radius.abs().clamp(1.0, 1e9)).then_some(distance < radius)
        };
        Some(inside(outer[0])? && inside(outer[1])? && !inside(inner)?)
    }

    #[test]
    fn runs_are_what_a_look_at_every_point_finds() {
        let mut rng = Pcg64::seed_from_u64(7);
        let (mut points, mut inside_count, mut undecided) = (0, 0, 0);
        for case in 0..4000 {
            let size_px = [rng.random_range(1..90), rng.random_range(1..60)];
            // Also gazes off the frame on all sides, some far off.
            let reach = if case % 10 == 0 { 1e6 } else { 60.0 };
            let gaze: [f32; 2] = size_px.map(|s| rng.random_range(-reach..s as f32 + reach));
            let step = rng.random_range(1..6);
            let lattice =
                if case % 2 == 0 { Lattice::blocks(step, size_px) } else { Lattice::through(step, gaze, size_px) };
            let mut radius = |around: f32| match rng.random_range(0..8) {
                0 => f32::INFINITY,
                1 => f32::NEG_INFINITY,
                2 => 0.0,
                _ => around + rng.random_range(-5.0..80.0_f32),
            };
            let far = if case % 10 == 0 { gaze[0].hypot(gaze[1]) } else { 0.0 };
            let circle = |center_px, radius_px| Circle { center_px, radius_px };
            let outer = [circle(gaze, radius(far)), circle(size_px.map(|s| 0.5 * s as f32), radius(0.0))];
            let inner = circle(gaze, radius(far));
            for row in 0..lattice.points[1] {
                let runs = runs(outer, inner, &lattice, row);
                assert!(runs.iter().all(|r| r.is_empty() || r.end <= lattice.points[0]), "{runs:?} of {lattice:?}");
                assert!(runs[1].is_empty() || runs[0].is_empty() || runs[0].end <= runs[1].start, "{runs:?}");
                for x in 0..lattice.points[0] {
                    points += 1;
                    let Some(is_inside) = is_inside(outer, inner, lattice.px([x, row]).map(f64::from)) else {
                        undecided += 1;
                        continue;
                    };
                    inside_count += u32::from(is_inside);
                    let found = runs.iter().any(|r| r.contains(&x));
                    assert_eq!(
                        found, is_inside,
                        "case {case}: point {x}, {row} of {lattice:?}, {outer:?} less {inner:?}"
                    );
                }
            }
        }
        println!("{points} points, {inside_count} in, {undecided} on an edge");
        assert!(inside_count * 20 > points && inside_count * 2 < points && undecided * 1000 < points);
    }

    #[test]
    fn growing_and_shrinking_keep_what_everything_and_nothing_are() {
        assert_eq!(Circle::EVERYTHING.grown(3.0), Circle::EVERYTHING);
        let nothing = Circle { radius_px: f32::NEG_INFINITY, ..Circle::EVERYTHING };
        assert_eq!(nothing.shrunk(3.0), nothing);
        let lattice = Lattice::blocks(2, [7, 5]);
        assert_eq!((Circle::EVERYTHING.chord(&lattice, 2), nothing.chord(&lattice, 0)), (0..4, 0..0));
    }
}

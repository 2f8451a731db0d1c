//! Rings of lattices around the gaze, and the blend of neighbours.

use super::fill::{Filter, value_at};
use super::lattice::Lattice;
use crate::image::Image;
use crate::trace::film::Film;
use glam::Vec3;

/// What of a frame can be seen: a disc around its axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Lens {
    pub center_px: [f32; 2],
    pub radius_px: f32,
}

impl Lens {
    /// Whether a place is seen, or no farther outside than `reach_px`.
    fn shows(&self, px: [f32; 2], reach_px: f32) -> bool {
        (px[0] - self.center_px[0]).hypot(px[1] - self.center_px[1]) <= self.radius_px + reach_px
    }
}

/// What lies between two circles around the gaze.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Ring {
    pub lattice: Lattice,
    /// Samples of a point.
    pub samples: u32,
    /// Where the next ring begins to show; infinity for the last.
    pub radius_px: f32,
    /// Over how many pixels it takes over.
    pub blend_px: f32,
    pub filter: Filter,
    /// Nothing is traced outside. `None`: all of the frame is seen.
    pub lens: Option<Lens>,
}

impl Ring {
    /// One sample set a pixel, everywhere.
    pub fn everywhere(size_px: [u32; 2], samples: u32) -> Self {
        let lattice = Lattice::blocks(1, size_px);
        Self { lattice, samples, radius_px: f32::INFINITY, blend_px: 0.0, filter: Filter::Linear, lens: None }
    }

    /// Points that some pixel of the ring or of its blends looks at, row by row.
    pub fn targets(
        &self,
        rings: &[Self],
        index: usize,
        size_px: [u32; 2],
        gaze_px: [f32; 2],
    ) -> impl Iterator<Item = [u32; 2]> + use<> {
        let reach = self.filter.reach() * self.lattice.step as f32;
        let inner = index.checked_sub(1).map_or(f32::NEG_INFINITY, |i| rings[i].radius_px - reach);
        let outer = self.radius_px + self.blend_px + reach;
        let (lattice, lens) = (self.lattice, self.lens);
        let last = size_px.map(|s| s.saturating_sub(1) as f32 + lattice.step as f32);
        (0..lattice.points[1]).flat_map(move |y| {
            (0..lattice.points[0]).map(move |x| [x, y]).filter(move |&point| {
                let px = lattice.px(point);
                let distance = (px[0] - gaze_px[0]).hypot(px[1] - gaze_px[1]);
                let is_seen = lens.is_none_or(|lens| lens.shows(px, reach));
                is_seen && distance >= inner && distance <= outer && px[0] <= last[0] && px[1] <= last[1]
            })
        })
    }
}

/// The rings as one frame, and the level of detail of its pixels. Black outside the lens.
pub(super) fn blend(
    rings: &[Ring],
    films: &[Film],
    size_px: [u32; 2],
    gaze_px: [f32; 2],
) -> (Image<[f32; 3]>, Image<f32>) {
    let pixels = Image::from_fn_parallel(size_px, |[x, y]| {
        let px = [x as f32, y as f32];
        let distance = (px[0] - gaze_px[0]).hypot(px[1] - gaze_px[1]);
        let shown = rings.iter().position(|r| distance < r.radius_px + r.blend_px);
        let Some(i) = shown.filter(|_| rings[0].lens.is_none_or(|lens| lens.shows(px, 0.0))) else {
            return (Vec3::ZERO, (rings[rings.len() - 1].lattice.step as f32).log2());
        };
        let of = |i: usize| value_at(&films[i], &rings[i].lattice, px, rings[i].filter);
        let lod = |i: usize| (rings[i].lattice.step as f32).log2();
        let t = ((distance - rings[i].radius_px) / rings[i].blend_px.max(1e-6)).clamp(0.0, 1.0);
        match (t > 0.0, i + 1 < rings.len()) {
            (false, _) => (of(i), lod(i)),
            // The last ring fades out.
            (true, false) => (of(i) * (1.0 - t), lod(i)),
            (true, true) => (of(i) * (1.0 - t) + of(i + 1) * t, lod(i) * (1.0 - t) + lod(i + 1) * t),
        }
    });
    (pixels.map(|(color, _)| color.to_array()), pixels.map(|(_, lod)| lod))
}

/// Noise of the blended frame: of the ring that shows most, that of the nearest point with samples.
pub(super) fn noise(rings: &[Ring], films: &[Film], size_px: [u32; 2], gaze_px: [f32; 2]) -> Image<[f32; 2]> {
    let of_rings: Vec<Image<[f32; 2]>> = films.iter().map(Film::noise).collect();
    Image::from_fn_parallel(size_px, |[x, y]| {
        let px = [x as f32, y as f32];
        let distance = (px[0] - gaze_px[0]).hypot(px[1] - gaze_px[1]);
        let Some(i) = rings.iter().position(|r| distance < r.radius_px + 0.5 * r.blend_px) else {
            return [0.0; 2];
        };
        let at = rings[i].lattice.coordinate(px);
        let nearest = [0, 1].map(|k| (at[k].round().max(0.0) as usize).min(rings[i].lattice.points[k] as usize - 1));
        of_rings[i].at(nearest[0], nearest[1])
    })
}

//! Foveated sampling: sample density over the frame for a gaze, and reconstruction between samples.
//!
//! A frame is traced on lattices, in rings around the gaze. A tracer treats a lattice as a small frame of its own
//! ([`View::on_lattice`]) and traces a list of its points. The other points cost nothing.

mod acuity;
mod circle;
mod fill;
mod layers;
mod planned;
mod regions;
mod rings;

pub use acuity::Acuity;
pub use layers::Layers;
pub use planned::trace_requested;
pub use regions::Regions;

use crate::Tracer;
use crate::film::Film;
use crate::work::Spans;
use crate::world::World;
use afterimage::internal::{Foveation, FoveationKind};
use afterimage::{Image, ViewGeometry};
use afterimage_lab::frame::FoveatedFrame;
use afterimage_lab::view::View;
use circle::Circle;
use rings::{Blended, Ring};
use std::ops::Range;

/// Sampling pattern.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Sampling {
    /// The same number of samples everywhere.
    #[default]
    Uniform,
    /// Three regions of pixel blocks (Mohanto et al. 2023).
    Regions(Regions),
    /// Nested lattices with blended borders (thesis).
    Layers(Layers),
    /// Density follows visual acuity; a different subset of pixels each frame.
    Acuity(Acuity),
}

/// Sample points of a frame, in rings from the inside out.
#[derive(Clone, Debug)]
pub struct Plan {
    size_px: [u32; 2],
    /// The gaze, as the middle of all rings.
    gaze: Circle,
    kind: Kind,
}

#[derive(Clone, Debug)]
enum Kind {
    Rings(Vec<Ring>),
    /// Pixels ordered by row, with the same number of samples each.
    Scattered {
        targets: Vec<[u32; 2]>,
        samples: u32,
        lod: Image<f32>,
    },
}

impl Sampling {
    /// Foveation parameters of the pattern for the post-process: the radius of full rate, and the coarsest rates.
    pub fn foveation(&self) -> Foveation {
        let rate = |pixels: f32| (pixels.ceil() as u32).next_power_of_two();
        let of = |fovea_deg: f32, mid_deg: f32, [mid, far]: [f32; 2]| Foveation {
            fovea_deg,
            mid_deg: mid_deg.max(fovea_deg),
            rate_mid: rate(mid),
            rate_far: rate(far.max(mid)),
            ..Foveation::default()
        };
        match self {
            Self::Uniform => Foveation { kind: FoveationKind::Off, rate_mid: 1, rate_far: 1, ..Foveation::default() },
            Self::Regions(r) => {
                let [fovea, mid] = r.diameters_deg.map(|d| d * r.radius_scale);
                of(fovea, mid, r.blocks.map(|b| b as f32))
            }
            Self::Layers(l) => {
                let [_, middle, coarse, coarsest] = l.steps.map(|s| s as f32);
                of(2.0 * l.radii_deg[0], 2.0 * l.radii_deg[2], [middle.max(coarse), coarsest])
            }
            Self::Acuity(a) => {
                let step = a.least.clamp(1.0 / 65536.0, 1.0).sqrt().recip();
                of(2.0 * a.fovea_deg, 4.0 * a.fovea_deg, [step, step])
            }
        }
    }

    /// Plan of frame `frame` for a gaze. `samples` is the number per pixel where sampling is densest, unless the
    /// pattern states its own.
    pub fn plan(&self, geometry: &ViewGeometry, gaze_px: [f32; 2], samples: u32, frame: u64) -> Plan {
        let size_px = geometry.size_px();
        // A gaze that is not finite means the centre of the frame. Distant gazes are clamped so that f32 resolves
        // distances to them.
        let middle = size_px.map(|s| 0.5 * (s as f32 - 1.0));
        let sound = gaze_px.iter().all(|g| g.is_finite());
        let gaze_px = if sound { gaze_px.map(|g| g.clamp(-1e6, 1e6)) } else { middle };
        let kind = match self {
            Self::Uniform => Kind::Rings(vec![Ring::everywhere(size_px, samples)]),
            Self::Regions(regions) => Kind::Rings(regions.rings(geometry)),
            Self::Layers(layers) => Kind::Rings(layers.rings(geometry, gaze_px, samples)),
            Self::Acuity(acuity) => {
                let (targets, lod) = acuity.targets(geometry, gaze_px, frame);
                Kind::Scattered { targets, samples, lod }
            }
        };
        Plan { size_px, gaze: Circle::around(gaze_px), kind }
    }
}

impl Plan {
    /// Number of samples of each ring.
    pub fn samples(&self) -> Vec<u64> {
        self.work().iter().map(Spans::len).collect()
    }

    /// Spans to trace for each ring, on its own lattice.
    pub fn work(&self) -> Vec<Spans> {
        match &self.kind {
            Kind::Rings(rings) => {
                let spans =
                    |(i, ring): (usize, &Ring)| Spans::of_runs(ring.targets(rings, i, self.gaze), 0..ring.samples);
                rings.iter().enumerate().map(spans).collect()
            }
            Kind::Scattered { targets, samples, .. } => vec![Spans::new(targets.iter().copied(), 0..*samples)],
        }
    }

    /// Sampled points, each in its ring's lattice coordinates.
    pub fn targets(&self) -> impl Iterator<Item = [u32; 2]> + '_ {
        let (rings, scattered): (&[Ring], &[[u32; 2]]) = match &self.kind {
            Kind::Rings(rings) => (rings, &[]),
            Kind::Scattered { targets, .. } => (&[], targets),
        };
        let of = move |(i, ring): (usize, &Ring)| points(ring.targets(rings, i, self.gaze));
        rings.iter().enumerate().flat_map(of).chain(scattered.iter().copied())
    }

    /// Traces the plan and reconstructs the full frame.
    pub fn trace(&self, tracer: &Tracer, world: &World, view: &View, frame: u64) -> FoveatedFrame {
        let work = self.work();
        let (mut samples, mut rays, mut nonfinite) = (vec![], 0, 0);
        let mut add = |view: &View, mut film: Film, work: &Spans| {
            tracer.trace(world, view, frame, work, &mut film);
            samples.push(work.len());
            (rays, nonfinite) = (rays + film.rays, nonfinite + film.nonfinite);
            film
        };
        let Blended { color, lod, noise } = match &self.kind {
            Kind::Rings(rings) => {
                let films: Vec<Film> = rings
                    .iter()
                    .zip(work.iter())
                    .map(|(ring, work)| {
                        let (first, size) = work.window();
                        add(&view.on_lattice(&ring.lattice), Film::window(first, size), work)
                    })
                    .collect();
                rings::blend(rings, &films, self.size_px, self.gaze)
            }
            Kind::Scattered { lod, .. } => {
                let film = add(view, Film::new(self.size_px), &work[0]);
                Blended { color: fill::pull_push(&film), lod: lod.clone(), noise: fill::noise_between(&film) }
            }
        };
        FoveatedFrame { color, lod, noise: Some(noise), samples, rays, nonfinite }
    }
}

/// Points of runs (columns, row).
fn points(runs: impl Iterator<Item = (Range<u32>, u32)>) -> impl Iterator<Item = [u32; 2]> {
    runs.flat_map(|(columns, y)| columns.map(move |x| [x, y]))
}

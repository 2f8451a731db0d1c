//! Foveated sampling: where a frame is sampled how densely for a gaze, and how the rest is filled in.
//!
//! A frame is traced on lattices: points a few pixels apart, in rings around the gaze. A tracer sees a lattice as a small frame of
//! its own ([`View::on_lattice`]) and traces a list of its points; nothing is done for the others.

mod acuity;
mod circle;
mod fill;
mod guided;
mod lattice;
mod layers;
mod regions;
mod rings;

pub use acuity::Acuity;
pub use lattice::Lattice;
pub use layers::Layers;
pub use regions::Regions;

use super::Tracer;
use super::film::Film;
use super::view::View;
use super::work::Spans;
use super::world::World;
use crate::frame::FoveatedFrame;
use afterimage::{Filter, Foveation, Image, ViewGeometry};
use rings::Ring;
use std::borrow::Cow;
use std::ops::Range;

/// How samples are spread over a frame.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Sampling {
    /// As many everywhere.
    #[default]
    Uniform,
    /// Three regions with blocks (Mohanto et al. 2023).
    Regions(Regions),
    /// Nested lattices with blend masks (thesis).
    Layers(Layers),
    /// As dense as the eye's cells, with another set of pixels every frame.
    Acuity(Acuity),
}

/// What a frame is to be sampled at: from the inside out.
#[derive(Clone, Debug)]
pub struct Plan {
    size_px: [u32; 2],
    gaze_px: [f32; 2],
    kind: Kind,
    /// Work of each ring, where it is not the same number of samples everywhere.
    guided: Option<Vec<Vec<Spans>>>,
}

/// Points on a lattice that a pattern samples as often.
struct Part {
    lattice: Lattice,
    targets: Vec<[u32; 2]>,
    samples: u32,
}

#[derive(Clone, Debug)]
enum Kind {
    Rings(Vec<Ring>),
    /// Pixels, one after the other by rows, and samples of each.
    Scattered {
        targets: Vec<[u32; 2]>,
        samples: u32,
        lod: Image<f32>,
    },
}

impl Sampling {
    /// The pattern as the post-process needs to know it: where full rate ends, and the coarsest it gets.
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
            Self::Uniform => Foveation { filter: Filter::Off, rate_mid: 1, rate_far: 1, ..Foveation::default() },
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

    /// The plan of frame number `frame` for a gaze; `samples` are those of a pixel where it is sampled most, unless the pattern
    /// states its own.
    pub fn plan(&self, geometry: &ViewGeometry, gaze_px: [f32; 2], samples: u32, frame: u64) -> Plan {
        let size_px = geometry.size_px();
        // A gaze that is no place is the middle; one far off is far off, at a distance that floats can tell.
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
        Plan { size_px, gaze_px, kind, guided: None }
    }
}

impl Plan {
    /// Number of samples it asks for, of each ring.
    pub fn samples(&self) -> Vec<u64> {
        self.work().iter().map(|ring| ring.iter().map(Spans::len).sum()).collect()
    }

    /// What is traced of each ring, on its own lattice.
    pub fn work(&self) -> Cow<'_, [Vec<Spans>]> {
        match &self.guided {
            Some(work) => work.into(),
            None => match &self.kind {
                Kind::Rings(rings) => {
                    let spans = |(i, ring): (usize, &Ring)| {
                        vec![Spans::of_runs(ring.targets(rings, i, self.gaze_px), 0..ring.samples)]
                    };
                    rings.iter().enumerate().map(spans).collect()
                }
                Kind::Scattered { targets, samples, .. } => {
                    vec![vec![Spans::new(targets.iter().copied(), 0..*samples)]].into()
                }
            },
        }
    }

    /// The pattern's rings.
    fn parts(&self) -> Vec<Part> {
        match &self.kind {
            Kind::Rings(rings) => {
                let part = |(i, ring): (usize, &Ring)| Part {
                    lattice: ring.lattice,
                    targets: points(ring.targets(rings, i, self.gaze_px)).collect(),
                    samples: ring.samples,
                };
                rings.iter().enumerate().map(part).collect()
            }
            Kind::Scattered { targets, samples, .. } => {
                let lattice = Lattice::blocks(1, self.size_px);
                vec![Part { lattice, targets: targets.clone(), samples: *samples }]
            }
        }
    }

    /// Points that are sampled, on each ring's own lattice.
    pub fn targets(&self) -> impl Iterator<Item = [u32; 2]> + '_ {
        let (rings, scattered): (&[Ring], &[[u32; 2]]) = match &self.kind {
            Kind::Rings(rings) => (rings, &[]),
            Kind::Scattered { targets, .. } => (&[], targets),
        };
        let of = move |(i, ring): (usize, &Ring)| points(ring.targets(rings, i, self.gaze_px));
        rings.iter().enumerate().flat_map(of).chain(scattered.iter().copied())
    }

    /// Traces it and fills in the rest.
    pub fn trace(&self, tracer: &Tracer, world: &World, view: &View, frame: u64) -> FoveatedFrame {
        let mut done = FoveatedFrame {
            color: Image::filled(self.size_px, [0.0; 3]),
            lod: Image::filled(self.size_px, 0.0),
            noise: Image::filled(self.size_px, [0.0; 2]),
            samples: vec![],
            rays: 0,
            nonfinite: 0,
        };
        let work = self.work();
        let mut add = |view: &View, mut film: Film, work: &[Spans]| {
            for spans in work {
                tracer.trace(world, view, frame, spans, &mut film);
            }
            done.samples.push(work.iter().map(Spans::len).sum());
            done.rays += film.rays;
            done.nonfinite += film.nonfinite;
            film
        };
        match &self.kind {
            Kind::Rings(rings) => {
                let films: Vec<Film> = rings
                    .iter()
                    .zip(work.iter())
                    .map(|(ring, work)| {
                        let (first, size) = Spans::window(work);
                        add(&view.on_lattice(&ring.lattice), Film::window(first, size), work)
                    })
                    .collect();
                (done.color, done.lod) = rings::blend(rings, &films, self.size_px, self.gaze_px);
                done.noise = rings::noise(rings, &films, self.size_px, self.gaze_px);
            }
            Kind::Scattered { lod, .. } => {
                let film = add(view, Film::new(self.size_px), &work[0]);
                done.color = fill::pull_push(&film);
                done.noise = fill::noise_between(&film);
                done.lod = lod.clone();
            }
        }
        done
    }
}

/// The points of runs.
fn points(runs: impl Iterator<Item = (Range<u32>, u32)>) -> impl Iterator<Item = [u32; 2]> {
    runs.flat_map(|(columns, y)| columns.map(move |x| [x, y]))
}

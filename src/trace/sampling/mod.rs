//! Foveated sampling: where a frame is sampled how densely for a gaze, and how the rest is filled in.
//!
//! A frame is traced on lattices: points a few pixels apart, in rings around the gaze. A tracer sees a lattice as a small frame of
//! its own ([`View::on_lattice`]) and traces a list of its points; nothing is done for the others.

mod acuity;
mod circle;
mod fill;
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
use crate::display::ViewGeometry;
use crate::image::Image;
use rings::Ring;

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

/// A frame sampled by a plan and filled in.
#[derive(Clone, Debug)]
pub struct FoveatedFrame {
    /// Linear radiance.
    pub color: Image<[f32; 3]>,
    /// Level of detail, log2 of the distance of samples in pixels.
    pub lod: Image<f32>,
    /// Samples of each ring.
    pub samples: Vec<u64>,
    /// Rays of all kinds.
    pub rays: u64,
    /// Samples that were not finite and count as black.
    pub nonfinite: u64,
}

impl Sampling {
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
        Plan { size_px, gaze_px, kind }
    }
}

impl Plan {
    /// Number of samples it asks for.
    pub fn samples(&self) -> Vec<u64> {
        match &self.kind {
            Kind::Rings(rings) => {
                let count =
                    |i: usize| rings[i].targets(rings, i, self.gaze_px).map(|(run, _)| run.len() as u64).sum::<u64>();
                (0..rings.len()).map(|i| count(i) * u64::from(rings[i].samples)).collect()
            }
            Kind::Scattered { targets, samples, .. } => vec![targets.len() as u64 * u64::from(*samples)],
        }
    }

    /// Points that are sampled, on each ring's own lattice.
    pub fn targets(&self) -> impl Iterator<Item = [u32; 2]> + '_ {
        let (rings, scattered): (&[Ring], &[[u32; 2]]) = match &self.kind {
            Kind::Rings(rings) => (rings, &[]),
            Kind::Scattered { targets, .. } => (&[], targets),
        };
        let of = move |(i, ring): (usize, &Ring)| {
            ring.targets(rings, i, self.gaze_px).flat_map(|(run, y)| run.map(move |x| [x, y]))
        };
        rings.iter().enumerate().flat_map(of).chain(scattered.iter().copied())
    }

    /// Traces it and fills in the rest.
    pub fn trace(&self, tracer: &Tracer, world: &World, view: &View, frame: u64) -> FoveatedFrame {
        let mut done = FoveatedFrame {
            color: Image::filled(self.size_px, [0.0; 3]),
            lod: Image::filled(self.size_px, 0.0),
            samples: vec![],
            rays: 0,
            nonfinite: 0,
        };
        let mut add = |view: &View, mut film: Film, spans: Spans| {
            tracer.trace(world, view, frame, &spans, &mut film);
            done.samples.push(spans.len());
            done.rays += film.rays;
            done.nonfinite += film.nonfinite;
            film
        };
        match &self.kind {
            Kind::Rings(rings) => {
                let films: Vec<Film> = rings
                    .iter()
                    .enumerate()
                    .map(|(i, ring)| {
                        let view = view.on_lattice(&ring.lattice);
                        let spans = Spans::of_runs(ring.targets(rings, i, self.gaze_px), 0..ring.samples);
                        let (first, size) = spans.window();
                        add(&view, Film::window(first, size), spans)
                    })
                    .collect();
                (done.color, done.lod) = rings::blend(rings, &films, self.size_px, self.gaze_px);
            }
            Kind::Scattered { targets, samples, lod } => {
                let spans = Spans::new(targets.iter().copied(), 0..*samples);
                let film = add(view, Film::new(self.size_px), spans);
                done.color = fill::pull_push(&film);
                done.lod = lod.clone();
            }
        }
        done
    }
}

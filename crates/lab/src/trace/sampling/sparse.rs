//! Samples of lattices that move every frame, given to the post-process in their places.

use super::lattice::Lattice;
use super::{Layers, Regions, Sampling};
use crate::frame::FoveatedFrame;
use crate::lattices::{SampleOrder, levels};
use crate::trace::Tracer;
use crate::trace::film::Film;
use crate::trace::view::View;
use crate::trace::work::Spans;
use crate::trace::world::World;
use afterimage::{Filter, Foveation, Image, Lattices, SettingsError, ViewGeometry};

/// Samples of a sparse frame: lattices of the post-process, and the number of samples a point.
///
/// A lattice covers the rectangle around its region, as a view that a renderer draws does. Each point is one pixel of
/// the full-rate frame: samples are spread over that pixel, not over the block.
#[derive(Clone, Debug, PartialEq)]
pub struct SparsePlan {
    size_px: [u32; 2],
    lattices: Lattices,
    /// Samples a point of each lattice.
    samples: Vec<u32>,
    /// Points of each lattice whose samples some pixel reads, ordered by row.
    points: Vec<Vec<[u32; 2]>>,
}

impl Sampling {
    /// Whether the samples of the pattern can lie on lattices of the post-process.
    ///
    /// # Errors
    /// [`SettingsError`] unless the pattern has lattices whose steps are ascending powers of two from 1 on, without a
    /// lens.
    pub fn check_sparse(&self) -> Result<(), SettingsError> {
        let refuse =
            |setting, found: String, expected: &str| Err(SettingsError { setting, found, expected: expected.into() });
        let (setting, steps) = match self {
            Self::Regions(r) => ("blocks of regions", vec![1, r.blocks[0], r.blocks[1]]),
            Self::Layers(Layers { lens_deg: Some(deg), .. }) => {
                return refuse(
                    "lens of layers",
                    format!("{deg} degrees"),
                    "none: a sparse frame covers the whole view",
                );
            }
            Self::Layers(l) => ("steps of layers", l.steps.to_vec()),
            Self::Uniform | Self::Acuity(_) => {
                let found = if *self == Self::Uniform { "uniform" } else { "acuity" };
                return refuse("sampling", found.into(), "regions or layers, whose samples lie on lattices");
            }
        };
        let ascends = steps.windows(2).all(|pair| pair[0] < pair[1]);
        let allowed = |&step: &u32| step.is_power_of_two() && step <= Foveation::MAX_RATE;
        if steps[0] != 1 || !ascends || !steps.iter().all(allowed) {
            let expected = format!("ascending powers of two, the first one 1, at most {}", Foveation::MAX_RATE);
            return refuse(setting, format!("{steps:?}"), &expected);
        }
        Ok(())
    }

    /// Plan of frame `frame` for a gaze, with lattices that move in `order`. `samples` is the number a point, unless
    /// the pattern states its own.
    ///
    /// # Errors
    /// As for [`check_sparse`](Self::check_sparse).
    pub fn sparse_plan(
        &self,
        geometry: &ViewGeometry,
        gaze_px: [f32; 2],
        samples: u32,
        frame: u64,
        order: SampleOrder,
    ) -> Result<SparsePlan, SettingsError> {
        self.check_sparse()?;
        let foveation = Foveation { filter: Filter::Sparse, ..self.foveation() };
        let mut stack = order.lattices(&foveation, geometry, gaze_px, frame).as_slice().to_vec();
        let mut samples = vec![samples; 4];
        match self {
            Self::Layers(Layers { radii_deg, steps, .. }) => {
                // A foveation has three regions: the second layer is the middle one of another foveation.
                let inner =
                    Foveation { mid_deg: 2.0 * radii_deg[1].max(radii_deg[0]), rate_mid: steps[1], ..foveation };
                let second = order.lattices(&inner, geometry, gaze_px, frame);
                let second = second.as_slice().iter().find(|lattice| lattice.step == steps[1]);
                let before = stack.iter().position(|lattice| lattice.step > steps[1]).unwrap_or(stack.len());
                stack.splice(before..before, second.copied());
            }
            Self::Regions(Regions { samples: of_regions, blocks, .. }) => {
                let of_step = |step| match step {
                    1 => of_regions[0],
                    _ if step == blocks[0] => of_regions[1],
                    _ => of_regions[2],
                };
                samples = stack.iter().map(|lattice| of_step(lattice.step)).collect();
            }
            Self::Uniform | Self::Acuity(_) => {}
        }
        samples.truncate(stack.len());
        Ok(SparsePlan::new(Lattices::new(&stack)?, samples, geometry.size_px()))
    }
}

impl SparsePlan {
    /// Plan for lattices that cover a frame of `size_px` pixels, with `samples` a point of each.
    pub fn new(lattices: Lattices, samples: Vec<u32>, size_px: [u32; 2]) -> Self {
        let stack = lattices.as_slice();
        let points = |(i, lattice): (usize, &afterimage::Lattice)| {
            let is_read = |px: [u32; 2]| {
                stack[..i].iter().all(|finer| {
                    let [low, high] = finer.covered_px();
                    // Pixels beside a finer lattice read samples at most a step inside it.
                    let inside = |k: usize| px[k] >= low[k] + lattice.step && px[k] + lattice.step < high[k];
                    !((inside(0) && inside(1)) || finer.samples(px))
                })
            };
            let [columns, rows] = lattice.points;
            let all = (0..rows).flat_map(|y| (0..columns).map(move |x| [x, y]));
            all.filter(|&point| {
                let px = px_of(lattice, point);
                px[0] < size_px[0] && px[1] < size_px[1] && is_read(px)
            })
            .collect()
        };
        let points = stack.iter().enumerate().map(points).collect();
        Self { size_px, lattices, samples, points }
    }

    /// The lattices.
    pub fn lattices(&self) -> &Lattices {
        &self.lattices
    }

    /// Number of samples of each lattice.
    pub fn samples(&self) -> Vec<u64> {
        self.points.iter().zip(&self.samples).map(|(points, &n)| points.len() as u64 * u64::from(n)).collect()
    }

    /// Pixels that are traced, each with its number of samples.
    pub fn pixels(&self) -> impl Iterator<Item = ([u32; 2], u32)> + '_ {
        let stack = self.lattices.as_slice().iter().zip(self.points.iter().zip(&self.samples));
        stack.flat_map(|(lattice, (points, &n))| points.iter().map(move |&point| (px_of(lattice, point), n)))
    }

    /// Traces the samples. Pixels without any are NaN: the post-process does not read them, and what did would show.
    /// Their noise is that of the nearest sample of their lattice.
    pub fn trace(&self, tracer: &Tracer, world: &World, view: &View, frame: u64) -> FoveatedFrame {
        let mut color = Image::filled(self.size_px, [f32::NAN; 3]);
        let mut noise = Image::filled(self.size_px, [0.0; 2]);
        let (mut rays, mut nonfinite) = (0, 0);
        let width = self.size_px[0] as usize;
        for (lattice, (points, &samples)) in self.lattices.as_slice().iter().zip(self.points.iter().zip(&self.samples))
        {
            let grid = Lattice {
                step: lattice.step,
                first_px: lattice.first_px.map(|v| v as f32),
                points: lattice.points,
                footprint_px: 1.0,
            };
            let work = Spans::new(points.iter().copied(), 0..samples);
            let (first, size) = Spans::window(std::slice::from_ref(&work));
            let mut film = Film::window(first, size);
            tracer.trace(world, &view.on_lattice(&grid), frame, &work, &mut film);
            (rays, nonfinite) = (rays + film.rays, nonfinite + film.nonfinite);
            for &point in points {
                let [x, y] = px_of(lattice, point).map(|v| v as usize);
                color.pixels_mut()[y * width + x] = film.at(point).mean.to_array();
                noise.pixels_mut()[y * width + x] = film.noise_at(point);
            }
        }
        let nearest = |px: [u32; 2]| {
            let Some(lattice) = self.lattices.at(px) else { return px };
            [0, 1].map(|i| {
                let inside = (self.size_px[i] - 1).saturating_sub(lattice.first_px[i]) / lattice.step;
                let steps = (px[i] as f32 - lattice.first_px[i] as f32) / lattice.step as f32;
                let point = (steps.round().max(0.0) as u32).min(inside).min(lattice.points[i] - 1);
                (lattice.first_px[i] + point * lattice.step).min(self.size_px[i] - 1)
            })
        };
        FoveatedFrame {
            color,
            lod: levels(&self.lattices, self.size_px),
            noise: Image::from_fn_parallel(self.size_px, |px| {
                let [x, y] = nearest(px);
                noise.at(x as usize, y as usize)
            }),
            lattices: Some(self.lattices),
            samples: self.samples(),
            rays,
            nonfinite,
        }
    }
}

/// Pixel of a point.
fn px_of(lattice: &afterimage::Lattice, point: [u32; 2]) -> [u32; 2] {
    [0, 1].map(|i| lattice.first_px[i] + point[i] * lattice.step)
}

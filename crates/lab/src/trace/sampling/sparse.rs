//! Samples of lattices that move every frame, given to the post-process in their places.

use super::lattice::Lattice;
use super::{Layers, Regions, Sampling};
use crate::frame::{DeviceSamples, FoveatedFrame};
use crate::lattices::{SampleOrder, Geometry, levels};
use crate::trace::Tracer;
use crate::trace::film::Film;
use crate::trace::gpu::{GpuTracer, SampledPoint};
use crate::trace::surfaces::Surfaces;
use crate::trace::view::View;
use crate::trace::work::Spans;
use crate::trace::world::World;
use afterimage::{Filter, Foveation, Image, Lattices, SettingsError, ViewGeometry};
use rayon::prelude::*;

/// Samples of a sparse frame: lattices of the post-process, and the number of samples a point.
///
/// A lattice covers the rectangle around its region, like a view that a renderer draws. Each point is one pixel of the
/// full-rate frame: samples are spread over that pixel, not over the block.
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
    /// lens. The last two regions may have equal steps: they then form one lattice, with the samples of the outer
    /// region.
    pub fn check_sparse(&self) -> Result<(), SettingsError> {
        let refuse =
            |setting, found: String, expected: &str| Err(SettingsError { setting, found, expected: expected.into() });
        let (setting, steps) = match self {
            // Equal blocks are one lattice.
            Self::Regions(Regions { blocks: [mid, far], .. }) if mid == far => ("blocks of regions", vec![1, *far]),
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
                // A foveation has only three regions. The second layer is therefore taken from another foveation, as
                // its middle region.
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
                    _ if step < blocks[1] => of_regions[1],
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

    /// Traces the samples. Pixels without samples are NaN. The post-process does not read them, and NaN shows any code
    /// that does. Such a pixel has the noise of the nearest sample of its lattice.
    pub fn trace(&self, tracer: &Tracer, world: &World, view: &View, frame: u64) -> FoveatedFrame {
        let mut color = Image::filled(self.size_px, [f32::NAN; 3]);
        let mut noise: Vec<Image<[f32; 2]>> = vec![];
        let (mut rays, mut nonfinite) = (0, 0);
        let width = self.size_px[0] as usize;
        for (i, lattice) in self.lattices.as_slice().iter().enumerate() {
            let film = self.film(i, tracer, world, view, frame);
            (rays, nonfinite) = (rays + film.rays, nonfinite + film.nonfinite);
            let mut of_points = self.finer_noise(i, &noise);
            for &[x, y] in &self.points[i] {
                let px = px_of(lattice, [x, y]).map(|v| v as usize);
                color.pixels_mut()[px[1] * width + px[0]] = film.at([x, y]).mean.to_array();
                of_points.pixels_mut()[(y * lattice.points[0] + x) as usize] = film.noise_at([x, y]);
            }
            noise.push(of_points);
        }
        FoveatedFrame {
            color,
            lod: levels(&self.lattices, self.size_px),
            noise: Some(self.noise(&noise)),
            lattices: Some(self.lattices),
            samples: self.samples(),
            rays,
            nonfinite,
        }
    }

    /// As [`trace`](Self::trace), with the samples left on the tracer's device: nothing is read back, and points of the
    /// lattices that are not traced are NaN. `views`: this frame's and the previous one's. Depth and motion at the
    /// samples come from rays on the CPU, in 64 bits, if `geometry` asks for them.
    pub fn trace_in_place(
        &self,
        tracer: &GpuTracer,
        world: &World,
        [view, previous]: [&View; 2],
        frame: u64,
        geometry: Geometry,
        samples: &mut DeviceSamples,
    ) {
        let surface_at = Surfaces::at_pixels(world, view, previous, tracer.effects());
        // Finer samples replace points of coarser lattices that are not traced.
        for (i, lattice) in self.lattices.as_slice().iter().enumerate().rev() {
            let sampled = |[x, y]: [u32; 2]| {
                let (depth, motion) = match geometry {
                    Geometry::Full => (0.0, [0.0; 2]),
                    Geometry::Samples => surface_at(px_of(lattice, [x, y])),
                };
                SampledPoint { point: x | y << 16, depth, motion }
            };
            let [columns, rows] = [0, 1].map(|i| {
                let in_view = self.size_px[i].saturating_sub(lattice.first_px[i]).div_ceil(lattice.step);
                lattice.points[i].min(in_view)
            });
            let all = (0..rows).into_par_iter().flat_map_iter(|y| (0..columns).map(move |x| [x, y]));
            let points: Vec<SampledPoint> = all.map(sampled).collect();
            let view = view.on_lattice(&grid(lattice));
            tracer.trace_in_place(world, &view, frame, &self.work(i), (lattice, &points), samples);
        }
        (samples.lattices, samples.samples) = (self.lattices, self.samples());
    }

    /// Traces the points of a lattice.
    fn film(&self, index: usize, tracer: &Tracer, world: &World, view: &View, frame: u64) -> Film {
        let work = self.work(index);
        let (first, size) = work.window();
        let mut film = Film::window(first, size);
        let view = view.on_lattice(&grid(&self.lattices.as_slice()[index]));
        tracer.trace(world, &view, frame, &work, &mut film);
        film
    }

    /// Samples of the points of a lattice.
    fn work(&self, index: usize) -> Spans {
        Spans::new(self.points[index].iter().copied(), 0..self.samples[index])
    }

    /// Noise of those points of a lattice at which a finer lattice has a sample; 0 at other points. `finer`: noise of
    /// the finer lattices' points.
    fn finer_noise(&self, index: usize, finer: &[Image<[f32; 2]>]) -> Image<[f32; 2]> {
        let stack = self.lattices.as_slice();
        let mut of_points = Image::filled(stack[index].points, [0.0; 2]);
        let columns = stack[index].points[0];
        for (lattice, noise) in stack.iter().zip(finer).rev() {
            // Only points within the finer lattice's rectangle are samples of it.
            let [low, high] = lattice.covered_px();
            let range = |i: usize| {
                let of = |px: u32| px.saturating_sub(stack[index].first_px[i]).div_ceil(stack[index].step);
                of(low[i])..of(high[i]).min(stack[index].points[i])
            };
            for (x, y) in range(1).flat_map(|y| range(0).map(move |x| (x, y))) {
                let px = px_of(&stack[index], [x, y]);
                if lattice.samples(px) {
                    let [x2, y2] = [0, 1].map(|i| ((px[i] - lattice.first_px[i]) / lattice.step) as usize);
                    of_points.pixels_mut()[(y * columns + x) as usize] = noise.at(x2, y2);
                }
            }
        }
        of_points
    }

    /// Noise of every pixel: its own noise if it was traced, else the noise of the nearest point of its lattice.
    /// `of_points`: noise of the points of each lattice.
    fn noise(&self, of_points: &[Image<[f32; 2]>]) -> Image<[f32; 2]> {
        let mut noise = self.spread(of_points);
        let width = self.size_px[0] as usize;
        for (lattice, (points, values)) in self.lattices.as_slice().iter().zip(self.points.iter().zip(of_points)) {
            for &[x, y] in points {
                let px = px_of(lattice, [x, y]).map(|v| v as usize);
                noise.pixels_mut()[px[1] * width + px[0]] = values.at(x as usize, y as usize);
            }
        }
        noise
    }

    /// Value of the nearest point of its lattice for each pixel. `of_points`: values of the points of each lattice.
    fn spread(&self, of_points: &[Image<[f32; 2]>]) -> Image<[f32; 2]> {
        let stack = self.lattices.as_slice();
        let columns: Vec<Vec<u32>> = stack.iter().map(|lattice| self.nearest(lattice, 0)).collect();
        let rows: Vec<Vec<u32>> = stack.iter().map(|lattice| self.nearest(lattice, 1)).collect();
        let mut spread = Image::filled(self.size_px, [0.0; 2]);
        let width = self.size_px[0].max(1) as usize;
        spread.pixels_mut().par_chunks_mut(width).enumerate().for_each(|(y, row)| {
            for (i, lattice) in stack.iter().enumerate().rev() {
                let [left, top] = lattice.covered_px()[0].map(|v| v as usize);
                let Some(&point) = y.checked_sub(top).and_then(|y| rows[i].get(y)) else { continue };
                let values = of_points[i].row(point as usize);
                for (pixel, &x) in row[left..].iter_mut().zip(&columns[i]) {
                    *pixel = values[x as usize];
                }
            }
        });
        spread
    }

    /// Index of the nearest point inside the view along an axis, for each pixel that a lattice covers.
    fn nearest(&self, lattice: &afterimage::Lattice, axis: usize) -> Vec<u32> {
        let [low, high] = lattice.covered_px().map(|v| v[axis]);
        let first = lattice.first_px[axis];
        let last = ((self.size_px[axis] - 1).saturating_sub(first) / lattice.step).min(lattice.points[axis] - 1);
        let of = |px: u32| (((px as f32 - first as f32) / lattice.step as f32).round().max(0.0) as u32).min(last);
        (low..high.min(self.size_px[axis])).map(of).collect()
    }
}

/// The lattice as the tracer sees it: samples are spread over one pixel.
fn grid(lattice: &afterimage::Lattice) -> Lattice {
    let first_px = lattice.first_px.map(|v| v as f32);
    Lattice { step: lattice.step, first_px, points: lattice.points, footprint_px: 1.0 }
}

/// Pixel of a point.
fn px_of(lattice: &afterimage::Lattice, point: [u32; 2]) -> [u32; 2] {
    [0, 1].map(|i| lattice.first_px[i] + point[i] * lattice.step)
}

//! Path tracer on the CPU: the reference for the GPU tracer, and the fallback without a GPU.

mod albedo;
mod lights;
mod path;
mod surface;
mod texture;

use super::film::{Film, Moments};
use super::settings::TraceSettings;
use super::work::Spans;
use super::world::World;
use afterimage::kernel::rng::{Purpose, path_draws, stream_key};
use afterimage_lab::kernel::direction::unit;
use afterimage_lab::scene::effects::Effects;
use afterimage_lab::view::View;
pub(crate) use albedo::albedo_along;
use glam::Vec3;
use path::{DRAWS_CAMERA, Paths};
use rayon::prelude::*;

/// Traces on all CPU threads. The image does not depend on their number.
#[derive(Clone, Copy, Debug)]
pub struct CpuTracer {
    settings: TraceSettings,
}

impl CpuTracer {
    /// A tracer with these settings.
    pub fn new(settings: TraceSettings) -> Self {
        Self { settings }
    }

    /// Effects that it simulates in `world`.
    pub fn effects(&self, world: &World) -> Effects {
        self.settings.effects.unwrap_or(world.needs)
    }

    /// Adds the samples of `work` to `film`, which must contain all its pixels. `frame` is the frame number; every
    /// frame has its own random draws.
    pub fn trace(&self, world: &World, view: &View, frame: u64, work: &Spans, film: &mut Film) {
        let paths = Paths {
            world,
            integrator: self.settings.integrator,
            bsdf: self.settings.bsdf,
            max_depth: self.settings.max_depth,
            effects: self.effects(world),
            key: path_key(self.settings.seed, frame),
        };
        let rays = view.rays();
        let (width, base) = (film.moments.size()[0], film.base());
        let moments = &film.moments;
        let pixels: Vec<u32> = work.each_pixel().collect();
        let done: Vec<PixelResult> = pixels
            .par_iter()
            .with_min_len(32)
            .map(|id| {
                let [x, y] = [id & 0xffff, id >> 16];
                let index = (y * width + x - base) as usize;
                let mut done = PixelResult { index, moments: moments.pixels()[index], rays: 0, nonfinite: 0 };
                for sample in work.samples() {
                    let draws = path_draws(*id, sample, DRAWS_CAMERA, paths.key);
                    let px = x as f32 + (draws[0] - 0.5) * rays.jitter;
                    let py = y as f32 + (draws[1] - 0.5) * rays.jitter;
                    let direction = unit(rays.corner + rays.right * px + rays.down * py);
                    let (radiance, traced) = paths.radiance(rays.origin, direction, *id, sample);
                    let sound = radiance.is_finite();
                    done.moments.add(if sound { radiance } else { Vec3::ZERO });
                    done.nonfinite += u64::from(!sound);
                    done.rays += traced;
                }
                done
            })
            .collect();
        for pixel in done {
            film.moments.pixels_mut()[pixel.index] = pixel.moments;
            film.rays += pixel.rays;
            film.nonfinite += pixel.nonfinite;
        }
    }
}

/// Result of one pixel.
struct PixelResult {
    index: usize,
    moments: Moments,
    rays: u64,
    nonfinite: u64,
}

/// Key of a frame's random draws.
pub(crate) fn path_key(seed: u64, frame: u64) -> u32 {
    // Path draws take no argument for the counter's low word, so it is mixed into the key.
    stream_key(seed, frame as u32, Purpose::Path, frame)
}

/// Alpha test with a fixed threshold: opacity above one half, or above the material's cutoff.
pub(super) fn is_half_opaque(world: &World, triangle: u32, u: f32, v: f32, effects: Effects) -> bool {
    surface::passes_alpha_test(world, triangle, u, v, 0.5, effects)
}

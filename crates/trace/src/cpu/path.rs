//! A light path, traced from the camera. `shaders/trace/shade_pass.wgsl` and the other passes do the same one step at a
//! time.

use super::lights::{LightSample, sample_light, sky, sky_pdf, triangle_pdf};
use super::surface::{SurfacePoint, lobes, passes_alpha_test, surface_point};
use crate::settings::{Bsdf, Integrator};
use crate::world::World;
use afterimage::kernel::approx::exp_approx;
use afterimage::kernel::rng::path_draws;
use afterimage_lab::kernel::bsdf::{Layers, Lobes, Sampled, Scatter, eval, layers, sample};
use afterimage_lab::kernel::direction::{to_local, to_world, unit};
use afterimage_lab::kernel::phong::{phong_eval, phong_sample};
use afterimage_lab::kernel::sampling::power_heuristic;
use afterimage_lab::kernel::triangle::offset_ray;
use afterimage_lab::rays::{Hit, Ray};
use afterimage_lab::scene::effects::{Effect, Effects};
use glam::Vec3;

/// Constants of all paths of a frame.
pub(super) struct Paths<'a> {
    pub world: &'a World,
    pub integrator: Integrator,
    pub bsdf: Bsdf,
    pub max_depth: u32,
    pub effects: Effects,
    pub key: u32,
}

/// Index of random draws: position within the pixel. Each decision of a path has draws of its own.
pub(super) const DRAWS_CAMERA: u32 = 0;
/// Index of random draws: scattered direction. This one and the next two are relative to the bounce.
const DRAWS_SCATTER: u32 = 1;
/// Index of random draws: light and point on it.
const DRAWS_LIGHT: u32 = 2;
/// Index of random draws: texel of the environment map.
const DRAWS_MAP: u32 = 3;
/// Increment of draw indices per bounce.
const DRAWS_STRIDE: u32 = 4;
/// Index of random draws: alpha test. The high bit keeps it apart from all others; the triangle index is mixed into the
/// key.
const DRAWS_ALPHA_TEST: u32 = 0x8000_0000;

/// State of a path between bounces.
struct State {
    ray: Ray,
    throughput: Vec3,
    /// Density of the ray's direction in 1/sr; 0 for camera rays.
    pdf: f32,
    /// Density in 1/sr with which light sampling would have chosen this direction of the environment.
    sky_pdf: f32,
}

impl Paths<'_> {
    /// Radiance arriving along `direction` (unit length), and the number of rays traced for it.
    pub fn radiance(&self, origin: Vec3, direction: Vec3, pixel: u32, sample: u32) -> (Vec3, u64) {
        let mut radiance = Vec3::ZERO;
        let mut rays = 0;
        let ray = Ray { origin, direction, t_max: f32::INFINITY };
        let mut state = State { ray, throughput: Vec3::ONE, pdf: 0.0, sky_pdf: 0.0 };
        for bounce in 0..=self.max_depth {
            rays += 1;
            let Some(hit) = self.closest(&state.ray, pixel, sample, 2 * bounce) else {
                radiance += state.throughput * self.sky_light(&state);
                break;
            };
            let p = surface_point(self.world, &hit, state.ray.direction, self.effects);
            if self.effects.has(Effect::Transmission) && !p.front {
                state.throughput *= (p.absorption * -hit.t).map(exp_approx);
            }
            radiance += state.throughput * self.surface_light(&state, &p, &hit);
            if bounce == self.max_depth {
                break;
            }
            let [x, y, z] = p.frame;
            let scattering = Scattering::new(self, &p, to_local(-state.ray.direction, x, y, z));
            let first = bounce * DRAWS_STRIDE;
            if self.integrator != Integrator::Naive {
                let draws = path_draws(pixel, sample, first + DRAWS_LIGHT, self.key);
                let more = path_draws(pixel, sample, first + DRAWS_MAP, self.key);
                if let Some((ray, light)) = self.direct_light(&p, &scattering, draws, more) {
                    rays += 1;
                    if !self.occluded(&ray, pixel, sample, 2 * bounce + 1) {
                        radiance += state.throughput * light;
                    }
                }
            }
            let sampled = scattering.sample(path_draws(pixel, sample, first + DRAWS_SCATTER, self.key));
            if sampled.scatter.pdf <= 0.0 {
                break;
            }
            let direction = unit(to_world(sampled.wi, x, y, z));
            let Some(origin) = spawn_origin(&p, direction, sampled.wi.z) else { break };
            state.throughput *= sampled.scatter.value / sampled.scatter.pdf;
            if !any_positive(state.throughput) {
                break;
            }
            state.ray = Ray { origin, direction, t_max: f32::INFINITY };
            state.pdf = sampled.scatter.pdf;
            state.sky_pdf = sky_pdf(self.world, direction, sampled.wi.z, self.effects);
        }
        (radiance, rays)
    }

    /// Nearest surface on a ray; `number` distinguishes the rays of a path in alpha tests.
    fn closest(&self, ray: &Ray, pixel: u32, sample: u32, number: u32) -> Option<Hit> {
        let accept = |t, u, v| self.accept_hit(t, u, v, pixel, sample, number);
        let geometry = &self.world.geometry;
        if self.effects.has(Effect::MovingObjects) {
            geometry.closest(ray, accept)
        } else {
            geometry.still.closest(ray, accept)
        }
    }

    fn occluded(&self, ray: &Ray, pixel: u32, sample: u32, number: u32) -> bool {
        let accept = |t, u, v| self.accept_hit(t, u, v, pixel, sample, number);
        let geometry = &self.world.geometry;
        if self.effects.has(Effect::MovingObjects) {
            geometry.occluded(ray, accept)
        } else {
            geometry.still.occluded(ray, accept)
        }
    }

    fn accept_hit(&self, triangle: u32, u: f32, v: f32, pixel: u32, sample: u32, number: u32) -> bool {
        if !self.effects.has(Effect::Alpha) {
            return true;
        }
        let draws = path_draws(pixel, sample, DRAWS_ALPHA_TEST | number, self.key ^ triangle);
        passes_alpha_test(self.world, triangle, u, v, draws[0], self.effects)
    }

    /// MIS weight of light that a scattered ray hits, given the density with which light sampling would have found it.
    fn mis_weight(&self, state: &State, light_pdf: f32) -> f32 {
        match self.integrator {
            _ if state.pdf <= 0.0 => 1.0,
            Integrator::Naive => 1.0,
            Integrator::Nee => 0.0,
            Integrator::Mis => power_heuristic(state.pdf, light_pdf),
        }
    }

    fn sky_light(&self, state: &State) -> Vec3 {
        if !self.effects.has(Effect::Environment) {
            return Vec3::ZERO;
        }
        sky(self.world, state.ray.direction, self.effects) * self.mis_weight(state, state.sky_pdf)
    }

    fn surface_light(&self, state: &State, p: &SurfacePoint, hit: &Hit) -> Vec3 {
        if !self.effects.has(Effect::EmissiveTriangles) || !any_positive(p.emitted) {
            return Vec3::ZERO;
        }
        let cosine = p.geometric.dot(state.ray.direction);
        p.emitted * self.mis_weight(state, triangle_pdf(self.world, hit.triangle, hit.t, cosine))
    }

    /// Shadow ray to a sampled light, and its contribution if unoccluded.
    fn direct_light(
        &self,
        p: &SurfacePoint,
        scattering: &Scattering,
        draws: [f32; 4],
        more: [f32; 4],
    ) -> Option<(Ray, Vec3)> {
        let sampled = sample_light(self.world, p.position, &p.frame, draws, more, self.effects)?;
        let [x, y, z] = p.frame;
        let wi = to_local(sampled.direction, x, y, z);
        let scatter = scattering.eval(wi);
        let mut weight = 1.0;
        if sampled.can_be_hit && self.integrator == Integrator::Mis {
            weight = power_heuristic(sampled.pdf, scatter.pdf);
        }
        let light = scatter.value * sampled.radiance * (weight / sampled.pdf);
        if !any_positive(light) {
            return None;
        }
        let origin = spawn_origin(p, sampled.direction, wi.z)?;
        Some((shadow_ray(origin, p.position, &sampled), light))
    }
}

/// Whether any channel is above 0; false for NaN.
fn any_positive(v: Vec3) -> bool {
    v.x.max(v.y.max(v.z)) > 0.0
}

/// Origin of a ray leaving `p` along `direction`, whose cosine to the shading normal is `cosine`. `None` where the
/// direction lies on different sides of the shading and of the geometric normal: light would leak through the surface.
fn spawn_origin(p: &SurfacePoint, direction: Vec3, cosine: f32) -> Option<Vec3> {
    let side = p.geometric.dot(direction);
    if side * cosine <= 0.0 {
        return None;
    }
    let normal = if side > 0.0 { p.geometric } else { -p.geometric };
    Some(offset_ray(p.position, normal, p.magnitude))
}

/// Shadow ray from `origin` to the light sampled from `position`. Both ends are offset from their surfaces, so the
/// segment meets neither. It ends slightly early to allow for rounding over its length.
fn shadow_ray(origin: Vec3, position: Vec3, light: &LightSample) -> Ray {
    if light.distance == f32::INFINITY {
        return Ray { origin, direction: light.direction, t_max: f32::INFINITY };
    }
    let to = light.direction * light.distance + (position - origin);
    Ray { origin, direction: unit(to), t_max: to.dot(to).sqrt() * SHADOW_RAY_SCALE }
}

/// Share of the distance to a light that the shadow ray covers.
const SHADOW_RAY_SCALE: f32 = 1.0 - 1.0 / 1_048_576.0;

/// Scattering at a surface point for the outgoing direction `wo`.
struct Scattering<'a> {
    point: &'a SurfacePoint,
    wo: Vec3,
    lobes: Lobes,
    /// `None` for Phong's model.
    layers: Option<Layers>,
}

impl<'a> Scattering<'a> {
    fn new(paths: &Paths, point: &'a SurfacePoint, wo: Vec3) -> Self {
        let lobes = lobes(paths.effects);
        let principled = paths.bsdf == Bsdf::Principled;
        let layers = principled.then(|| layers(&point.surface, wo, &paths.world.tables, lobes));
        Self { point, wo, lobes, layers }
    }

    fn eval(&self, wi: Vec3) -> Scatter {
        match &self.layers {
            Some(layers) => eval(layers, self.wo, wi, self.lobes),
            None => phong_eval(&self.point.phong, self.wo, wi),
        }
    }

    fn sample(&self, draws: [f32; 4]) -> Sampled {
        match &self.layers {
            Some(layers) => sample(layers, self.wo, draws, self.lobes),
            None => phong_sample(&self.point.phong, self.wo, [draws[0], draws[1], draws[2]]),
        }
    }
}

//! Exact, noise-free depth and motion at pixel centres, and albedo.

use super::cpu;
use super::settings::TraceSettings;
use super::world::World;
use afterimage::Image;
use afterimage_lab::kernel::direction::unit;
use afterimage_lab::rays::Ray;
use afterimage_lab::scene::effects::{Effect, Effects};
use afterimage_lab::view::View;
use glam::{DVec3, Vec3};

/// Distance and motion of the first surface at each pixel centre. Transmissive surfaces count; surfaces less than half
/// opaque do not.
#[derive(Clone, Debug)]
pub struct Surfaces {
    /// Distance along the view axis in metres; infinity where nothing is hit.
    pub depth: Image<f32>,
    /// Motion in pixels, y down, previous minus current position. Points behind the previous camera get a motion far
    /// off the frame.
    pub motion: Image<[f32; 2]>,
}

/// Rays of a pixel's albedo along each axis: it is a mean over the pixel, as the color is.
const ALBEDO_RAYS: u8 = 4;

/// Albedo of every pixel, linear: the reflectance that multiplies light, of the first surface that is neither a perfect
/// mirror nor clear glass, times their tints; 0 for the sky.
pub fn albedo(world: &World, view: &View, settings: &TraceSettings) -> Image<[f32; 3]> {
    let rays = view.rays();
    let offset = |i: u8| ((f32::from(i) + 0.5) / f32::from(ALBEDO_RAYS) - 0.5) * rays.jitter;
    let places = (0..ALBEDO_RAYS).flat_map(|j| (0..ALBEDO_RAYS).map(move |i| [offset(i), offset(j)]));
    let places: Vec<[f32; 2]> = places.collect();
    Image::from_fn_parallel(view.geometry().size_px(), |[x, y]| {
        let at = |[dx, dy]: &[f32; 2]| {
            let direction = unit(rays.corner + rays.right * (x as f32 + dx) + rays.down * (y as f32 + dy));
            cpu::albedo_along(world, rays.origin, direction, settings)
        };
        (places.iter().map(at).sum::<Vec3>() / places.len() as f32).to_array()
    })
}

/// Motion of points behind the previous camera, and the bound of all motion, in pixels.
const OFF_FRAME_PX: f32 = 1e6;

impl Surfaces {
    /// Traces `world` through `view`. `previous` is the previous frame's view, at the `previous_s` given to
    /// [`World::pose`].
    pub fn trace(world: &World, view: &View, previous: &View, effects: Effects) -> Self {
        let size = view.geometry().size_px();
        let at = Self::at_pixels(world, view, previous, effects);
        let pixels = Image::from_fn_parallel(size, at);
        Self { depth: pixels.map(|(depth, _)| depth), motion: pixels.map(|(_, motion)| motion) }
    }

    /// Distance and motion at a pixel, as a function: what [`trace`](Self::trace) computes for all pixels.
    pub fn at_pixels(
        world: &World,
        view: &View,
        previous: &View,
        effects: Effects,
    ) -> impl Fn([u32; 2]) -> (f32, [f32; 2]) + Sync {
        let rays = view.rays();
        move |[x, y]| {
            let px = [x as f32, y as f32];
            let direction = unit(rays.corner + rays.right * px[0] + rays.down * px[1]);
            let Some(seen) = first_surface(world, rays.origin, direction, effects) else {
                let before = previous.project_direction(direction.as_dvec3());
                return (f32::INFINITY, motion(px, before));
            };
            let depth = view.project(seen.current).map_or(f32::INFINITY, |(_, depth)| depth as f32);
            (depth, motion(px, previous.project(seen.previous).map(|(px, _)| px)))
        }
    }
}

/// Distance in metres from a point to the first surface in a direction, a unit vector; `None` if the ray hits no
/// surface.
pub fn distance_m(world: &World, from: DVec3, direction: DVec3) -> Option<f64> {
    let seen = first_surface(world, from.as_vec3(), unit(direction.as_vec3()), world.needs)?;
    Some(seen.current.distance(from))
}

/// World-space positions of a surface point, in this frame and in the previous one.
pub(super) struct SurfacePosition {
    pub current: DVec3,
    pub previous: DVec3,
}

/// First surface on a ray.
pub(super) fn first_surface(world: &World, origin: Vec3, direction: Vec3, effects: Effects) -> Option<SurfacePosition> {
    let ray = Ray { origin, direction, t_max: f32::INFINITY };
    let hit = world.geometry.closest(&ray, |triangle, u, v| {
        !effects.has(Effect::Alpha) || cpu::is_half_opaque(world, triangle, u, v, effects)
    })?;
    let corners = world.geometry.triangle(hit.triangle).positions();
    let previous = world.geometry.previous(hit.triangle).unwrap_or(corners);
    Some(SurfacePosition { current: at(corners, hit.u, hit.v), previous: at(previous, hit.u, hit.v) })
}

fn at(corners: [Vec3; 3], u: f32, v: f32) -> DVec3 {
    let [a, b, c] = corners.map(|p| p.as_dvec3());
    a + (b - a) * f64::from(u) + (c - a) * f64::from(v)
}

fn motion(px: [f32; 2], before: Option<[f64; 2]>) -> [f32; 2] {
    let off = [OFF_FRAME_PX; 2];
    before.map_or(off, |b| [0, 1].map(|i| ((b[i] - f64::from(px[i])) as f32).clamp(-OFF_FRAME_PX, OFF_FRAME_PX)))
}

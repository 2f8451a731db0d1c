//! Traversal cost: ray rates on the CPU against `obvhs`' own traversal, and build times.

use afterimage_lab::clock::Stopwatch;
use afterimage_lab::rays::{Bvh, Geometry, Hit, Ray};
use afterimage_lab::scene::Triangles;
use glam::{Vec3, Vec3A};
use obvhs::BvhBuildParams;
use obvhs::cwbvh::CwBvh;
use obvhs::cwbvh::builder::build_cwbvh_from_tris;
use obvhs::ray::RayHit;
use obvhs::rt_triangle::RtTriangle;
use obvhs::triangle::Triangle;

/// A ray count and the CPU time it took.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rate {
    /// Number of rays.
    pub rays: usize,
    /// Number of rays that hit something.
    pub hits: usize,
    /// CPU time of the process; wall time where the system reports none.
    pub cpu_ms: f64,
}

impl Rate {
    /// Million rays per second on one core.
    pub fn mrays(&self) -> f64 {
        self.rays as f64 / self.cpu_ms * 1e-3
    }
}

/// Runs `work` and returns its CPU time in milliseconds; wall time where the system reports none.
pub fn cpu_ms<T>(work: impl FnOnce() -> T) -> (T, f64) {
    let watch = Stopwatch::start();
    let result = work();
    (result, watch.cpu_ms().unwrap_or_else(|| watch.wall_ms()))
}

/// Nearest hits on one CPU thread.
pub fn closest(geometry: &Geometry, rays: &[Ray]) -> (Vec<Option<Hit>>, Rate) {
    let (hits, cpu_ms) = cpu_ms(|| rays.iter().map(|r| geometry.closest(r, |_, _, _| true)).collect::<Vec<_>>());
    let rate = Rate { rays: rays.len(), hits: hits.iter().flatten().count(), cpu_ms };
    (hits, rate)
}

/// Occlusion queries on one CPU thread.
pub fn occluded(geometry: &Geometry, rays: &[Ray]) -> Rate {
    let (hits, cpu_ms) = cpu_ms(|| rays.iter().filter(|r| geometry.occluded(r, |_, _, _| true)).count());
    Rate { rays: rays.len(), hits, cpu_ms }
}

/// Triangles in `obvhs`' own hierarchy and intersection format, for comparison.
pub struct Obvhs {
    bvh: CwBvh,
    triangles: Vec<RtTriangle>,
    /// CPU time of the build in milliseconds.
    pub build_ms: f64,
}

impl Obvhs {
    /// Builds with `obvhs`' own builder.
    pub fn build(triangles: &Triangles, params: BvhBuildParams) -> Self {
        let soup: Vec<Triangle> = triangles.positions.iter().map(of_obvhs).collect();
        let (bvh, build_ms) = cpu_ms(|| build_cwbvh_from_tris(&soup, params, &mut Default::default()));
        let triangles = bvh.primitive_indices.iter().map(|&i| RtTriangle::from(&soup[i as usize])).collect();
        Self { bvh, triangles, build_ms }
    }

    /// Shares the nodes of `bvh`, so that only the traversal differs.
    pub fn sharing(bvh: &Bvh) -> Self {
        let nodes = CwBvh { nodes: bvh.nodes().to_vec(), ..CwBvh::default() };
        let triangles = bvh.triangles().iter().map(|t| RtTriangle::from(&of_obvhs(&t.positions()))).collect();
        Self { bvh: nodes, triangles, build_ms: 0.0 }
    }

    /// Nearest hits on one CPU thread.
    pub fn closest(&self, rays: &[Ray]) -> Rate {
        let (hits, cpu_ms) = cpu_ms(|| {
            let hit = |r: &&Ray| {
                let ray = obvhs::ray::Ray::new(r.origin.into(), r.direction.into(), 0.0, r.t_max);
                self.bvh.ray_traverse(ray, &mut RayHit::none(), |ray, i| self.triangles[i].intersect(ray))
            };
            rays.iter().filter(hit).count()
        });
        Rate { rays: rays.len(), hits, cpu_ms }
    }
}

fn of_obvhs(corners: &[Vec3; 3]) -> Triangle {
    let [v0, v1, v2] = corners.map(Vec3A::from);
    Triangle { v0, v1, v2 }
}

/// One ray through each pixel centre of a pinhole camera, in row order.
pub fn primary_rays(size: [u32; 2], eye: Vec3, target: Vec3, fov_y_deg: f32) -> Vec<Ray> {
    let forward = (target - eye).normalize();
    let right = forward.cross(Vec3::Y).normalize();
    let up = right.cross(forward);
    let half = (0.5 * fov_y_deg).to_radians().tan();
    let [width, height] = size.map(|n| n as f32);
    let pixel = |x: u32, y: u32| {
        let (x, y) = ((2.0 * x as f32 + 1.0 - width) / height, (height - 2.0 * y as f32 - 1.0) / height);
        let direction = (forward + right * (x * half) + up * (y * half)).normalize();
        Ray { origin: eye, direction, t_max: f32::INFINITY }
    };
    (0..size[1]).flat_map(|y| (0..size[0]).map(move |x| (x, y))).map(|(x, y)| pixel(x, y)).collect()
}

/// A cosine-distributed ray from each hit into the half space above its surface, as paths continue after their first
/// hit.
pub fn bounce_rays(geometry: &Geometry, rays: &[Ray], hits: &[Option<Hit>]) -> Vec<Ray> {
    use afterimage::kernel::rng::{pcg4d, unit_draw};
    use afterimage_lab::kernel::triangle::{magnitude, offset_ray, point_at};
    let bounce = |(i, (ray, hit)): (usize, (&Ray, &Option<Hit>))| {
        let hit = (*hit)?;
        let [a, b, c] = geometry.triangle(hit.triangle).positions();
        let flat = (b - a).cross(c - a).normalize_or(Vec3::Y);
        let normal = if flat.dot(ray.direction) > 0.0 { -flat } else { flat };
        let [p, q, _, _] = pcg4d([i as u32, 0, 0, 1]).map(unit_draw);
        let (angle, z) = (p * std::f32::consts::TAU, 1.0 - 2.0 * q);
        let ring = (1.0 - z * z).max(0.0).sqrt();
        let on_sphere = Vec3::new(ring * angle.cos(), ring * angle.sin(), z);
        let origin = offset_ray(point_at(a, b, c, hit.u, hit.v), normal, magnitude(a, b, c));
        Some(Ray { origin, direction: (normal + on_sphere).normalize_or(normal), t_max: f32::INFINITY })
    };
    rays.iter().zip(hits).enumerate().filter_map(bounce).collect()
}

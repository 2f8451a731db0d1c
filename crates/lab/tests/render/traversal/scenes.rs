//! Triangles and rays for the traversal tests.

use afterimage_lab::kernel::triangle::{Intersection, intersect, shear};
use afterimage_lab::rays::{Bvh, Hit, Ray};
use afterimage_lab::scene::Triangles;
use afterimage_testing::Draws;
use glam::{Vec2, Vec3, Vec3A, Vec4, vec3};

/// Accepts every hit.
pub fn all(_: u32, _: f32, _: f32) -> bool {
    true
}

/// Random point in the cube of half width `half`.
pub fn point(d: &mut Draws, half: f32) -> Vec3 {
    vec3(d.range(-half, half), d.range(-half, half), d.range(-half, half))
}

/// Random direction, uniform over the sphere.
pub fn direction(d: &mut Draws) -> Vec3 {
    loop {
        let p = point(d, 1.0);
        if (0.01..1.0).contains(&p.length_squared()) {
            return p.normalize();
        }
    }
}

/// Numbers of triangles, and the cubes that they are in: center and half width.
pub const SOUPS: [(usize, Vec3, f32); 10] = [
    (0, Vec3::ZERO, 1.0),
    (1, Vec3::ZERO, 1.0),
    (2, Vec3::ZERO, 1.0),
    (7, Vec3::ZERO, 1.0),
    (3000, Vec3::ZERO, 1.0),
    (3000, vec3(3.0, -40.0, 7.0), 10.0),
    (500, Vec3::splat(1e6), 30.0),
    (500, Vec3::ZERO, 1e-3),
    (500, Vec3::splat(1.0), 1e-3),
    (500, Vec3::ZERO, 1e6),
];

/// Random triangles around `center`, with sizes from `half` down to a thousandth of it.
pub fn soup(name: &str, count: usize, center: Vec3, half: f32) -> Triangles {
    let mut d = Draws::new(name);
    let mut triangles = Triangles::default();
    for _ in 0..count {
        let at = center + point(&mut d, half);
        let size = half * 10_f32.powf(d.range(-3.0, 0.0));
        triangles.push_flat([0; 3].map(|_| at + point(&mut d, size)), 0);
    }
    triangles
}

/// The same around the origin with random attributes, of two materials in turn.
pub fn dressed(name: &str, count: u32) -> Triangles {
    let mut d = Draws::new(name);
    let mut triangles = soup(name, count as usize, Vec3::ZERO, 1.0);
    for i in 0..count as usize {
        triangles.normals[i] = [0; 3].map(|_| direction(&mut d));
        triangles.tangents[i] =
            [0; 3].map(|_| direction(&mut d).extend(if d.bits().is_multiple_of(2) { 1.0 } else { -1.0 }));
        triangles.uvs[i] = [0; 3].map(|_| Vec2::new(d.range(-9.0, 9.0), d.range(-9.0, 9.0)));
        triangles.colors[i] = [0; 3].map(|_| Vec4::new(d.uniform(), d.uniform(), d.uniform(), d.uniform()));
        triangles.materials[i] = i as u32 % 2;
    }
    triangles
}

/// Random rays from inside and around the cube of half width `half`; every fourth is axis-parallel, with zeros of both
/// signs.
pub fn rays(name: &str, count: usize, center: Vec3, half: f32) -> Vec<Ray> {
    let mut d = Draws::new(name);
    let axes = [
        vec3(1.0, 0.0, 0.0),
        vec3(-1.0, -0.0, 0.0),
        vec3(0.0, 1.0, -0.0),
        vec3(-0.0, -1.0, -0.0),
        vec3(0.0, -0.0, 1.0),
        vec3(0.0, 0.0, -1.0),
        vec3(0.6, 0.8, 0.0),
        vec3(-0.0, 0.6, -0.8),
    ];
    let ray = |i: usize| {
        let direction = if i.is_multiple_of(4) { axes[i / 4 % axes.len()] } else { direction(&mut d) };
        Ray { origin: center + point(&mut d, 1.5 * half), direction, t_max: f32::INFINITY }
    };
    (0..count).map(ray).collect()
}

/// Nearest hit by brute force over a hierarchy's triangles, with the same triangle test.
pub fn nearest(bvh: &Bvh, ray: &Ray) -> Option<Hit> {
    let shear = shear(ray.direction);
    let mut best = Hit { triangle: u32::MAX, t: ray.t_max, u: 0.0, v: 0.0 };
    for (i, triangle) in bvh.triangles().iter().enumerate() {
        let [a, b, c] = triangle.positions().map(Vec3A::from);
        let Intersection { t, u, v } = intersect(shear, ray.origin.into(), a, b, c);
        if t > 0.0 && t < best.t {
            best = Hit { triangle: i as u32, t, u, v };
        }
    }
    (best.triangle != u32::MAX).then_some(best)
}

/// Number of rays whose nearest hits are not those of brute force.
pub fn differing(bvh: &Bvh, rays: &[Ray]) -> usize {
    rays.iter().filter(|ray| bvh.closest(ray, all) != nearest(bvh, ray)).count()
}

/// A closed sphere of `8 * 4^levels` triangles with bit-identical shared corners.
pub fn sphere(center: Vec3, radius: f32, levels: u32) -> Triangles {
    let mut faces = vec![];
    for (x, y, z) in
        [(1, 1, 1), (-1, 1, 1), (-1, -1, 1), (1, -1, 1), (1, 1, -1), (-1, 1, -1), (-1, -1, -1), (1, -1, -1)]
    {
        let corners = [Vec3::X * x as f32, Vec3::Y * y as f32, Vec3::Z * z as f32];
        faces.push(if x * y * z > 0 { corners } else { [corners[0], corners[2], corners[1]] });
    }
    for _ in 0..levels {
        let halves = |[a, b, c]: [Vec3; 3]| {
            // Addition is commutative, so neighbouring triangles compute the same bits.
            let middle = |p: Vec3, q: Vec3| (p + q).normalize();
            let (ab, bc, ca) = (middle(a, b), middle(b, c), middle(c, a));
            [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
        };
        faces = faces.into_iter().flat_map(halves).collect();
    }
    let mut triangles = Triangles::default();
    for face in faces {
        triangles.push_flat(face.map(|p| center + p * radius), 0);
    }
    triangles
}

/// Rays that cannot hit anything: not finite, or without a direction or limit.
pub fn no_rays() -> Vec<Ray> {
    let mut out = vec![Ray { origin: Vec3::ZERO, direction: Vec3::X, t_max: f32::NAN }];
    for (origin, direction) in [
        (Vec3::NAN, Vec3::X),
        (Vec3::ZERO, Vec3::NAN),
        (Vec3::ZERO, Vec3::ZERO),
        (Vec3::INFINITY, Vec3::X),
        (Vec3::ZERO, vec3(f32::INFINITY, 0.0, 0.0)),
    ] {
        out.extend([f32::INFINITY, 1.0, 0.0, -1.0, f32::NAN].map(|t_max| Ray { origin, direction, t_max }));
    }
    out
}

//! H80: no ray leaves a closed surface.

use super::scenes::{all, direction, point, sphere};
use afterimage_lab::rays::{Bvh, Ray};
use afterimage_testing::{Draws, holds};
use glam::{Vec3, vec3};

/// Directions exactly through corners and edges, including axes and axis planes with zeros of both signs.
fn directions(bvh: &Bvh, center: Vec3, name: &str, count: usize) -> Vec<Vec3> {
    let mut d = Draws::new(name);
    let mut out: Vec<Vec3> = (0..count).map(|_| direction(&mut d)).collect();
    for zero in [0.0, -0.0] {
        for (one, other) in [(1.0, zero), (1.0, -zero), (-1.0, zero), (-1.0, -zero)] {
            out.extend([vec3(one, other, zero), vec3(zero, one, other), vec3(other, zero, one)]);
        }
        for _ in 0..count / 40 {
            let [x, y] = direction(&mut d).truncate().normalize().to_array();
            out.extend([vec3(x, y, zero), vec3(zero, x, y), vec3(y, zero, x)]);
            // Nearly parallel to an axis plane.
            let least = 10_f32.powf(d.range(-40.0, -4.0));
            out.extend([vec3(x, y, least), vec3(-least, x, y), vec3(y, least, -x)]);
        }
    }
    let step = (bvh.triangles().len() / 30_000).max(1);
    for triangle in bvh.triangles().iter().step_by(step) {
        let [a, b, c] = triangle.positions().map(|p| p - center);
        let share = d.range(0.0, 1.0);
        out.extend([a, (a + b) * 0.5, b + (c - b) * share]);
    }
    out
}

fn holes(bvh: &Bvh, origin: Vec3, directions: &[Vec3]) -> usize {
    let ray = |&direction: &Vec3| Ray { origin, direction, t_max: f32::INFINITY };
    directions.iter().filter(|d| bvh.closest(&ray(d), all).is_none() || !bvh.occluded(&ray(d), all)).count()
}

#[test]
fn h80_a_closed_sphere_of_a_million_triangles_has_no_holes() {
    let bvh = Bvh::build(&sphere(Vec3::ZERO, 1.0, 9), None, &[]);
    println!("{} triangles, {} nodes", bvh.triangles().len(), bvh.node_count());
    assert!(bvh.triangles().len() > 1_000_000);
    let mut d = Draws::new("inside");
    let directions = directions(&bvh, Vec3::ZERO, "million", 200_000);
    for origin in [Vec3::ZERO, Vec3::X * 0.999, point(&mut d, 0.5), point(&mut d, 0.5)] {
        assert_eq!(holes(&bvh, origin, &directions), 0, "from {origin}, {} rays", directions.len());
    }
    let (triangles, rays) = (bvh.triangles().len(), 4 * directions.len());
    let among = "axes, edges, corners and zeros of both signs among them";
    holds!("H80", Cpu, "closed sphere of {triangles} triangles: 0 holes in {rays} rays, {among}");
}

#[test]
fn h80_h82_spheres_of_all_sizes_and_places_have_no_holes() {
    for (center, radius) in [
        (Vec3::splat(1e6), 1000.0),
        (Vec3::splat(1e6), 10.0),
        (Vec3::ZERO, 1e-3),
        (vec3(1.0, -2.0, 3.0), 1e-3),
        (Vec3::ZERO, 1e6),
        (Vec3::ZERO, 1e-6),
    ] {
        let bvh = Bvh::build(&sphere(center, radius, 5), None, &[]);
        let directions = directions(&bvh, center, &format!("{center} {radius}"), 40_000);
        let mut d = Draws::new("places");
        for i in 0..3 {
            let origin = center + point(&mut d, 0.25 * i as f32) * radius;
            assert_eq!(holes(&bvh, origin, &directions), 0, "radius {radius} around {center}, from {origin}");
        }
    }
}

#[test]
fn h80_rays_from_afar_through_corners_of_a_closed_fan_hit() {
    // Corners of a regular fan, hit from 1 to 10,000 m: every spoke and the hub.
    let mut triangles = afterimage_lab::scene::Triangles::default();
    let rim = |i: u32| {
        let a = i as f32 / 64.0 * std::f32::consts::TAU;
        vec3(a.cos(), a.sin(), 0.25 * (3.0 * a).sin())
    };
    for i in 0..64 {
        triangles.push_flat([Vec3::ZERO, rim(i), rim((i + 1) % 64)], 0);
    }
    let bvh = Bvh::build(&triangles, None, &[]);
    let mut d = Draws::new("fan");
    for _ in 0..20_000 {
        let distance = 10_f32.powf(d.range(0.0, 4.0));
        let mut origin = direction(&mut d) * distance;
        origin.z = origin.z.abs() + distance;
        let target = rim((d.range(0.0, 63.9)) as u32) * if d.range(0.0, 1.0) < 0.2 { 0.0 } else { d.range(0.0, 0.9) };
        let ray = Ray { origin, direction: (target - origin).normalize(), t_max: f32::INFINITY };
        assert!(bvh.closest(&ray, all).is_some(), "from {origin} to {target}");
    }
}

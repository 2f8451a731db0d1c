//! H82: a ray leaving a surface does not hit it again, and its origin is offset by no more than the stated bound.

use super::scenes::{all, direction, point, sphere};
use afterimage_lab::kernel::triangle::{ORIGIN_OFFSET, magnitude, offset_ray, point_at};
use afterimage_lab::rays::{Bvh, Ray};
use afterimage_lab::scene::Triangles;
use afterimage_testing::{Draws, holds};
use glam::{Vec3, vec3};

/// Checks that no ray that leaves a convex or flat surface to the outside hits it; returns their number.
#[track_caller]
fn nothing_is_stopped(name: &str, triangles: &Triangles, outside: impl Fn(Vec3) -> Vec3) -> usize {
    let bvh = Bvh::build(triangles, None, &[]);
    let mut d = Draws::new(name);
    let (mut count, mut rays) = (0, 0);
    for i in 0..40_000 {
        let triangle = &bvh.triangles()[i % bvh.triangles().len()];
        let [a, b, c] = triangle.positions();
        let (u, v) = (d.range(0.0, 1.0), d.range(0.0, 1.0));
        let (u, v) = if u + v > 1.0 { (1.0 - u, 1.0 - v) } else { (u, v) };
        let hit = point_at(a, b, c, u, v);
        let flat = (b - a).cross(c - a).normalize();
        let normal = if flat.dot(outside(hit)) < 0.0 { -flat } else { flat };
        let largest = magnitude(a, b, c);
        let origin = offset_ray(hit, normal, largest);
        // The offset, plus three roundings at the size of the largest coordinate.
        assert!((origin - hit).length() <= largest * (ORIGIN_OFFSET + 3.0 * f32::EPSILON), "{origin} from {hit}");
        let mut direction = direction(&mut d);
        // Includes grazing directions, down to a cosine of 1e-3.
        let above = direction.dot(normal);
        let cosine = if i % 2 == 0 { 1e-3 } else { above.abs().max(1e-3) };
        direction = (direction + normal * (cosine - above)).normalize();
        rays += 1;
        count += usize::from(bvh.occluded(&Ray { origin, direction, t_max: f32::INFINITY }, all));
    }
    println!("{name}: {count} of {rays} stopped");
    assert_eq!(count, 0, "{name}");
    rays
}

fn grid(center: Vec3, step: f32, x: Vec3, y: Vec3) -> Triangles {
    let mut triangles = Triangles::default();
    for i in -20..20 {
        for j in -20..20 {
            let at = |i: i32, j: i32| center + x * (i as f32 * step) + y * (j as f32 * step);
            triangles.push_quad([at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)], 0);
        }
    }
    triangles
}

#[test]
fn h82_flat_ground_does_not_stop_what_leaves_it() {
    let mut left = 0;
    for (center, step) in [
        (Vec3::ZERO, 1.0),
        (Vec3::ZERO, 1e-3),
        (vec3(0.0, 5.0, 0.0), 1e-3),
        (vec3(1e6, 7.0, -1e6), 1.0),
        (Vec3::splat(1e6), 10.0),
    ] {
        let ground = grid(center, step, Vec3::X, Vec3::Z);
        left += nothing_is_stopped(&format!("{center} {step}"), &ground, |_| Vec3::Y);
    }
    let bound = "offset at most 2^-18 of the largest coordinate";
    holds!("H82", Cpu, "0 of {left} rays stopped that leave flat ground, down to 1e-3 m and out to 1e6 m; {bound}");
}

#[test]
fn h82_tilted_ground_and_spheres_of_a_millimetre_do_not_stop_what_leaves_them() {
    // Corners on a slope of simple numbers are exact, so the ground is flat in f32, too.
    let (x, y) = (vec3(1.0, 0.5, 0.0), vec3(0.0, 0.25, 1.0));
    for (center, step) in [(Vec3::ZERO, 1.0), (Vec3::ZERO, 1.0 / 1024.0), (Vec3::splat(1_048_576.0), 4.0)] {
        nothing_is_stopped(&format!("slope {center} {step}"), &grid(center, step, x, y), |_| Vec3::Y);
    }
    for radius in [1e-3, 1.0] {
        nothing_is_stopped(&format!("sphere {radius}"), &sphere(Vec3::ZERO, radius, 4), |p| p);
    }
}

#[test]
fn without_the_offset_rays_are_stopped() {
    let triangles = grid(vec3(3.0, 5.0, 0.3), 0.37, vec3(1.0, 0.3, 0.1), vec3(0.2, 0.4, 1.0));
    let bvh = Bvh::build(&triangles, None, &[]);
    let mut d = Draws::new("no offset");
    let mut count = 0;
    for i in 0..10_000 {
        let [a, b, c] = bvh.triangles()[i % bvh.triangles().len()].positions();
        let origin = point_at(a, b, c, d.range(0.0, 0.5), d.range(0.0, 0.5));
        let normal = (b - a).cross(c - a).normalize();
        let direction = (normal * normal.y.signum() + point(&mut d, 0.9)).normalize();
        count += usize::from(bvh.occluded(&Ray { origin, direction, t_max: f32::INFINITY }, all));
    }
    println!("{count} of 10000 stopped");
    assert!(count > 100, "planted error not caught");
}

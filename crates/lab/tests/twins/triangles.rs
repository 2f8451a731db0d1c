//! Probes of intersection and direction functions.

use crate::probe::{Probe, probe};
use crate::scattering::{put, put_all};
use crate::shape::*;
use crate::values::*;
use afterimage_lab::kernel::octahedral;
use afterimage_lab::kernel::triangle::{self, Shear};
use afterimage_testing::Draws;
use glam::{Vec3, Vec3A};

fn vector(d: &mut Draws, size: f32) -> Vec3 {
    Vec3::new(d.range(-size, size), d.range(-size, size), d.range(-size, size))
}

/// A ray, and a distant triangle as small as the rounding error at its distance: edge signs are random.
fn ray_and_speck(d: &mut Draws, row: &mut Vec<u32>) {
    let (at, direction) = (vector(d, 1.0), vector(d, 1.0).normalize_or(Vec3::X));
    let shear = triangle::shear(direction);
    let corners = [0; 3].map(|_| at + vector(d, 3e-7));
    put_all(row, [shear.x, shear.y, shear.z, vector(d, 1e-3).into()].into_iter().chain(corners.map(Vec3A::from)));
}

/// A ray and a triangle that it hits in the middle, at an edge, at a corner, or just misses.
fn ray_and_triangle(d: &mut Draws, row: &mut Vec<u32>) {
    let corners = [0; 3].map(|_| vector(d, 1.0));
    let distance = 10_f32.powf(d.range(-2.0, 3.0));
    let origin = vector(d, 1.0) * distance;
    let [u, v] = match d.bits() % 4 {
        0 => [0.0, d.range(-0.1, 1.1)],
        1 => [0.0, 0.0],
        _ => [d.range(-0.1, 0.6), d.range(-0.1, 0.6)],
    };
    let target = triangle::point_at(corners[0], corners[1], corners[2], u, v);
    let mut direction = (target - origin).normalize_or(Vec3::X);
    if d.bits().is_multiple_of(8) {
        direction[(d.bits() % 3) as usize] = 0.0;
    }
    let shear = triangle::shear(direction.normalize_or(Vec3::Y));
    put_all(row, [shear.x, shear.y, shear.z, origin.into()].into_iter().chain(corners.map(Vec3A::from)));
}

shape!(Shear { x: Vec3A, y: Vec3A, z: Vec3A });
shape!(triangle::Intersection { t: f32, u: f32, v: f32 });

pub const PROBES: &[Probe] = &[
    probe!(triangle::shear, |rows| {
        let axis = floats(&[1.0, -1.0, 0.5, -0.25, 1e-3]);
        rows.cross(&[&axis, &axis, &axis]).random(|d, row| put(row, vector(d, 1.0)))
    }),
    probe!(triangle::sheared, |rows| {
        rows.random(|d, row| {
            let shear = triangle::shear(vector(d, 1.0).normalize_or(Vec3::X));
            put_all(row, [shear.x, shear.y, shear.z, vector(d, 10.0).into()]);
        })
    }),
    probe!(
        triangle::edge,
        |a: Vec3A, b: Vec3A| {
            // The sign of a zero may differ.
            let e = triangle::edge(a, b);
            (e.abs(), e < 0.0)
        },
        "let e = edge($0, $1); out_f(abs(e)); out_b(e < 0.0);",
        |rows| {
            rows.random(|d, row| {
                let a = vector(d, 1.0);
                let b = if d.bits().is_multiple_of(2) { a * d.range(-2.0, 2.0) } else { vector(d, 1.0) };
                put_all(row, [a, b]);
            })
        }
    ),
    probe!(triangle::intersect, |rows| {
        rows.random(ray_and_triangle).random_of("specks", ray_and_speck).random_of("alike corners", |d, row| {
            ray_and_triangle(d, row);
            let start = row.len() - 9;
            let (to, from) = (d.bits() as usize % 3, d.bits() as usize % 3);
            let corner = row[start + 3 * from..][..3].to_vec();
            row[start + 3 * to..][..3].copy_from_slice(&corner);
        })
    }),
    probe!(triangle::point_at, |rows| {
        rows.random(|d, row| {
            (0..3).for_each(|_| put(row, vector(d, 100.0)));
            row.extend([d.uniform().to_bits(), d.uniform().to_bits()]);
        })
    }),
    probe!(triangle::magnitude, |rows| { rows.random(|d, row| (0..3).for_each(|_| put(row, vector(d, 100.0)))) }),
    probe!(triangle::offset_ray, |rows| {
        rows.random(|d, row| {
            put_all(row, [vector(d, 100.0), vector(d, 1.0).normalize_or(Vec3::X)]);
            row.push(scaled(d, -20, 20));
        })
    }),
    probe!(octahedral::encode_direction, |rows| {
        let axis = floats(&[1.0, -1.0, 0.5, -0.25, 1e-3]);
        rows.cross(&[&axis, &axis, &axis]).random(|d, row| put(row, vector(d, 1.0)))
    }),
    probe!(octahedral::decode_direction, |rows| rows.cross(&[&words()]).random(|d, row| row.push(d.bits()))),
];

//! Probes of intersection and direction functions.

use crate::probe::{Out, Probe, Row, Rows};
use crate::values::*;
use afterimage_lab::kernel::octahedral;
use afterimage_lab::kernel::triangle;
use afterimage_lab::kernel::triangle::Shear;
use afterimage_testing::Draws;
use glam::{Vec3, Vec3A};

fn shear_of(r: &Row<'_>) -> Shear {
    Shear { x: r.v(0).into(), y: r.v(3).into(), z: r.v(6).into() }
}

fn vector(d: &mut Draws, size: f32) -> Vec3 {
    Vec3::new(d.range(-size, size), d.range(-size, size), d.range(-size, size))
}

fn push(row: &mut Vec<u32>, v: impl Into<Vec3>) {
    row.extend(v.into().to_array().map(f32::to_bits));
}

/// A ray, and a distant triangle as small as the rounding error at its distance: edge signs are random.
fn ray_and_speck(d: &mut Draws, row: &mut Vec<u32>) {
    let (at, direction) = (vector(d, 1.0), vector(d, 1.0).normalize_or(Vec3::X));
    let shear = triangle::shear(direction);
    let corners = [0; 3].map(|_| at + vector(d, 3e-7));
    for v in [shear.x, shear.y, shear.z, vector(d, 1e-3).into()].into_iter().chain(corners.map(Vec3A::from)) {
        push(row, v);
    }
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
    for v in [shear.x, shear.y, shear.z, origin.into()].into_iter().chain(corners.map(Vec3A::from)) {
        push(row, v);
    }
}

fn out_shear(o: &mut Out, s: Shear) {
    o.v(s.x.into());
    o.v(s.y.into());
    o.v(s.z.into());
}

pub const PROBES: &[Probe] = &[
    Probe {
        name: "shear",
        module: "triangle",
        words: [3, 9],
        wgsl: "let s = shear(in_v(0u)); out_v(s.x); out_v(s.y); out_v(s.z);",
        rust: |r, o| out_shear(o, triangle::shear(r.v(0))),
        rows: || {
            let axis = floats(&[1.0, -1.0, 0.5, -0.25, 1e-3]);
            Rows::new(3).cross(&[&axis, &axis, &axis]).random("shear", |d, row| {
                let v = vector(d, 1.0);
                push(row, v);
            })
        },
    },
    Probe {
        name: "sheared",
        module: "triangle",
        words: [12, 3],
        wgsl: "out_v(sheared(Shear(in_v(0u), in_v(3u), in_v(6u)), in_v(9u)));",
        rust: |r, o| o.v(triangle::sheared(shear_of(r), r.v(9).into()).into()),
        rows: || {
            Rows::new(12).random("sheared", |d, row| {
                let shear = triangle::shear(vector(d, 1.0).normalize_or(Vec3::X));
                let at = vector(d, 10.0);
                for v in [shear.x, shear.y, shear.z, at.into()] {
                    push(row, v);
                }
            })
        },
    },
    Probe {
        name: "edge",
        module: "triangle",
        words: [6, 2],
        // The sign of a zero may differ.
        wgsl: "let e = edge(in_v(0u), in_v(3u)); out_f(abs(e)); out_b(e < 0.0);",
        rust: |r, o| {
            let e = triangle::edge(r.v(0).into(), r.v(3).into());
            o.f(e.abs());
            o.b(e < 0.0);
        },
        rows: || {
            Rows::new(6).random("edge", |d, row| {
                let a = vector(d, 1.0);
                let b = if d.bits().is_multiple_of(2) { a * d.range(-2.0, 2.0) } else { vector(d, 1.0) };
                push(row, a);
                push(row, b);
            })
        },
    },
    Probe {
        name: "intersect",
        module: "triangle",
        words: [21, 3],
        wgsl: "let m = intersect(Shear(in_v(0u), in_v(3u), in_v(6u)), in_v(9u), in_v(12u), in_v(15u), in_v(18u));
            out_f(m.t); out_f(m.u); out_f(m.v);",
        rust: |r, o| {
            let m = triangle::intersect(shear_of(r), r.v(9).into(), r.v(12).into(), r.v(15).into(), r.v(18).into());
            [m.t, m.u, m.v].into_iter().for_each(|x| o.f(x));
        },
        rows: || {
            Rows::new(21).random("intersect", ray_and_triangle).random("intersect, specks", ray_and_speck).random(
                "intersect, alike corners",
                |d, row| {
                    ray_and_triangle(d, row);
                    let start = row.len() - 9;
                    let (to, from) = (d.bits() as usize % 3, d.bits() as usize % 3);
                    let corner = row[start + 3 * from..][..3].to_vec();
                    row[start + 3 * to..][..3].copy_from_slice(&corner);
                },
            )
        },
    },
    Probe {
        name: "point_at",
        module: "triangle",
        words: [11, 3],
        wgsl: "out_v(point_at(in_v(0u), in_v(3u), in_v(6u), in_f(9u), in_f(10u)));",
        rust: |r, o| o.v(triangle::point_at(r.v(0), r.v(3), r.v(6), r.f(9), r.f(10))),
        rows: || {
            Rows::new(11).random("point_at", |d, row| {
                for _ in 0..3 {
                    let v = vector(d, 100.0);
                    push(row, v);
                }
                row.extend([d.uniform().to_bits(), d.uniform().to_bits()]);
            })
        },
    },
    Probe {
        name: "magnitude",
        module: "triangle",
        words: [9, 1],
        wgsl: "out_f(magnitude(in_v(0u), in_v(3u), in_v(6u)));",
        rust: |r, o| o.f(triangle::magnitude(r.v(0), r.v(3), r.v(6))),
        rows: || {
            Rows::new(9).random("magnitude", |d, row| {
                for _ in 0..3 {
                    let v = vector(d, 100.0);
                    push(row, v);
                }
            })
        },
    },
    Probe {
        name: "offset_ray",
        module: "triangle",
        words: [7, 3],
        wgsl: "out_v(offset_ray(in_v(0u), in_v(3u), in_f(6u)));",
        rust: |r, o| o.v(triangle::offset_ray(r.v(0), r.v(3), r.f(6))),
        rows: || {
            Rows::new(7).random("offset_ray", |d, row| {
                let (p, n) = (vector(d, 100.0), vector(d, 1.0).normalize_or(Vec3::X));
                push(row, p);
                push(row, n);
                row.push(scaled(d, -20, 20));
            })
        },
    },
    Probe {
        name: "encode_direction",
        module: "octahedral",
        words: [3, 1],
        wgsl: "out_u(encode_direction(in_v(0u)));",
        rust: |r, o| o.u(octahedral::encode_direction(r.v(0))),
        rows: || {
            let axis = floats(&[1.0, -1.0, 0.5, -0.25, 1e-3]);
            Rows::new(3).cross(&[&axis, &axis, &axis]).random("encode_direction", |d, row| {
                let v = vector(d, 1.0);
                push(row, v);
            })
        },
    },
    Probe {
        name: "decode_direction",
        module: "octahedral",
        words: [1, 3],
        wgsl: "out_v(decode_direction(in_u(0u)));",
        rust: |r, o| o.v(octahedral::decode_direction(r.u(0))),
        rows: || Rows::new(1).cross(&[&words()]).random("decode_direction", |d, row| row.push(d.bits())),
    },
];

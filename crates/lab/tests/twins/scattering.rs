//! Probes of scattering functions without tables: direction, sampling, phong.

use crate::probe::{Out, Probe, Row, Rows};
use crate::values::*;
use afterimage_lab::kernel::bsdf::{Sampled, Scatter};
use afterimage_lab::kernel::phong::PhongSurface;
use afterimage_lab::kernel::{direction, phong, sampling};
use afterimage_testing::Draws;
use glam::{Vec2, Vec3};

pub fn two(r: &Row<'_>, k: usize) -> Vec2 {
    Vec2::new(r.f(k), r.f(k + 1))
}

pub fn put_two(o: &mut Out, v: Vec2) {
    o.f(v.x);
    o.f(v.y);
}

pub fn put(row: &mut Vec<u32>, v: Vec3) {
    row.extend(v.to_array().map(f32::to_bits));
}

/// Unit vector in the upper hemisphere, including the horizon and the pole.
pub fn above(d: &mut Draws) -> Vec3 {
    let z = match d.bits() % 8 {
        0 => 1.0,
        1 => 1e-7,
        2 => d.range(1e-4, 1e-2),
        _ => d.uniform().max(1e-7),
    };
    around_z(d, z)
}

fn around_z(d: &mut Draws, z: f32) -> Vec3 {
    let r = ((1.0 - z) * (1.0 + z)).max(0.0).sqrt();
    let [s, c] = afterimage::kernel::approx::sin_cos_turns(d.uniform());
    Vec3::new(r * c, r * s, z)
}

/// Unit vector in either hemisphere.
pub fn anywhere(d: &mut Draws) -> Vec3 {
    let v = above(d);
    if d.bits() & 1 == 0 { v } else { Vec3::new(v.x, v.y, -v.z) }
}

/// 0, 1 or uniform in between.
pub fn share(d: &mut Draws) -> f32 {
    match d.bits() % 4 {
        0 => 0.0,
        1 => 1.0,
        _ => d.uniform(),
    }
}

pub fn draw(d: &mut Draws) -> u32 {
    range(d, 0.0, 1.0)
}

/// Rows of two draws, including their ends.
pub fn two_draws(name: &str) -> Rows {
    let ends = [draws(), floats(&[1.0])].concat();
    Rows::new(2).cross(&[&ends, &ends]).random(name, |d, row| row.extend([draw(d), draw(d)]))
}

/// Rows of one number from 0 to 1.
pub fn one_share(name: &str) -> Rows {
    let ends = [draws(), floats(&[1.0, 1e-7])].concat();
    Rows::new(1).cross(&[&ends]).random(name, |d, row| row.push(draw(d)))
}

fn material(r: &Row<'_>) -> PhongSurface {
    PhongSurface { diffuse: r.v(0), specular: r.v(3), exponent: r.f(6) }
}

fn materials(name: &str, more: fn(&mut Draws, &mut Vec<u32>), count: usize) -> Rows {
    Rows::new(7 + count).random(name, |d, row| {
        (0..6).for_each(|_| row.push(share(d).to_bits()));
        row.push(match d.bits() % 3 {
            0 => 0,
            _ => range(d, 0.0, 300.0),
        });
        more(d, row);
    })
}

pub fn put_scatter(o: &mut Out, s: &Scatter) {
    o.v(s.value);
    o.f(s.pdf);
}

pub fn put_sampled(o: &mut Out, s: &Sampled) {
    o.v(s.wi);
    put_scatter(o, &s.scatter);
}

macro_rules! material {
    () => {
        "let s = PhongSurface(in_v(0u), in_v(3u), in_f(6u)); "
    };
}

pub const PROBES: &[Probe] = &[
    Probe {
        name: "unit",
        module: "direction",
        words: [3, 3],
        wgsl: "out_v(unit(in_v(0u)));",
        rust: |r, o| o.v(direction::unit(r.v(0))),
        rows: || {
            let sizes = floats(&[0.0, 1e-38, 1e-30, 1e-20, -1.0, 3.0, 1e30, 3e38]);
            Rows::new(3)
                .cross(&[&sizes, &sizes, &sizes])
                .random("unit", |d, row| row.extend([signed(d, -9, 9), signed(d, -9, 9), signed(d, -9, 9)]))
        },
    },
    Probe {
        name: "basis",
        module: "direction",
        words: [3, 6],
        wgsl: "let b = basis(in_v(0u)); out_v(b[0]); out_v(b[1]);",
        rust: |r, o| direction::basis(r.v(0)).into_iter().for_each(|v| o.v(v)),
        rows: || Rows::new(3).random("basis", |d, row| put(row, anywhere(d))),
    },
    Probe {
        name: "to_local",
        module: "direction",
        words: [12, 3],
        wgsl: "out_v(to_local(in_v(0u), in_v(3u), in_v(6u), in_v(9u)));",
        rust: |r, o| o.v(direction::to_local(r.v(0), r.v(3), r.v(6), r.v(9))),
        rows: || Rows::new(12).random("to_local", |d, row| (0..4).for_each(|_| put(row, anywhere(d)))),
    },
    Probe {
        name: "to_world",
        module: "direction",
        words: [12, 3],
        wgsl: "out_v(to_world(in_v(0u), in_v(3u), in_v(6u), in_v(9u)));",
        rust: |r, o| o.v(direction::to_world(r.v(0), r.v(3), r.v(6), r.v(9))),
        rows: || Rows::new(12).random("to_world", |d, row| (0..4).for_each(|_| put(row, anywhere(d)))),
    },
    Probe {
        name: "disk",
        module: "sampling",
        words: [2, 2],
        wgsl: "let p = disk(vec2<f32>(in_f(0u), in_f(1u))); out_f(p.x); out_f(p.y);",
        rust: |r, o| put_two(o, sampling::disk(two(r, 0))),
        rows: || two_draws("disk"),
    },
    Probe {
        name: "cosine_hemisphere",
        module: "sampling",
        words: [2, 3],
        wgsl: "out_v(cosine_hemisphere(vec2<f32>(in_f(0u), in_f(1u))));",
        rust: |r, o| o.v(sampling::cosine_hemisphere(two(r, 0))),
        rows: || two_draws("cosine_hemisphere"),
    },
    Probe {
        name: "cosine_hemisphere_pdf",
        module: "sampling",
        words: [1, 1],
        wgsl: "out_f(cosine_hemisphere_pdf(in_f(0u)));",
        rust: |r, o| o.f(sampling::cosine_hemisphere_pdf(r.f(0))),
        rows: || one_share("cosine_hemisphere_pdf"),
    },
    Probe {
        name: "uniform_hemisphere",
        module: "sampling",
        words: [2, 3],
        wgsl: "out_v(uniform_hemisphere(vec2<f32>(in_f(0u), in_f(1u))));",
        rust: |r, o| o.v(sampling::uniform_hemisphere(two(r, 0))),
        rows: || two_draws("uniform_hemisphere"),
    },
    Probe {
        name: "uniform_hemisphere_pdf",
        module: "sampling",
        words: [1, 1],
        wgsl: "out_f(uniform_hemisphere_pdf(in_f(0u)));",
        rust: |r, o| o.f(sampling::uniform_hemisphere_pdf(r.f(0))),
        rows: || Rows::new(1).random("uniform_hemisphere_pdf", |d, row| row.push(range(d, -1.0, 1.0))),
    },
    Probe {
        name: "uniform_sphere",
        module: "sampling",
        words: [2, 3],
        wgsl: "out_v(uniform_sphere(vec2<f32>(in_f(0u), in_f(1u))));",
        rust: |r, o| o.v(sampling::uniform_sphere(two(r, 0))),
        rows: || two_draws("uniform_sphere"),
    },
    Probe {
        name: "uniform_sphere_pdf",
        module: "sampling",
        words: [1, 1],
        wgsl: "out_f(uniform_sphere_pdf());",
        rust: |_, o| o.f(sampling::uniform_sphere_pdf()),
        rows: || one_share("uniform_sphere_pdf"),
    },
    Probe {
        name: "barycentrics",
        module: "sampling",
        words: [2, 3],
        wgsl: "out_v(barycentrics(vec2<f32>(in_f(0u), in_f(1u))));",
        rust: |r, o| o.v(sampling::barycentrics(two(r, 0))),
        rows: || two_draws("barycentrics"),
    },
    Probe {
        name: "area_pdf",
        module: "sampling",
        words: [3, 1],
        wgsl: "out_f(area_pdf(in_f(0u), in_f(1u), in_f(2u)));",
        rust: |r, o| o.f(sampling::area_pdf(r.f(0), r.f(1), r.f(2))),
        rows: || {
            let ends = floats(&[0.0, 1e-15, 1e-7, 1.0]);
            Rows::new(3)
                .cross(&[&ends, &ends, &ends])
                .random("area_pdf", |d, row| row.extend([scaled(d, -30, 20), scaled(d, -20, 20), draw(d)]))
        },
    },
    Probe {
        name: "power_heuristic",
        module: "sampling",
        words: [2, 1],
        wgsl: "out_f(power_heuristic(in_f(0u), in_f(1u)));",
        rust: |r, o| o.f(sampling::power_heuristic(r.f(0), r.f(1))),
        rows: || {
            let ends = floats(&[0.0, 1e-10, 1.0, 3.0, 1e18]);
            Rows::new(2)
                .cross(&[&ends, &ends])
                .random("power_heuristic", |d, row| row.extend([scaled(d, -20, 20), scaled(d, -20, 20)]))
        },
    },
    Probe {
        name: "phong_power",
        module: "phong",
        words: [2, 1],
        wgsl: "out_f(phong_power(in_f(0u), in_f(1u)));",
        rust: |r, o| o.f(phong::phong_power(r.f(0), r.f(1))),
        rows: || {
            let ends = floats(&[0.0, 1e-7, 1.0]);
            Rows::new(2)
                .cross(&[&ends, &[ends.clone(), floats(&[1e6])].concat()])
                .random("phong_power", |d, row| row.extend([draw(d), range(d, 0.0, 300.0)]))
        },
    },
    Probe {
        name: "phong_specular_probability",
        module: "phong",
        words: [7, 1],
        wgsl: concat!(material!(), "out_f(phong_specular_probability(s));"),
        rust: |r, o| o.f(phong::phong_specular_probability(&material(r))),
        rows: || materials("phong_specular_probability", |_, _| {}, 0),
    },
    Probe {
        name: "phong_diffuse",
        module: "phong",
        words: [10, 3],
        wgsl: concat!(material!(), "out_v(phong_diffuse(s, in_v(7u)));"),
        rust: |r, o| o.v(phong::phong_diffuse(&material(r), r.v(7))),
        rows: || materials("phong_diffuse", |d, row| put(row, anywhere(d)), 3),
    },
    Probe {
        name: "phong_specular",
        module: "phong",
        words: [13, 3],
        wgsl: concat!(material!(), "out_v(phong_specular(s, in_v(7u), in_v(10u)));"),
        rust: |r, o| o.v(phong::phong_specular(&material(r), r.v(7), r.v(10))),
        rows: || {
            materials(
                "phong_specular",
                |d, row| {
                    put(row, above(d));
                    put(row, anywhere(d));
                },
                6,
            )
        },
    },
    Probe {
        name: "phong_eval",
        module: "phong",
        words: [13, 4],
        wgsl: concat!(material!(), "let r = phong_eval(s, in_v(7u), in_v(10u)); out_v(r.value); out_f(r.pdf);"),
        rust: |r, o| put_scatter(o, &phong::phong_eval(&material(r), r.v(7), r.v(10))),
        rows: || {
            materials(
                "phong_eval",
                |d, row| {
                    put(row, anywhere(d));
                    put(row, anywhere(d));
                },
                6,
            )
        },
    },
    Probe {
        name: "phong_sample",
        module: "phong",
        words: [13, 7],
        wgsl: concat!(
            material!(),
            "let r = phong_sample(s, in_v(7u), in_v(10u)); out_v(r.wi); out_v(r.value); out_f(r.pdf);"
        ),
        rust: |r, o| put_sampled(o, &phong::phong_sample(&material(r), r.v(7), [r.f(10), r.f(11), r.f(12)])),
        rows: || {
            materials(
                "phong_sample",
                |d, row| {
                    put(row, anywhere(d));
                    (0..3).for_each(|_| row.push(draw(d)));
                },
                6,
            )
        },
    },
];

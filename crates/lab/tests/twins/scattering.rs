//! Probes of scattering functions without tables: direction, sampling, phong.

use crate::probe::{Probe, Rows, probe};
use crate::shape::*;
use crate::values::*;
use afterimage_lab::kernel::bsdf::{Sampled, Scatter};
use afterimage_lab::kernel::phong::PhongSurface;
use afterimage_lab::kernel::{direction, phong, sampling};
use afterimage_testing::Draws;
use glam::Vec3;

pub fn put(row: &mut Vec<u32>, v: impl Into<Vec3>) {
    row.extend(v.into().to_array().map(f32::to_bits));
}

pub fn put_all(row: &mut Vec<u32>, vectors: impl IntoIterator<Item = impl Into<Vec3>>) {
    vectors.into_iter().for_each(|v| put(row, v));
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

/// Rows of `count` directions, and the words that `more` adds.
pub fn directions(
    rows: Rows,
    count: usize,
    direction: fn(&mut Draws) -> Vec3,
    more: fn(&mut Draws, &mut Vec<u32>),
) -> Rows {
    rows.random(|d, row| {
        (0..count).for_each(|_| put(row, direction(d)));
        more(d, row);
    })
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
pub fn two_draws(rows: Rows) -> Rows {
    let ends = [draws(), floats(&[1.0])].concat();
    rows.cross(&[&ends, &ends]).random(|d, row| row.extend([draw(d), draw(d)]))
}

/// Rows of one number from 0 to 1.
pub fn one_share(rows: Rows) -> Rows {
    let ends = [draws(), floats(&[1.0, 1e-7])].concat();
    rows.cross(&[&ends]).random(|d, row| row.push(draw(d)))
}

fn materials(rows: Rows, more: fn(&mut Draws, &mut Vec<u32>)) -> Rows {
    rows.random(|d, row| {
        (0..6).for_each(|_| row.push(share(d).to_bits()));
        row.push(if d.bits().is_multiple_of(3) { 0 } else { range(d, 0.0, 300.0) });
        more(d, row);
    })
}

shape!(PhongSurface { diffuse: Vec3, specular: Vec3, exponent: f32 });
shape!(Scatter { value: Vec3, pdf: f32 });
shape!(Sampled { wi: Vec3, scatter: Scatter });

pub const PROBES: &[Probe] = &[
    probe!(direction::unit, |rows| {
        let sizes = floats(&[0.0, 1e-38, 1e-30, 1e-20, -1.0, 3.0, 1e30, 3e38]);
        rows.cross(&[&sizes, &sizes, &sizes])
            .random(|d, row| row.extend([signed(d, -9, 9), signed(d, -9, 9), signed(d, -9, 9)]))
    }),
    probe!(direction::basis, |rows| directions(rows, 1, anywhere, |_, _| {})),
    probe!(direction::to_local, |rows| directions(rows, 4, anywhere, |_, _| {})),
    probe!(direction::to_world, |rows| directions(rows, 4, anywhere, |_, _| {})),
    probe!(sampling::disk, two_draws),
    probe!(sampling::cosine_hemisphere, two_draws),
    probe!(sampling::cosine_hemisphere_pdf, one_share),
    probe!(sampling::uniform_hemisphere, two_draws),
    probe!(sampling::uniform_hemisphere_pdf, |rows| rows.random(|d, row| row.push(range(d, -1.0, 1.0)))),
    probe!(sampling::barycentrics, two_draws),
    probe!(sampling::area_pdf, |rows| {
        let ends = floats(&[0.0, 1e-15, 1e-7, 1.0]);
        rows.cross(&[&ends, &ends, &ends])
            .random(|d, row| row.extend([scaled(d, -30, 20), scaled(d, -20, 20), draw(d)]))
    }),
    probe!(sampling::power_heuristic, |rows| {
        let ends = floats(&[0.0, 1e-10, 1.0, 3.0, 1e18]);
        rows.cross(&[&ends, &ends]).random(|d, row| row.extend([scaled(d, -20, 20), scaled(d, -20, 20)]))
    }),
    probe!(phong::phong_power, |rows| {
        let ends = floats(&[0.0, 1e-7, 1.0]);
        rows.cross(&[&ends, &[ends.clone(), floats(&[1e6])].concat()])
            .random(|d, row| row.extend([draw(d), range(d, 0.0, 300.0)]))
    }),
    probe!(
        phong::phong_specular_probability,
        |surface: PhongSurface| phong::phong_specular_probability(&surface),
        |rows| materials(rows, |_, _| {})
    ),
    probe!(phong::phong_diffuse, |surface: PhongSurface, wi: Vec3| phong::phong_diffuse(&surface, wi), |rows| {
        materials(rows, |d, row| put(row, anywhere(d)))
    }),
    probe!(
        phong::phong_specular,
        |surface: PhongSurface, wo: Vec3, wi: Vec3| phong::phong_specular(&surface, wo, wi),
        |rows| materials(rows, |d, row| put_all(row, [above(d), anywhere(d)]))
    ),
    probe!(
        phong::phong_eval,
        |surface: PhongSurface, wo: Vec3, wi: Vec3| phong::phong_eval(&surface, wo, wi),
        |rows| materials(rows, |d, row| put_all(row, [anywhere(d), anywhere(d)]))
    ),
    probe!(
        phong::phong_sample,
        |s: PhongSurface, wo: Vec3, u: [f32; 3]| phong::phong_sample(&s, wo, u),
        "let r = phong_sample($0, $1, $2); out_v(r.wi); out_v(r.value); out_f(r.pdf);",
        |rows| {
            materials(rows, |d, row| {
                put(row, anywhere(d));
                (0..3).for_each(|_| row.push(draw(d)));
            })
        }
    ),
];

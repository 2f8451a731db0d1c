//! Probes of microfacet functions.

use crate::probe::{Probe, Rows, probe};
use crate::scattering::{above, directions, draw, one_share, put, two_draws};
use crate::values::*;
use afterimage_lab::kernel::microfacet;
use afterimage_testing::Draws;

fn width(d: &mut Draws) -> f32 {
    match d.bits() % 4 {
        0 => 1e-3,
        1 => 1.0,
        _ => d.range(1e-3, 1.0),
    }
}

/// Rows of a direction above the horizon, two widths, and the words that `more` adds.
fn seen(rows: Rows, more: fn(&mut Draws, &mut Vec<u32>)) -> Rows {
    rows.random(|d, row| {
        put(row, above(d));
        row.extend([width(d), width(d)].map(f32::to_bits));
        more(d, row);
    })
}

fn cosine_and_width(rows: Rows) -> Rows {
    rows.random(|d, row| row.extend([draw(d), range(d, 0.01, 1.0)]))
}

pub const PROBES: &[Probe] = &[
    probe!(microfacet::ggx_widths, two_draws),
    probe!(microfacet::ggx_mean_width, |rows| rows.random(|d, row| row.extend([width(d), width(d)].map(f32::to_bits)))),
    probe!(microfacet::ggx_length, |rows| seen(rows, |_, _| {})),
    probe!(microfacet::ggx_d, |rows| seen(rows, |_, _| {})),
    probe!(microfacet::vndf_sample, |rows| seen(rows, |d, row| row.extend([draw(d), draw(d)]))),
    probe!(microfacet::schlick_weight, one_share),
    probe!(microfacet::reflectance_at_normal, |rows| {
        rows.cross(&[&floats(&[1.0, 1.5, 3.0])]).random(|d, row| row.push(range(d, 1.0, 4.0)))
    }),
    probe!(microfacet::fresnel_dielectric, |rows| rows.random(|d, row| row.extend([draw(d), range(d, 0.3, 3.0)]))),
    probe!(microfacet::refraction_discriminant, |rows| rows.random(|d, row| row.extend([draw(d), range(d, 0.3, 3.0)]))),
    probe!(microfacet::mirrored, |rows| directions(rows, 2, above, |_, _| {})),
    probe!(microfacet::refracted, |rows| directions(rows, 2, above, |d, row| row.push(range(d, 0.3, 3.0)))),
    probe!(microfacet::charlie_d, cosine_and_width),
    probe!(microfacet::charlie_curve, cosine_and_width),
    probe!(microfacet::charlie_lambda, cosine_and_width),
    probe!(microfacet::charlie_visibility, |rows| {
        rows.random(|d, row| row.extend([draw(d), scaled(d, -4, 14), draw(d), scaled(d, -4, 14)]))
    }),
];

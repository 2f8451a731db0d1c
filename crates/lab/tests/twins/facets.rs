//! Probes of microfacet functions.

use crate::probe::{Probe, Rows};
use crate::scattering::{above, draw, one_share, put, put_two, two, two_draws};
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

/// Rows of a direction above the horizon and two widths.
fn seen(name: &str, more: usize) -> Rows {
    Rows::new(5 + more).random(name, |d, row| {
        put(row, above(d));
        row.extend([width(d), width(d)].map(f32::to_bits));
        (0..more).for_each(|_| row.push(draw(d)));
    })
}

fn vector_and_normal(name: &str, more: usize) -> Rows {
    Rows::new(6 + more).random(name, |d, row| {
        put(row, above(d));
        put(row, above(d));
        (0..more).for_each(|_| row.push(range(d, 0.3, 3.0)));
    })
}

fn widths_rows(name: &str, count: usize) -> Rows {
    Rows::new(count).random(name, |d, row| (0..count).for_each(|_| row.push(width(d).to_bits())))
}

pub const PROBES: &[Probe] = &[
    Probe {
        name: "ggx_widths",
        module: "microfacet",
        words: [2, 2],
        wgsl: "let a = ggx_widths(in_f(0u), in_f(1u)); out_f(a.x); out_f(a.y);",
        rust: |r, o| put_two(o, microfacet::ggx_widths(r.f(0), r.f(1))),
        rows: || two_draws("ggx_widths"),
    },
    Probe {
        name: "ggx_mean_width",
        module: "microfacet",
        words: [2, 1],
        wgsl: "out_f(ggx_mean_width(vec2<f32>(in_f(0u), in_f(1u))));",
        rust: |r, o| o.f(microfacet::ggx_mean_width(two(r, 0))),
        rows: || widths_rows("ggx_mean_width", 2),
    },
    Probe {
        name: "ggx_length",
        module: "microfacet",
        words: [5, 1],
        wgsl: "out_f(ggx_length(in_v(0u), vec2<f32>(in_f(3u), in_f(4u))));",
        rust: |r, o| o.f(microfacet::ggx_length(r.v(0), two(r, 3))),
        rows: || seen("ggx_length", 0),
    },
    Probe {
        name: "ggx_d",
        module: "microfacet",
        words: [5, 1],
        wgsl: "out_f(ggx_d(in_v(0u), vec2<f32>(in_f(3u), in_f(4u))));",
        rust: |r, o| o.f(microfacet::ggx_d(r.v(0), two(r, 3))),
        rows: || seen("ggx_d", 0),
    },
    Probe {
        name: "smith_g1",
        module: "microfacet",
        words: [5, 1],
        wgsl: "out_f(smith_g1(in_v(0u), vec2<f32>(in_f(3u), in_f(4u))));",
        rust: |r, o| o.f(microfacet::smith_g1(r.v(0), two(r, 3))),
        rows: || seen("smith_g1", 0),
    },
    Probe {
        name: "smith_g2",
        module: "microfacet",
        words: [4, 1],
        wgsl: "out_f(smith_g2(in_f(0u), in_f(1u), in_f(2u), in_f(3u)));",
        rust: |r, o| o.f(microfacet::smith_g2(r.f(0), r.f(1), r.f(2), r.f(3))),
        rows: || widths_rows("smith_g2", 4),
    },
    Probe {
        name: "vndf_sample",
        module: "microfacet",
        words: [7, 3],
        wgsl: "out_v(vndf_sample(in_v(0u), vec2<f32>(in_f(3u), in_f(4u)), vec2<f32>(in_f(5u), in_f(6u))));",
        rust: |r, o| o.v(microfacet::vndf_sample(r.v(0), two(r, 3), two(r, 5))),
        rows: || seen("vndf_sample", 2),
    },
    Probe {
        name: "vndf_pdf",
        module: "microfacet",
        words: [8, 1],
        wgsl: "out_f(vndf_pdf(in_v(0u), in_v(3u), vec2<f32>(in_f(6u), in_f(7u))));",
        rust: |r, o| o.f(microfacet::vndf_pdf(r.v(0), r.v(3), two(r, 6))),
        rows: || {
            Rows::new(8).random("vndf_pdf", |d, row| {
                put(row, above(d));
                put(row, above(d));
                row.extend([width(d), width(d)].map(f32::to_bits));
            })
        },
    },
    Probe {
        name: "schlick_weight",
        module: "microfacet",
        words: [1, 1],
        wgsl: "out_f(schlick_weight(in_f(0u)));",
        rust: |r, o| o.f(microfacet::schlick_weight(r.f(0))),
        rows: || one_share("schlick_weight"),
    },
    Probe {
        name: "reflectance_at_normal",
        module: "microfacet",
        words: [1, 1],
        wgsl: "out_f(reflectance_at_normal(in_f(0u)));",
        rust: |r, o| o.f(microfacet::reflectance_at_normal(r.f(0))),
        rows: || {
            Rows::new(1)
                .cross(&[&floats(&[1.0, 1.5, 3.0])])
                .random("reflectance_at_normal", |d, row| row.push(range(d, 1.0, 4.0)))
        },
    },
    Probe {
        name: "fresnel_dielectric",
        module: "microfacet",
        words: [2, 1],
        wgsl: "out_f(fresnel_dielectric(in_f(0u), in_f(1u)));",
        rust: |r, o| o.f(microfacet::fresnel_dielectric(r.f(0), r.f(1))),
        rows: || Rows::new(2).random("fresnel_dielectric", |d, row| row.extend([draw(d), range(d, 0.3, 3.0)])),
    },
    Probe {
        name: "refraction_discriminant",
        module: "microfacet",
        words: [2, 1],
        wgsl: "out_f(refraction_discriminant(in_f(0u), in_f(1u)));",
        rust: |r, o| o.f(microfacet::refraction_discriminant(r.f(0), r.f(1))),
        rows: || Rows::new(2).random("refraction_discriminant", |d, row| row.extend([draw(d), range(d, 0.3, 3.0)])),
    },
    Probe {
        name: "mirrored",
        module: "microfacet",
        words: [6, 3],
        wgsl: "out_v(mirrored(in_v(0u), in_v(3u)));",
        rust: |r, o| o.v(microfacet::mirrored(r.v(0), r.v(3))),
        rows: || vector_and_normal("mirrored", 0),
    },
    Probe {
        name: "refracted",
        module: "microfacet",
        words: [7, 3],
        wgsl: "out_v(refracted(in_v(0u), in_v(3u), in_f(6u)));",
        rust: |r, o| o.v(microfacet::refracted(r.v(0), r.v(3), r.f(6))),
        rows: || vector_and_normal("refracted", 1),
    },
    Probe {
        name: "charlie_d",
        module: "microfacet",
        words: [2, 1],
        wgsl: "out_f(charlie_d(in_f(0u), in_f(1u)));",
        rust: |r, o| o.f(microfacet::charlie_d(r.f(0), r.f(1))),
        rows: || Rows::new(2).random("charlie_d", |d, row| row.extend([draw(d), range(d, 0.01, 1.0)])),
    },
    Probe {
        name: "charlie_curve",
        module: "microfacet",
        words: [2, 1],
        wgsl: "out_f(charlie_curve(in_f(0u), in_f(1u)));",
        rust: |r, o| o.f(microfacet::charlie_curve(r.f(0), r.f(1))),
        rows: || Rows::new(2).random("charlie_curve", |d, row| row.extend([draw(d), range(d, 0.01, 1.0)])),
    },
    Probe {
        name: "charlie_lambda",
        module: "microfacet",
        words: [2, 1],
        wgsl: "out_f(charlie_lambda(in_f(0u), in_f(1u)));",
        rust: |r, o| o.f(microfacet::charlie_lambda(r.f(0), r.f(1))),
        rows: || Rows::new(2).random("charlie_lambda", |d, row| row.extend([draw(d), range(d, 0.01, 1.0)])),
    },
    Probe {
        name: "charlie_visibility",
        module: "microfacet",
        words: [4, 1],
        wgsl: "out_f(charlie_visibility(in_f(0u), in_f(1u), in_f(2u), in_f(3u)));",
        rust: |r, o| o.f(microfacet::charlie_visibility(r.f(0), r.f(1), r.f(2), r.f(3))),
        rows: || {
            Rows::new(4).random("charlie_visibility", |d, row| {
                row.extend([draw(d), scaled(d, -4, 14), draw(d), scaled(d, -4, 14)]);
            })
        },
    },
];

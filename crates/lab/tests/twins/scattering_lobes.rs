//! Probes of scattering functions that read tables: albedo, bsdf. Also: unused lobes change no bit.

use crate::probe::{Out, Probe, Row, Rows};
use crate::scattering::{above, anywhere, put, put_sampled, put_scatter, share, two};
use crate::values::*;
use afterimage_lab::kernel::albedo;
use afterimage_lab::kernel::albedo::AlbedoTables;
use afterimage_lab::kernel::bsdf;
use afterimage_lab::kernel::bsdf::{Layers, Lobes, Surface};
use afterimage_lab::kernel::layers;
use afterimage_testing::Draws;
use glam::{Vec2, Vec3};
use std::sync::LazyLock;

static TABLES: LazyLock<AlbedoTables> = LazyLock::new(AlbedoTables::compute);

/// Words that `load` reads while `module` is probed: the albedo tables where it needs them.
pub fn table_data(module: &str) -> Vec<u32> {
    if ["albedo", "bsdf", "layers"].contains(&module) { TABLES.words().flatten().collect() } else { vec![] }
}

/// Words of a surface in a row.
const SURFACE: usize = 19;

pub fn surface(r: &Row<'_>) -> Surface {
    Surface {
        base_color: r.v(0),
        metallic: r.f(3),
        roughness: r.f(4),
        specular: r.f(5),
        specular_color: r.v(6),
        ior: r.f(9),
        anisotropy: r.f(10),
        clearcoat: r.f(11),
        clearcoat_roughness: r.f(12),
        sheen_color: r.v(13),
        sheen_roughness: r.f(16),
        transmission: r.f(17),
        thin: r.u(18) & 1 != 0,
        entering: r.u(18) & 2 != 0,
    }
}

fn put_surface(d: &mut Draws, row: &mut Vec<u32>) {
    let color = |d: &mut Draws| Vec3::new(share(d), share(d), share(d));
    put(row, color(d));
    (0..3).for_each(|_| row.push(share(d).to_bits()));
    put(row, color(d));
    row.push(range(d, 1.0, 3.2));
    (0..3).for_each(|_| row.push(share(d).to_bits()));
    let sheen = if d.bits() & 1 == 0 { Vec3::ZERO } else { color(d) };
    put(row, sheen);
    row.extend([share(d), share(d)].map(f32::to_bits));
    row.push(d.bits() & 3);
}

fn layers_of(r: &Row<'_>) -> Layers {
    bsdf::layers(&surface(r), r.v(SURFACE), &TABLES, Lobes::ALL)
}

fn put_layers(o: &mut Out, l: &Layers) {
    o.f(l.widths.x);
    o.f(l.widths.y);
    o.v(l.diffuse);
    [l.retro, l.retro_roughness, l.retro_scale].into_iter().for_each(|x| o.f(x));
    o.v(l.reflect);
    o.v(l.reflect_rise);
    [l.coat_width, l.coat, l.coat_rise].into_iter().for_each(|x| o.f(x));
    o.v(l.sheen);
    [l.sheen_width, l.sheen_lambda].into_iter().for_each(|x| o.f(x));
    o.v(l.glass);
    o.v(l.glass_color);
    o.v(l.glass_reflect);
    o.f(l.eta);
    o.b(l.thin);
    l.probabilities.into_iter().for_each(|x| o.f(x));
}

/// WGSL code for [`surface`], followed by [`layers`].
macro_rules! layered {
    ($rest:literal) => {
        concat!(
            "let s = BsdfSurface(in_v(0u), in_f(3u), in_f(4u), in_f(5u), in_v(6u), in_f(9u), in_f(10u), in_f(11u),
        in_f(12u), in_v(13u), in_f(16u), in_f(17u), (in_u(18u) & 1u) != 0u, (in_u(18u) & 2u) != 0u);
    let wo = in_v(19u); let l = layers(s, wo, 0u); ",
            $rest
        )
    };
}

/// Rows of a surface, `wo`, and the words that `more` adds.
fn surfaces(name: &str, words: usize, more: fn(&mut Draws, &mut Vec<u32>)) -> Rows {
    Rows::new(SURFACE + 3 + words).random(name, |d, row| {
        put_surface(d, row);
        put(row, above(d));
        more(d, row);
    })
}

fn one_draw(d: &mut Draws) -> u32 {
    share(d).min(16_777_215.0 / 16_777_216.0).to_bits()
}

fn pair(name: &str) -> Rows {
    let ends = floats(&[0.0, 1e-7, 0.5, 1.0]);
    Rows::new(2).cross(&[&ends, &ends]).random(name, |d, row| row.extend([range(d, 0.0, 1.0), share(d).to_bits()]))
}

pub const PROBES: &[Probe] = &[
    Probe {
        name: "albedo_cell",
        module: "albedo",
        words: [1, 4],
        wgsl: "let c = albedo_cell(0u, in_u(0u)); out_v(c.xyz); out_f(c.w);",
        rust: |r, o| TABLES.words().nth(r.u(0) as usize).unwrap().into_iter().for_each(|x| o.u(x)),
        rows: || Rows { width: 1, words: (0..albedo::CELLS).step_by(97).collect() },
    },
    Probe {
        name: "albedo_knot",
        module: "albedo",
        words: [2, 2],
        wgsl: "let k = albedo_knot(in_f(0u), in_u(1u)); out_f(k.x); out_f(k.y);",
        rust: |r, o| {
            let k = albedo::albedo_knot(r.f(0), r.u(1));
            o.f(k.x);
            o.f(k.y);
        },
        rows: || {
            Rows::new(2)
                .cross(&[&floats(&[-1.0, 0.0, 1.0, 2.0]), &[2, 12, 48]])
                .random("albedo_knot", |d, row| row.extend([range(d, 0.0, 1.0), 2 + d.bits() % 63]))
        },
    },
    Probe {
        name: "albedo_cosine",
        module: "albedo",
        words: [2, 1],
        wgsl: "out_f(albedo_cosine(in_f(0u), in_f(1u)));",
        rust: |r, o| o.f(albedo::albedo_cosine(r.f(0), r.f(1))),
        rows: || pair("albedo_cosine").within(|r| r.f(1) >= 1e-3),
    },
    Probe {
        name: "albedo_plane",
        module: "albedo",
        words: [2, 4],
        wgsl: "let c = albedo_plane(0u, in_f(0u), in_f(1u)); out_v(c.xyz); out_f(c.w);",
        rust: |r, o| {
            let c = albedo::albedo_plane(&TABLES, r.f(0), r.f(1));
            o.v(c.truncate());
            o.f(c.w);
        },
        rows: || pair("albedo_plane"),
    },
    Probe {
        name: "ggx_albedo",
        module: "albedo",
        words: [2, 2],
        wgsl: "let e = ggx_albedo(0u, in_f(0u), in_f(1u)); out_f(e.x); out_f(e.y);",
        rust: |r, o| {
            let e = albedo::ggx_albedo(&TABLES, r.f(0), r.f(1));
            o.f(e.x);
            o.f(e.y);
        },
        rows: || pair("ggx_albedo").within(|r| r.f(1) >= 1e-3),
    },
    Probe {
        name: "anisotropic_albedo",
        module: "albedo",
        words: [5, 2],
        wgsl: "let e = anisotropic_albedo(0u, in_v(0u), vec2<f32>(in_f(3u), in_f(4u))); out_f(e.x); out_f(e.y);",
        rust: |r, o| {
            let e = albedo::anisotropic_albedo(&TABLES, r.v(0), two(r, 3));
            o.f(e.x);
            o.f(e.y);
        },
        rows: || {
            Rows::new(5).random("anisotropic_albedo", |d, row| {
                put(row, above(d));
                let a: Vec2 = afterimage_lab::kernel::microfacet::ggx_widths(share(d), share(d));
                row.extend([a.x, a.y].map(f32::to_bits));
            })
        },
    },
    Probe {
        name: "sheen_albedo",
        module: "albedo",
        words: [2, 1],
        wgsl: "out_f(sheen_albedo(0u, in_f(0u), in_f(1u)));",
        rust: |r, o| o.f(albedo::sheen_albedo(&TABLES, r.f(0), r.f(1))),
        rows: || pair("sheen_albedo"),
    },
    Probe {
        name: "glass_albedo",
        module: "albedo",
        words: [4, 2],
        wgsl: "let e = glass_albedo(0u, in_f(0u), in_f(1u), in_f(2u), in_u(3u) != 0u); out_f(e.x); out_f(e.y);",
        rust: |r, o| {
            let e = albedo::glass_albedo(&TABLES, r.f(0), r.f(1), r.f(2), r.u(3) != 0);
            o.f(e.x);
            o.f(e.y);
        },
        rows: || {
            Rows::new(4).random("glass_albedo", |d, row| {
                row.extend([range(d, 0.0, 1.0), share(d).to_bits(), range(d, 1.03, 3.0), d.bits() & 1]);
            })
        },
    },
    Probe {
        name: "retro_albedo",
        module: "layers",
        words: [2, 1],
        wgsl: "out_f(retro_albedo(in_f(0u), in_f(1u)));",
        rust: |r, o| o.f(layers::retro_albedo(r.f(0), r.f(1))),
        rows: || pair("retro_albedo"),
    },
    Probe {
        name: "retro_value",
        module: "bsdf",
        words: [7, 1],
        wgsl: "out_f(retro_value(in_v(0u), in_v(3u), in_f(6u)));",
        rust: |r, o| o.f(bsdf::retro_value(r.v(0), r.v(3), r.f(6))),
        rows: || {
            Rows::new(7).random("retro_value", |d, row| {
                put(row, above(d));
                put(row, above(d));
                row.push(share(d).to_bits());
            })
        },
    },
    Probe {
        name: "reflect_albedo",
        module: "layers",
        words: [5, 3],
        wgsl: "out_v(reflect_albedo(in_v(0u), vec2<f32>(in_f(3u), in_f(4u))));",
        rust: |r, o| o.v(layers::reflect_albedo(r.v(0), two(r, 3))),
        rows: || {
            Rows::new(5).random("reflect_albedo", |d, row| {
                (0..3).for_each(|_| row.push(share(d).to_bits()));
                row.extend([range(d, 0.3, 1.0), range(d, 0.0, 0.3)]);
            })
        },
    },
    Probe {
        name: "layers",
        module: "layers",
        words: [SURFACE + 3, 37],
        wgsl: layered!(
            "out_f(l.widths.x); out_f(l.widths.y); out_v(l.diffuse); out_f(l.retro); out_f(l.retro_roughness);
    out_f(l.retro_scale); out_v(l.reflect); out_v(l.reflect_rise); out_f(l.coat_width); out_f(l.coat);
    out_f(l.coat_rise); out_v(l.sheen); out_f(l.sheen_width); out_f(l.sheen_lambda); out_v(l.glass);
    out_v(l.glass_color); out_v(l.glass_reflect); out_f(l.eta); out_b(l.thin); out_v(l.probabilities.xyz); out_f(l.probabilities.w);"
        ),
        rust: |r, o| put_layers(o, &layers_of(r)),
        rows: || surfaces("layers", 0, |_, _| {}),
    },
    Probe {
        name: "eval",
        module: "bsdf",
        words: [SURFACE + 6, 4],
        wgsl: layered!("let r = eval(l, wo, in_v(22u)); out_v(r.value); out_f(r.pdf);"),
        rust: |r, o| put_scatter(o, &bsdf::eval(&layers_of(r), r.v(SURFACE), r.v(SURFACE + 3), Lobes::ALL)),
        rows: || surfaces("eval", 3, |d, row| put(row, anywhere(d))),
    },
    Probe {
        name: "sample",
        module: "bsdf",
        words: [SURFACE + 7, 7],
        wgsl: layered!(
            "let r = sample(l, wo, vec4<f32>(in_f(22u), in_f(23u), in_f(24u), in_f(25u)));
    out_v(r.wi); out_v(r.value); out_f(r.pdf);"
        ),
        rust: |r, o| {
            let u = std::array::from_fn(|k| r.f(SURFACE + 3 + k));
            put_sampled(o, &bsdf::sample(&layers_of(r), r.v(SURFACE), u, Lobes::ALL));
        },
        rows: || surfaces("sample", 4, |d, row| (0..4).for_each(|_| row.push(one_draw(d)))),
    },
];

type Switch = (&'static str, fn(&Lobes) -> bool);

/// Override of each lobe, and whether a surface needs it.
const SWITCHES: [Switch; 7] = [
    ("LOBE_RETRO", |l| l.retro),
    ("LOBE_SPECULAR", |l| l.specular),
    ("LOBE_METAL", |l| l.metal),
    ("LOBE_ANISOTROPY", |l| l.anisotropy),
    ("LOBE_CLEARCOAT", |l| l.clearcoat),
    ("LOBE_SHEEN", |l| l.sheen),
    ("LOBE_TRANSMISSION", |l| l.transmission),
];

/// Rows of `probe` whose surfaces need none of the lobes in `off`, and their differences between a device without these
/// lobes and Rust with all lobes.
fn without(probe: &Probe, off: &[usize]) -> Option<(usize, Vec<String>)> {
    let mut source = probe.source();
    for &k in off {
        let on = format!("override {}: bool = true;", SWITCHES[k].0);
        assert_eq!(source.matches(&on).count(), 1);
        source = source.replace(&on, &on.replace("true", "false"));
    }
    let (device, queue) = afterimage_testing::gpu::device()?;
    let keep = |r: &Row<'_>| {
        let used = Lobes::used_by(&surface(r));
        off.iter().all(|&k| !SWITCHES[k].1(&used))
    };
    let rows = (probe.rows)().within(keep);
    Some(probe.differences_of(&device, &queue, &source, &rows))
}

#[test]
fn a_lobe_that_is_not_used_can_be_left_out_bit_for_bit() {
    let all = [0, 1, 2, 3, 4, 5, 6];
    let sets = [vec![0, 1], vec![2], vec![3], vec![4], vec![5], vec![6], vec![3, 4, 5], all[2..].to_vec()];
    for name in ["eval", "sample"] {
        let probe = PROBES.iter().find(|p| p.name == name).unwrap();
        for off in &sets {
            let Some((count, lines)) = without(probe, off) else { return };
            println!("{name} without {off:?}: {} of {count} rows differ", lines.len());
            assert!(count > 100);
            assert!(lines.is_empty(), "{name} without {off:?}: {:#?}", &lines[..lines.len().min(3)]);
        }
    }
}

//! Probes of scattering functions that read tables: albedo, bsdf.

use crate::probe::{Probe, Rows, probe};
use crate::scattering::{above, anywhere, directions, put, share};
use crate::shape::*;
use crate::values::*;
use afterimage_lab::kernel::albedo::{self, AlbedoTables};
use afterimage_lab::kernel::bsdf::{self, Layers, Lobes, Surface};
use afterimage_lab::kernel::layers;
use afterimage_testing::Draws;
use glam::{Vec2, Vec3};
use std::sync::LazyLock;

static TABLES: LazyLock<AlbedoTables> = LazyLock::new(AlbedoTables::compute);

/// Words that `load` reads while `module` is probed: the albedo tables where it needs them.
pub fn table_data(module: &str) -> Vec<u32> {
    if ["albedo", "bsdf", "layers"].contains(&module) { TABLES.words().flatten().collect() } else { vec![] }
}

fn put_surface(d: &mut Draws, row: &mut Vec<u32>) {
    let color = |d: &mut Draws| Vec3::new(share(d), share(d), share(d));
    put(row, color(d));
    (0..3).for_each(|_| row.push(share(d).to_bits()));
    put(row, color(d));
    row.push(range(d, 1.0, 3.2));
    (0..3).for_each(|_| row.push(share(d).to_bits()));
    put(row, if d.bits() & 1 == 0 { Vec3::ZERO } else { color(d) });
    row.extend([share(d), share(d)].map(f32::to_bits));
    let flags = d.bits();
    row.extend([flags & 1, flags >> 1 & 1]);
}

shape!(Surface as "BsdfSurface" {
    base_color: Vec3, metallic: f32, roughness: f32, specular: f32, specular_color: Vec3, ior: f32, anisotropy: f32,
    clearcoat: f32, clearcoat_roughness: f32, sheen_color: Vec3, sheen_roughness: f32, transmission: f32, thin: bool,
    entering: bool
});
shape!(Layers {
    widths: Vec2,
    diffuse: Vec3,
    retro: f32,
    retro_roughness: f32,
    retro_scale: f32,
    reflect: Vec3,
    reflect_rise: Vec3,
    coat_width: f32,
    coat: f32,
    coat_rise: f32,
    sheen: Vec3,
    sheen_width: f32,
    sheen_lambda: f32,
    glass: Vec3,
    glass_color: Vec3,
    glass_reflect: Vec3,
    eta: f32,
    thin: bool,
    probabilities: [f32; 4]
});

fn layers_of(s: &Surface, wo: Vec3) -> Layers {
    bsdf::layers(s, wo, &TABLES, Lobes::ALL)
}

/// Rows of a surface, `wo`, and the words that `more` adds.
fn surfaces(rows: Rows, more: fn(&mut Draws, &mut Vec<u32>)) -> Rows {
    rows.random(|d, row| {
        put_surface(d, row);
        put(row, above(d));
        more(d, row);
    })
}

fn one_draw(d: &mut Draws) -> u32 {
    share(d).min(16_777_215.0 / 16_777_216.0).to_bits()
}

fn pair(rows: Rows) -> Rows {
    let ends = floats(&[0.0, 1e-7, 0.5, 1.0]);
    rows.cross(&[&ends, &ends]).random(|d, row| row.extend([range(d, 0.0, 1.0), share(d).to_bits()]))
}

pub const PROBES: &[Probe] = &[
    probe!(
        albedo::albedo_cell,
        |cell: u32| TABLES.words().nth(cell as usize).unwrap(),
        "let c = albedo_cell(0u, $0); out_v(c.xyz); out_f(c.w);",
        |rows| Rows { words: (0..albedo::CELLS).step_by(97).collect(), ..rows }
    ),
    probe!(albedo::albedo_knot, |rows| {
        rows.cross(&[&floats(&[-1.0, 0.0, 1.0, 2.0]), &[2, 12, 48]])
            .random(|d, row| row.extend([range(d, 0.0, 1.0), 2 + d.bits() % 63]))
    }),
    probe!(albedo::albedo_cosine, |rows| pair(rows).within(|r| r.f(1) >= 1e-3)),
    probe!(
        albedo::albedo_plane,
        |x: f32, y: f32| albedo::albedo_plane(&TABLES, x, y),
        "albedo_plane(0u, $0, $1)",
        pair
    ),
    probe!(
        albedo::ggx_albedo,
        |cosine: f32, width: f32| albedo::ggx_albedo(&TABLES, cosine, width),
        "ggx_albedo(0u, $0, $1)",
        |rows| pair(rows).within(|r| r.f(1) >= 1e-3)
    ),
    probe!(
        albedo::anisotropic_albedo,
        |wo: Vec3, a: Vec2| albedo::anisotropic_albedo(&TABLES, wo, a),
        "anisotropic_albedo(0u, $0, $1)",
        |rows| {
            directions(rows, 1, above, |d, row| {
                let a: Vec2 = afterimage_lab::kernel::microfacet::ggx_widths(share(d), share(d));
                row.extend([a.x, a.y].map(f32::to_bits));
            })
        }
    ),
    probe!(
        albedo::sheen_albedo,
        |cosine: f32, roughness: f32| albedo::sheen_albedo(&TABLES, cosine, roughness),
        "sheen_albedo(0u, $0, $1)",
        pair
    ),
    probe!(
        albedo::glass_albedo,
        |cosine: f32, width: f32, ior: f32, entering: bool| albedo::glass_albedo(&TABLES, cosine, width, ior, entering),
        "glass_albedo(0u, $0, $1, $2, $3)",
        |rows| {
            rows.random(|d, row| {
                row.extend([range(d, 0.0, 1.0), share(d).to_bits(), range(d, 1.03, 3.0), d.bits() & 1])
            })
        }
    ),
    probe!(layers::retro_albedo, pair),
    probe!(bsdf::retro_value, |rows| directions(rows, 2, above, |d, row| row.push(share(d).to_bits()))),
    probe!(layers::reflect_albedo, |rows| {
        rows.random(|d, row| {
            (0..3).for_each(|_| row.push(share(d).to_bits()));
            row.extend([range(d, 0.3, 1.0), range(d, 0.0, 0.3)]);
        })
    }),
    probe!(layers::layers, |s: Surface, wo: Vec3| layers_of(&s, wo), "layers($0, $1, 0u)", |rows| surfaces(
        rows,
        |_, _| {}
    )),
    probe!(
        bsdf::eval,
        |s: Surface, wo: Vec3, wi: Vec3| bsdf::eval(&layers_of(&s, wo), wo, wi, Lobes::ALL),
        "let l = layers($0, $1, 0u); eval(l, $1, $2)",
        |rows| surfaces(rows, |d, row| put(row, anywhere(d)))
    ),
    probe!(
        bsdf::sample,
        |s: Surface, wo: Vec3, u: [f32; 4]| bsdf::sample(&layers_of(&s, wo), wo, u, Lobes::ALL),
        "let l = layers($0, $1, 0u); let r = sample(l, $1, $2); out_v(r.wi); out_v(r.value); out_f(r.pdf);",
        |rows| surfaces(rows, |d, row| (0..4).for_each(|_| row.push(one_draw(d))))
    ),
];

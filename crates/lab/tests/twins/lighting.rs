//! Probes of light and texture functions: light, shading, texel, and path draws.

use crate::probe::{Out, Probe, Row, Rows};
use crate::scattering::{anywhere, put, share, two};
use crate::values::*;
use afterimage_lab::kernel::{light, shading, texel};
use afterimage_testing::Draws;
use glam::{Vec3, Vec4};

fn put_four(o: &mut Out, v: Vec4) {
    v.to_array().into_iter().for_each(|x| o.f(x));
}

fn color(d: &mut Draws, row: &mut Vec<u32>) {
    (0..3).for_each(|_| row.push(share(d).to_bits()));
}

/// Two directions that are not opposite, such as a shading normal and its geometric normal.
fn beside(d: &mut Draws, v: Vec3) -> Vec3 {
    let off = Vec3::new(d.range(-1.0, 1.0), d.range(-1.0, 1.0), d.range(-1.0, 1.0));
    (v + off * d.uniform()).normalize_or(v)
}

fn uv(r: &Row<'_>) -> [f32; 2] {
    two(r, 0).to_array()
}

pub const PROBES: &[Probe] = &[
    Probe {
        name: "distance_falloff",
        module: "light",
        words: [2, 1],
        wgsl: "out_f(distance_falloff(in_f(0u), in_f(1u)));",
        rust: |r, o| o.f(light::distance_falloff(r.f(0), r.f(1))),
        rows: || {
            let distances = [around(&[1e-3, 1.0, 10.0]), floats(&[0.0, 1e-6, 1e4])].concat();
            // An infinite range means a light without a window.
            let ranges = [around(&[1.0, 10.0]), floats(&[0.5, 1e6, f32::INFINITY])].concat();
            Rows::new(2)
                .cross(&[&distances, &ranges])
                .random("falloff", |d, row| row.extend([scaled(d, -12, 10), scaled(d, -3, 12)]))
                .random("falloff, endless", |d, row| row.extend([scaled(d, -12, 10), f32::INFINITY.to_bits()]))
        },
    },
    Probe {
        name: "cone_falloff",
        module: "light",
        words: [3, 1],
        wgsl: "out_f(cone_falloff(in_f(0u), in_f(1u), in_f(2u)));",
        rust: |r, o| o.f(light::cone_falloff(r.f(0), r.f(1), r.f(2))),
        rows: || {
            let cosines = [around(&[0.5, 0.9]), floats(&[-1.0, 0.0, 1.0])].concat();
            Rows::new(3).cross(&[&cosines, &cosines, &cosines]).random("cone", |d, row| {
                let outer = d.range(-1.0, 1.0);
                row.extend([d.range(-1.0, 1.0), d.range(outer, 1.0), outer].map(f32::to_bits));
            })
        },
    },
    Probe {
        name: "map_coordinates",
        module: "light",
        words: [3, 2],
        wgsl: "let p = map_coordinates(in_v(0u)); out_f(p.x); out_f(p.y);",
        rust: |r, o| light::map_coordinates(r.v(0)).into_iter().for_each(|x| o.f(x)),
        rows: || {
            let axis = floats(&[0.0, -0.0, 1.0, -1.0, 1e-10, -1e-10]);
            Rows::new(3).cross(&[&axis, &axis, &axis]).random("map_coordinates", |d, row| {
                let v = anywhere(d);
                put(row, if d.bits() % 2 == 0 { v } else { Vec3::new(v.z, v.x, v.y) });
            })
        },
    },
    Probe {
        name: "map_direction",
        module: "light",
        words: [2, 4],
        wgsl: "let m = map_direction(in_f(0u), in_f(1u)); out_v(m.direction); out_f(m.sine);",
        rust: |r, o| {
            let [u, v] = uv(r);
            let (direction, sine) = light::map_direction(u, v);
            o.v(direction);
            o.f(sine);
        },
        rows: || {
            // Without arguments whose sine is nearly denormal: a device may flush their products to zero.
            let ends = floats(&[0.0, 0.125, 0.25, 0.5, 0.75, 0.999, 1.0]);
            Rows::new(2)
                .cross(&[&ends, &ends])
                .random("map_direction", |d, row| row.extend([range(d, 0.0, 1.0), range(d, 0.0, 1.0)]))
        },
    },
    Probe {
        name: "map_pdf",
        module: "light",
        words: [3, 1],
        wgsl: "out_f(map_pdf(in_f(0u), in_f(1u), in_f(2u)));",
        rust: |r, o| o.f(light::map_pdf(r.f(0), r.f(1), r.f(2))),
        rows: || {
            let sines = [around(&[1e-6, 1.0]), floats(&[0.0])].concat();
            Rows::new(3).cross(&[&floats(&[0.0, 1e-9, 0.25, 1.0]), &floats(&[1.0, 2048.0, 1e6]), &sines]).random(
                "map_pdf",
                |d, row| {
                    row.extend([range(d, 0.0, 1.0), ((d.bits() % 1_000_000 + 1) as f32).to_bits(), range(d, 0.0, 1.0)])
                },
            )
        },
    },
    Probe {
        name: "mapped_normal",
        module: "shading",
        words: [11, 3],
        wgsl: "out_v(mapped_normal(in_v(0u), in_v(3u), in_f(6u), in_v(7u), in_f(10u)));",
        rust: |r, o| o.v(shading::mapped_normal(r.v(0), r.v(3), r.f(6), r.v(7), r.f(10))),
        rows: || {
            Rows::new(11).random("mapped_normal", |d, row| {
                put(row, anywhere(d));
                put(row, anywhere(d));
                row.push(if d.bits() % 2 == 0 { 1.0_f32 } else { -1.0 }.to_bits());
                (0..3).for_each(|_| row.push(((d.bits() % 256) as f32 / 255.0).to_bits()));
                row.push(if d.bits() % 2 == 0 { 1.0_f32.to_bits() } else { range(d, 0.0, 2.0) });
            })
        },
    },
    Probe {
        name: "visible_normal",
        module: "shading",
        words: [9, 3],
        wgsl: "out_v(visible_normal(in_v(0u), in_v(3u), in_v(6u)));",
        rust: |r, o| o.v(shading::visible_normal(r.v(0), r.v(3), r.v(6))),
        rows: || {
            Rows::new(9).random("visible_normal", |d, row| {
                let toward = anywhere(d);
                let face = anywhere(d);
                let geometric = if face.dot(toward) < 0.0 { -face } else { face };
                put(row, beside(d, geometric));
                put(row, geometric);
                put(row, toward);
            })
        },
    },
    Probe {
        name: "hue",
        module: "shading",
        words: [3, 3],
        wgsl: "out_v(hue(in_v(0u)));",
        rust: |r, o| o.v(shading::hue(r.v(0))),
        rows: || {
            let axis = [around(&[1e-6]), floats(&[0.0, 0.25, 1.0])].concat();
            Rows::new(3).cross(&[&axis, &axis, &axis]).random("hue", color)
        },
    },
    Probe {
        name: "tint",
        module: "shading",
        words: [4, 3],
        wgsl: "out_v(tint(in_v(0u), in_f(3u)));",
        rust: |r, o| o.v(shading::tint(r.v(0), r.f(3))),
        rows: || {
            Rows::new(4).random("tint", |d, row| {
                color(d, row);
                row.push(share(d).to_bits());
            })
        },
    },
    Probe {
        name: "wrap_coordinate",
        module: "texel",
        words: [2, 1],
        wgsl: "out_f(wrap_coordinate(in_f(0u), in_u(1u)));",
        rust: |r, o| o.f(texel::wrap_coordinate(r.f(0), r.u(1))),
        rows: || {
            let places = around(&[0.0, 0.5, 1.0, 2.0, -1.0, -0.5, 1e4, -1e4]);
            let normal: Vec<u32> = places.into_iter().filter(|x| x << 1 == 0 || x << 1 >= 0x0100_0000).collect();
            Rows::new(2)
                .cross(&[&normal, &[0, 1, 2]])
                .random("wrap_coordinate", |d, row| row.extend([range(d, -10.0, 10.0), d.bits() % 3]))
        },
    },
    Probe {
        name: "wrap_texel",
        module: "texel",
        words: [3, 1],
        wgsl: "out_u(wrap_texel(bitcast<i32>(in_u(0u)), in_u(1u), in_u(2u)));",
        rust: |r, o| o.u(texel::wrap_texel(r.u(0) as i32, r.u(1), r.u(2))),
        rows: || {
            Rows::new(3).random("wrap_texel", |d, row| {
                let (size, wrap) = (1 + d.bits() % if d.bits() % 2 == 0 { 4 } else { 5000 }, d.bits() % 3);
                let period = if wrap == texel::WRAP_MIRROR { 2 * size } else { size };
                // From one before the period to one after it.
                row.extend([(d.bits() % (period + 2)).wrapping_sub(1), size, wrap]);
            })
        },
    },
    Probe {
        name: "texel_value",
        module: "texel",
        words: [1, 4],
        wgsl: "let v = texel_value(in_u(0u)); out_f(v.x); out_f(v.y); out_f(v.z); out_f(v.w);",
        rust: |r, o| put_four(o, texel::texel_value(r.u(0))),
        rows: || {
            let mut rows = Rows::new(1).random("texel_value", |d, row| row.push(d.bits()));
            rows.words.extend((0..=255).map(|byte| byte * 0x0101_0101));
            rows
        },
    },
];

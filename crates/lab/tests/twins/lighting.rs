//! Probes of light and texture functions: light, shading, texel, and path draws.

use crate::probe::{Probe, probe};
use crate::scattering::{anywhere, put, put_all, share};
use crate::values::*;
use afterimage_lab::kernel::{light, shading, texel};
use afterimage_testing::Draws;
use glam::Vec3;

fn color(d: &mut Draws, row: &mut Vec<u32>) {
    (0..3).for_each(|_| row.push(share(d).to_bits()));
}

/// Two directions that are not opposite, such as a shading normal and its geometric normal.
fn beside(d: &mut Draws, v: Vec3) -> Vec3 {
    let off = Vec3::new(d.range(-1.0, 1.0), d.range(-1.0, 1.0), d.range(-1.0, 1.0));
    (v + off * d.uniform()).normalize_or(v)
}

pub const PROBES: &[Probe] = &[
    probe!(light::distance_falloff, |rows| {
        let distances = [around(&[1e-3, 1.0, 10.0]), floats(&[0.0, 1e-6, 1e4])].concat();
        // An infinite range means a light without a window.
        let ranges = [around(&[1.0, 10.0]), floats(&[0.5, 1e6, f32::INFINITY])].concat();
        rows.cross(&[&distances, &ranges])
            .random_of("falloff", |d, row| row.extend([scaled(d, -12, 10), scaled(d, -3, 12)]))
            .random_of("falloff, endless", |d, row| row.extend([scaled(d, -12, 10), f32::INFINITY.to_bits()]))
    }),
    probe!(light::cone_falloff, |rows| {
        let cosines = [around(&[0.5, 0.9]), floats(&[-1.0, 0.0, 1.0])].concat();
        rows.cross(&[&cosines, &cosines, &cosines]).random_of("cone", |d, row| {
            let outer = d.range(-1.0, 1.0);
            row.extend([d.range(-1.0, 1.0), d.range(outer, 1.0), outer].map(f32::to_bits));
        })
    }),
    probe!(light::map_coordinates, |rows| {
        let axis = floats(&[0.0, -0.0, 1.0, -1.0, 1e-10, -1e-10]);
        rows.cross(&[&axis, &axis, &axis]).random(|d, row| {
            let v = anywhere(d);
            put(row, if d.bits() % 2 == 0 { v } else { Vec3::new(v.z, v.x, v.y) });
        })
    }),
    probe!(
        light::map_direction,
        light::map_direction,
        "let m = map_direction($0, $1); out_v(m.direction); out_f(m.sine);",
        |rows| {
            // Without arguments whose sine is nearly denormal: a device may flush their products to zero.
            let ends = floats(&[0.0, 0.125, 0.25, 0.5, 0.75, 0.999, 1.0]);
            rows.cross(&[&ends, &ends]).random(|d, row| row.extend([range(d, 0.0, 1.0), range(d, 0.0, 1.0)]))
        }
    ),
    probe!(light::map_pdf, |rows| {
        let sines = [around(&[1e-6, 1.0]), floats(&[0.0])].concat();
        rows.cross(&[&floats(&[0.0, 1e-9, 0.25, 1.0]), &floats(&[1.0, 2048.0, 1e6]), &sines]).random(|d, row| {
            row.extend([range(d, 0.0, 1.0), ((d.bits() % 1_000_000 + 1) as f32).to_bits(), range(d, 0.0, 1.0)])
        })
    }),
    probe!(shading::mapped_normal, |rows| {
        rows.random(|d, row| {
            put_all(row, [anywhere(d), anywhere(d)]);
            row.push(if d.bits() % 2 == 0 { 1.0_f32 } else { -1.0 }.to_bits());
            (0..3).for_each(|_| row.push(((d.bits() % 256) as f32 / 255.0).to_bits()));
            row.push(if d.bits() % 2 == 0 { 1.0_f32.to_bits() } else { range(d, 0.0, 2.0) });
        })
    }),
    probe!(shading::visible_normal, |rows| {
        rows.random(|d, row| {
            let toward = anywhere(d);
            let face = anywhere(d);
            let geometric = if face.dot(toward) < 0.0 { -face } else { face };
            put_all(row, [beside(d, geometric), geometric, toward]);
        })
    }),
    probe!(shading::hue, |rows| {
        let axis = [around(&[1e-6]), floats(&[0.0, 0.25, 1.0])].concat();
        rows.cross(&[&axis, &axis, &axis]).random(color)
    }),
    probe!(shading::tint, |rows| {
        rows.random(|d, row| {
            color(d, row);
            row.push(share(d).to_bits());
        })
    }),
    probe!(texel::wrap_coordinate, |rows| {
        let places = around(&[0.0, 0.5, 1.0, 2.0, -1.0, -0.5, 1e4, -1e4]);
        let normal: Vec<u32> = places.into_iter().filter(|x| x << 1 == 0 || x << 1 >= 0x0100_0000).collect();
        rows.cross(&[&normal, &[0, 1, 2]]).random(|d, row| row.extend([range(d, -10.0, 10.0), d.bits() % 3]))
    }),
    probe!(texel::wrap_texel, |rows| {
        rows.random(|d, row| {
            let (size, wrap) = (1 + d.bits() % if d.bits() % 2 == 0 { 4 } else { 5000 }, d.bits() % 3);
            let period = if wrap == texel::WRAP_MIRROR { 2 * size } else { size };
            // From one before the period to one after it.
            row.extend([(d.bits() % (period + 2)).wrapping_sub(1), size, wrap]);
        })
    }),
    probe!(texel::texel_value, |rows| {
        let mut rows = rows.random(|d, row| row.push(d.bits()));
        rows.words.extend((0..=255).map(|byte| byte * 0x0101_0101));
        rows
    }),
];

//! Area that a lens shows: lens.

use super::probe::{Probe, Rows};
use super::values::*;
use afterimage::kernel::lens;
use glam::Vec4;

pub const PROBES: &[Probe] = &[Probe {
    name: "is_visible",
    module: "lens",
    words: [10, 1],
    wgsl: "
        let lowest = vec4<f32>(in_f(2u), in_f(3u), in_f(4u), in_f(5u));
        let highest = vec4<f32>(in_f(6u), in_f(7u), in_f(8u), in_f(9u));
        out_u(select(0u, 1u, is_visible(in_u(0u), in_u(1u), lowest, highest)));",
    rust: |r, o| {
        let bounds = |i: usize| Vec4::new(r.f(i), r.f(i + 1), r.f(i + 2), r.f(i + 3));
        o.u(u32::from(lens::is_visible(r.u(0), r.u(1), bounds(2), bounds(6))));
    },
    rows: || {
        let corner = [0, 1, 16383];
        let (least, most) = (floats(&[f32::MIN]), floats(&[f32::MAX]));
        let edge = floats(&[0.0, 0.5, 1.0, 16383.0, 32766.0]);
        let any = [&least[..], &edge[..]].concat();
        let none = [&most[..], &edge[..]].concat();
        Rows::new(10).cross(&[&corner, &corner, &any, &least, &any, &least, &none, &most, &most, &none]).random(
            "is_visible",
            |d, row| {
                row.extend([d.bits() % 64, d.bits() % 64]);
                row.extend([0.0, 0.0, 0.0, -64.0].map(|low| range(d, low, low + 24.0)));
                row.extend([40.0, 40.0, 80.0, 40.0].map(|low| range(d, low, low + 24.0)));
            },
        )
    },
}];

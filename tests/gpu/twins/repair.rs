//! Repair of sparse frames: repair.

use super::probe::{Probe, Rows};
use super::values::*;
use afterimage::kernel::repair;

pub const PROBES: &[Probe] = &[
    Probe {
        name: "priority",
        module: "repair",
        words: [2, 1],
        wgsl: "out_u(priority(in_f(0u), in_f(1u)));",
        rust: |r, o| o.u(repair::priority(r.f(0), r.f(1))),
        rows: || {
            let lods = floats(&[-1.0, 0.0, 0.99, 1.0, 1.01, 8.0]);
            let degrees = floats(&[0.0, 1.99, 2.0, 59.9, 60.0, 62.0, 180.0]);
            Rows::new(2).cross(&[&lods, &degrees]).random("priority", |d, row| {
                row.extend([range(d, -1.0, 4.0), range(d, 0.0, 90.0)]);
            })
        },
    },
    Probe {
        name: "asked_px",
        module: "repair",
        words: [4, 2],
        wgsl: "let p = asked_px(in_u(0u), in_u(1u), in_u(2u), in_u(3u)); out_u(p.x); out_u(p.y);",
        rust: |r, o| repair::asked_px(r.u(0), r.u(1), r.u(2), r.u(3)).into_iter().for_each(|side| o.u(side)),
        rows: || {
            Rows::new(4).random("asked_px", |d, row| {
                row.extend([d.bits() % 2, d.bits() % 4096, d.bits() % 4096, d.bits()]);
            })
        },
    },
    Probe {
        name: "quad_key",
        module: "repair",
        words: [5, 1],
        wgsl: "out_u(quad_key(in_u(0u), in_u(1u), in_u(2u), in_u(3u), in_u(4u)));",
        rust: |r, o| o.u(repair::quad_key(r.u(0), r.u(1), r.u(2), r.u(3), r.u(4))),
        rows: || {
            Rows::new(5).random("quad_key", |d, row| {
                row.push(d.bits() % 63);
                row.extend([0; 4].map(|_| d.bits()));
            })
        },
    },
];

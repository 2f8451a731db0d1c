//! Repair of sparse frames: repair.

use super::probe::{Probe, probe};
use super::values::*;
use afterimage::kernel::repair;

pub const PROBES: &[Probe] = &[
    probe!(repair::priority, |rows| {
        let lods = floats(&[-1.0, 0.0, 0.99, 1.0, 1.01, 8.0]);
        let degrees = floats(&[0.0, 1.99, 2.0, 59.9, 60.0, 62.0, 180.0]);
        rows.cross(&[&lods, &degrees]).random(|d, row| {
            row.extend([range(d, -1.0, 4.0), range(d, 0.0, 90.0)]);
        })
    }),
    probe!(repair::asked_px, |rows| {
        rows.random(|d, row| {
            row.extend([d.bits() % 2, d.bits() % 4096, d.bits() % 4096, d.bits()]);
        })
    }),
    probe!(repair::quad_key, |rows| {
        rows.random(|d, row| {
            row.push(d.bits() % 63);
            row.extend([0; 4].map(|_| d.bits()));
        })
    }),
];

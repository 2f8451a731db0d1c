//! Places of samples: lattice.

use super::*;
use afterimage::kernel::lattice;

pub const PROBES: &[Probe] = &[probe!(lattice::place_weight, |rows| {
    let offsets: Vec<f32> = (-256..=256).map(|i| i as f32).collect();
    rows.cross(&[&floats(&offsets), &floats(&[-255.0, -3.0, 0.0, 1.0, 8.0])])
})];

//! Area that a lens shows: lens.

use super::*;
use afterimage::kernel::lens;

pub const PROBES: &[Probe] = &[probe!(lens::is_visible, |rows| {
    let corner = [0, 1, 16383];
    let (least, most) = (floats(&[f32::MIN]), floats(&[f32::MAX]));
    let edge = floats(&[0.0, 0.5, 1.0, 16383.0, 32766.0]);
    let any = [&least[..], &edge[..]].concat();
    let none = [&most[..], &edge[..]].concat();
    rows.cross(&[&corner, &corner, &any, &least, &any, &least, &none, &most, &most, &none]).random(|d, row| {
        row.extend([d.bits() % 64, d.bits() % 64]);
        row.extend([0.0, 0.0, 0.0, -64.0].map(|low| range(d, low, low + 24.0)));
        row.extend([40.0, 40.0, 80.0, 40.0].map(|low| range(d, low, low + 24.0)));
    })
})];

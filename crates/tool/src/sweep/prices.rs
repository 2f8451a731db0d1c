//! Cost and effect of each switch.

use super::metrics::METRICS;
use super::row::Row;
use afterimage_lab::clock::Quartiles;
use serde::Serialize;
use std::collections::BTreeMap;

/// A point with a switch, compared with the same point without it.
#[derive(Clone, Debug, Serialize)]
pub struct Price {
    /// The switch and its value, as on the command line.
    pub switch: String,
    /// The input.
    pub input: String,
    /// The method.
    pub method: String,
    /// [`Row::id`] of the point without it.
    pub base: String,
    /// [`Row::id`] of the point with it.
    pub switched: String,
    /// Milliseconds of the pass, without it and with it.
    pub pass_ms: [f64; 2],
    /// Time of the pass with the switch, divided by its time without the switch. Median and quartiles of the per-frame
    /// ratios if both points were measured in the same round, which cancels differences between frames; else from the
    /// quartiles of both times.
    pub time_ratio: Quartiles,
    /// Bytes per pixel that the pass reads and writes, without it and with it.
    pub bytes_per_pixel: [Option<u32>; 2],
    /// Persistent bytes per pixel, without it and with it.
    pub memory_bytes_per_pixel: [f64; 2],
    /// Values by [`METRICS`]' keys, without it and with it.
    pub values: BTreeMap<&'static str, [Option<f64>; 2]>,
}

/// Compares every pair of points that differ in one additional option.
pub(super) fn prices(rows: &[Row]) -> Vec<Price> {
    let mut prices = vec![];
    for switched in rows {
        for (name, value) in &switched.point.options {
            let mut options = switched.point.options.clone();
            options.remove(name);
            let (input, method) = (&switched.point.input, &switched.point.method);
            let is_base = |r: &&Row| (&r.point.input, &r.point.method, &r.point.options) == (input, method, &options);
            prices.extend(rows.iter().find(is_base).map(|base| price(name, value, base, switched)));
        }
    }
    prices.sort_by(|a, b| (&a.input, &a.switch, &a.method).cmp(&(&b.input, &b.switch, &b.method)));
    prices
}

fn price(name: &str, value: &str, base: &Row, switched: &Row) -> Price {
    Price {
        switch: if value.is_empty() { name.to_owned() } else { format!("{name} {value}") },
        input: base.point.input.clone(),
        method: base.point.method.clone(),
        base: base.id.clone(),
        switched: switched.id.clone(),
        pass_ms: [base.pass_ms.median, switched.pass_ms.median],
        time_ratio: time_ratio(base, switched),
        bytes_per_pixel: [base.bytes_per_pixel, switched.bytes_per_pixel],
        memory_bytes_per_pixel: [base.memory_bytes_per_pixel, switched.memory_bytes_per_pixel],
        values: METRICS.iter().map(|m| (m.key, [base.value(m.key), switched.value(m.key)])).collect(),
    }
}

fn time_ratio(base: &Row, switched: &Row) -> Quartiles {
    let (same_round, pairs) = (base.frames.0 == switched.frames.0, base.frames.1.iter().zip(&switched.frames.1));
    let ratios: Vec<f64> =
        pairs.map(|(without, with)| with / without).filter(|r| same_round && r.is_finite()).collect();
    let (a, b) = (base.pass_ms, switched.pass_ms);
    let apart = Quartiles { median: b.median / a.median, p25: b.p25 / a.p75, p75: b.p75 / a.p25 };
    Quartiles::of(&ratios).unwrap_or(apart)
}

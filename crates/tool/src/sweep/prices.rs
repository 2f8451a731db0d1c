//! What a switch costs and buys.

use super::metrics::METRICS;
use super::table::Row;
use afterimage_lab::clock::Quartiles;
use serde::Serialize;
use std::collections::BTreeMap;

/// A point with a switch thrown, and the same without.
#[derive(Clone, Debug, Serialize)]
pub struct Price {
    /// The switch, as it is typed.
    pub switch: String,
    /// What is sampled.
    pub input: String,
    /// Which method.
    pub method: String,
    /// [`Row::id`] of the point without it.
    pub base: String,
    /// [`Row::id`] of the point with it.
    pub switched: String,
    /// Milliseconds of the pass, without it and with it.
    pub pass_ms: [f64; 2],
    /// Time of the pass with it over that without it: median and quartiles over the frames, frame by frame where both were measured in one
    /// round, so that what makes a frame dear for both is not in it; else of the times' own quartiles.
    pub time_ratio: Quartiles,
    /// Bytes that the pass reads and writes a pixel, without it and with it.
    pub bytes_per_pixel: [Option<u32>; 2],
    /// Bytes kept a pixel, without it and with it.
    pub memory_bytes_per_pixel: [f64; 2],
    /// Figures by [`METRICS`]' keys, without it and with it.
    pub values: BTreeMap<&'static str, [Option<f64>; 2]>,
}

/// Of every pair of points of which one has an option more than the other, and all else alike.
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
    let value_of = |row: &Row, key: &str| row.values.get(key).copied().flatten();
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
        values: METRICS.iter().map(|m| (m.key, [value_of(base, m.key), value_of(switched, m.key)])).collect(),
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

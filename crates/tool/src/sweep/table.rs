//! Table of a sweep: merges seeds, corrects times for drift, marks the frontier.

use super::convergence::{Convergence, convergences};
use super::frontier::{Standing, frontier};
use super::grid::{Options, Point};
use super::measurement::{ClipFacts, Machine, Measurement};
use super::metrics::METRICS;
use super::prices::{Price, prices};
use super::row::Row;
use super::rust_source::name_of;
use super::store::id;
use crate::output::csv_cell;
use afterimage_lab::clock::Quartiles;
use serde::Serialize;
use std::collections::BTreeMap;

/// Results of a sweep.
#[derive(Clone, Debug, Serialize)]
pub struct Table {
    /// `afterimage`.
    pub tool: &'static str,
    /// Version of the tool.
    pub version: String,
    /// The command that wrote the table.
    pub command: String,
    /// Options that all points share.
    pub common: Options,
    /// Properties of the clips, by input.
    pub clips: BTreeMap<String, ClipFacts>,
    /// Machines; several after a merge.
    pub machines: Vec<Machine>,
    /// Time of the renderer for a full-rate frame, milliseconds, from the command line.
    pub renderer_ms: Option<f64>,
    /// Points, sorted by input and cost.
    pub rows: Vec<Row>,
    /// Cost and effect of each switch.
    pub prices: Vec<Price>,
    /// Convergence of traced points.
    pub convergences: Vec<Convergence>,
}

impl Table {
    /// The table of a sweep's measurements. `renderer_ms`: time of the renderer for a full-rate frame, if known.
    pub fn new(measurements: &[Measurement], renderer_ms: Option<f64>, command: String) -> Self {
        let mut groups: BTreeMap<Point, Vec<&Measurement>> = BTreeMap::new();
        for m in measurements {
            groups.entry(Point { seed: 0, ..m.point.clone() }).or_default().push(m);
        }
        let controls = controls(measurements);
        let shared = shared_options(groups.keys());
        let mut rows: Vec<Row> = groups
            .values()
            .map(|group| row(group, controls[group[0].point.input.as_str()], renderer_ms, &shared))
            .collect();
        mark_frontiers(&mut rows, renderer_ms);
        rows.sort_by(|a, b| a.point.input.cmp(&b.point.input).then(a.cost_ms.total_cmp(&b.cost_ms)));
        let mut machines: Vec<Machine> = vec![];
        for m in measurements {
            if !machines.contains(&m.machine) {
                machines.push(m.machine.clone());
            }
        }
        let first = measurements.first();
        Self {
            tool: "afterimage",
            version: first.map_or_else(String::new, |m| m.version.clone()),
            command,
            common: first.map_or_else(Options::new, |m| m.common.clone()),
            clips: measurements.iter().map(|m| (m.point.input.clone(), m.clip.clone())).collect(),
            machines,
            renderer_ms,
            prices: prices(&rows),
            convergences: convergences(&rows),
            rows,
        }
    }

    /// The table as CSV, one line per point.
    pub fn csv(&self) -> String {
        let metrics = METRICS.iter().map(|m| m.key).collect::<Vec<_>>().join(",");
        let mut text = format!(
            "input,label,method,seeds,cost_ms,pass_ms,pass_p25_ms,pass_p75_ms,render_ms,copy_ms,drift,samples_share,\
             bytes_per_pixel,memory_bytes_per_pixel,{metrics},frontier,command,\
             post_ms,total_ms,render_cpu_ms,post_cpu_ms,total_cpu_ms\n"
        );
        for row in &self.rows {
            let number = |v: Option<f64>| v.map_or_else(String::new, |v| v.to_string());
            let mut cells =
                vec![csv_cell(&row.point.input), csv_cell(&row.label), row.point.method.clone(), row.seeds.to_string()];
            let times = [row.cost_ms, row.pass_ms.median, row.pass_ms.p25, row.pass_ms.p75].map(Some);
            let rest = [row.render_ms, Some(row.copy_ms), Some(row.drift), Some(row.samples_share)];
            cells.extend(times.into_iter().chain(rest).map(number));
            cells.extend([number(row.bytes_per_pixel.map(f64::from)), row.memory_bytes_per_pixel.to_string()]);
            cells.extend(METRICS.iter().map(|m| number(row.value(m.key))));
            cells.extend([row.frontier.join(" "), csv_cell(&row.command)]);
            let whole = [Some(row.post_ms), row.total_ms, row.render_cpu_ms, row.post_cpu_ms, row.total_cpu_ms];
            cells.extend(whole.map(number));
            text += &(cells.join(",") + "\n");
        }
        text
    }
}

/// Median time of the control method, by input.
fn controls(measurements: &[Measurement]) -> BTreeMap<&str, f64> {
    let mut by_input: BTreeMap<&str, Vec<f64>> = BTreeMap::new();
    for m in measurements {
        by_input.entry(&m.point.input).or_default().push(m.control_ms.median);
    }
    by_input.into_iter().filter_map(|(input, times)| Some((input, Quartiles::of(&times)?.median))).collect()
}

/// Options with the same value in all points, which labels leave out.
fn shared_options<'a>(points: impl Iterator<Item = &'a Point>) -> Options {
    let mut points = points.map(|p| &p.options);
    let Some(first) = points.next() else { return Options::new() };
    let mut shared = first.clone();
    points.for_each(|options| shared.retain(|name, value| options.get(name) == Some(value)));
    shared
}

fn row(group: &[&Measurement], control_ms: f64, renderer_ms: Option<f64>, shared: &Options) -> Row {
    let first = group[0];
    let count = group.len() as f64;
    let mean = |of: &dyn Fn(&Measurement) -> f64| group.iter().map(|m| of(m)).sum::<f64>() / count;
    let drift = |m: &Measurement| if m.control_ms.median > 0.0 { control_ms / m.control_ms.median } else { 1.0 };
    let pass_ms = Quartiles {
        median: mean(&|m| drift(m) * m.pass_ms.median),
        p25: mean(&|m| drift(m) * m.pass_ms.p25),
        p75: mean(&|m| drift(m) * m.pass_ms.p75),
    };
    let samples_share = mean(&|m| m.samples_share);
    let of_seeds = |of: &dyn Fn(&Measurement) -> Option<f64>| -> Option<f64> {
        group.iter().map(|m| Some(drift(m) * of(m)?)).sum::<Option<f64>>().map(|sum| sum / count)
    };
    let measured_ms = of_seeds(&|m| m.render_ms.map(|q| q.median));
    // What the user says of the renderer counts, even where ours was measured.
    let render_ms = renderer_ms.map(|ms| ms * samples_share).or(measured_ms);
    let (render_cpu_ms, post_cpu_ms) = (of_seeds(&|m| m.render_cpu_ms), of_seeds(&|m| m.pass_cpu_ms));
    let mut values = BTreeMap::new();
    let mut spread = BTreeMap::new();
    for metric in METRICS {
        let values_of: Option<Vec<f64>> = group.iter().map(|m| (metric.of)(&m.figures.scores)).collect();
        if let Some(seeds) = values_of.as_ref().filter(|seeds| seeds.len() > 1) {
            let most = |a: [f64; 2], &v: &f64| [a[0].min(v), a[1].max(v)];
            spread.insert(metric.key, seeds.iter().fold([f64::INFINITY, f64::NEG_INFINITY], most));
        }
        values.insert(metric.key, values_of.map(|seeds| seeds.iter().sum::<f64>() / count));
    }
    let options = first.point.options.iter().filter(|(name, value)| shared.get(*name) != Some(*value));
    let words = options.map(|(name, value)| if value.is_empty() { name.clone() } else { format!("{name} {value}") });
    let name = name_of(&first.rust).map(str::to_owned);
    Row {
        id: id(&first.point),
        label: [first.point.method.clone()].into_iter().chain(words).chain(name).collect::<Vec<_>>().join(", "),
        seeds: group.len(),
        pass_ms,
        frames: (first.round.clone(), first.frame_ms.clone()),
        drift: mean(&drift),
        render_ms,
        cost_ms: pass_ms.median + render_ms.unwrap_or(0.0),
        post_ms: pass_ms.median,
        total_ms: render_ms.map(|ms| ms + pass_ms.median),
        render_cpu_ms,
        post_cpu_ms,
        total_cpu_ms: render_cpu_ms.zip(post_cpu_ms).map(|(render, post)| render + post),
        samples_share,
        samples_per_pixel: first.samples_per_pixel.map(|_| mean(&|m| m.samples_per_pixel.unwrap_or(0.0))),
        copy_ms: mean(&|m| drift(m) * m.copy_ms),
        bytes_per_pixel: first.figures.bytes_per_pixel,
        memory_bytes_per_pixel: first.figures.persistent_bytes_per_pixel,
        values,
        mse: [0, 1, 2, 3].map(|i| {
            let of =
                |m: &&Measurement| [&m.figures.scores.whole].into_iter().chain(&m.figures.scores.bands).nth(i)?.mse;
            group.iter().map(of).sum::<Option<f64>>().map(|sum| sum / count)
        }),
        spread,
        frontier: vec![],
        nonfinite_out: group.iter().map(|m| m.figures.nonfinite_out).sum(),
        command: first.point.command(&first.common),
        rust: first.rust.clone(),
        point: first.point.clone(),
    }
}

/// Marks the frontier of each input and metric. Without the oracle, which no renderer can run.
fn mark_frontiers(rows: &mut [Row], renderer_ms: Option<f64>) {
    let inputs: std::collections::BTreeSet<String> = rows.iter().map(|r| r.point.input.clone()).collect();
    for input in inputs {
        let runs = |r: &Row| r.point.input == input && r.is_choice();
        let of_input: Vec<usize> = (0..rows.len()).filter(|&i| runs(&rows[i])).collect();
        for metric in METRICS {
            let standings: Vec<Standing> = of_input.iter().map(|&i| rows[i].standing(metric, renderer_ms)).collect();
            for (&i, is_best) in of_input.iter().zip(frontier(&standings)) {
                if is_best {
                    rows[i].frontier.push(metric.key);
                }
            }
        }
    }
}

impl Row {
    /// Value of the metric with this key; `None` if it was not measured, and for the PSNR of equal pictures.
    pub fn value(&self, key: &str) -> Option<f64> {
        self.values.get(key).copied().flatten()
    }

    /// Whether a program can use the method: the oracle is only an upper bound.
    pub fn is_choice(&self) -> bool {
        self.point.method != "oracle"
    }

    /// Cost and error in a metric. The share of the samples counts as a cost if the renderer's time is not known.
    pub fn standing(&self, metric: &super::Metric, renderer_ms: Option<f64>) -> Standing {
        let priced = renderer_ms.is_some() || self.render_ms.is_some();
        let error = match self.value(metric.key) {
            // The metric was not measured. (A missing PSNR means zero error.)
            None if !metric.key.ends_with("psnr_db") => f64::NAN,
            value => metric.error(value),
        };
        Standing { cost_ms: self.cost_ms, samples_share: if priced { 0.0 } else { self.samples_share }, error }
    }
}

//! Comparison of methods at equal time and at equal quality.

use super::frontier::{Standing, frontier};
use super::metrics::Metric;
use super::row::Row;
use super::table::Table;
use crate::args::{MethodName, Named};
use serde::Serialize;
use std::collections::BTreeMap;

/// Limit on the lines of a table; further steps of the frontier are thinned out evenly.
const MAX_LINES: usize = 7;

/// Rows with comparable costs: the renderer's time is known, or all trace the same share of the samples.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Section {
    /// Share of the samples, rounded to a thousandth; `None` if the renderer's time is known.
    pub samples_share: Option<f64>,
    /// Number of rows.
    pub points: usize,
    /// Methods, in the order of the columns.
    pub methods: Vec<String>,
    /// One line per budget in milliseconds.
    pub equal_time: Vec<Line>,
    /// One line per level of the metric, lowest quality first.
    pub equal_quality: Vec<Line>,
}

/// The best point of each method within a bound.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Line {
    /// Largest time in milliseconds, or lowest acceptable quality in the metric.
    pub bound: f64,
    /// The best point per method; `None` if no point is within the bound.
    pub cells: Vec<Option<Cell>>,
}

/// The best point of a method within a bound.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Cell {
    /// [`Row::id`].
    pub row: String,
    /// Cost in milliseconds.
    pub cost_ms: f64,
    /// Value of the metric; `None` for the PSNR of equal pictures.
    pub value: Option<f64>,
}

/// A row with its value and error in the metric.
#[derive(Clone, Copy)]
struct Candidate<'a> {
    row: &'a Row,
    error: f64,
    value: Option<f64>,
}

impl Candidate<'_> {
    fn cell(&self) -> Cell {
        Cell { row: self.row.id.clone(), cost_ms: self.row.cost_ms, value: self.value }
    }
}

/// Class of rows with comparable costs: share of the samples in thousandths, or `None` if the renderer's time is known.
pub fn class(row: &Row) -> Option<u32> {
    row.render_ms.is_none().then(|| (row.samples_share * 1000.0).round() as u32)
}

/// The tables of an input for a metric, largest share of the samples first; empty if no row has the metric. Without the
/// oracle, which no renderer can run.
pub fn equal(table: &Table, input: &str, metric: &Metric) -> Vec<Section> {
    let rows: Vec<&Row> = table.rows.iter().filter(|r| r.point.input == input && r.is_choice()).collect();
    if rows.iter().all(|r| r.value(metric.key).is_none()) {
        return vec![];
    }
    let mut classes: BTreeMap<Option<u32>, Vec<Candidate<'_>>> = BTreeMap::new();
    for row in rows {
        let error = row.standing(metric, table.renderer_ms).error;
        if row.cost_ms.is_finite() && !error.is_nan() {
            classes.entry(class(row)).or_default().push(Candidate { row, error, value: row.value(metric.key) });
        }
    }
    let share = |class: Option<u32>| class.map(|thousandths| f64::from(thousandths) / 1000.0);
    classes.iter().rev().map(|(&class, rows)| section(share(class), rows, metric)).collect()
}

fn section(samples_share: Option<f64>, rows: &[Candidate<'_>], metric: &Metric) -> Section {
    let methods = in_order(rows.iter().map(|c| c.row.point.method.as_str()));
    let better = |a: &&Candidate<'_>, b: &&Candidate<'_>| {
        a.error.total_cmp(&b.error).then(a.row.cost_ms.total_cmp(&b.row.cost_ms))
    };
    let cheaper = |a: &&Candidate<'_>, b: &&Candidate<'_>| {
        a.row.cost_ms.total_cmp(&b.row.cost_ms).then(a.error.total_cmp(&b.error))
    };
    let cheapest = methods.iter().filter_map(|m| of(rows, m).min_by(cheaper).map(|c| c.row.cost_ms));
    let finest = methods.iter().filter_map(|m| of(rows, m).min_by(better)?.value);
    let standing = |c: &Candidate<'_>| Standing { cost_ms: c.row.cost_ms, samples_share: 0.0, error: c.error };
    let is_step = frontier(&rows.iter().map(standing).collect::<Vec<_>>());
    let steps: Vec<&Candidate<'_>> = rows.iter().zip(is_step).filter_map(|(c, is_step)| is_step.then_some(c)).collect();

    let budgets = bounds(cheapest, steps.iter().map(|c| c.row.cost_ms), round_up_ms);
    let ease = |value: f64| round_to(value, metric.digits, !metric.more_is_better);
    let mut levels = bounds(finest, steps.iter().filter_map(|c| c.value), ease);
    levels.sort_by(|a, b| metric.error(Some(*b)).total_cmp(&metric.error(Some(*a))));

    let within = |ms: f64, method: &String| of(rows, method).filter(|c| c.row.cost_ms <= ms).min_by(better);
    let reaching =
        |level: f64, method: &String| of(rows, method).filter(|c| c.error <= metric.error(Some(level))).min_by(cheaper);
    let line =
        |bound: f64, best: &dyn Fn(&String) -> Option<Cell>| Line { bound, cells: methods.iter().map(best).collect() };
    Section {
        samples_share,
        points: rows.len(),
        equal_time: budgets.iter().map(|&ms| line(ms, &|m| within(ms, m).map(Candidate::cell))).collect(),
        equal_quality: levels.iter().map(|&level| line(level, &|m| reaching(level, m).map(Candidate::cell))).collect(),
        methods,
    }
}

fn of<'a>(rows: &'a [Candidate<'a>], method: &str) -> impl Iterator<Item = &'a Candidate<'a>> {
    rows.iter().filter(move |c| c.row.point.method == method)
}

/// Names of methods without duplicates, in the order of `--method`, then unknown ones.
pub fn in_order<'a>(methods: impl Iterator<Item = &'a str>) -> Vec<String> {
    let known = MethodName::rows();
    let rank = |m: &str| known.iter().position(|known| known.1 == m).unwrap_or(usize::MAX);
    let mut methods: Vec<String> = methods.map(str::to_owned).collect();
    methods.sort_by(|a, b| rank(a).cmp(&rank(b)).then(a.cmp(b)));
    methods.dedup();
    methods
}

/// Bounds of a table in ascending order, rounded: all `needed` values, and an even selection of `steps` up to
/// [`MAX_LINES`].
fn bounds(
    needed: impl Iterator<Item = f64>,
    steps: impl Iterator<Item = f64>,
    rounded: impl Fn(f64) -> f64,
) -> Vec<f64> {
    let sorted = |values: &mut Vec<f64>| {
        values.sort_by(f64::total_cmp);
        values.dedup();
    };
    let mut bounds: Vec<f64> = needed.map(&rounded).collect();
    sorted(&mut bounds);
    let mut more: Vec<f64> = steps.map(&rounded).filter(|s| !bounds.contains(s)).collect();
    sorted(&mut more);
    let room = MAX_LINES.saturating_sub(bounds.len()).min(more.len());
    // Select from the last step backwards, so that the best end of the frontier is included.
    bounds.extend((0..room).map(|i| more[more.len() - 1 - i * more.len() / room]));
    sorted(&mut bounds);
    bounds
}

/// Rounds up to three significant digits, so that the printed bound is the bound of the comparison.
fn round_up_ms(ms: f64) -> f64 {
    if ms <= 0.0 {
        return 0.0;
    }
    round_to(ms, (2.0 - ms.log10().floor()).max(0.0) as usize, true)
}

fn round_to(value: f64, digits: usize, up: bool) -> f64 {
    let rounded: f64 = format!("{value:.digits$}").parse().unwrap_or(value);
    let unit = 0.1_f64.powi(digits as i32);
    // Format and parse again, so that the next value up or down is an exact decimal too.
    let next = |by: f64| format!("{:.digits$}", rounded + by).parse().unwrap_or(value);
    match up {
        true if rounded < value => next(unit),
        false if rounded > value => next(-unit),
        _ => rounded,
    }
}

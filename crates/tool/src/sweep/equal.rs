//! What each method gets for the same time, and what it takes for the same quality.

use super::frontier::{Standing, frontier};
use super::metrics::Metric;
use super::table::{Row, Table};
use serde::Serialize;
use std::collections::BTreeMap;

/// Budgets and levels that a table has at most; of more, some in the middle are left out.
const MAX_LINES: usize = 7;

/// Rows whose costs can be compared: what their renderer takes is known, or they shade the same share of the samples.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Section {
    /// Share of the samples, to a thousandth, where it is not known what they cost.
    pub samples_share: Option<f64>,
    /// How many rows it is made of.
    pub points: usize,
    /// Methods, in the order of the columns.
    pub methods: Vec<String>,
    /// A line for each budget in milliseconds.
    pub equal_time: Vec<Line>,
    /// A line for each level of the figure, the easiest first.
    pub equal_quality: Vec<Line>,
}

/// What the methods do within a bound.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Line {
    /// Most milliseconds, or the least that is good enough.
    pub bound: f64,
    /// The best of each method; `None` where nothing of it is within the bound.
    pub cells: Vec<Option<Cell>>,
}

/// The point that is best within a bound.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Cell {
    /// [`Row::id`].
    pub row: String,
    /// What it costs in milliseconds.
    pub cost_ms: f64,
    /// Its figure; `None` for the PSNR of equal pictures.
    pub value: Option<f64>,
}

/// A row as it is compared here.
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

/// Class of the rows whose cost can be compared with this one's: thousandths of the samples, or nothing where their cost is known.
pub fn class(row: &Row) -> Option<u32> {
    row.render_ms.is_none().then(|| (row.samples_share * 1000.0).round() as u32)
}

/// The tables of an input for a figure, those of the largest share of the samples first; none where no row has the figure.
/// The oracle, which no renderer can run, is in none.
pub fn equal(table: &Table, input: &str, metric: &Metric) -> Vec<Section> {
    let value = |row: &Row| row.values.get(metric.key).copied().flatten();
    let rows: Vec<&Row> = table.rows.iter().filter(|r| r.point.input == input && r.is_choice()).collect();
    if rows.iter().all(|r| value(r).is_none()) {
        return vec![];
    }
    let mut classes: BTreeMap<Option<u32>, Vec<Candidate<'_>>> = BTreeMap::new();
    for row in rows {
        let error = row.standing(metric, table.renderer_ms).error;
        if row.cost_ms.is_finite() && !error.is_nan() {
            classes.entry(class(row)).or_default().push(Candidate { row, error, value: value(row) });
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

/// Names of methods, each once, in the order in which they are explained: what does nothing first, strangers last.
pub fn in_order<'a>(methods: impl Iterator<Item = &'a str>) -> Vec<String> {
    let rank =
        |m: &str| ["none", "taa", "wrs", "smr", "oracle"].iter().position(|&known| known == m).unwrap_or(usize::MAX);
    let mut methods: Vec<String> = methods.map(str::to_owned).collect();
    methods.sort_by(|a, b| rank(a).cmp(&rank(b)).then(a.cmp(b)));
    methods.dedup();
    methods
}

/// All of the `needed`, then of the `steps` as many as there is room for, evenly; rounded, in ascending order.
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
    // From the last step backwards: the end of the frontier is where the most is to be had.
    bounds.extend((0..room).map(|i| more[more.len() - 1 - i * more.len() / room]));
    sorted(&mut bounds);
    bounds
}

/// Up to three digits, so that what is printed is what was compared with.
fn round_up_ms(ms: f64) -> f64 {
    if ms <= 0.0 {
        return 0.0;
    }
    round_to(ms, (2.0 - ms.log10().floor()).max(0.0) as usize, true)
}

fn round_to(value: f64, digits: usize, up: bool) -> f64 {
    let rounded: f64 = format!("{value:.digits$}").parse().unwrap_or(value);
    let unit = 0.1_f64.powi(digits as i32);
    // A decimal is printed and read back, so that the next one up or down is a decimal too.
    let next = |by: f64| format!("{:.digits$}", rounded + by).parse().unwrap_or(value);
    match up {
        true if rounded < value => next(unit),
        false if rounded > value => next(-unit),
        _ => rounded,
    }
}

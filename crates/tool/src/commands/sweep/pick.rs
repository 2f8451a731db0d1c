//! `--budget-ms`, `--target`: print recommended settings.

use crate::failure::Failure;
use crate::sweep::{METRICS, Metric, Row, Table};
use clap::Args;
use std::collections::BTreeSet;

/// Criteria for recommended settings.
#[derive(Args, Clone, Debug)]
pub struct PickArgs {
    /// Metric for comparing points: flip, psnr_db, ssim, weighted_psnr_db, retained_psnr_db, ... (columns of sweep.csv)
    #[arg(long, default_value = "flip", value_name = "NAME", value_parser = parse_metric)]
    pub by: &'static Metric,
    /// Time of your renderer for a frame at full rate, milliseconds; foveated frames are assumed to take their share of
    /// the samples. Default: the measured time of scenes; unknown for other inputs, whose costs are those of the pass
    /// alone
    #[arg(long, value_name = "MS")]
    pub renderer_ms: Option<f64>,
    /// Print the best settings within this time per frame, milliseconds
    #[arg(long, value_name = "MS")]
    pub budget_ms: Option<f64>,
    /// Print the cheapest settings with at least this quality, in the metric of --by
    #[arg(long, value_name = "VALUE", conflicts_with = "budget_ms")]
    pub target: Option<f64>,
    /// Short for --by flip --target VALUE
    #[arg(long, value_name = "VALUE", conflicts_with_all = ["budget_ms", "target", "by"])]
    pub target_flip: Option<f64>,
}

fn parse_metric(key: &str) -> Result<&'static Metric, String> {
    Metric::find(key)
        .ok_or_else(|| format!("expected one of {}", METRICS.iter().map(|m| m.key).collect::<Vec<_>>().join(", ")))
}

impl PickArgs {
    /// The metric of --by or, if that was not measured, the first that was, and a line that says so.
    pub fn measured(&self, table: &Table) -> (&'static Metric, Option<String>) {
        let is_measured = |metric: &&Metric| table.rows.iter().any(|row| row.value(metric.key).is_some());
        let by = self.by;
        if is_measured(&by) {
            return (by, None);
        }
        match METRICS.iter().find(is_measured) {
            Some(other) => {
                let key = other.key;
                (
                    other,
                    Some(format!("{} was not measured; points are compared by {} (--by {key})", by.title, other.title)),
                )
            }
            None => (by, None),
        }
    }
}

/// Prints recommended settings, if requested.
pub fn print(args: &PickArgs, table: &Table) -> Result<(), Failure> {
    let target = args.target.or(args.target_flip);
    if args.budget_ms.is_none() && target.is_none() {
        return Ok(());
    }
    let (by, is_other) = args.measured(table);
    if let (Some(target), Some(_)) = (target, is_other) {
        let (title, key) = (args.by.title, by.key);
        return Err(Failure::Input(format!(
            "--target {target}: {title} was not measured; measure it, or give the target in another metric, --by {key}"
        )));
    }
    let inputs: BTreeSet<&str> = table.rows.iter().map(|r| r.point.input.as_str()).collect();
    for input in inputs {
        for (shading, rows) in classes(table, input) {
            say!("\n{input}{shading}");
            match pick(&rows, by, args.budget_ms, target) {
                Some(row) => print_row(row, by),
                None => print_nothing(&rows, args, by),
            }
        }
    }
    Ok(())
}

/// Groups of points that can be compared by time alone: all points if the renderer's time is known, else those with the
/// same share of samples.
fn classes<'a>(table: &'a Table, input: &str) -> Vec<(String, Vec<&'a Row>)> {
    let rows: Vec<&Row> = table.rows.iter().filter(|r| r.point.input == input && r.is_choice()).collect();
    if rows.iter().all(|r| r.render_ms.is_some()) {
        return vec![(String::new(), rows)];
    }
    let percent = |r: &Row| format!(", shading {:.1} % of the samples", 100.0 * r.samples_share);
    let shares: BTreeSet<String> = rows.iter().map(|r| percent(r)).collect();
    let of = |share: String| (share.clone(), rows.iter().copied().filter(|r| percent(r) == share).collect());
    shares.into_iter().map(of).collect()
}

/// The best point within the budget, or the cheapest one that reaches the target.
fn pick<'a>(rows: &[&'a Row], by: &Metric, budget_ms: Option<f64>, target: Option<f64>) -> Option<&'a Row> {
    let error = |r: &Row| by.error(r.value(by.key));
    let fits =
        |r: &&&Row| budget_ms.is_none_or(|ms| r.cost_ms <= ms) && target.is_none_or(|t| error(r) <= by.error(Some(t)));
    let order = |a: &&&Row, b: &&&Row| {
        let (by_error, by_cost) = (error(a).total_cmp(&error(b)), a.cost_ms.total_cmp(&b.cost_ms));
        if target.is_some() { by_cost.then(by_error) } else { by_error.then(by_cost) }
    };
    rows.iter().filter(fits).min_by(order).copied()
}

fn print_row(row: &Row, by: &Metric) {
    let value = row.value(by.key);
    let value = value.map_or("-".into(), |v| format!("{v:.*} {}", by.digits, by.unit));
    say!("  {}: {} {}, {:.2} ms a frame", row.label, by.title, value.trim(), row.cost_ms);
    say!("  {} --out DIR", row.command);
    say!("  let settings = {};", row.rust);
}

fn print_nothing(rows: &[&Row], args: &PickArgs, by: &Metric) {
    let cheapest = rows.iter().min_by(|a, b| a.cost_ms.total_cmp(&b.cost_ms));
    let best = pick(rows, by, None, None);
    match (args.budget_ms, cheapest, best) {
        (Some(ms), Some(row), _) => {
            say!("  nothing costs {ms} ms or less; the cheapest, {}, costs {:.2}", row.label, row.cost_ms)
        }
        (_, _, Some(row)) => {
            say!("  nothing is as good; the best is");
            print_row(row, by);
        }
        _ => say!("  nothing is measured"),
    }
}

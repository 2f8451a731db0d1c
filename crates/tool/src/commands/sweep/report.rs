//! Output files of a sweep: tables, plots, a page.

use super::SweepArgs;
use crate::output::{WriteError, write_json, write_text};
use crate::report::page::page;
use crate::report::{pareto, plot};
use crate::sweep::grid::command_line;
use crate::sweep::markdown::markdown;
use crate::sweep::{Measurement, Store, Table};
use afterimage_lab::picture::write_png;

/// Writes all files; returns the table.
pub fn write(args: &SweepArgs, store: &Store, measurements: &[Measurement]) -> Result<Table, WriteError> {
    let table = Table::new(measurements, args.pick.renderer_ms, command_line());
    let (by, _) = args.pick.measured(&table);
    let root = store.root();
    write_json(Some(&root.join("sweep.json")), &table)?;
    write_text(&root.join("sweep.csv"), &table.csv())?;
    write_text(&root.join("sweep.md"), &markdown(&table))?;
    for (i, input) in table.clips.keys().enumerate() {
        // The help promises this name for the first input.
        let name = if i == 0 { "pareto".to_owned() } else { format!("pareto-{}", i + 1) };
        let svg = pareto::svg(&table, input, by);
        write_text(&root.join(format!("{name}.svg")), &svg)?;
        let path = root.join(format!("{name}.png"));
        write_png(&path, &plot::png(&svg)).map_err(|e| WriteError::new(&path, e))?;
    }
    let picture = |id: &str, what: &str| std::fs::read(root.join("pictures").join(format!("{id}-{what}.jpg"))).ok();
    write_text(&root.join("report.html"), &page(&table, &picture))?;
    Ok(table)
}

/// Prints the frontier and the path of the report.
pub fn print_summary(args: &SweepArgs, table: &Table) {
    let (by, is_other) = args.pick.measured(table);
    is_other.iter().for_each(|line| say!("{line}"));
    say!("{} points; best {} for its cost:", table.rows.len(), by.title);
    let is_whole = table.rows.iter().all(|r| r.total_ms.is_some());
    say!("ms: {}", if is_whole { "whole frame, render + post" } else { "the pass alone where nothing is rendered" });
    say!("  ms/frame  {:>10}  point", by.key);
    for row in table.rows.iter().filter(|r| r.frontier.contains(&by.key)) {
        let value = row.value(by.key).map_or("-".into(), |v| format!("{v:.*}", by.digits));
        say!("{:>10.2}  {value:>10}  {}", row.cost_ms, row.label);
    }
    say!("report: {}", args.out.join("report.html").display());
}

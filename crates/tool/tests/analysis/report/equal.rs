//! Tables at equal time and equal quality, compared with a search over all rows.

use super::table::{INPUTS, table};
use afterimage_cli::sweep::equal::{Cell, Section, equal};
use afterimage_cli::sweep::{METRICS, Metric, Row, Table};

/// Whether a row belongs to a section, by the columns of the table.
fn comparable(row: &Row, input: &str, section: &Section) -> bool {
    let same_share = |share: f64| (row.samples_share * 1000.0).round() == (share * 1000.0).round();
    row.point.input == input && row.point.method != "oracle" && section.samples_share.is_none_or(same_share)
}

/// Checks every cell of every section; returns the first error.
fn check(table: &Table, input: &str, metric: &Metric, sections: &[Section]) -> Result<usize, String> {
    let mut checked = 0;
    for section in sections {
        for (method, i) in section.methods.iter().zip(0..) {
            let rows = || table.rows.iter().filter(|r| comparable(r, input, section) && r.point.method == *method);
            let error = |r: &Row| metric.error(r.values[metric.key]);
            let mut test =
                |cell: &Option<Cell>, is_within: &dyn Fn(&Row) -> bool, goal: &dyn Fn(&Row) -> f64, what: &str| {
                    let best = rows().filter(|r| is_within(r)).map(goal).fold(f64::INFINITY, f64::min);
                    checked += 1;
                    let found = cell.as_ref().map(|c| rows().find(|r| r.id == c.row));
                    match found {
                        None if best == f64::INFINITY => Ok(()),
                        None => Err(format!("{what}: {method} has nothing, and could have {best}")),
                        Some(Some(r)) if is_within(r) && goal(r) == best => Ok(()),
                        Some(r) => Err(format!("{what}: {:?}, and {best} can be had", r.map(|r| &r.label))),
                    }
                };
            for line in &section.equal_time {
                test(&line.cells[i], &|r| r.cost_ms <= line.bound, &error, &format!("{} ms", line.bound))?;
            }
            for line in &section.equal_quality {
                let enough = |r: &Row| error(r) <= metric.error(Some(line.bound));
                test(&line.cells[i], &enough, &|r| r.cost_ms, &format!("{} {}", metric.key, line.bound))?;
            }
        }
    }
    Ok(checked)
}

#[test]
fn every_cell_is_the_best_of_all_rows() {
    let mut cells = 0;
    for table in [table(Some(12.0)), table(None)] {
        for (input, metric) in INPUTS.iter().flat_map(|i| METRICS.iter().map(move |m| (*i, m))) {
            cells += check(&table, input, metric, &equal(&table, input, metric)).unwrap();
        }
    }
    println!("{cells} cells");
    assert!(cells > 1000);
}

#[test]
fn the_check_catches_a_cell_that_is_not_the_best() {
    let table = table(Some(12.0));
    let metric = Metric::find("flip").unwrap();
    let sections = equal(&table, INPUTS[0], metric);
    let wrong = |plant: &dyn Fn(&mut Section)| {
        let mut sections = sections.clone();
        plant(&mut sections[0]);
        check(&table, INPUTS[0], metric, &sections).unwrap_err()
    };
    let last = sections[0].equal_time.len() - 1;
    let cheapest = sections[0].equal_time[0].cells[0].clone();
    println!("{}", wrong(&|s| s.equal_time[last].cells[0] = cheapest.clone()));
    println!("{}", wrong(&|s| s.equal_time[last].cells[0] = None));
    println!("{}", wrong(&|s| s.equal_time[0].cells.swap(0, 1)));
    println!("{}", wrong(&|s| s.equal_quality[0].bound *= 0.9));
}

#[test]
fn rows_that_shade_differently_are_compared_only_where_that_has_a_price() {
    let metric = Metric::find("flip").unwrap();
    let priced = equal(&table(Some(12.0)), INPUTS[0], metric);
    assert_eq!(priced.len(), 1);
    assert_eq!(priced[0].samples_share, None);
    let unpriced = equal(&table(None), INPUTS[0], metric);
    assert_eq!(unpriced.len(), 6, "three foveae, two rates");
    assert_eq!(unpriced.iter().map(|s| s.points).sum::<usize>(), priced[0].points);
    assert!(unpriced.windows(2).all(|w| w[0].samples_share > w[1].samples_share));
}

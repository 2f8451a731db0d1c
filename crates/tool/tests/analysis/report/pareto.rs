//! The plot: well-formed, complete, legible, reproducible.

use super::drawn::{assert_marks_and_letters, has_text, mark_at, with_class};
use super::table::{INPUTS, measurements, of, table};
use afterimage_cli::report::pareto;
use afterimage_cli::sweep::{METRICS, Metric, Table};
use resvg::usvg::roxmltree::{Document, Node};
use std::collections::BTreeSet;

fn flip() -> &'static Metric {
    Metric::find("flip").unwrap()
}

#[test]
fn every_plot_is_xml_with_a_mark_for_each_point() {
    for table in [table(Some(12.0)), table(None)] {
        for (input, metric) in INPUTS.iter().flat_map(|i| METRICS.iter().map(move |m| (*i, m))) {
            let svg = pareto::svg(&table, input, metric);
            let document = Document::parse(&svg).unwrap();
            let known = table.rows.iter().filter(|r| r.point.input == *input && r.values[metric.key].is_some());
            let expected: BTreeSet<&str> = known.clone().map(|r| r.id.as_str()).collect();
            let found: Vec<&str> = with_class(&document, "point").map(|n| n.attribute("data-row").unwrap()).collect();
            assert_eq!(found.len(), expected.len(), "{input} {}", metric.key);
            assert_eq!(BTreeSet::from_iter(found), expected, "{input} {}", metric.key);
            let best = known.filter(|r| r.frontier.contains(&metric.key)).count();
            let numbers = with_class(&document, "numbers").flat_map(|n| n.children()).filter(Node::is_element).count();
            assert_eq!(numbers, best);
            let better = if metric.more_is_better { "higher is better" } else { "lower is better" };
            assert!(has_text(&document, better));
        }
    }
}

#[test]
fn better_and_cheaper_are_where_the_axes_say() {
    let table = table(Some(12.0));
    for key in ["flip", "psnr_db"] {
        let metric = Metric::find(key).unwrap();
        let svg = pareto::svg(&table, INPUTS[0], metric);
        let document = Document::parse(&svg).unwrap();
        let at = |id: &str| -> [f64; 2] {
            let point = with_class(&document, "point").find(|n| n.attribute("data-row") == Some(id)).unwrap();
            mark_at(&point.descendants().find(|n| n.tag_name().name() == "path").unwrap())
        };
        let rows: Vec<_> = table.rows.iter().filter(|r| r.point.input == INPUTS[0]).collect();
        for pair in rows.windows(2) {
            let [a, b] = [at(&pair[0].id), at(&pair[1].id)];
            assert!(a[0] <= b[0], "rows are sorted by cost");
            let more = pair[1].values[key] > pair[0].values[key];
            assert!((b[1] - a[1]).abs() < 0.11 || (b[1] < a[1]) == more, "up is more");
        }
    }
}

#[test]
fn png_has_marks_and_letters_and_is_the_same_again() {
    assert_marks_and_letters(&pareto::svg(&table(None), INPUTS[1], flip()), 100);
}

#[test]
fn odd_tables_make_a_plot() {
    let nothing: Table = of(&[], None);
    assert!(Document::parse(&pareto::svg(&nothing, "none", flip())).is_ok());
    let mut one = measurements()[..1].to_vec();
    one[0].pass_ms.median = 0.0;
    one[0].point.input = "a\u{1}<b>&\"'\u{fffe}".into();
    let table = of(&one, None);
    let svg = pareto::svg(&table, &one[0].point.input, flip());
    let document = Document::parse(&svg).unwrap();
    assert!(has_text(&document, "<b>&\"'"), "names are text");
    assert_eq!(with_class(&document, "point").count(), 1);
    assert!(!svg.contains("NaN") && !svg.contains("inf"));
    let mut strange = measurements();
    for m in &mut strange {
        m.figures.scores.whole.flip = Some(f64::NAN);
    }
    let svg = pareto::svg(&of(&strange, None), INPUTS[0], flip());
    assert!(!svg.contains("NaN"), "what is no number is no point");
}

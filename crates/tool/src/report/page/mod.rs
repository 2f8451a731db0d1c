//! Report of a sweep as one HTML file that loads nothing else: data, plots, pictures, style and script are embedded.
//!
//! All numbers are computed here; the script only formats them. Names of files and options are always text: escaped
//! here, and set as text nodes by the script.

mod answers;
mod pictures;

use crate::report::pareto;
use crate::sweep::equal::equal;
use crate::sweep::{METRICS, Metric, Table};
use answers::escaped;
use serde::Serialize;
use serde_json::json;
use std::collections::BTreeMap;

const TEMPLATE: &str = include_str!("page.html");
const STYLE: &str = include_str!("page.css");
const SCRIPTS: [&str; 5] = [
    include_str!("base.js"),
    include_str!("plot.js"),
    include_str!("tables.js"),
    include_str!("compare.js"),
    include_str!("main.js"),
];

/// The page. `pictures` returns the JPEG of a [`Row::id`](crate::sweep::Row::id) and `shown`, `error` or `reference`,
/// if it exists.
pub fn page(table: &Table, pictures: &dyn Fn(&str, &str) -> Option<Vec<u8>>) -> String {
    let inputs = inputs(table);
    let by_metric = |of: &dyn Fn(&str, &Metric) -> serde_json::Value| {
        let of_input = |input: &str| METRICS.iter().map(|m| (m.key, of(input, m))).collect::<BTreeMap<_, _>>();
        inputs.iter().map(|input| (*input, of_input(input))).collect::<BTreeMap<_, _>>()
    };
    let metrics: Vec<_> = METRICS
        .iter()
        .map(|m| json!({"key": m.key, "title": m.title, "unit": m.unit, "more_is_better": m.more_is_better, "digits": m.digits}))
        .collect();
    let islands = [
        island("table", table),
        island("metrics", &metrics),
        island("equal", &by_metric(&|input, metric| json!(equal(table, input, metric)))),
        island("plots", &by_metric(&|input, metric| json!(inline_plot(table, input, metric)))),
        island("pictures", &pictures::embed(table, pictures)),
    ];
    let first_plot = inputs.first().map_or_else(String::new, |input| inline_plot(table, input, &METRICS[0]));
    fill(TEMPLATE, |name| match name {
        "style" => STYLE.into(),
        "answers" => answers::answers(table, &inputs),
        "facts" => answers::facts(table),
        "plot" => first_plot.clone(),
        "command" => escaped(&table.command),
        "version" => escaped(&table.version),
        "islands" => islands.join("\n"),
        "script" => SCRIPTS.join("\n"),
        other => unreachable!("the template names {other}"),
    })
}

/// The plot as an HTML element, without its XML namespace.
fn inline_plot(table: &Table, input: &str, metric: &Metric) -> String {
    pareto::svg(table, input, metric).replacen(" xmlns=\"http://www.w3.org/2000/svg\"", "", 1)
}

/// Inputs in the order of the rows.
fn inputs(table: &Table) -> Vec<&str> {
    let mut inputs: Vec<&str> = table.rows.iter().map(|r| r.point.input.as_str()).collect();
    inputs.dedup();
    inputs
}

/// Replaces every `{{name}}` in a single pass, so that inserted text is never expanded.
fn fill(template: &str, of: impl Fn(&str) -> String) -> String {
    let mut parts = template.split("{{");
    let mut page = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        let (name, rest) = part.split_once("}}").unwrap_or(("", part));
        page += &of(name);
        page += rest;
    }
    page
}

/// JSON data for the script. `<` is escaped, so that the data cannot close the element.
fn island(id: &str, data: &impl Serialize) -> String {
    let text = serde_json::to_string(data).expect("figures are JSON").replace('<', "\\u003c");
    format!("<script type=\"application/json\" id=\"data-{id}\">{text}</script>")
}

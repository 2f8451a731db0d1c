//! A sweep as one page that opens from disk and fetches nothing: figures, plots, pictures, style and script are in the file.
//!
//! Numbers are made here and shown by the script as they are; names of files and options reach the page as text alone: escaped in what
//! is written here, as text nodes in what the script makes.

mod answers;
mod pictures;

use crate::report::pareto;
use crate::sweep::equal::{Section, equal};
use crate::sweep::{METRICS, Metric, Table};
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

/// The page. `pictures`: a JPEG by [`Row::id`](crate::sweep::Row::id) and `shown`, `error` or `reference`, where there is one.
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

/// As an element of HTML, which needs no namespace.
fn inline_plot(table: &Table, input: &str, metric: &Metric) -> String {
    pareto::svg(table, input, metric).replacen(" xmlns=\"http://www.w3.org/2000/svg\"", "", 1)
}

/// In the order of the rows.
fn inputs(table: &Table) -> Vec<&str> {
    let mut inputs: Vec<&str> = table.rows.iter().map(|r| r.point.input.as_str()).collect();
    inputs.dedup();
    inputs
}

/// Puts something for every `{{name}}`, in one go: what is put in is not looked at again.
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

/// Data for the script. No `<` is left in it, so that nothing in it ends the element.
fn island(id: &str, data: &impl Serialize) -> String {
    let text = serde_json::to_string(data).expect("figures are JSON").replace('<', "\\u003c");
    format!("<script type=\"application/json\" id=\"data-{id}\">{text}</script>")
}

/// As text of HTML, or a quoted attribute.
fn escaped(text: &str) -> String {
    let entity = |c: char| match c {
        '&' => "&amp;".into(),
        '<' => "&lt;".into(),
        '>' => "&gt;".into(),
        '"' => "&quot;".into(),
        '\'' => "&#39;".into(),
        c => c.to_string(),
    };
    text.chars().map(entity).collect()
}

/// The section with the most points: what sentences are about.
fn largest(sections: &[Section]) -> Option<&Section> {
    sections.iter().max_by_key(|s| s.points)
}

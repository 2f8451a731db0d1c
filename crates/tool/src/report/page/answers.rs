//! Summary of a sweep in generated sentences, and the table of clips and machines.

use crate::sweep::equal::{Line, Section, equal};
use crate::sweep::prices::Price;
use crate::sweep::{METRICS, Metric, Row, Table};

/// Summary for every input, as HTML.
pub fn answers(table: &Table, inputs: &[&str]) -> String {
    let of_input = |input: &&str| {
        let sentences = [budgets(table, input), switches(table, input)].concat();
        let items: String = sentences.iter().map(|s| format!("<li>{s}</li>")).collect();
        format!("<h3>{}</h3><ul>{items}</ul>", escaped(input))
    };
    inputs.iter().map(of_input).collect()
}

/// The metric of the summary: the first one that was measured for the input.
fn figure(table: &Table, input: &str) -> Option<&'static Metric> {
    let has = |m: &&Metric| table.rows.iter().any(|r| r.point.input == input && r.value(m.key).is_some());
    METRICS.iter().find(has)
}

fn budgets(table: &Table, input: &str) -> Vec<String> {
    let Some(metric) = figure(table, input) else { return vec!["No metric was measured.".into()] };
    let sections = equal(table, input, metric);
    let Some(section) = largest(&sections) else { return vec![] };
    let lines = &section.equal_time;
    let mut bests: Vec<(f64, &Row)> = vec![];
    for i in [0, lines.len() / 2, lines.len().saturating_sub(1)] {
        let Some((ms, row)) = lines.get(i).and_then(|line| Some((line.bound, best(table, line, metric)?))) else {
            continue;
        };
        if bests.last().is_none_or(|(_, last)| last.id != row.id) {
            bests.push((ms, row));
        }
    }
    let parts: Vec<String> = bests
        .iter()
        .map(|(ms, row)| {
            format!("up to {} ms a frame, <b>{}</b> ({})", three_digits(*ms), escaped(&row.label), value(row, metric))
        })
        .collect();
    let (figure, direction) = (metric.title, if metric.more_is_better { "highest" } else { "lowest" });
    let share = section.samples_share.map_or_else(String::new, |share| {
        format!(" among the {} points that trace {:.1} % of the samples", section.points, 100.0 * share)
    });
    vec![format!("The {direction} {figure}{share}: for {}.", parts.join("; for "))]
}

fn best<'a>(table: &'a Table, line: &Line, metric: &Metric) -> Option<&'a Row> {
    let cells = line.cells.iter().flatten();
    let best = cells
        .min_by(|a, b| metric.error(a.value).total_cmp(&metric.error(b.value)).then(a.cost_ms.total_cmp(&b.cost_ms)))?;
    row(table, &best.row)
}

fn row<'a>(table: &'a Table, id: &str) -> Option<&'a Row> {
    table.rows.iter().find(|r| r.id == id)
}

/// Three significant digits, as in the table of budgets.
fn three_digits(ms: f64) -> String {
    let digits = if ms > 0.0 { (2.0 - ms.log10().floor()).max(0.0) as usize } else { 0 };
    format!("{ms:.digits$}")
}

fn value(row: &Row, metric: &Metric) -> String {
    let unit = if metric.unit.is_empty() { String::new() } else { format!(" {}", metric.unit) };
    let digits = metric.digits;
    match row.value(metric.key) {
        Some(v) => format!("{} {v:.digits$}{unit}", metric.title),
        None => format!("no {}", metric.title),
    }
}

fn switches(table: &Table, input: &str) -> Vec<String> {
    let prices: Vec<&Price> = table.prices.iter().filter(|p| p.input == input).collect();
    let more = |p: &&&Price| p.pass_ms[1] - p.pass_ms[0];
    let by_time = |a: &&&Price, b: &&&Price| more(a).total_cmp(&more(b));
    let (Some(most), Some(least)) = (prices.iter().max_by(by_time), prices.iter().min_by(by_time)) else {
        return vec!["No switch was measured.".into()];
    };
    let sentence = |which: &str, price: &Price| format!("{which}: {}.", effect(table, input, price));
    if prices.len() == 1 {
        return vec![sentence("The only switch", most)];
    }
    let (count, adds, saves) = (prices.len(), more(&most), more(&least));
    let adds = if adds > 0.0 { "adds the most time" } else { "saves the least time" };
    let saves = if saves < 0.0 { "saves the most time" } else { "adds the least time" };
    vec![
        sentence(&format!("Of {count} switches, the one that {saves}"), least),
        sentence(&format!("The one that {adds}"), most),
    ]
}

fn effect(table: &Table, input: &str, price: &Price) -> String {
    let [without, with] = price.pass_ms;
    let ratio = price.time_ratio;
    let percent = 100.0 * (ratio.median - 1.0);
    let points = row(table, &price.base).zip(row(table, &price.switched));
    let of = points.map_or(&price.method, |(base, _)| &base.label);
    let name = format!("<b>{}</b> takes the pass of {}", escaped(&price.switch), escaped(of));
    let mut text = format!("{name} from {without:.3} to {with:.3} ms ({percent:+.1} %)");
    if ratio.p25 <= 1.0 && ratio.p75 >= 1.0 {
        text += ", within the variation between frames,";
    }
    let figure = figure(table, input).and_then(|m| Some((m, price.values.get(m.key)?)));
    if let Some((metric, [Some(a), Some(b)])) = figure.map(|(m, v)| (m, *v)) {
        let digits = metric.digits;
        let [a, b] = [a, b].map(|v| format!("{v:.digits$}"));
        let verdict = match metric.error(b.parse().ok()).total_cmp(&metric.error(a.parse().ok())) {
            std::cmp::Ordering::Less => "better",
            std::cmp::Ordering::Equal => "the same",
            std::cmp::Ordering::Greater => "worse",
        };
        let spreads = points.and_then(|(a, b)| Some((a.spread.get(metric.key)?, b.spread.get(metric.key)?)));
        let varies = spreads.is_some_and(|(a, b)| a[0] <= b[1] && b[0] <= a[1]);
        let verdict = if varies { "within the variation between seeds" } else { verdict };
        text += &format!(" and {} from {a} to {b} ({verdict})", metric.title);
    }
    text
}

/// Clips, machines and renderer, as rows of an HTML table.
pub fn facts(table: &Table) -> String {
    let clips = table.clips.iter().map(|(input, c)| {
        let [w, h] = c.size;
        // Pixels per degree at the center of the view, as used by FLIP.
        let degrees = 2.0 * ((0.5 * f64::from(c.hfov_deg).to_radians()).tan() / f64::from(w)).atan().to_degrees();
        let text = format!(
            "{w}x{h} pixels, {} frames scored and {} timed, {} frames per second, {} degrees wide, {:.1} pixels per degree at the center",
            c.frames, c.timed_frames, c.fps, c.hfov_deg, degrees.recip()
        );
        (format!("Clip {input}"), text)
    });
    let machines = table.machines.iter().map(|m| {
        let driver = if m.driver == "none" { String::new() } else { format!(", driver {}", m.driver) };
        ("Machine".to_owned(), format!("{} ({}{driver}); times: {}", m.name, m.kind, m.clock))
    });
    let renderer = match (table.renderer_ms, table.rows.iter().any(|r| r.render_ms.is_some())) {
        (Some(ms), _) => {
            format!("{ms} ms for a full-rate frame (--renderer-ms); foveated frames take their share of the samples")
        }
        (None, true) => {
            "timed in every frame: costs, budgets and the frontier are those of the whole frame, renderer and pass"
                .into()
        }
        (None, false) => {
            "time unknown: costs are those of the pass alone, and points are compared at equal shares of the samples"
                .into()
        }
    };
    let rows = clips.chain(machines).chain([("Renderer".to_owned(), renderer)]);
    rows.map(|(name, text)| format!("<tr><th scope=\"row\">{}</th><td>{}</td></tr>", escaped(&name), escaped(&text)))
        .collect()
}

/// Escapes text for HTML content and quoted attributes.
pub fn escaped(text: &str) -> String {
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

/// The section with the most points, which the summary is about.
fn largest(sections: &[Section]) -> Option<&Section> {
    sections.iter().max_by_key(|s| s.points)
}

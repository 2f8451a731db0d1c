//! SVG drawing of the plot.

use super::tags;
use crate::report::plot::{
    FAINT, HIGH_PX, INK, LINE_PX, LOW_PX, Mark, OF_JOD, OF_PSNR, Scale, axes, chars_from, document, legend, line, mark,
    on_ground, px, reading, shortened, spread, text, visible,
};
use crate::sweep::equal::{class, in_order};
use crate::sweep::rust_source::name_of;
use crate::sweep::{Metric, Row, Table};
use std::collections::BTreeMap;
use svg::node::element::{Group, Path, Text};

/// X position of the second column of notes.
const MIDDLE_PX: f64 = 528.0;
/// Width of a character of a name.
const NAME_CHAR_PX: f64 = 7.0;

/// A row with its value and position.
struct Spot<'a> {
    row: &'a Row,
    value: f64,
    at: [f64; 2],
    is_best: bool,
}

/// Least length and end of a metric's axis.
fn least(metric: &Metric) -> [f64; 2] {
    match metric.unit {
        "dB" => OF_PSNR,
        _ if metric.key.ends_with("jod") => OF_JOD,
        _ => [0.0, f64::INFINITY],
    }
}

/// Plot of an input's points by cost and a metric. Rows without the metric are counted in a note.
pub fn svg(table: &Table, input: &str, metric: &Metric) -> String {
    let of_input = || table.rows.iter().filter(|r| r.point.input == input && r.cost_ms.is_finite());
    let value = |r: &Row| r.value(metric.key).filter(|v| v.is_finite());
    let known: Vec<(&Row, f64)> = of_input().filter_map(|r| Some((r, value(r)?))).collect();
    let missing = of_input().count() - known.len();
    let floors = floors(&known);
    let renders_known = known.iter().all(|(r, _)| r.render_ms.is_some());
    let costs = known.iter().filter(|(r, _)| !is_bound(r)).map(|(r, _)| r.cost_ms).chain(floors.values().copied());
    let x = Scale::new(costs, true, LOW_PX[0], HIGH_PX[0]);
    let y = Scale::new(known.iter().map(|(_, v)| *v), false, HIGH_PX[1], LOW_PX[1]).of_at_least(least(metric));
    let spots: Vec<Spot<'_>> = known
        .iter()
        .map(|&(row, value)| {
            let is_best = row.frontier.contains(&metric.key);
            let across = if is_bound(row) { HIGH_PX[0] } else { px(x.px(row.cost_ms)) };
            Spot { row, value, at: [across, px(y.px(value))], is_best }
        })
        .collect();
    let best: Vec<&Spot<'_>> = spots.iter().filter(|s| s.is_best).collect();

    let title = format!("{}: {} and cost of {} points", visible(input), metric.title, spots.len());
    let methods = in_order(spots.iter().map(|s| s.row.point.method.as_str()));
    let [along, up] = names(metric, renders_known);
    let mut plot = Group::new()
        .add(legend(methods.iter().map(|method| (method.as_str(), method.as_str()))))
        .add(axes(&x, &y, &along, &up));
    plot = plot.add(roofline(&floors, &x)).add(steps(&best, metric));
    // Draw the frontier on top.
    for spot in spots.iter().filter(|s| !s.is_best).chain(best.iter().copied()) {
        plot = plot.add(point(spot, &x));
    }
    let (names, taken) = names_of(&spots);
    plot = plot.add(names).add(numbers(&best, &spots, &taken));
    let (notes, height) = notes(&best, metric, missing, spots.iter().any(|s| is_bound(s.row)));
    document("pareto", &title, height, plot.add(notes))
}

/// The oracle is an upper bound that no renderer can run, so its time has no meaning.
fn is_bound(row: &Row) -> bool {
    row.point.method == "oracle"
}

/// Lower bound of each method's cost: time of the renderer and of a copy that moves as many bytes.
fn floors<'a>(known: &[(&'a Row, f64)]) -> BTreeMap<&'a str, f64> {
    let mut floors = BTreeMap::new();
    for (row, _) in known.iter().filter(|(r, _)| r.copy_ms > 0.0 && !is_bound(r)) {
        let floor = floors.entry(row.point.method.as_str()).or_insert(f64::INFINITY);
        *floor = floor.min(row.copy_ms + row.render_ms.unwrap_or(0.0));
    }
    floors
}

/// Names of the axes.
fn names(metric: &Metric, renders_known: bool) -> [String; 2] {
    let cost = if renders_known { "whole frame: renderer and pass" } else { "pass alone, renderer's time unknown" };
    let says_unit = metric.unit.is_empty() || metric.title.contains(metric.unit);
    let unit = if says_unit { String::new() } else { format!(", {}", metric.unit) };
    let better = if metric.more_is_better { "higher is better" } else { "lower is better" };
    [format!("milliseconds a frame ({cost}); left is cheaper"), format!("{}{unit}; {better}", metric.title)]
}

/// A bar at the bottom for each method's lower bound. Bars that would overlap are stacked.
fn roofline(floors: &BTreeMap<&str, f64>, x: &Scale) -> Group {
    let mut sorted: Vec<(f64, &str)> = floors.iter().map(|(method, ms)| (px(x.px(*ms)), *method)).collect();
    sorted.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut group = Group::new().set("class", "roofline");
    let mut below = (f64::NEG_INFINITY, HIGH_PX[1]);
    for (at, method) in sorted {
        let foot = if at - below.0 < 4.0 { below.1 - 20.0 } else { HIGH_PX[1] };
        let mark = Mark::of(method);
        let bar = line([at, foot - 18.0], [at, foot], mark.color);
        group = group.add(bar.set("class", format!("line {}", mark.class)).set("stroke-width", 3));
        below = (at, foot);
    }
    group
}

/// Frontier of each class of comparable points as a step line.
fn steps(best: &[&Spot<'_>], metric: &Metric) -> Group {
    let mut classes: BTreeMap<Option<u32>, Vec<&Spot<'_>>> = BTreeMap::new();
    best.iter().for_each(|spot| classes.entry(class(spot.row)).or_default().push(spot));
    let mut group = Group::new().set("class", "frontier");
    let mut ends = vec![];
    for (class, mut spots) in classes {
        spots.sort_by(|a, b| {
            let by_error = metric.error(Some(b.value)).total_cmp(&metric.error(Some(a.value)));
            a.row.cost_ms.total_cmp(&b.row.cost_ms).then(by_error)
        });
        let (first, last) = (spots[0], spots[spots.len() - 1]);
        let path = spots.iter().skip(1).fold(format!("M{} {}", first.at[0], first.at[1]), |path, spot| {
            format!("{path}H{}V{}", spot.at[0], spot.at[1])
        });
        let path = Path::new().set("d", format!("{path}H{}", HIGH_PX[0])).set("class", "axis");
        group = group.add(path.set("fill", "none").set("stroke", INK).set("stroke-dasharray", "5 3"));
        ends.extend(class.map(|thousandths| (last.at[1], format!("{:.1} %", f64::from(thousandths) / 10.0))));
    }
    if !ends.is_empty() {
        group = group.add(faint("samples", LOW_PX[1] + 3.0));
    }
    let places = spread(&ends.iter().map(|end| end.0 + 4.5).collect::<Vec<_>>(), LOW_PX[1] + 18.0, HIGH_PX[1]);
    ends.iter().zip(places).fold(group, |group, ((_, share), at)| group.add(faint(share, px(at))))
}

/// Text to the right of the plot area.
fn faint(content: &str, y: f64) -> Text {
    text(content, [HIGH_PX[0] + 12.0, y], "start").set("fill", FAINT).set("class", "faint")
}

/// A point, with a bar for the quartiles of its pass.
fn point(spot: &Spot<'_>, x: &Scale) -> Group {
    let row = spot.row;
    let other = row.cost_ms - row.pass_ms.median;
    let [from, to] = [row.pass_ms.p25, row.pass_ms.p75].map(|ms| px(x.px(other + ms)));
    let Mark { color, class, .. } = Mark::of(&row.point.method);
    let bar = line([from, spot.at[1]], [to, spot.at[1]], color).set("class", format!("line {class}"));
    let group = Group::new().set("class", "point").set("data-row", visible(&row.id));
    let group = if is_bound(row) { group } else { group.add(bar.set("stroke-width", 2)) };
    group.add(mark(&row.point.method, spot.at, spot.is_best))
}

/// Names of settings beside their points, below them, where points are worse; and the places that they take.
fn names_of(spots: &[Spot<'_>]) -> (Group, Vec<[f64; 2]>) {
    let mut group = Group::new().set("class", "names");
    let mut taken = vec![];
    for (spot, name) in spots.iter().filter_map(|spot| Some((spot, name_of(&spot.row.rust)?))) {
        let [x, y] = [spot.at[0], spot.at[1] + 18.0];
        let fits = x + 9.0 + name.len() as f64 * NAME_CHAR_PX < HIGH_PX[0];
        let (side, anchor) = if fits { (1.0, "start") } else { (-1.0, "end") };
        group = group.add(on_ground(text(name, [px(x + 9.0 * side), px(y)], anchor).set("class", "ink")));
        taken.extend((2..=name.len()).map(|i| [x + side * i as f64 * NAME_CHAR_PX, y - 4.5]));
    }
    (group, taken)
}

/// Numbers of the best points, away from all points and from what else is `taken`.
fn numbers(best: &[&Spot<'_>], spots: &[Spot<'_>], taken: &[[f64; 2]]) -> Group {
    let best: Vec<_> = best.iter().map(|spot| spot.at).collect();
    let marks: Vec<_> = spots.iter().map(|spot| spot.at).chain(taken.iter().copied()).collect();
    let places = tags::place(&best, &marks, LOW_PX, HIGH_PX);
    places.iter().enumerate().fold(Group::new().set("class", "numbers"), |group, (i, [x, y])| {
        let number = text(&(i + 1).to_string(), [px(*x), px(y + 4.5)], "middle");
        group.add(on_ground(number.set("class", "ink")))
    })
}

/// List of the numbered points, and a key to the marks. Returns the total height as well.
fn notes(best: &[&Spot<'_>], metric: &Metric, missing: usize, has_bound: bool) -> (Group, f64) {
    let top = HIGH_PX[1] + 68.0;
    let unit = if metric.unit.is_empty() { String::new() } else { format!(" {}", metric.unit) };
    let what = |spot: &&Spot<'_>| {
        let (digits, value, ms) = (metric.digits, spot.value, spot.row.cost_ms);
        format!("{value:.digits$}{unit} in {ms:.3} ms: {}", visible(&spot.row.label))
    };
    let entries: Vec<String> = best.iter().map(what).collect();
    // One column if an entry is too long for two, since labels may differ at their ends only.
    let longest = entries.iter().map(|e| e.chars().count()).max().unwrap_or(0);
    let columns = if longest <= chars_from(MIDDLE_PX) { 2 } else { 1 };
    let lines = best.len().div_ceil(columns);
    let mut notes = Group::new();
    for (i, entry) in entries.iter().enumerate() {
        let (x, y) = if i < lines { (LOW_PX[0], i) } else { (MIDDLE_PX, i - lines) };
        let y = top + LINE_PX * y as f64;
        let number = text(&(i + 1).to_string(), [x - 10.0, y], "end").set("fill", FAINT).set("class", "faint");
        notes =
            notes.add(number).add(text(&shortened(entry, chars_from(LOW_PX[0])), [x, y], "start").set("class", "ink"));
    }
    let mut how = vec![
        "filled, with a number: on the frontier, no point is both cheaper and better; hollow: other points; dashed: the frontier".into(),
        "bars at marks: quartiles of the pass; bars at the bottom: lower bound of the method's time, a copy of as many bytes".into(),
    ];
    if has_bound {
        how.push("oracle: upper bound of any reuse; no renderer can run it, so it is drawn at the border instead of at its time".into());
    }
    if missing > 0 {
        how.push(format!("{missing} points without this metric are left out"));
    }
    let (how, height) = reading(&how, top + LINE_PX * lines as f64 + 6.0);
    (notes.add(how), height)
}

//! The tables of a sweep as Markdown, for documents.

use super::metrics::Metric;
use super::row::Row;
use super::table::Table;
use std::fmt::Write;

/// Metrics of the tables: as many as fit on a page.
const KEYS: [&str; 7] = ["jod", "flip", "psnr_db", "ssim", "weighted_psnr_db", "retained_psnr_db", "flicker"];

/// All tables: points by cost, cost of each switch, convergence of traced points.
pub fn markdown(table: &Table) -> String {
    let mut text = String::new();
    // Writing to a string cannot fail.
    let _ = write_all(table, &mut text);
    text
}

fn write_all(table: &Table, text: &mut String) -> std::fmt::Result {
    writeln!(text, "Made by `{}`.\n", table.command)?;
    for (input, clip) in &table.clips {
        let ([w, h], machines) = (clip.size, machines(table));
        writeln!(text, "{input}: {w}x{h}, {} frames, {} of them timed; {machines}.\n", clip.frames, clip.timed_frames)?;
        points(table, input, text)?;
        prices(table, input, text)?;
        convergences(table, input, text)?;
    }
    Ok(())
}

fn machines(table: &Table) -> String {
    let of = |m: &super::measurement::Machine| match m.driver.as_str() {
        "none" => format!("{} {}, {}", m.kind.to_uppercase(), m.name, m.clock),
        driver => format!("{} {} ({driver}), {}", m.kind.to_uppercase(), m.name, m.clock),
    };
    table.machines.iter().map(of).collect::<Vec<_>>().join("; ")
}

fn points(table: &Table, input: &str, text: &mut String) -> std::fmt::Result {
    writeln!(text, "| point | ms | render | post | B/px | samples | {} |", titles().join(" | "))?;
    writeln!(text, "|---|---|---|---|---|---|{}", "---|".repeat(KEYS.len()))?;
    for row in table.rows.iter().filter(|r| r.point.input == input) {
        let bytes = row.bytes_per_pixel.map_or("-".into(), |b| b.to_string());
        let figures: Vec<String> = KEYS.iter().map(|key| figure(row, key)).collect();
        let render = row.render_ms.map_or("-".into(), |ms| format!("{ms:.2}"));
        let samples = 100.0 * row.samples_share;
        writeln!(
            text,
            "| {} | {:.2} | {render} | {:.2} | {bytes} | {samples:.1} % | {} |",
            cell(&row.label),
            row.cost_ms,
            row.post_ms,
            figures.join(" | ")
        )?;
    }
    writeln!(text)
}

/// The value of a metric; bold if the point is on its frontier.
fn figure(row: &Row, key: &str) -> String {
    let digits = Metric::find(key).map_or(4, |m| m.digits);
    let Some(value) = row.value(key) else { return "-".into() };
    let number = format!("{value:.digits$}");
    if row.frontier.contains(&key) { format!("**{number}**") } else { number }
}

fn titles() -> Vec<String> {
    let of = |key: &&str| Metric::find(key).map(|m| format!("{} {}", m.title, m.unit).trim_end().to_owned());
    KEYS.iter().filter_map(of).collect()
}

fn prices(table: &Table, input: &str, text: &mut String) -> std::fmt::Result {
    let mut prices = table.prices.iter().filter(|p| p.input == input).peekable();
    if prices.peek().is_none() {
        return Ok(());
    }
    writeln!(text, "| switch | method | ms without | with | {} |", titles().join(" | "))?;
    writeln!(text, "|---|---|---|---|{}", "---|".repeat(KEYS.len()))?;
    for price in prices {
        let change = |key: &&str| {
            let digits = Metric::find(key).map_or(4, |m| m.digits);
            match price.values.get(key) {
                Some([Some(without), Some(with)]) => format!("{without:.digits$} -> {with:.digits$}"),
                _ => "-".into(),
            }
        };
        let figures: Vec<String> = KEYS.iter().map(change).collect();
        let [without, with] = price.pass_ms;
        writeln!(
            text,
            "| {} | {} | {without:.2} | {with:.2} | {} |",
            cell(&price.switch),
            price.method,
            figures.join(" | ")
        )?;
    }
    writeln!(text)
}

fn convergences(table: &Table, input: &str, text: &mut String) -> std::fmt::Result {
    let mut groups = table.convergences.iter().filter(|c| c.input == input).peekable();
    if groups.peek().is_none() {
        return Ok(());
    }
    let number = |v: Option<f64>| v.map_or("-".into(), |v| format!("{v:.3e}"));
    let slope = |v: Option<f64>| v.map_or("-".into(), |v| format!("{v:.2}"));
    writeln!(
        text,
        "Slopes are of lg(squared error) against lg(samples) and against lg(ms); efficiency is 1 / (squared error x seconds).\n"
    )?;
    writeln!(
        text,
        "| pattern | samples a pixel | ms | squared error: all | fovea | middle | periphery | efficiency: all | fovea | middle | periphery |"
    )?;
    writeln!(text, "|---|---|---|---|---|---|---|---|---|---|---|")?;
    for group in groups {
        for point in &group.points {
            let figures = point.mse.iter().chain(&point.efficiency).map(|&v| number(v)).collect::<Vec<_>>().join(" | ");
            let (samples, ms) = (point.samples_per_pixel, point.cost_ms);
            writeln!(text, "| {} | {samples:.3} | {ms:.1} | {figures} |", cell(&group.label))?;
        }
        let slopes = |s: &[Option<f64>; 4]| s.iter().map(|&v| slope(v)).collect::<Vec<_>>().join(" | ");
        writeln!(
            text,
            "| {}: slopes | by samples, ms | | {} | {} |",
            cell(&group.label),
            slopes(&group.slope_by_samples),
            slopes(&group.slope_by_time)
        )?;
    }
    writeln!(text)
}

/// A text escaped for a cell.
fn cell(text: &str) -> String {
    text.replace('|', "\\|").replace(['\n', '\r'], " ")
}

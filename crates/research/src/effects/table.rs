//! Costs of effects: the report, and its Markdown tables.

use afterimage_cli::failure::Failure;
use afterimage_lab::clock::Quartiles;
use afterimage_lab::pipeline::ProcessorInfo;
use afterimage_lab::trace::effects::Effect;
use afterimage_lab::whole_file::write_whole;
use serde::Serialize;
use std::fmt::Write;
use std::path::Path;

/// Costs of effects.
#[derive(Serialize)]
pub struct Report {
    pub tool: &'static str,
    pub version: &'static str,
    pub size: [u32; 2],
    pub frames: u64,
    pub max_depth: u32,
    pub machine: String,
    /// Whether the driver's shader cache was switched off.
    pub compiled_cold: bool,
    pub backends: Vec<ProcessorInfo>,
    pub scenes: Vec<SceneReport>,
}

/// Costs in a scene.
#[derive(Serialize)]
pub struct SceneReport {
    pub scene: String,
    pub triangles: u32,
    pub needs: Vec<&'static str>,
    /// One list per backend.
    pub prices: Vec<Vec<Price>>,
    /// Time of kernels with the effect switched off, divided by that of kernels without its source; on an adapter, with
    /// `--removal`.
    pub removals: Vec<Price>,
}

/// Cost of a set of effects.
#[derive(Clone, Debug, Serialize)]
pub struct Price {
    /// `auto`, `again` (the same compiled again, which shows the noise), `all`, or the effect added to `auto`.
    pub what: String,
    pub ms: Option<Quartiles>,
    /// Time of each frame divided by that of `auto`.
    pub ratio: Option<Quartiles>,
    /// The median's 99.9 % confidence interval.
    pub interval: Option<[f64; 2]>,
    pub compile_ms: Option<Quartiles>,
}

const BEGIN: &str = "<!-- begin of the output of `cargo research effects` -->";
const END: &str = "<!-- end of the output of `cargo research effects` -->";

/// Replaces the text between the markers of a file, or writes a new file.
pub fn write(path: &Path, text: &str) -> Result<(), Failure> {
    let before = std::fs::read_to_string(path).unwrap_or_default();
    let whole = match (before.find(BEGIN), before.find(END)) {
        (Some(begin), Some(end)) if begin < end => {
            format!("{}{text}{}", &before[..begin], &before[end + END.len()..])
        }
        _ if before.is_empty() => format!("{text}\n"),
        _ => {
            let text = format!("{}: has no markers for the tables; add '{BEGIN}' and '{END}'", path.display());
            return Err(Failure::Input(text));
        }
    };
    write_whole(path, |file| std::io::Write::write_all(file, whole.as_bytes())).map_err(|e| Failure::writing(path, e))
}

/// All tables, between the markers.
pub fn markdown(report: &Report) -> String {
    let mut out = String::new();
    // Writing to a string cannot fail.
    let _ = tables(report, &mut out);
    out
}

fn tables(report: &Report, out: &mut String) -> std::fmt::Result {
    let [w, h] = report.size;
    writeln!(out, "{BEGIN}")?;
    writeln!(out, "{w}x{h}, 1 sample per pixel, depth {}, {} frames per value;", report.max_depth, report.frames)?;
    let names: Vec<_> = report.backends.iter().map(|b| format!("{}: {} ({})", b.kind, b.name, b.driver)).collect();
    writeln!(out, "{}; {}. Kernels are compiled {}.\n", report.machine, names.join("; "), cache_state(report))?;
    summary(report, out)?;
    for scene in &report.scenes {
        writeln!(out, "\n### {}\n", scene.scene)?;
        writeln!(out, "{} triangles; needs {}.\n", scene.triangles, scene.needs.join(", "))?;
        one_scene(report, scene, out)?;
    }
    removals(report, out)?;
    write!(out, "{END}")
}

fn cache_state(report: &Report) -> &'static str {
    if report.compiled_cold { "without the driver's shader cache" } else { "with the driver's shader cache" }
}

/// Noise: largest distance from 1 within the interval of `again`.
fn noise(prices: &[Price]) -> f64 {
    let again = prices.iter().find(|p| p.what == "again").and_then(|p| p.interval);
    again.map_or(0.0, |[low, high]| (1.0 - low).max(high - 1.0).max(0.0))
}

/// Whether the interval of the cost is above the noise.
fn is_beyond_noise(price: &Price, noise: f64) -> bool {
    price.interval.is_some_and(|[low, _]| low > 1.0 + noise)
}

/// Summary with one row per effect and one column per scene.
fn summary(report: &Report, out: &mut String) -> std::fmt::Result {
    for (b, backend) in report.backends.iter().enumerate() {
        writeln!(out, "Increase of the frame time, {}, in percent; bold beyond noise:\n", backend.kind)?;
        let names: Vec<_> = report.scenes.iter().map(|s| s.scene.as_str()).collect();
        writeln!(out, "| effect added | {} |", names.join(" | "))?;
        writeln!(out, "|---|{}", "---|".repeat(names.len()))?;
        let cells = |what: &str| -> Vec<String> {
            let cell = |s: &SceneReport| {
                let prices = &s.prices[b];
                let Some(price) = prices.iter().find(|p| p.what == what) else { return "needed".to_owned() };
                let Some(ratio) = price.ratio else { return "-".to_owned() };
                let percent = format!("{:+.1}", 100.0 * (ratio.median - 1.0));
                let is_bold = what != "again" && is_beyond_noise(price, noise(prices));
                if is_bold { format!("**{percent}**") } else { percent }
            };
            report.scenes.iter().map(cell).collect()
        };
        for effect in Effect::ALL {
            writeln!(out, "| {} | {} |", effect.name(), cells(effect.name()).join(" | "))?;
        }
        writeln!(out, "| all of them | {} |", cells("all").join(" | "))?;
        let noise = |s: &SceneReport| format!("{:.1}", 100.0 * noise(&s.prices[b]));
        let noise: Vec<_> = report.scenes.iter().map(noise).collect();
        writeln!(out, "| noise: no effect added | {} |\n", noise.join(" | "))?;
    }
    Ok(())
}

fn one_scene(report: &Report, scene: &SceneReport, out: &mut String) -> std::fmt::Result {
    write!(out, "| kernels |")?;
    for backend in &report.backends {
        write!(out, " {0}, ms | quartiles | {0}, ratio to auto |", backend.kind)?;
        if backend.kind == "gpu" {
            write!(out, " compile ms |")?;
        }
    }
    writeln!(out)?;
    let columns: usize = report.backends.iter().map(|b| if b.kind == "gpu" { 4 } else { 3 }).sum();
    writeln!(out, "|---|{}", "---|".repeat(columns))?;
    let rows = scene.prices.first().map_or(0, Vec::len);
    for row in 0..rows {
        let what = &scene.prices[0][row].what;
        let name = match what.as_str() {
            "auto" => "auto".to_owned(),
            "again" => "auto again".to_owned(),
            "all" => "all".to_owned(),
            effect => format!("auto and {effect}"),
        };
        write!(out, "| {name} |")?;
        for (prices, backend) in scene.prices.iter().zip(&report.backends) {
            let price = &prices[row];
            write!(out, " {} | {} |", median(price.ms, 1), quartiles(price.ms))?;
            write!(out, " {} |", median(price.ratio, 3))?;
            if backend.kind == "gpu" {
                write!(out, " {} |", median(price.compile_ms, 0))?;
            }
        }
        writeln!(out)?;
    }
    Ok(())
}

fn removals(report: &Report, out: &mut String) -> std::fmt::Result {
    if report.scenes.iter().all(|s| s.removals.is_empty()) {
        return Ok(());
    }
    writeln!(out, "\n### Switched off or removed\n")?;
    writeln!(
        out,
        "Frame time with the effect switched off by an `override` constant, divided by that with its text \
         removed; gpu.\n"
    )?;
    writeln!(out, "| scene | effect | off / removed | quartiles | 99.9 % interval of the median |")?;
    writeln!(out, "|---|---|---|---|---|")?;
    for scene in &report.scenes {
        for price in &scene.removals {
            let name = if price.what == "again" { "none removed" } else { price.what.as_str() };
            let quartiles = price.ratio.map_or("-".into(), |q| format!("{:.3} to {:.3}", q.p25, q.p75));
            let interval = price.interval.map_or("-".into(), |[low, high]| format!("{low:.3} to {high:.3}"));
            let ratio = median(price.ratio, 3);
            writeln!(out, "| {} | {name} | {ratio} | {quartiles} | {interval} |", scene.scene)?;
        }
    }
    Ok(())
}

fn median(q: Option<Quartiles>, digits: usize) -> String {
    q.map_or("-".into(), |q| format!("{:.digits$}", q.median))
}

fn quartiles(q: Option<Quartiles>) -> String {
    q.map_or("-".into(), |q| format!("{:.1} to {:.1}", q.p25, q.p75))
}

//! Costs of effects: the report, and its Markdown tables.

use afterimage_lab::clock::Quartiles;
use afterimage_lab::pipeline::ProcessorInfo;
use afterimage_lab::scene::effects::Effect;
use afterimage_lab::whole_file::write_whole;
use afterimage_program::failure::Failure;
use serde::Serialize;
use std::fmt::Write;
use std::path::Path;

/// Costs of effects.
#[derive(Serialize)]
pub struct EffectsReport {
    pub tool: &'static str,
    pub version: &'static str,
    pub size: [u32; 2],
    pub frames: u64,
    pub max_depth: u32,
    pub machine: String,
    /// Whether the driver's shader cache was switched off.
    pub compiled_cold: bool,
    pub backends: Vec<ProcessorInfo>,
    pub scenes: Vec<EffectsSceneReport>,
}

/// Costs in a scene.
#[derive(Serialize)]
pub struct EffectsSceneReport {
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
pub fn markdown(report: &EffectsReport) -> String {
    let mut out = String::new();
    // Writing to a string cannot fail.
    let _ = tables(report, &mut out);
    out
}

fn tables(report: &EffectsReport, out: &mut String) -> std::fmt::Result {
    let [w, h] = report.size;
    writeln!(out, "{BEGIN}")?;
    writeln!(out, "{w}x{h}, 1 sample per pixel, depth {}, {} frames per value;", report.max_depth, report.frames)?;
    let names: Vec<_> = report.backends.iter().map(|b| format!("{}: {} ({})", b.kind, b.name, b.driver)).collect();
    writeln!(out, "{}; {}. Kernels are compiled {}.\n", report.machine, names.join("; "), cache_state(report))?;
    increases(report, out)?;
    kernels(report, out)?;
    removals(report, out)?;
    write!(out, "{END}")
}

fn cache_state(report: &EffectsReport) -> &'static str {
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

/// One row per effect and one column per scene, with a value per backend.
fn increases(report: &EffectsReport, out: &mut String) -> std::fmt::Result {
    let kinds: Vec<_> = report.backends.iter().map(|b| b.kind).collect();
    writeln!(out, "Increase of the frame time in percent, {}; bold beyond noise:\n", kinds.join(", "))?;
    let names: Vec<_> = report.scenes.iter().map(|s| s.scene.as_str()).collect();
    writeln!(out, "| effect added | {} |", names.join(" | "))?;
    writeln!(out, "|---|{}", "---|".repeat(names.len()))?;
    let row = |cell: &dyn Fn(&EffectsSceneReport) -> String| -> String {
        let cells: Vec<_> = report.scenes.iter().map(cell).collect();
        cells.join(" | ")
    };
    for effect in Effect::ALL {
        writeln!(out, "| {} | {} |", effect.name(), row(&|s| increase(s, effect.name())))?;
    }
    writeln!(out, "| all of them | {} |", row(&|s| increase(s, "all")))?;
    let noises = |s: &EffectsSceneReport| of_each(s, |prices| format!("{:.1}", 100.0 * noise(prices)));
    writeln!(out, "| noise: no effect added | {} |\n", row(&noises))
}

/// A cell with a value per backend.
fn of_each(scene: &EffectsSceneReport, value: impl Fn(&[Price]) -> String) -> String {
    let values: Vec<_> = scene.prices.iter().map(|prices| value(prices)).collect();
    values.join(", ")
}

/// Increase of the frame time in percent, per backend; "needed" for an effect that the scene uses.
fn increase(scene: &EffectsSceneReport, what: &str) -> String {
    if scene.needs.contains(&what) {
        return "needed".to_owned();
    }
    of_each(scene, |prices| {
        let Some((price, ratio)) = find(prices, what).and_then(|p| Some((p, p.ratio?))) else { return "-".to_owned() };
        let percent = format!("{:+.1}", 100.0 * (ratio.median - 1.0));
        if is_beyond_noise(price, noise(prices)) { format!("**{percent}**") } else { percent }
    })
}

fn find<'a>(prices: &'a [Price], what: &str) -> Option<&'a Price> {
    prices.iter().find(|p| p.what == what)
}

/// One row per scene: times of the kernels with the effects that the scene needs, and with all effects.
fn kernels(report: &EffectsReport, out: &mut String) -> std::fmt::Result {
    let kinds = report.backends.iter().map(|b| format!(" {}, ms: auto, all |", b.kind));
    writeln!(out, "| scene | triangles | needs |{} compile ms: auto, all |", kinds.collect::<String>())?;
    writeln!(out, "|---|---|---|---|{}", "---|".repeat(report.backends.len()))?;
    for scene in &report.scenes {
        write!(out, "| {} | {} | {} |", scene.scene, scene.triangles, scene.needs.join(", "))?;
        let both = |prices: &[Price], ms: fn(&Price) -> Option<Quartiles>, digits: usize| {
            ["auto", "all"].map(|what| median(find(prices, what).and_then(ms), digits)).join(", ")
        };
        for prices in &scene.prices {
            write!(out, " {} |", both(prices, |p| p.ms, 1))?;
        }
        // The CPU compiles nothing.
        let compiled = scene.prices.last().map_or_else(String::new, |prices| both(prices, |p| p.compile_ms, 0));
        writeln!(out, " {compiled} |")?;
    }
    Ok(())
}

/// One row per scene: the control, the effect with the largest ratio, and all effects.
fn removals(report: &EffectsReport, out: &mut String) -> std::fmt::Result {
    if report.scenes.iter().all(|s| s.removals.is_empty()) {
        return Ok(());
    }
    writeln!(
        out,
        "\nFrame time with an effect switched off by an `override` constant, divided by that with its text removed;\n\
         gpu, with the 99.9 % interval of the median:\n"
    )?;
    writeln!(out, "| scene | none removed | largest of an effect | all of them |")?;
    writeln!(out, "|---|---|---|---|")?;
    let cell = |price: Option<&Price>| {
        let interval =
            price.and_then(|p| p.interval).map_or("-".into(), |[low, high]| format!("{low:.3} to {high:.3}"));
        format!("{} ({interval})", median(price.and_then(|p| p.ratio), 3))
    };
    for scene in &report.scenes {
        let effects = scene.removals.iter().filter(|p| !["again", "all of them"].contains(&p.what.as_str()));
        let ratio = |p: &Price| p.ratio.map_or(0.0, |q| q.median);
        let largest = effects.max_by(|a, b| ratio(a).total_cmp(&ratio(b)));
        let [control, all] = ["again", "all of them"].map(|what| cell(find(&scene.removals, what)));
        let name = largest.map_or("-", |p| p.what.as_str());
        writeln!(out, "| {} | {control} | {name} {} | {all} |", scene.scene, cell(largest))?;
    }
    Ok(())
}

fn median(q: Option<Quartiles>, digits: usize) -> String {
    q.map_or("-".into(), |q| format!("{:.digits$}", q.median))
}

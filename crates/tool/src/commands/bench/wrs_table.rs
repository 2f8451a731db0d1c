//! `afterimage bench wrs`: table 1 and the run times of Cantory et al. 2025, with our results and theirs.

use super::wrs_readings;
use crate::args::backend::BackendName;
use crate::commands::sweep::{SweepArgs, execute};
use crate::failure::Failure;
use crate::sweep::{Metric, Row, Table};
use afterimage_lab::whole_file::write_whole;
use clap::{Args, Parser, ValueEnum};
use std::io::Write;
use std::path::PathBuf;

/// Table 1 and the run times of weighted reservoir sampling (Cantory et al. 2025) in Markdown, with our results and
/// theirs
#[derive(Args, Clone, Debug)]
#[command(
    after_help = "Example:\n  afterimage bench wrs sponza_still/ sponza_lateral/ --gaze viewing.csv --start 1 --out out/wrs --markdown docs/wrs-table.md\n\n\
    Run the same command again to resume. OUT/report.html has all results."
)]
pub struct WrsTableArgs {
    /// A still, as for run; compared with the paper's scenes "-S"
    pub still: String,
    /// Frames of a camera that moves sideways; compared with the paper's scenes "-M"
    pub moving: String,
    /// Scanpath, as for run
    #[arg(long, value_name = "FILE.csv")]
    pub gaze: String,
    /// Start time in the scanpath, seconds
    #[arg(long, default_value_t = 0.0, value_name = "S")]
    pub start: f64,
    /// Number of frames of each point
    #[arg(long, default_value_t = 300, value_name = "N")]
    pub frames: u64,
    /// Block edge in the middle region, pixels. With 4 and 8 a frame of 1920x1080 has the block angles of the paper's
    /// 3840x2160 with 8 and 16
    #[arg(long, default_value_t = 4, value_name = "N")]
    pub rate_mid: u32,
    /// Block edge in the periphery, pixels
    #[arg(long, default_value_t = 8, value_name = "N")]
    pub rate_far: u32,
    /// Another scanpath for the readings, stretched over the picture
    #[arg(long, value_name = "FILE.csv")]
    pub second_gaze: Option<String>,
    /// Make these tables alone
    #[arg(long, value_enum, value_name = "TABLES")]
    pub only: Option<Tables>,
    /// Repetitions of randomized methods, each with another seed
    #[arg(long, default_value_t = 3, value_name = "N")]
    pub seeds: u64,
    /// Device that runs the methods
    #[arg(long, value_enum, default_value = "auto")]
    pub backend: BackendName,
    /// Folder of the sweep
    #[arg(long, value_name = "DIR")]
    pub out: PathBuf,
    /// File for the tables; default: standard output
    #[arg(long, value_name = "FILE.md")]
    pub markdown: Option<PathBuf>,
}

/// Tables of `bench wrs`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Tables {
    /// Table 1 and run times, which need a sweep
    Published,
    /// Gains of the method with other readings of its equations, on the still
    Readings,
}

/// Published results: PSNR in dB and SSIM, without (still) or with TAA (moving), and with weighted reservoirs.
struct Published {
    scene: &'static str,
    still: Option<[[f64; 2]; 2]>,
    moving: Option<[[f64; 2]; 2]>,
    /// Milliseconds at 4K on an RTX 4070 Ti Super: foveated, with TAA, with weighted reservoirs.
    ms: [f64; 3],
}

/// The paper's table 1. Its values for Sponza in motion repeat those of the still, so they are left out.
const PUBLISHED: [Published; 4] = [
    Published {
        scene: "Fantasy Forest",
        still: Some([[21.93, 0.540], [23.71, 0.661]]),
        moving: Some([[23.39, 0.600], [24.61, 0.654]]),
        ms: [12.52, 14.95, 12.63],
    },
    Published { scene: "Sponza", still: Some([[24.13, 0.540], [26.52, 0.720]]), moving: None, ms: [9.77, 11.97, 9.82] },
    Published {
        scene: "San Miguel",
        still: Some([[22.15, 0.579], [24.73, 0.749]]),
        moving: Some([[20.21, 0.614], [21.66, 0.693]]),
        ms: [13.53, 18.62, 13.59],
    },
    Published {
        scene: "Corridor",
        still: None,
        moving: Some([[22.27, 0.7359], [23.12, 0.7752]]),
        ms: [9.87, 11.66, 10.81],
    },
];

const FOVEAE_DEG: [&str; 3] = ["5", "7.5", "10"];

/// Parser of the options of `sweep`.
#[derive(Parser)]
#[command(name = "sweep")]
struct Sweep {
    #[command(flatten)]
    args: SweepArgs,
}

/// Runs the sweep and writes the tables.
pub fn bench(args: &WrsTableArgs) -> Result<(), Failure> {
    if args.only == Some(Tables::Published) {
        return match published(args)? {
            Some(tables) => write(args, &tables),
            None => Ok(()),
        };
    }
    let readings = wrs_readings::table(args)?;
    // Before the sweep, which may be interrupted.
    if args.only.is_some() || args.markdown.is_some() {
        write(args, &readings)?;
    }
    if args.only.is_none()
        && let Some(tables) = published(args)?
    {
        write(args, &format!("{tables}\n{readings}"))?;
    }
    Ok(())
}

/// Table 1 and run times; nothing if the sweep was interrupted.
fn published(args: &WrsTableArgs) -> Result<Option<String>, Failure> {
    let (start, frames, seeds) = (args.start.to_string(), args.frames.to_string(), args.seeds.to_string());
    let out = args.out.to_string_lossy();
    let (rate_mid, rate_far) = (format!("rate-mid={}", args.rate_mid), format!("rate-far={}", args.rate_far));
    let words = [
        "sweep",
        &args.still,
        &args.moving,
        "--preset",
        "paper",
        "--gaze",
        &args.gaze,
        "--start",
        &start,
        "--frames",
        &frames,
        "--seeds",
        &seeds,
        "--backend",
        args.backend.name(),
        "--set",
        &rate_mid,
        "--set",
        &rate_far,
        "--out",
        &out,
    ];
    let sweep = Sweep::try_parse_from(words).map_err(|e| Failure::usage(&e))?;
    Ok(execute(&sweep.args)?.map(|table| markdown(args, &table)))
}

fn write(args: &WrsTableArgs, text: &str) -> Result<(), Failure> {
    match &args.markdown {
        Some(path) => write_whole(path, |file| file.write_all(text.as_bytes())).map_err(|e| Failure::writing(path, e)),
        None => {
            say!("{text}");
            Ok(())
        }
    }
}

fn markdown(args: &WrsTableArgs, table: &Table) -> String {
    let mut lines = vec![format!("<!-- Generated by `{}`; do not edit. -->", table.command), String::new()];
    let machine = table.machines.first().map_or(String::new(), |m| format!("{} {}, {}", m.kind, m.name, m.clock));
    for (input, title, baseline) in [(&args.still, "Still", "none"), (&args.moving, "Moving camera", "taa")] {
        let Some(clip) = table.clips.get(input) else { continue };
        let [w, h] = clip.size;
        lines.push(format!("{title}: `{input}`, {w}x{h}, {} frames.\n", clip.frames));
        lines.push("| | fovea, degrees | PSNR dB | SSIM | FLIP | retained dB | ms per frame |".into());
        lines.push("|---|---|---|---|---|---|---|".into());
        for fovea in FOVEAE_DEG {
            for label in ["none", "taa", "wrs", WEIGHTED, "smr"] {
                if let Some(row) = find(table, input, label, fovea) {
                    lines.push(line(row, label, fovea));
                }
            }
        }
        for published in &PUBLISHED {
            let pair = if baseline == "none" { published.still } else { published.moving };
            let Some([before, after]) = pair else { continue };
            let name = if baseline == "none" { "none" } else { "taa" };
            for (method, [psnr, ssim]) in [(name, before), ("wrs", after)] {
                lines.push(format!("| paper, {}: {method} | 5 | {psnr:.2} | {ssim:.3} | - | - | - |", published.scene));
            }
        }
        lines.push(gain(table, input, baseline));
    }
    lines.push(format!(
        "Run time, milliseconds per frame.\n\
         Measured on {machine}.\n\
         The paper's times are for a 4K frame on an RTX 4070 Ti Super and include rendering:\n\
         the cost of a method is the difference from the first column.\n"
    ));
    lines.push("| | foveated | + taa | + wrs | + wrs weighted | + smr |".into());
    lines.push("|---|---|---|---|---|---|".into());
    for input in [&args.still, &args.moving] {
        let ms = |label| find(table, input, label, "5").map_or("-".into(), |r| format!("{:.2}", r.pass_ms.median));
        let all = ["none", "taa", "wrs", WEIGHTED, "smr"].map(ms);
        lines.push(format!("| `{input}` | {} |", all.join(" | ")));
    }
    for published in &PUBLISHED {
        let [foveated, taa, wrs] = published.ms;
        lines.push(format!("| paper, {} | {foveated:.2} | {taa:.2} | {wrs:.2} | - | - |", published.scene));
    }
    lines.push(String::new());
    lines.join("\n")
}

/// Label of wrs with `--wrs-preset weighted`.
const WEIGHTED: &str = "wrs weighted";

/// Row of a method, or of [`WEIGHTED`].
fn find<'a>(table: &'a Table, input: &str, label: &str, fovea: &str) -> Option<&'a Row> {
    let method = label.split(' ').next().unwrap_or(label);
    let has = |r: &&Row, option: &str, value: &str| r.point.options.get(option).is_some_and(|v| v == value);
    let fits = |r: &&Row| {
        r.point.input == input
            && r.point.method == method
            && has(r, "fovea", fovea)
            && has(r, "wrs-preset", "weighted") == (label == WEIGHTED)
    };
    table.rows.iter().find(fits)
}

fn line(row: &Row, label: &str, fovea: &str) -> String {
    let value = |key: &str| {
        let digits = Metric::find(key).map_or(2, |m| m.digits);
        row.values.get(key).copied().flatten().map_or("-".into(), |v| format!("{v:.digits$}"))
    };
    let [psnr, ssim, flip, retained] = ["psnr_db", "ssim", "flip", "retained_psnr_db"].map(value);
    format!("| {label} | {fovea} | {psnr} | {ssim} | {flip} | {retained} | {:.2} |", row.pass_ms.median)
}

/// Gain in PSNR of wrs and smr over the paper's baseline, and the paper's gain.
fn gain(table: &Table, input: &str, baseline: &str) -> String {
    let psnr = |method| find(table, input, method, "5").and_then(|r| r.values.get("psnr_db").copied().flatten());
    let (Some(before), Some(wrs), Some(weighted), Some(smr)) =
        (psnr(baseline), psnr("wrs"), psnr(WEIGHTED), psnr("smr"))
    else {
        return String::new();
    };
    let theirs: Vec<f64> = PUBLISHED
        .iter()
        .filter_map(|p| if baseline == "none" { p.still } else { p.moving })
        .map(|[before, after]| after[0] - before[0])
        .collect();
    let (least, most) = theirs.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, m), &v| (l.min(v), m.max(v)));
    format!(
        "\nPSNR gain over {baseline}, 5 degrees: wrs {:+.2} dB, weighted {:+.2} dB, smr {:+.2} dB.\n\
         The paper reports {least:+.2} to {most:+.2} dB for wrs on its scenes.\n",
        wrs - before,
        weighted - before,
        smr - before
    )
}

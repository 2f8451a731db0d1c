//! Agreement of JOD with another metric's scores of the same pairs of videos: the table and the plot of
//! `docs/metrics.md`. `cargo research jod-validation FOLDER [PLOT.svg]`, a minute
//! for 342 pairs of 30 frames.
//!
//! FOLDER holds `pairs.csv` (id, set, reference, test, gaze, fps, ppd, peak_nits, contrast, kind, ...; set is `fit` or
//! `held`), `scores.csv` (id and the other metric's JOD), the PNG frames of each video in `clips/NAME`, and gaze in
//! `gaze/NAME.csv` (frame, x_px, y_px; (0, 0) is the middle of the top-left pixel).

use crate::error::AnyError;
use afterimage::{Image, ViewGeometry};
use afterimage_metric::{Display, ReferenceVideo, TestVideo, Viewing};
use afterimage_program::say;
use clap::Args;
use rayon::prelude::*;
use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::fs;
use std::path::Path;
use std::path::PathBuf;

/// Differences of the other metric above which a pair of videos must be ranked alike.
const RANKED_JOD: f64 = 0.2;

/// One pair of videos: its kind and set, the other metric's JOD, and ours.
struct Scored {
    id: String,
    kind: String,
    is_held: bool,
    other: f64,
    ours: f64,
}

/// Agreement of JOD with another metric's scores of the same pairs of videos
#[derive(Args, Clone, Debug)]
pub struct JodValidationArgs {
    /// Folder with pairs.csv, scores.csv and the videos
    pub folder: PathBuf,
    /// Also plot the scores
    #[arg(value_name = "PLOT.svg")]
    pub plot: Option<PathBuf>,
}

pub fn bench(args: &JodValidationArgs) -> Result<(), AnyError> {
    let folder = &args.folder;
    let others: BTreeMap<String, f64> = table(&folder.join("scores.csv"))?
        .iter()
        .filter_map(|row| Some((row.get("id")?.clone(), row.get("fvvdp_jod")?.parse().ok()?)))
        .collect();
    let pairs = table(&folder.join("pairs.csv"))?;
    let scored: Vec<Scored> = pairs
        .par_iter()
        .filter_map(|pair| {
            let other = *others.get(&pair["id"])?;
            Some(score(folder, pair).map(|ours| {
                let [id, kind] = ["id", "kind"].map(|key| pair[key].clone());
                Scored { id, kind, is_held: pair["set"] == "held", other, ours }
            }))
        })
        .collect::<Result<_, _>>()
        .map_err(|e: String| e)?;
    say!("| pairs | number | Pearson | Spearman | mean absolute difference | largest | ranked the other way |");
    say!("|---|---|---|---|---|---|---|");
    for (name, is_held) in [("fitted", false), ("set aside", true)] {
        let of: Vec<&Scored> = scored.iter().filter(|s| s.is_held == is_held).collect();
        say!("| {name} | {} |", summary(&of));
    }
    let mut kinds: BTreeMap<&str, Vec<&Scored>> = BTreeMap::new();
    scored.iter().filter(|s| s.is_held).for_each(|s| kinds.entry(&s.kind).or_default().push(s));
    say!("\n| kind, set aside | number | JOD of the other metric | mean absolute difference | mean difference |");
    say!("|---|---|---|---|---|");
    for (kind, of) in kinds {
        let (least, most) = of.iter().fold((10.0_f64, 0.0_f64), |(a, b), s| (a.min(s.other), b.max(s.other)));
        let mean = |f: &dyn Fn(&Scored) -> f64| of.iter().map(|s| f(s)).sum::<f64>() / of.len() as f64;
        say!(
            "| {kind} | {} | {least:.2} to {most:.2} | {:.2} | {:+.2} |",
            of.len(),
            mean(&|s| (s.ours - s.other).abs()),
            mean(&|s| s.ours - s.other),
        );
    }
    let mut worst: Vec<&Scored> = scored.iter().filter(|s| s.is_held).collect();
    worst.sort_by(|a, b| (b.ours - b.other).abs().total_cmp(&(a.ours - a.other).abs()));
    say!("\nlargest differences, set aside:");
    worst.iter().take(10).for_each(|s| say!("  {}: {:.2}, ours {:.2}", s.id, s.other, s.ours));
    if let Some(path) = &args.plot {
        fs::write(path, plot(&scored))?;
    }
    Ok(())
}

/// JOD of a pair by our metric.
fn score(folder: &Path, pair: &BTreeMap<String, String>) -> Result<f64, String> {
    let number = |key: &str| pair[key].parse::<f32>().map_err(|e| format!("{}: {key}: {e}", pair["id"]));
    let [reference, test] = ["reference", "test"].map(|key| frames(&folder.join("clips").join(&pair[key])));
    let (reference, test) = (reference?, test?);
    let gaze: Vec<[f32; 2]> = table(&folder.join("gaze").join(format!("{}.csv", pair["gaze"])))?
        .iter()
        .map(|row| ["x_px", "y_px"].map(|key| row[key].parse::<f32>().unwrap_or(f32::NAN) + 0.5))
        .collect();
    let size = reference.first().ok_or("no frames")?.size();
    let tangent_per_px = 2.0 * (0.5 / number("ppd")?).to_radians().tan();
    let hfov_deg = 2.0 * (0.5 * tangent_per_px * size[0] as f32).atan().to_degrees();
    let geometry = ViewGeometry::flat(size, hfov_deg).map_err(|e| e.to_string())?;
    let display = Display { peak_nits: number("peak_nits")?, contrast: number("contrast")?, ..Display::default() };
    let mut references = ReferenceVideo::new(Viewing { geometry, display, fps: number("fps")? });
    let mut video = TestVideo::default();
    for (i, (reference, test)) in reference.iter().zip(&test).enumerate() {
        video.push(&references.push(reference, gaze.get(i).copied()), test);
    }
    Ok(video.score().map_or(10.0, |score| score.jod))
}

/// The PNG frames of a folder in the order of their names.
fn frames(folder: &Path) -> Result<Vec<Image<[f32; 3]>>, String> {
    let failed = |e: &dyn std::fmt::Display| format!("{}: {e}", folder.display());
    let entries = fs::read_dir(folder).map_err(|e| failed(&e))?;
    let mut paths: Vec<_> = entries.filter_map(|entry| Some(entry.ok()?.path())).collect();
    paths.retain(|path| path.extension().is_some_and(|e| e == "png"));
    paths.sort();
    let frame = |path: &std::path::PathBuf| {
        let picture = image::open(path).map_err(|e| failed(&e))?.to_rgb8();
        let pixels = picture.pixels().map(|p| p.0.map(|v| f32::from(v) / 255.0)).collect();
        Image::from_pixels([picture.width(), picture.height()], pixels).map_err(|e| failed(&e))
    };
    paths.iter().map(frame).collect()
}

/// Rows of a CSV file by its header.
fn table(path: &Path) -> Result<Vec<BTreeMap<String, String>>, String> {
    let text = fs::read_to_string(path).map_err(|e| format!("{}: {e}", path.display()))?;
    let mut lines = text.lines();
    let header: Vec<&str> = lines.next().unwrap_or_default().split(',').collect();
    Ok(lines
        .map(|line| header.iter().zip(line.split(',')).map(|(k, v)| (k.to_string(), v.to_owned())).collect())
        .collect())
}

/// Cells of the table for pairs.
fn summary(of: &[&Scored]) -> String {
    let (others, ours): (Vec<f64>, Vec<f64>) = of.iter().map(|s| (s.other, s.ours)).unzip();
    let off: Vec<f64> = others.iter().zip(&ours).map(|(a, b)| (a - b).abs()).collect();
    let (mut apart, mut reversed) = (0, 0);
    for i in 0..of.len() {
        for j in 0..i {
            let (other, own) = (others[i] - others[j], ours[i] - ours[j]);
            if other.abs() > RANKED_JOD {
                apart += 1;
                reversed += usize::from(other * own < 0.0);
            }
        }
    }
    format!(
        "{} | {:.4} | {:.4} | {:.3} | {:.2} | {:.2} %",
        of.len(),
        correlation(&others, &ours),
        correlation(&ranks(&others), &ranks(&ours)),
        off.iter().sum::<f64>() / off.len() as f64,
        off.iter().copied().fold(0.0, f64::max),
        100.0 * reversed as f64 / apart.max(1) as f64,
    )
}

/// Pearson's correlation.
fn correlation(a: &[f64], b: &[f64]) -> f64 {
    let mean = |v: &[f64]| v.iter().sum::<f64>() / v.len() as f64;
    let (ma, mb) = (mean(a), mean(b));
    let sum = |f: &dyn Fn(f64, f64) -> f64| a.iter().zip(b).map(|(a, b)| f(a - ma, b - mb)).sum::<f64>();
    sum(&|a, b| a * b) / (sum(&|a, _| a * a) * sum(&|_, b| b * b)).sqrt()
}

/// Rank of each value; equal values have their mean rank.
fn ranks(values: &[f64]) -> Vec<f64> {
    let below = |v: f64| values.iter().filter(|&&other| other < v).count() as f64;
    let equal = |v: f64| values.iter().filter(|&&other| other == v).count() as f64;
    values.iter().map(|&v| below(v) + 0.5 * (equal(v) - 1.0)).collect()
}

/// Scatter plot: the other metric to the right, ours upwards; fitted pairs are hollow.
fn plot(scored: &[Scored]) -> String {
    const SIDE: f64 = 480.0;
    const MARGIN: f64 = 44.0;
    const FROM: f64 = 3.0;
    let at = |jod: f64| (jod - FROM) / (10.0 - FROM) * SIDE;
    let (x, y) = (|jod| MARGIN + at(jod), |jod| MARGIN + SIDE - at(jod));
    let full = SIDE + 2.0 * MARGIN;
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {full} {full}\" font-family=\"sans-serif\" \
         font-size=\"13\">\n<rect width=\"{full}\" height=\"{full}\" fill=\"#fff\"/>\n"
    );
    for jod in 3..=10 {
        let jod = f64::from(jod);
        let _ = writeln!(
            svg,
            "<path d=\"M{:.1} {:.1}V{:.1}M{:.1} {:.1}H{:.1}\" stroke=\"#ddd\"/><text x=\"{:.1}\" y=\"{:.1}\" \
             text-anchor=\"middle\">{jod}</text><text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"end\">{jod}</text>",
            x(jod),
            y(FROM),
            y(10.0),
            x(FROM),
            y(jod),
            x(10.0),
            x(jod),
            y(FROM) + 17.0,
            x(FROM) - 6.0,
            y(jod) + 4.0,
        );
    }
    let _ = writeln!(svg, "<path d=\"M{:.1} {:.1}L{:.1} {:.1}\" stroke=\"#888\"/>", x(FROM), y(FROM), x(10.0), y(10.0));
    for s in scored {
        let (fill, stroke) = if s.is_held { ("#1f6fb4", "none") } else { ("none", "#c77f2a") };
        let (cx, cy) = (x(s.other.max(FROM)), y(s.ours.max(FROM)));
        let _ = writeln!(svg, "<circle cx=\"{cx:.1}\" cy=\"{cy:.1}\" r=\"3\" fill=\"{fill}\" stroke=\"{stroke}\"/>");
    }
    let middle = MARGIN + 0.5 * SIDE;
    let _ = writeln!(
        svg,
        "<text x=\"{middle}\" y=\"{}\" text-anchor=\"middle\">JOD of FovVideoVDP</text><text x=\"14\" y=\"{middle}\" \
         text-anchor=\"middle\" transform=\"rotate(-90 14 {middle})\">JOD, ours</text><text x=\"{middle}\" y=\"24\" \
         text-anchor=\"middle\">blue: set aside; orange, hollow: fitted</text>\n</svg>",
        full - 6.0
    );
    svg
}

//! The tables of `docs/foreign.md`.

use super::clip::ROWS;
use super::scenes::Unread;
use super::scores::{Crop, QUADS, SceneScores, psnr};
use crate::error::AnyError;
use afterimage_lab::whole_file::write_whole;
use std::fs;
use std::io::Write as _;
use std::path::Path;

/// The picture, from the root of the workspace.
pub const PICTURE: &str = "docs/images/foreign.png";
const PAGE: &str = "docs/foreign.md";
const BEGIN: &str = "<!-- begin of the output of the example `foreign` -->";
const END: &str = "<!-- end of the output of the example `foreign` -->";
/// Most JOD that quads may lack against full rate with taa, in the order of [`QUADS`].
const BARS_JOD: [f64; 2] = [0.10, 0.25];

/// Replaces the text between the page's markers.
pub fn write(text: &str) -> Result<(), AnyError> {
    let page = fs::read_to_string(PAGE).map_err(|e| format!("{PAGE}: {e}"))?;
    let (Some(begin), Some(end)) = (page.find(BEGIN), page.find(END)) else {
        return Err(format!("{PAGE}: has no markers for the tables; add '{BEGIN}' and '{END}'").into());
    };
    let page = format!("{}{BEGIN}\n\n{text}\n{}", &page[..begin], &page[end..]);
    write_whole(Path::new(PAGE), |file| file.write_all(page.as_bytes())).map_err(|e| format!("{PAGE}: {e}").into())
}

/// All tables, and the scenes that could not be opened.
pub fn markdown(scores: &[SceneScores], unread: &[Unread]) -> String {
    [losses(scores), worst(scores), scenes(scores), refused(unread)]
        .into_iter()
        .filter(|part| !part.is_empty())
        .collect::<Vec<_>>()
        .join("\n")
}

/// The scenes that could not be measured; nothing if there are none.
fn refused(unread: &[Unread]) -> String {
    if unread.is_empty() {
        return String::new();
    }
    let line = |scene: &Unread| format!("| {} | {} |\n", scene.name, scene.reason.replace('\n', " "));
    format!("| not measured | why |\n|---|---|\n{}", unread.iter().map(line).collect::<String>())
}

/// JOD of a row below that of full rate with taa, by our metric and by FovVideoVDP.
fn lost(scene: &SceneScores, row: usize) -> [Option<f64>; 2] {
    let [full, quads] = [&scene.rows[0], &scene.rows[row]];
    let fvvdp = full.fvvdp_jod.zip(quads.fvvdp_jod);
    [Some(full.jod - quads.jod), fvvdp.map(|(full, quads)| full - quads)]
}

fn number(value: Option<f64>) -> String {
    // Adding 0 turns -0 into 0.
    value.map_or("-".into(), |v| format!("{:.2}", (100.0 * v).round() / 100.0 + 0.0))
}

fn place(crop: &Crop) -> String {
    format!("{}: {}, {}", crop.frame, crop.px[0], crop.px[1])
}

/// JOD below full rate with taa, and the crop of the picture.
fn losses(scores: &[SceneScores]) -> String {
    let mut text = "| JOD below full rate, taa | 25 % | by FovVideoVDP | `screen` | by FovVideoVDP | crop of the picture \
                    (frame: x, y) | its PSNR, dB: full rate, taa | 25 % | `screen` |\n|---|---|---|---|---|---|---|---|---|\n"
        .to_owned();
    for scene in scores {
        let lost: Vec<_> = QUADS.iter().flat_map(|&row| lost(scene, row)).map(number).collect();
        let dbs: Vec<_> = [0, QUADS[0], QUADS[1]].map(|row| psnr(scene.shown.mse[row])).to_vec();
        let place = place(&scene.shown.crop);
        text += &format!("| {} | {} | {place} | {} |\n", scene.name, lost.join(" | "), dbs.join(" | "));
    }
    text
}

/// The scenes that lose most.
fn worst(scores: &[SceneScores]) -> String {
    let most = |row: usize, metric: usize| {
        let lost = scores.iter().filter_map(|scene| Some((lost(scene, row)[metric]?, &scene.name)));
        let most = lost.max_by(|a, b| a.0.total_cmp(&b.0));
        most.map_or("-".into(), |(jod, name)| format!("{} ({name})", number(Some(jod))))
    };
    let line = |(&row, bar): (&usize, f64)| {
        format!("- Worst, {}: {} JOD, FovVideoVDP {}; bar {bar:.2}.\n", ROWS[row], most(row, 0), most(row, 1))
    };
    QUADS.iter().zip(BARS_JOD).map(line).collect()
}

/// All scores.
fn scenes(scores: &[SceneScores]) -> String {
    let mut text =
        "| scene | frames | pixels shaded, % | JOD | FovVideoVDP | PSNR, dB | worst crop, dB (frame: x, y) |\n\
                    |---|---|---|---|---|---|---|\n"
            .to_owned();
    for scene in scores {
        for (i, (name, row)) in ROWS.iter().zip(&scene.rows).enumerate() {
            text += &format!(
                "| {} | {name} | {:.1} | {} | {} | {} | {} ({}) |\n",
                if i == 0 { &scene.name } else { "" },
                100.0 * row.shaded,
                number(Some(row.jod)),
                number(row.fvvdp_jod),
                psnr(row.mse),
                psnr(row.worst.error),
                place(&row.worst),
            );
        }
    }
    text
}

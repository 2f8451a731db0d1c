//! Full rate and frames shaded by quads over every scene at hand: the built-in ones, and those of other people in a
//! folder.
//!
//! Each line says the share of the pixels that are shaded in percent, JOD, FovVideoVDP (JOD), PSNR in dB (sRGB), and
//! the worst crop of 64x64 pixels; jittered frames, the CPU executor, a moving camera, a supersampled reference. JOD,
//! FovVideoVDP and PSNR are of the 8-bit pictures of the last frames alone.
//!
//! `cargo research foreign`
//!
//! Makes the tables and the picture of `docs/foreign.md` (`--write`); minutes.

mod camera;
mod clip;
mod judge;
mod options;
mod page;
mod picture;
mod scenes;
mod scores;

use crate::error::AnyError;
use afterimage_lab::device::Headless;
pub use options::ForeignArgs;
use scenes::{SceneInput, Unread};
use scores::SceneScores;
use std::sync::Arc;
use std::time::Instant;

pub fn bench(options: &ForeignArgs) -> Result<(), AnyError> {
    let device = Headless::find_roomy(true).ok_or("there is no adapter; install mesa-vulkan-drivers")?;
    let (mut scores, mut unread) = (vec![], vec![]);
    for scene in scenes::chosen(options)? {
        let start = Instant::now();
        match measure(&scene, options, &device) {
            Ok(found) => {
                let jod: Vec<_> = found.rows.iter().map(|row| format!("{:.2}", row.jod)).collect();
                eprintln!("{}: JOD {}, {:.0} s", scene.name, jod.join(" "), start.elapsed().as_secs_f64());
                scores.push(found);
            }
            Err(error) => {
                eprintln!("{}: {error}", scene.name);
                unread.push(Unread { name: scene.name, reason: error.to_string() });
            }
        }
    }
    let text = page::markdown(&scores, &unread);
    say!("{text}");
    let picture = picture::crops(&scores);
    if options.write {
        page::write(&text)?;
        picture::write(page::PICTURE.as_ref(), &picture)?;
    }
    if let Some(folder) = &options.out {
        picture::write(&folder.join("crops.png"), &picture)?;
    }
    Ok(())
}

fn measure(scene: &SceneInput, options: &ForeignArgs, device: &Arc<Headless>) -> Result<SceneScores, AnyError> {
    let clip = clip::render(scene, options, device)?;
    // For the judge alone, if no folder is given; dropped with its frames.
    let temporary = tempfile::tempdir()?;
    let folder = options.out.as_deref().unwrap_or(temporary.path()).join(&scene.name);
    let judge = options.judge();
    if options.out.is_some() || judge.is_some() {
        judge::write_frames(&clip, &folder)?;
    }
    let judged = judge.and_then(|command| {
        // The other scores do not need it.
        judge::fvvdp_jod(&command, &clip, &folder).inspect_err(|error| eprintln!("{}: {error}", scene.name)).ok()
    });
    Ok(scores::score(&scene.name, &clip, judged))
}

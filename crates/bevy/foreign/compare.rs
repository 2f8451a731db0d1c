//! Compares pictures of two runs: `compare REFERENCE SHOWN OUT`, three folders. Prints PSNR over all pictures, and that
//! of the worst crop; writes reference, shown and the difference side by side, and the worst crop enlarged.

#[allow(dead_code, reason = "a part is used")]
mod headless;

use bevy::prelude::*;
use headless::{psnr_db, read_png, write_png};
use std::error::Error;
use std::path::{Path, PathBuf};

/// Side of a crop in pixels.
const CROP: u32 = 64;

/// How many times larger the difference is shown, and the worst crop.
const GAIN: u8 = 4;
const ENLARGED: u32 = 8;

struct Worst {
    psnr_db: f64,
    picture: String,
    corner: UVec2,
    crops: [Vec<u8>; 2],
}

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<PathBuf> = std::env::args_os().skip(1).map(PathBuf::from).collect();
    let [reference, shown, out] = &arguments[..] else { return Err("expected: REFERENCE SHOWN OUT".into()) };
    let mut all = [vec![], vec![]];
    let mut worst: Option<Worst> = None;
    for picture in pictures(shown)? {
        let [(size, a), (other_size, b)] = [read_png(&reference.join(&picture))?, read_png(&shown.join(&picture))?];
        if size != other_size {
            return Err(format!("{picture}: {size} and {other_size}").into());
        }
        for corner in corners(size) {
            let crops = [&a, &b].map(|picture| crop(picture, size, corner));
            let psnr_db = psnr_db(&crops[0], &crops[1]);
            if worst.as_ref().is_none_or(|worst| psnr_db < worst.psnr_db) {
                worst = Some(Worst { psnr_db, picture: picture.clone(), corner, crops });
            }
        }
        let strip = beside([&a, &b, &difference(&a, &b)], size);
        write_png(&out.join(&picture), size * UVec2::new(3, 1), &strip)?;
        all[0].extend(a);
        all[1].extend(b);
    }
    let Worst { psnr_db: worst_db, picture, corner, crops } = worst.ok_or("no pictures")?;
    let [a, b] = crops.map(|crop| enlarged(&crop));
    let side = UVec2::splat(CROP * ENLARGED);
    write_png(&out.join("worst.png"), side * UVec2::new(2, 1), &beside([&a, &b], side))?;
    println!("{:.2} {worst_db:.2} {picture} {} {}", psnr_db(&all[0], &all[1]), corner.x, corner.y);
    Ok(())
}

fn pictures(folder: &Path) -> Result<Vec<String>, Box<dyn Error>> {
    let names = std::fs::read_dir(folder)?.flatten().filter_map(|entry| entry.file_name().into_string().ok());
    let mut names: Vec<String> = names.filter(|name| name.ends_with(".png")).collect();
    names.sort();
    Ok(names)
}

/// Crops overlap by half.
fn corners(size: UVec2) -> impl Iterator<Item = UVec2> {
    let starts = |length: u32| (0..=length - CROP).step_by(CROP as usize / 2);
    starts(size.y).flat_map(move |y| starts(size.x).map(move |x| UVec2::new(x, y)))
}

fn crop(rgba: &[u8], size: UVec2, corner: UVec2) -> Vec<u8> {
    let row = |y| {
        let start = 4 * ((corner.y + y) * size.x + corner.x) as usize;
        &rgba[start..start + 4 * CROP as usize]
    };
    (0..CROP).flat_map(row).copied().collect()
}

fn difference(a: &[u8], b: &[u8]) -> Vec<u8> {
    a.iter().zip(b).map(|(a, b)| a.abs_diff(*b).saturating_mul(GAIN)).collect()
}

/// A crop, each of whose pixels is a square.
fn enlarged(crop: &[u8]) -> Vec<u8> {
    let side = CROP * ENLARGED;
    let pixel = |i: u32| {
        let at = UVec2::new(i % side, i / side) / ENLARGED;
        let start = 4 * (at.y * CROP + at.x) as usize;
        &crop[start..start + 4]
    };
    (0..side * side).flat_map(pixel).copied().collect()
}

fn beside<const N: usize>(parts: [&[u8]; N], size: UVec2) -> Vec<u8> {
    let stride = 4 * size.x as usize;
    let row = |y| parts.map(|part| &part[y * stride..(y + 1) * stride]);
    (0..size.y as usize).flat_map(row).flatten().copied().collect()
}

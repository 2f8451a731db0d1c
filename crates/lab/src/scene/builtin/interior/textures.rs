//! Procedural textures. Their coordinates are metres.

use crate::scene::{Coordinates, Texture, Wrap};
use afterimage::kernel::rng::{pcg4d, unit_draw};
use glam::Vec3;

/// Width and height of each texture, texels.
const SIDE: u32 = 256;

/// Textures in the order of their indices.
#[derive(Clone, Copy)]
pub(super) enum Pattern {
    Planks,
    Wallpaper,
    Tiles,
    Rug,
    Picture,
}

/// All textures.
pub(super) fn all() -> Vec<Texture> {
    [Pattern::Planks, Pattern::Wallpaper, Pattern::Tiles, Pattern::Rug, Pattern::Picture].map(texture).into()
}

/// Random number in \[0, 1) of a cell.
pub(super) fn noise([x, y]: [u32; 2], salt: u32) -> f32 {
    unit_draw(pcg4d([x, y, salt, 0])[0])
}

fn texture(pattern: Pattern) -> Texture {
    let color: fn(u32, u32) -> Vec3 = match pattern {
        Pattern::Planks => planks,
        Pattern::Wallpaper => wallpaper,
        Pattern::Tiles => tiles,
        Pattern::Rug => rug,
        Pattern::Picture => picture,
    };
    // Metres that a texture spans.
    let [across, down]: [f32; 2] = match pattern {
        Pattern::Planks => [1.2, 2.4],
        Pattern::Wallpaper => [0.6, 0.6],
        Pattern::Tiles => [0.8, 0.8],
        Pattern::Rug => [0.6, 0.6],
        Pattern::Picture => [0.82, 0.62],
    };
    let texel = |i: u32| {
        let [r, g, b] = color(i % SIDE, i / SIDE).to_array().map(|v| (v.clamp(0.0, 1.0) * 255.0).round() as u8);
        [r, g, b, 255]
    };
    Texture {
        size: [SIDE; 2],
        texels: (0..SIDE * SIDE).map(texel).collect(),
        wrap: [Wrap::Repeat; 2],
        nearest: false,
        coordinates: Coordinates { second: false, rows: [[1.0 / across, 0.0, 0.0], [0.0, 1.0 / down, 0.0]] },
    }
}

/// Ten planks side by side, two in a row, with seams and grain along them.
fn planks(x: u32, y: u32) -> Vec3 {
    let plank = x * 10 / SIDE;
    let within = x * 10 % SIDE;
    let shifted = (y + 90 * plank) % SIDE;
    let tone = 0.75 + 0.25 * noise([plank, shifted / 128], 1);
    let grain = 0.93 + 0.07 * noise([x, shifted / 24], 2);
    let is_seam = within < 10 || shifted.is_multiple_of(128);
    Vec3::new(0.66, 0.5, 0.36) * tone * grain * if is_seam { 0.55 } else { 1.0 }
}

/// Stripes of two widths, with a row of lozenges on the wide ones.
fn wallpaper(x: u32, y: u32) -> Vec3 {
    let (column, row) = (x % 64, y % 64);
    let lozenge = column.abs_diff(20) + row.abs_diff(32) < 12;
    match column {
        _ if lozenge => Vec3::new(0.55, 0.5, 0.62),
        0..=40 => Vec3::new(0.82, 0.78, 0.7),
        48..=52 => Vec3::new(0.5, 0.56, 0.5),
        _ => Vec3::new(0.74, 0.72, 0.62),
    }
}

/// Eight by eight glazed tiles with light joints.
fn tiles(x: u32, y: u32) -> Vec3 {
    let tone = 0.85 + 0.15 * noise([x / 32, y / 32], 3);
    let is_joint = x % 32 < 2 || y % 32 < 2;
    if is_joint { Vec3::splat(0.5) } else { Vec3::new(0.86, 0.9, 0.88) * tone }
}

/// Zigzag bands.
fn rug(x: u32, y: u32) -> Vec3 {
    let band = (y + (x % 64).abs_diff(32)) / 16 % 4;
    let weave = 0.85 + 0.15 * noise([x / 2, y / 2], 4);
    weave
        * [Vec3::new(0.6, 0.2, 0.17), Vec3::new(0.85, 0.76, 0.6), Vec3::new(0.25, 0.27, 0.4), Vec3::new(0.8, 0.5, 0.25)]
            [band as usize]
}

/// Rings around two points.
fn picture(x: u32, y: u32) -> Vec3 {
    let distance = |a: f32, b: f32| ((x as f32 - a).powi(2) + (y as f32 - b).powi(2)).sqrt();
    let ring = (distance(90.0, 110.0) * 0.15).sin() * (distance(180.0, 150.0) * 0.11).sin();
    Vec3::new(0.85, 0.6, 0.2).lerp(Vec3::new(0.1, 0.25, 0.5), 0.5 + 0.5 * ring)
}

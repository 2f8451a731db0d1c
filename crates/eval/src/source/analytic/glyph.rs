//! Printed text: a 5x7 dot-matrix font, and running text set in it.

use super::noise::{pulse, split, surviving};
use glam::Vec2;

/// Columns of a character cell; five are ink.
const ADVANCE: f32 = 6.0;
/// Rows of a line; seven are ink, descenders included.
const LEADING: f32 = 10.0;

/// Opening of "Alice's Adventures in Wonderland" (Lewis Carroll, 1865; public domain).
const ALICE: &[u8] = b"alice was beginning to get very tired of sitting by her sister on the bank, and of having \
nothing to do: once or twice she had peeped into the book her sister was reading, but it had no pictures or conversations \
in it, and what is the use of a book, thought alice without pictures or conversation? ";

/// Dots of a to z, one byte per column from the left, the lowest bit at the top.
const LOWER: [[u8; 5]; 26] = [
    [0x20, 0x54, 0x54, 0x54, 0x78],
    [0x7f, 0x48, 0x44, 0x44, 0x38],
    [0x38, 0x44, 0x44, 0x44, 0x20],
    [0x38, 0x44, 0x44, 0x48, 0x7f],
    [0x38, 0x54, 0x54, 0x54, 0x18],
    [0x08, 0x7e, 0x09, 0x01, 0x02],
    [0x0c, 0x52, 0x52, 0x52, 0x3e],
    [0x7f, 0x08, 0x04, 0x04, 0x78],
    [0x00, 0x44, 0x7d, 0x40, 0x00],
    [0x20, 0x40, 0x44, 0x3d, 0x00],
    [0x7f, 0x10, 0x28, 0x44, 0x00],
    [0x00, 0x41, 0x7f, 0x40, 0x00],
    [0x7c, 0x04, 0x18, 0x04, 0x78],
    [0x7c, 0x08, 0x04, 0x04, 0x78],
    [0x38, 0x44, 0x44, 0x44, 0x38],
    [0x7c, 0x14, 0x14, 0x14, 0x08],
    [0x08, 0x14, 0x14, 0x18, 0x7c],
    [0x7c, 0x08, 0x04, 0x04, 0x08],
    [0x48, 0x54, 0x54, 0x54, 0x20],
    [0x04, 0x3f, 0x44, 0x40, 0x20],
    [0x3c, 0x40, 0x40, 0x20, 0x7c],
    [0x1c, 0x20, 0x40, 0x20, 0x1c],
    [0x3c, 0x40, 0x30, 0x40, 0x3c],
    [0x44, 0x28, 0x10, 0x28, 0x44],
    [0x0c, 0x50, 0x50, 0x50, 0x3c],
    [0x44, 0x64, 0x54, 0x4c, 0x44],
];

/// Dots of the headline's capitals: A F T E R I M A G E.
const HEADLINE: [[u8; 5]; 10] = [
    [0x7e, 0x11, 0x11, 0x11, 0x7e],
    [0x7f, 0x09, 0x09, 0x09, 0x01],
    [0x01, 0x01, 0x7f, 0x01, 0x01],
    [0x7f, 0x49, 0x49, 0x49, 0x41],
    [0x7f, 0x09, 0x19, 0x29, 0x46],
    [0x00, 0x41, 0x7f, 0x41, 0x00],
    [0x7f, 0x02, 0x0c, 0x02, 0x7f],
    [0x7e, 0x11, 0x11, 0x11, 0x7e],
    [0x3e, 0x41, 0x49, 0x49, 0x7a],
    [0x7f, 0x49, 0x49, 0x49, 0x41],
];

fn dots(character: u8) -> [u8; 5] {
    match character {
        b'a'..=b'z' => LOWER[(character - b'a') as usize],
        b',' => [0x00, 0x50, 0x30, 0x00, 0x00],
        b':' => [0x00, 0x36, 0x36, 0x00, 0x00],
        b'?' => [0x02, 0x01, 0x51, 0x09, 0x06],
        _ => [0; 5],
    }
}

/// Ink of one dot: 1 if the dot at (x, y) of a character cell is set, else 0.
fn dot(columns: [u8; 5], x: f32, y: f32) -> f32 {
    if (0.0..5.0).contains(&x) && (0.0..7.0).contains(&y) {
        f32::from(columns[x as usize] >> (y as u32) & 1)
    } else {
        0.0
    }
}

/// Ink in [0, 1] of running text at `p`, in dots, y down. Lines are `columns` characters long and go on without end;
/// the first one starts at character `first` of the text. Where the footprint `w` is wider than a dot, the result fades
/// to the rows' mean grey.
pub(super) fn running_text(p: Vec2, w: Vec2, columns: i32, first: i32) -> f32 {
    let line = split(p.y / LEADING).0;
    let column = split(p.x / ADVANCE).0;
    if column < 0 || column >= columns {
        return 0.0;
    }
    let grey = 0.36 * pulse((p.y - 1.0) / LEADING, 0.6, w.y / LEADING);
    let kept = surviving(0.45 * w.max_element());
    if kept <= 0.0 {
        return grey;
    }
    let index = line.wrapping_mul(columns) + column + first;
    let character = ALICE[index.rem_euclid(ALICE.len() as i32) as usize];
    let ink = dot(dots(character), p.x - column as f32 * ADVANCE, p.y - line as f32 * LEADING);
    grey + (ink - grey) * kept
}

/// Ink of the word AFTERIMAGE at `p`, in dots of its 59 x 7 box.
pub(super) fn headline(p: Vec2) -> f32 {
    let column = split(p.x / ADVANCE).0;
    if !(0..10).contains(&column) {
        return 0.0;
    }
    dot(HEADLINE[column as usize], p.x - column as f32 * ADVANCE, p.y)
}

//! Strips: rows of an image that are prepared and scored together. They run in parallel and fit into caches. Colors are
//! one plane a channel, and arithmetic runs over blocks of a plane, so that it becomes vector instructions.
//!
//! Functions here are inlined into an implementation of [`pulp::WithSimd`], which compiles them for the instructions
//! that a processor may have. All of them compute the same bits: compilers neither contract nor reorder.

use afterimage::Image;
use afterimage::kernel::{color, lab};
use glam::Vec3;
use rayon::prelude::*;
use std::ops::Range;

/// Rows of a strip. FLIP's filters reach a few rows beyond it, which more rows amortize; fewer keep planes in the
/// cache.
pub const STRIP_ROWS: usize = 32;

/// Pixels of a block: results are collected in an array of its own, because compilers give up vector instructions where
/// too many slices might overlap.
pub(crate) const BLOCK: usize = 32;

/// One value a pixel, row after row.
pub type Plane = Vec<f32>;

/// Rows of each strip of an image of `height` rows.
pub fn strips(height: usize) -> impl IndexedParallelIterator<Item = Range<usize>> {
    let rows = move |i| i * STRIP_ROWS..height.min((i + 1) * STRIP_ROWS);
    (0..height.div_ceil(STRIP_ROWS)).into_par_iter().map(rows)
}

/// Ranges of the blocks of `count` pixels.
#[inline(always)]
pub(crate) fn blocks(count: usize) -> impl Iterator<Item = Range<usize>> {
    (0..count.div_ceil(BLOCK)).map(move |i| i * BLOCK..count.min((i + 1) * BLOCK))
}

/// The values of a block. If it is short, the plane's following values fill it, and then zeros.
#[inline(always)]
pub(crate) fn block(plane: &[f32], range: Range<usize>) -> [f32; BLOCK] {
    // The length of a whole block is known, so that copying it takes a few vector instructions.
    if let Some(values) = plane[range.start..].first_chunk() {
        return *values;
    }
    let mut values = [0.0; BLOCK];
    values[..range.len()].copy_from_slice(&plane[range]);
    values
}

/// Stores the values of a block.
#[inline(always)]
pub(crate) fn store(values: &[f32; BLOCK], plane: &mut [f32], range: Range<usize>) {
    match plane[range.clone()].first_chunk_mut() {
        Some(whole) => *whole = *values,
        None => plane[range.clone()].copy_from_slice(&values[..range.len()]),
    }
}

/// Linear colors of rows of an sRGB-encoded image.
#[inline(always)]
pub fn linear(encoded: &Image<[f32; 3]>, rows: Range<usize>) -> [Plane; 3] {
    let width = encoded.width();
    let pixels = &encoded.pixels()[rows.start * width..rows.end * width];
    let mut planes = [0; 3].map(|_| vec![0.0; pixels.len()]);
    for (channel, plane) in planes.iter_mut().enumerate() {
        for (value, pixel) in plane.iter_mut().zip(pixels) {
            *value = color::srgb_decode(pixel[channel]);
        }
    }
    planes
}

/// L\*a\*b\* of linear colors.
#[inline(always)]
pub fn lab(linear: &[Plane; 3], range: Range<usize>) -> [Plane; 3] {
    let mut planes = [0; 3].map(|_| vec![0.0; range.len()]);
    for to in blocks(range.len()) {
        let from = range.start + to.start..range.start + to.end;
        let [r, g, b] = [0, 1, 2].map(|c| block(&linear[c], from.clone()));
        let mut lab = [[0.0; BLOCK]; 3];
        for i in 0..BLOCK {
            [lab[0][i], lab[1][i], lab[2][i]] = lab::lab(Vec3::new(r[i], g[i], b[i])).to_array();
        }
        for (plane, values) in planes.iter_mut().zip(&lab) {
            store(values, plane, to.clone());
        }
    }
    planes
}

/// Delta E 94 of L\*a\*b\* colors.
#[inline(always)]
pub fn delta_e94(reference: &[Plane; 3], output: &[Plane; 3]) -> Plane {
    let mut differences = vec![0.0; reference[0].len()];
    for range in blocks(differences.len()) {
        let [r, s] = [reference, output].map(|lab| [0, 1, 2].map(|c| block(&lab[c], range.clone())));
        let mut values = [0.0; BLOCK];
        for (i, value) in values.iter_mut().enumerate() {
            *value = lab::delta_e94(Vec3::new(r[0][i], r[1][i], r[2][i]), Vec3::new(s[0][i], s[1][i], s[2][i]));
        }
        store(&values, &mut differences, range);
    }
    differences
}

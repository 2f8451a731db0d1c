//! Which convention do a renderer's motion vectors follow? Found by trying all of them on two frames.
//!
//! A mistaken sign or unit does not crash: it shows as ghosts and blur. Reprojecting the frame before under each of the
//! twelve conventions and comparing tells which one is meant, wherever the scene moves enough.

use crate::error::InputError;
use afterimage::{Image, MotionConvention, MotionDirection, MotionUnit, YAxis};

/// Pixels looked at in search of motion. More finds smaller moving things, and takes longer.
const SCANNED: usize = 1 << 18;

/// Moving pixels compared under each convention. More steadies the figures, and takes longer.
const COMPARED: usize = 1 << 14;

/// Conventions this close to the best, in dB, are taken as equal: path-tracing noise moves the figure by about 0.1 dB.
const TIE_DB: f64 = 0.3;

/// What the two frames allow to say.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// One convention is clearly better than all others.
    Decided,
    /// Unit and direction are clear, but nothing moves vertically: either direction of the y axis would do.
    YAxisOpen,
    /// Nothing moves, or several conventions explain the motion equally well.
    Undecidable,
}

/// How well each convention explains a frame from the one before.
#[derive(Clone, Debug)]
pub struct MotionCheck {
    /// What can be said.
    pub verdict: Verdict,
    /// The convention that explains best; among equals the one closest to the internal form.
    pub best: MotionConvention,
    /// All twelve conventions with the PSNR in dB of tone-mapped color over moving pixels (100 at most), best first.
    pub psnr_db: Vec<(MotionConvention, f64)>,
    /// PSNR of the best above that of the first convention that is not equal to it, in dB; 0 if all are equal.
    pub margin_db: f64,
    /// Moving pixels compared.
    pub pixels: usize,
}

/// All conventions: three units, two directions, two y axes. The internal form comes first.
pub fn conventions() -> impl Iterator<Item = MotionConvention> {
    let units = [MotionUnit::Pixels, MotionUnit::Uv, MotionUnit::Ndc];
    let directions = [MotionDirection::PreviousMinusCurrent, MotionDirection::CurrentMinusPrevious];
    units.into_iter().flat_map(move |unit| {
        directions.into_iter().flat_map(move |direction| {
            [YAxis::Down, YAxis::Up].map(|y_axis| MotionConvention { unit, direction, y_axis })
        })
    })
}

/// Finds the convention of `raw` motion vectors of the frame `current`, given the frame before.
///
/// Frames are linear color at full rate. Vectors that are not finite are skipped.
///
/// # Errors
/// If the three images differ in size.
pub fn detect(
    previous: &Image<[f32; 3]>,
    current: &Image<[f32; 3]>,
    raw: &Image<[f32; 2]>,
) -> Result<MotionCheck, InputError> {
    let size = current.size();
    for (name, other) in [("previous frame", previous.size()), ("motion", raw.size())] {
        if other != size {
            return Err(InputError::request(
                name,
                format!("has {}x{} pixels but the frame has {}x{}", other[0], other[1], size[0], size[1]),
                "expected one size for both frames and the motion",
            ));
        }
    }
    let moving = moving_pixels(raw);
    let mut psnr_db: Vec<_> = conventions().map(|c| (c, explained_db(previous, current, raw, &moving, c))).collect();
    // Stable: among exact equals the internal form stays first.
    psnr_db.sort_by(|a, b| b.1.total_cmp(&a.1));
    let top = psnr_db[0].1;
    let tied: Vec<_> = psnr_db.iter().filter(|p| top - p.1 < TIE_DB).collect();
    let best = conventions().find(|c| tied.iter().any(|t| t.0 == *c)).unwrap_or_default();
    let only_y_differs = |c: MotionConvention| (c.unit, c.direction) == (best.unit, best.direction);
    let verdict = match tied.len() {
        _ if moving.is_empty() => Verdict::Undecidable,
        1 => Verdict::Decided,
        2 if tied.iter().all(|t| only_y_differs(t.0)) => Verdict::YAxisOpen,
        _ => Verdict::Undecidable,
    };
    Ok(MotionCheck {
        verdict,
        best,
        margin_db: psnr_db.get(tied.len()).map_or(0.0, |p| top - p.1),
        pixels: moving.len(),
        psnr_db,
    })
}

/// Evenly spread pixels whose vectors are among the longer ones. Pixels at rest look alike under every convention.
fn moving_pixels(raw: &Image<[f32; 2]>) -> Vec<[usize; 2]> {
    let stride = ((raw.width() * raw.height()) as f64 / SCANNED as f64).sqrt().ceil().max(1.0) as usize;
    let mut found: Vec<(f32, [usize; 2])> = Vec::new();
    for y in (0..raw.height()).step_by(stride) {
        for (x, m) in raw.row(y).iter().enumerate().step_by(stride) {
            let length = m[0].hypot(m[1]);
            if length.is_finite() && length > 0.0 {
                found.push((length, [x, y]));
            }
        }
    }
    if found.is_empty() {
        return Vec::new();
    }
    // A quantile, not the longest: a few wild vectors must not hide the rest.
    let at = found.len() * 9 / 10;
    let mut lengths: Vec<f32> = found.iter().map(|f| f.0).collect();
    let threshold = 0.25 * *lengths.select_nth_unstable_by(at, f32::total_cmp).1;
    found.retain(|f| f.0 >= threshold);
    let thin = found.len().div_ceil(COMPARED);
    found.into_iter().step_by(thin).map(|f| f.1).collect()
}

/// PSNR of the previous frame, fetched where the convention points, against the current one.
fn explained_db(
    previous: &Image<[f32; 3]>,
    current: &Image<[f32; 3]>,
    raw: &Image<[f32; 2]>,
    pixels: &[[usize; 2]],
    convention: MotionConvention,
) -> f64 {
    let factor = convention.to_internal(raw.size());
    let error: f64 = pixels
        .iter()
        .map(|&[x, y]| {
            let m = raw.at(x, y);
            let fetched = bilinear(previous, x as f32 + m[0] * factor[0], y as f32 + m[1] * factor[1]);
            let seen = current.at(x, y).map(tone);
            (0..3).map(|i| f64::from(fetched[i] - seen[i]).powi(2)).sum::<f64>()
        })
        .sum();
    let mse = error / (3 * pixels.len()).max(1) as f64;
    -10.0 * mse.max(1e-10).log10()
}

/// Compresses highlights: errors then count about as much as they are seen.
fn tone(x: f32) -> f32 {
    let x = x.max(0.0);
    (x / (1.0 + x)).powf(1.0 / 2.2)
}

/// Tone-mapped color at a place, the border repeated outside: a convention that points far away finds the wrong color.
fn bilinear(image: &Image<[f32; 3]>, x: f32, y: f32) -> [f32; 3] {
    let along = |v: f32, n: usize| {
        let v = v.clamp(0.0, (n - 1) as f32);
        let low = v as usize;
        (low, (low + 1).min(n - 1), v - low as f32)
    };
    let (x0, x1, fx) = along(x, image.width());
    let (y0, y1, fy) = along(y, image.height());
    let tap = |x, y| image.at(x, y).map(tone);
    let (a, b, c, d) = (tap(x0, y0), tap(x1, y0), tap(x0, y1), tap(x1, y1));
    std::array::from_fn(|i| {
        let upper = a[i] + (b[i] - a[i]) * fx;
        let lower = c[i] + (d[i] - c[i]) * fx;
        upper + (lower - upper) * fy
    })
}

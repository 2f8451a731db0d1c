//! Detects the convention of a renderer's motion vectors by trying all of them on two frames.
//!
//! A wrong sign or unit does not crash: it shows as ghosts and blur. The detector reprojects the previous frame under
//! each of the twelve conventions and picks the one that matches the current frame best. The scene must move enough.

use crate::error::InputError;
use afterimage::{Image, MotionConvention, MotionDirection, MotionUnit, YAxis};

/// Pixels scanned for motion. More finds smaller moving objects and takes longer.
const SCANNED: usize = 1 << 18;

/// Moving pixels compared under each convention. More reduces the variance of the PSNR and takes longer.
const COMPARED: usize = 1 << 14;

/// Conventions within this many dB of the best count as tied: path-tracing noise changes the PSNR by about 0.1 dB.
const TIE_DB: f64 = 0.3;

/// Outcome of [`detect`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// One convention is clearly better than all others.
    Decided,
    /// Unit and direction are clear, but nothing moves vertically, so the y axis is undetermined.
    YAxisOpen,
    /// Nothing moves, or several conventions explain the motion equally well.
    Undecidable,
}

/// How well each convention predicts a frame from the previous one.
#[derive(Clone, Debug)]
pub struct MotionCheck {
    /// Whether `best` is certain.
    pub verdict: Verdict,
    /// The convention with the highest PSNR; among tied ones the first of [`conventions`].
    pub best: MotionConvention,
    /// All twelve conventions with the PSNR in dB of tone-mapped color over moving pixels (100 at most), best first.
    pub psnr_db: Vec<(MotionConvention, f64)>,
    /// PSNR of the best minus that of the first convention that is not tied with it, in dB; 0 if all are tied.
    pub margin_db: f64,
    /// Number of moving pixels compared.
    pub pixels: usize,
}

/// All conventions: three units, two directions, two y axes. The library's own comes first.
pub fn conventions() -> impl Iterator<Item = MotionConvention> {
    let units = [MotionUnit::Pixels, MotionUnit::Uv, MotionUnit::Ndc];
    let directions = [MotionDirection::PreviousMinusCurrent, MotionDirection::CurrentMinusPrevious];
    units.into_iter().flat_map(move |unit| {
        directions.into_iter().flat_map(move |direction| {
            [YAxis::Down, YAxis::Up].map(|y_axis| MotionConvention {
                unit,
                direction,
                y_axis,
                ..MotionConvention::default()
            })
        })
    })
}

/// Detects the convention of the `raw` motion vectors of frame `current`, given the previous frame.
///
/// Frames are linear color at full rate. Vectors that are not finite are skipped.
///
/// # Errors
/// [`Request`](InputError::Request) if the three images differ in size.
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
    // A stable sort: among exact ties the library's own convention stays first.
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

/// Evenly spread pixels with the longer motion vectors. Pixels at rest look alike under every convention.
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
    // A quantile, not the maximum: a few outliers must not hide the rest.
    let at = found.len() * 9 / 10;
    let mut lengths: Vec<f32> = found.iter().map(|f| f.0).collect();
    let threshold = 0.25 * *lengths.select_nth_unstable_by(at, f32::total_cmp).1;
    found.retain(|f| f.0 >= threshold);
    let thin = found.len().div_ceil(COMPARED);
    found.into_iter().step_by(thin).map(|f| f.1).collect()
}

/// PSNR in dB of the previous frame, reprojected under `convention`, against the current frame at `pixels`.
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

/// Tone curve that compresses highlights, so that errors weigh about as much as they are visible.
fn tone(x: f32) -> f32 {
    let x = x.max(0.0);
    (x / (1.0 + x)).powf(1.0 / 2.2)
}

/// Bilinearly filtered tone-mapped color, clamped to the edge: a convention that points far outside finds a wrong
/// color.
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

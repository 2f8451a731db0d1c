//! Reconstruction of pixels between samples.

use crate::film::{Film, Moments};
use afterimage::Image;
use afterimage::kernel::resample::catmull_rom;
use afterimage_lab::view::Lattice;
use glam::Vec3;

/// Interpolation between lattice points.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Filter {
    /// Bilinear, from four points.
    Linear,
    /// Catmull-Rom bicubic, from sixteen points.
    Bicubic,
}

impl Filter {
    /// Largest distance in pixels from a pixel to a lattice point that the filter reads there.
    pub fn reach_px(self, lattice: &Lattice) -> f32 {
        // Along an axis, a pixel that is not on a point is at least this far from one: a whole pixel, or half a pixel
        // for blocks of even size, whose centres lie between pixels. A tap a whole step away has zero weight.
        let least = 1.0 - lattice.first_px[0].fract();
        let farther = match self {
            Self::Linear => 0.0,
            Self::Bicubic => lattice.step as f32,
        };
        std::f32::consts::SQRT_2 * (lattice.step as f32 - least + farther)
    }
}

/// Lattice points around a pixel along one axis.
#[derive(Clone, Copy, Debug)]
pub(super) struct Around {
    /// Indices of the two points on either side; 1 and 2 are the nearest.
    points: [u32; 4],
    /// Position between points 1 and 2, in steps.
    part: f32,
    /// Index of the nearest point.
    pub nearest: u32,
}

impl Around {
    pub fn new(lattice: &Lattice, axis: usize, px: u32) -> Self {
        let at = lattice.coordinate([px as f32; 2])[axis];
        let base = at.floor();
        let last = lattice.points[axis] as i32 - 1;
        Self {
            points: [-1, 0, 1, 2].map(|d| (base as i32 + d).clamp(0, last) as u32),
            part: at - base,
            nearest: (at.round().max(0.0) as u32).min(lattice.points[axis].saturating_sub(1)),
        }
    }
}

/// Value of the film at a pixel. Points without samples are skipped; the bicubic filter becomes bilinear if one of its
/// points has no sample.
#[inline]
pub(super) fn value_at(film: &Film, filter: Filter, x: &Around, y: &Around) -> Vec3 {
    let part = [x.part, y.part];
    let tap = |i: usize, j: usize| {
        let moments = film.at([x.points[i], y.points[j]]);
        (moments.count > 0).then_some(moments.mean)
    };
    // A pixel on a point takes that point's value, whether or not its neighbours have samples.
    if part == [0.0; 2]
        && let Some(value) = tap(1, 1)
    {
        return value;
    }
    if filter == Filter::Bicubic {
        let (wx, wy) = (catmull_rom(part[0]), catmull_rom(part[1]));
        let mut sum = Some(Vec3::ZERO);
        for (j, wy) in wy.iter().enumerate() {
            for (i, wx) in wx.iter().enumerate() {
                // On a row or column of points the other taps have zero weight and may have no samples.
                if wx * wy != 0.0 {
                    sum = sum.zip(tap(i, j)).map(|(sum, value)| sum + value * (wx * wy));
                }
            }
        }
        if let Some(sum) = sum {
            // The bicubic filter overshoots at edges; radiance must not be negative.
            return sum.max(Vec3::ZERO);
        }
    }
    let (mut sum, mut weights) = (Vec3::ZERO, 0.0);
    for (dx, dy) in [(0, 0), (1, 0), (0, 1), (1, 1)] {
        let weight = (if dx == 0 { 1.0 - part[0] } else { part[0] }) * (if dy == 0 { 1.0 - part[1] } else { part[1] });
        if let Some(value) = tap(1 + dx, 1 + dy) {
            sum += value * weight;
            weights += weight;
        }
    }
    if weights > 0.0 { sum / weights } else { Vec3::ZERO }
}

/// Fills a frame from scattered samples by pull-push (Gortler et al., "The Lumigraph", 1996, section 3.4): averages 2x2
/// pixels upwards until everything is covered, then fills each level's gaps from the coarser level.
pub(super) fn pull_push(film: &Film) -> Image<[f32; 3]> {
    let mut levels: Vec<Image<(Vec3, f32)>> = vec![film.moments.map(|m| (m.mean, if m.count > 0 { 1.0 } else { 0.0 }))];
    while let Some(last) = levels.last()
        && last.size() != [1, 1]
    {
        let size = last.size().map(|s| s.div_ceil(2));
        levels.push(Image::from_fn_parallel(size, |[x, y]| {
            let (mut sum, mut weight) = (Vec3::ZERO, 0.0);
            for (dx, dy) in [(0, 0), (1, 0), (0, 1), (1, 1)] {
                let (x, y) = ((2 * x + dx) as usize, (2 * y + dy) as usize);
                if x < last.width() && y < last.height() {
                    let (value, w) = last.at(x, y);
                    sum += value * w;
                    weight += w;
                }
            }
            // Coverage saturates at 1, regardless of the number of samples.
            (if weight > 0.0 { sum / weight } else { Vec3::ZERO }, weight.min(1.0))
        }));
    }
    let mut coarse = levels.pop().expect("there is the frame itself").map(|(value, _)| value);
    while let Some(fine) = levels.pop() {
        coarse = Image::from_fn_parallel(fine.size(), |[x, y]| {
            let (value, weight) = fine.at(x as usize, y as usize);
            if weight >= 1.0 { value } else { value * weight + upsampled(&coarse, x, y) * (1.0 - weight) }
        });
    }
    coarse.map(|c| c.to_array())
}

/// Noise of scattered samples; pixels without samples take the mean noise of the samples around them.
pub(super) fn noise_between(film: &Film) -> Image<[f32; 2]> {
    let mut as_means = Film::new(film.moments.size());
    as_means.moments = Image::from_fn_parallel(film.moments.size(), |pixel| {
        let [error, samples] = film.noise_at(pixel);
        Moments { mean: Vec3::new(error, samples, 0.0), squares: Vec3::ZERO, count: u32::from(samples > 0.0) }
    });
    pull_push(&as_means).map(|[error, samples, _]| [error, samples])
}

/// The coarser level interpolated at a pixel of the finer level, from its nearest four pixels.
fn upsampled(coarse: &Image<Vec3>, x: u32, y: u32) -> Vec3 {
    let axis = |v: u32, len: usize| {
        let near = (v / 2) as i32;
        let far = near + if v.is_multiple_of(2) { -1 } else { 1 };
        [near, far].map(|i| i.clamp(0, len as i32 - 1) as usize)
    };
    let ([x0, x1], [y0, y1]) = (axis(x, coarse.width()), axis(y, coarse.height()));
    let top = coarse.at(x0, y0) * 0.75 + coarse.at(x1, y0) * 0.25;
    let bottom = coarse.at(x0, y1) * 0.75 + coarse.at(x1, y1) * 0.25;
    top * 0.75 + bottom * 0.25
}

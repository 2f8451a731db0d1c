//! FLIP: visibility of the difference between two images that are shown in alternation (Andersson et al., "FLIP: A
//! Difference Evaluator for Alternating Images", 2020). This is LDR-FLIP, for sRGB-encoded values in \[0, 1\].
//!
//! A contrast sensitivity filter removes detail that the eye cannot resolve at the given distance. The filtered images
//! are then compared by color, with more weight where edges or points differ.

use crate::jod::pixels_per_degree;
use crate::strip::{BLOCK, Plane, block, blocks, linear, store, strips};
use afterimage::kernel::{approx, lab};
use afterimage::{Image, ViewGeometry};
use glam::{DMat3, DVec3, Mat3, Vec3};
use pulp::{Arch, Simd, WithSimd};
use rayon::prelude::*;
use std::f32::consts::FRAC_1_SQRT_2;
use std::f64::consts::PI;
use std::ops::Range;

/// Exponent of the color difference (q_c, section 4.1.3).
const COLOR_EXPONENT: f32 = 0.7;
/// Knee of the color error curve, as a share of the largest color difference (p_c).
const COLOR_KNEE: f32 = 0.4;
/// Color error at the knee (p_t).
const COLOR_BELOW_KNEE: f32 = 0.95;
/// Width in degrees of the detected edges and points (w, section 4.2).
const FEATURE_DEG: f64 = 0.082;

/// Contrast sensitivity to luminance, red-green and blue-yellow: sums of Gaussians a exp(-b f^2) of the frequency f in
/// cycles per degree, as pairs (a, b) (section 4.1.1).
const LUMINANCE: [(f64, f64); 1] = [(1.0, 0.0047)];
const RED_GREEN: [(f64, f64); 1] = [(1.0, 0.0053)];
const BLUE_YELLOW: [(f64, f64); 2] = [(34.1, 0.04), (13.5, 0.025)];
/// The largest b, which determines the radius of the filters.
const WIDEST: f64 = 0.04;

/// Chromaticities (x, y) of the primaries and of white (BT.709).
const PRIMARIES: [[f64; 2]; 3] = [[0.64, 0.33], [0.30, 0.60], [0.15, 0.06]];
const WHITE: [f64; 2] = [0.3127, 0.3290];

/// Range of pixels per degree: below it the filters are a single pixel; above it they become large without need,
/// because no eye resolves such detail.
const PIXELS_PER_DEGREE: [f32; 2] = [1.0, 1000.0];

/// Filter weights of pixels -r to r.
type Kernel = Vec<f32>;

/// The FLIP metric for a viewing distance.
#[derive(Clone, Debug)]
pub struct Flip {
    pixels_per_degree: f32,
    xyz_from_linear: Mat3,
    linear_from_xyz: Mat3,
    luminance: Vec<Kernel>,
    red_green: Vec<Kernel>,
    blue_yellow: Vec<Kernel>,
    smooth: Kernel,
    edge: Kernel,
    point: Kernel,
    largest_color: f32,
}

/// A strip after FLIP's filters and feature detection.
#[derive(Clone, Debug)]
pub struct Filtered {
    /// Filtered color in L\*a\*b\*, with Hunt's adjustment of chroma to lightness.
    colors: [Plane; 3],
    /// Strength of edges and of points.
    features: [Plane; 2],
}

impl Flip {
    /// The metric at a resolution in pixels per degree, clamped to 1 to 1000. NVIDIA's default is 67.02: 3840 pixels
    /// over 0.7 m, seen from 0.7 m.
    pub fn new(pixels_per_degree: f32) -> Self {
        let [least, most] = PIXELS_PER_DEGREE;
        let pixels_per_degree = pixels_per_degree.max(least).min(most);
        let ppd = f64::from(pixels_per_degree);
        let xyz_from_linear = xyz_from_linear();
        let sigma = 0.5 * FEATURE_DEG * ppd;
        let reach = (3.0 * sigma).ceil() as i32;
        let bell = |x: f64| (-x * x / (2.0 * sigma * sigma)).exp();
        let [green, blue] = [Vec3::Y, Vec3::Z].map(hunt_lab);
        Self {
            pixels_per_degree,
            xyz_from_linear: xyz_from_linear.as_mat3(),
            linear_from_xyz: xyz_from_linear.inverse().as_mat3(),
            luminance: sensitivity(&LUMINANCE, ppd),
            red_green: sensitivity(&RED_GREEN, ppd),
            blue_yellow: sensitivity(&BLUE_YELLOW, ppd),
            smooth: balanced(reach, bell),
            edge: balanced(reach, |x| -x * bell(x)),
            point: balanced(reach, |x| (x * x / (sigma * sigma) - 1.0) * bell(x)),
            largest_color: power(hyab(green, blue), COLOR_EXPONENT),
        }
    }

    /// The metric at the pixels per degree in the middle of `view`.
    pub fn for_view(view: &ViewGeometry) -> Self {
        Self::new(pixels_per_degree(view))
    }

    /// Resolution in pixels per degree.
    pub fn pixels_per_degree(&self) -> f32 {
        self.pixels_per_degree
    }

    /// FLIP error at every pixel, 0 to 1, of two images of sRGB-encoded values in \[0, 1\].
    ///
    /// # Panics
    /// If the sizes differ.
    pub fn map(&self, reference: &Image<[f32; 3]>, output: &Image<[f32; 3]>) -> Image<f32> {
        let size = reference.size();
        assert_eq!(size, output.size());
        let errors = |rows| Arch::new().dispatch(MapStrip { flip: self, images: [reference, output], rows });
        let strips: Vec<Plane> = strips(reference.height()).map(errors).collect();
        Image::from_pixels(size, strips.concat()).expect("strips cover the image")
    }

    /// Rows that the filters read for `rows` of an image of `height` rows.
    pub fn rows_read(&self, rows: Range<usize>, height: usize) -> Range<usize> {
        let kernels = self.luminance.iter().chain(&self.red_green).chain(&self.blue_yellow).chain([&self.smooth]);
        let reach = kernels.map(|kernel| kernel.len() / 2).max().unwrap_or(0);
        rows.start.saturating_sub(reach)..height.min(rows.end + reach)
    }

    /// Filters `rows` of an image and detects its features, given the linear colors of the rows `held`, which are all
    /// that [`Self::rows_read`] names.
    #[inline(always)]
    pub fn filtered(&self, linear: &[Plane; 3], width: usize, held: Range<usize>, rows: Range<usize>) -> Filtered {
        let own = Rows { width, held, rows };
        let opponent = self.opponents(linear);
        let [y, red_green, blue_yellow] = &opponent;
        let filtered = [
            own.convolved(y, &self.luminance),
            own.convolved(red_green, &self.red_green),
            own.convolved(blue_yellow, &self.blue_yellow),
        ];
        let [smooth, edge, point] =
            [own.across(y, &self.smooth), own.across(y, &self.edge), own.across(y, &self.point)];
        let edges = length(&own.down(&edge, &self.smooth), &own.down(&smooth, &self.edge));
        let points = length(&own.down(&point, &self.smooth), &own.down(&smooth, &self.point));
        Filtered { colors: self.hunt_labs(&filtered), features: [edges, points] }
    }

    /// FLIP error at every pixel of a strip, 0 to 1.
    #[inline(always)]
    pub fn difference(&self, reference: &Filtered, output: &Filtered) -> Plane {
        let mut errors = vec![0.0; reference.colors[0].len()];
        for range in blocks(errors.len()) {
            let [a, b] = [reference, output].map(|f| [0, 1, 2].map(|c| block(&f.colors[c], range.clone())));
            let [r, s] = [reference, output].map(|f| [0, 1].map(|c| block(&f.features[c], range.clone())));
            let mut values = [0.0; BLOCK];
            for i in 0..BLOCK {
                let (a, b) = (Vec3::new(a[0][i], a[1][i], a[2][i]), Vec3::new(b[0][i], b[1][i], b[2][i]));
                let color = self.color_difference(a, b);
                let feature = (r[0][i] - s[0][i]).abs().max((r[1][i] - s[1][i]).abs());
                let feature = (feature * FRAC_1_SQRT_2).sqrt();
                values[i] = power(color, 1.0 - feature.min(1.0));
            }
            store(&values, &mut errors, range);
        }
        errors
    }

    /// [`Self::opponent`] of linear colors.
    #[inline(always)]
    fn opponents(&self, linear: &[Plane; 3]) -> [Plane; 3] {
        let mut planes = [0; 3].map(|_| vec![0.0; linear[0].len()]);
        for range in blocks(linear[0].len()) {
            let [r, g, b] = [0, 1, 2].map(|c| block(&linear[c], range.clone()));
            let mut values = [[0.0; BLOCK]; 3];
            for i in 0..BLOCK {
                [values[0][i], values[1][i], values[2][i]] = self.opponent(Vec3::new(r[i], g[i], b[i])).to_array();
            }
            for (plane, values) in planes.iter_mut().zip(&values) {
                store(values, plane, range.clone());
            }
        }
        planes
    }

    /// [`hunt_lab`] of opponent colors.
    #[inline(always)]
    fn hunt_labs(&self, opponent: &[Plane; 3]) -> [Plane; 3] {
        let mut planes = [0; 3].map(|_| vec![0.0; opponent[0].len()]);
        for range in blocks(opponent[0].len()) {
            let [y, red_green, blue_yellow] = [0, 1, 2].map(|c| block(&opponent[c], range.clone()));
            let mut values = [[0.0; BLOCK]; 3];
            for i in 0..BLOCK {
                let lab = hunt_lab(self.linear([y[i], red_green[i], blue_yellow[i]]));
                [values[0][i], values[1][i], values[2][i]] = lab.to_array();
            }
            for (plane, values) in planes.iter_mut().zip(&values) {
                store(values, plane, range.clone());
            }
        }
        planes
    }

    /// Color error, 0 to 1 (section 4.1.3).
    #[inline(always)]
    fn color_difference(&self, a: Vec3, b: Vec3) -> f32 {
        let difference = power(hyab(a, b), COLOR_EXPONENT);
        let knee = COLOR_KNEE * self.largest_color;
        let share = if difference < knee {
            COLOR_BELOW_KNEE / knee * difference
        } else {
            COLOR_BELOW_KNEE + (difference - knee) / (self.largest_color - knee) * (1.0 - COLOR_BELOW_KNEE)
        };
        share.min(1.0)
    }

    /// Opponent color YCxCz (luminance, red-green, blue-yellow) of a linear color, divided by 116, 500 and 200. The
    /// factors cancel, because the filters are linear.
    #[inline(always)]
    fn opponent(&self, linear: Vec3) -> Vec3 {
        let xyz = self.xyz_from_linear * linear;
        Vec3::new(xyz.y, xyz.x - xyz.y, xyz.y - xyz.z)
    }

    /// Inverse of [`Self::opponent`]: linear RGB, clamped to \[0, 1\].
    #[inline(always)]
    fn linear(&self, [y, red_green, blue_yellow]: [f32; 3]) -> Vec3 {
        let xyz = Vec3::new(y + red_green, y, y - blue_yellow);
        (self.linear_from_xyz * xyz).clamp(Vec3::ZERO, Vec3::ONE)
    }
}

/// Matrix from linear RGB to XYZ, relative to white.
fn xyz_from_linear() -> DMat3 {
    let xyz = |[x, y]: [f64; 2]| DVec3::new(x / y, 1.0, (1.0 - x - y) / y);
    let [r, g, b] = PRIMARIES.map(xyz);
    let primaries = DMat3::from_cols(r, g, b);
    let white = xyz(WHITE);
    DMat3::from_diagonal(white.recip()) * primaries * DMat3::from_diagonal(primaries.inverse() * white)
}

/// L\*a\*b\* with chroma scaled by lightness (Hunt effect, section 4.1.2).
#[inline(always)]
fn hunt_lab(linear: Vec3) -> Vec3 {
    let lab = lab::lab(linear);
    let chroma = 0.01 * lab.x;
    Vec3::new(lab.x, chroma * lab.y, chroma * lab.z)
}

/// HyAB distance (section 4.1.3).
#[inline(always)]
fn hyab(a: Vec3, b: Vec3) -> f32 {
    let d = a - b;
    d.x.abs() + (d.y * d.y + d.z * d.z).sqrt()
}

/// `base` of at least 0 to the power of an exponent from 0 to 1; relative error below 3e-6 for a base from 1e-9 to 1e3.
/// The standard library's function takes longer than all of FLIP's filters.
#[inline(always)]
fn power(base: f32, exponent: f32) -> f32 {
    let power = approx::exp_approx(exponent * approx::ln_approx(base));
    let of_zero = if exponent == 0.0 { 1.0 } else { 0.0 };
    if base > 0.0 { power } else { of_zero }
}

/// Lengths of the vectors whose coordinates two planes hold.
#[inline(always)]
fn length(x: &[f32], y: &[f32]) -> Plane {
    let mut lengths = vec![0.0; x.len()];
    for (length, (x, y)) in lengths.iter_mut().zip(x.iter().zip(y)) {
        *length = (x * x + y * y).sqrt();
    }
    lengths
}

/// Spatial filters of a contrast sensitivity function: a separable kernel for each of its Gaussians. Their 2D sum is 1.
fn sensitivity(gaussians: &[(f64, f64)], ppd: f64) -> Vec<Kernel> {
    let reach = (3.0 * (WIDEST / (2.0 * PI * PI)).sqrt() * ppd).ceil() as i32;
    // The inverse Fourier transform (section 4.1.1). As published, the 2D filters have the factor sqrt(pi / b) of the
    // 1D transform.
    let height = |(a, b): (f64, f64)| a * (PI / b).sqrt();
    let along = |b: f64, x: i32| (-PI * PI / b * (f64::from(x) / ppd).powi(2)).exp();
    let side = |b: f64| (-reach..=reach).map(|x| along(b, x)).sum::<f64>();
    let total: f64 = gaussians.iter().map(|&g| height(g) * side(g.1).powi(2)).sum();
    let kernel = |&g: &(f64, f64)| {
        let scale = (height(g) / total).sqrt();
        (-reach..=reach).map(|x| (scale * along(g.1, x)) as f32).collect()
    };
    gaussians.iter().map(kernel).collect()
}

/// Values of `f` at -reach to reach, with positive values scaled to a sum of 1 and negative ones to -1.
fn balanced(reach: i32, f: impl Fn(f64) -> f64) -> Kernel {
    let values: Vec<f64> = (-reach..=reach).map(|x| f(f64::from(x))).collect();
    let sum = |sign: f64| values.iter().map(|v| (v * sign).max(0.0)).sum::<f64>();
    let (positive, negative) = (sum(1.0), sum(-1.0));
    values.iter().map(|&v| if v > 0.0 { v / positive } else { v / negative.max(f64::MIN_POSITIVE) } as f32).collect()
}

/// Rows of an image to filter.
struct Rows {
    width: usize,
    /// Rows that planes hold.
    held: Range<usize>,
    /// Rows to compute.
    rows: Range<usize>,
}

impl Rows {
    /// Sum of the separable convolutions of a plane with each kernel.
    #[inline(always)]
    fn convolved(&self, plane: &[f32], kernels: &[Kernel]) -> Plane {
        let mut sum: Plane = vec![];
        for kernel in kernels {
            let part = self.down(&self.across(plane, kernel), kernel);
            if sum.is_empty() {
                sum = part;
            } else {
                sum.iter_mut().zip(&part).for_each(|(sum, part)| *sum += part);
            }
        }
        sum
    }

    /// Convolution along the rows that are held, clamped to the edge.
    #[inline(always)]
    fn across(&self, plane: &[f32], kernel: &Kernel) -> Plane {
        let (width, reach) = (self.width, kernel.len() / 2);
        let mut out = vec![0.0; plane.len()];
        let mut padded = vec![];
        for (out, row) in out.chunks_exact_mut(width).zip(plane.chunks_exact(width)) {
            padded.clear();
            padded.resize(reach, row[0]);
            padded.extend_from_slice(row);
            padded.resize(width + 2 * reach, row[width - 1]);
            for (k, &weight) in kernel.iter().rev().enumerate() {
                accumulate(out, &padded[k..k + width], weight);
            }
        }
        out
    }

    /// Convolution along columns, clamped to the edge. Rows that are read but not held lie outside the image.
    #[inline(always)]
    fn down(&self, plane: &[f32], kernel: &Kernel) -> Plane {
        let (width, reach) = (self.width, kernel.len() / 2);
        let mut out = vec![0.0; self.rows.len() * width];
        for (out, y) in out.chunks_exact_mut(width).zip(self.rows.clone()) {
            for (k, &weight) in kernel.iter().rev().enumerate() {
                let row = (y + k).saturating_sub(reach).clamp(self.held.start, self.held.end - 1);
                let from = (row - self.held.start) * width;
                accumulate(out, &plane[from..from + width], weight);
            }
        }
        out
    }
}

/// Arguments of a strip of [`Flip::map`].
struct MapStrip<'a> {
    flip: &'a Flip,
    images: [&'a Image<[f32; 3]>; 2],
    rows: Range<usize>,
}

impl WithSimd for MapStrip<'_> {
    type Output = Plane;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> Plane {
        let Self { flip, images: [reference, output], rows } = self;
        let (width, held) = (reference.width(), flip.rows_read(rows.clone(), reference.height()));
        let reference = flip.filtered(&linear(reference, held.clone()), width, held.clone(), rows.clone());
        let output = flip.filtered(&linear(output, held.clone()), width, held, rows);
        flip.difference(&reference, &output)
    }
}

#[inline(always)]
fn accumulate(out: &mut [f32], values: &[f32], weight: f32) {
    for (out, value) in out.iter_mut().zip(values) {
        *out += weight * value;
    }
}

//! FLIP: visibility of the difference between two images that are shown in alternation (Andersson et al., "FLIP: A
//! Difference Evaluator for Alternating Images", 2020). This is LDR-FLIP, for sRGB-encoded values in \[0, 1\].
//!
//! A contrast sensitivity filter removes detail that the eye cannot resolve at the given distance. The filtered images
//! are then compared by color, with more weight where edges or points differ.

use afterimage::kernel::color;
use afterimage::{Image, ViewGeometry};
use glam::{DMat3, DVec3, Mat3, Vec3};
use rayon::prelude::*;
use std::f64::consts::PI;

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

/// Range of pixels per degree: below it the filters are a single pixel; above it they grow large beyond what any eye
/// resolves.
const PIXELS_PER_DEGREE: [f32; 2] = [1.0, 1000.0];

/// Filter weights of pixels -r to r.
type Kernel = Vec<f32>;
/// One value per pixel, in row-major order.
type Plane = Vec<f32>;

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

/// An image after FLIP's filters and feature detection.
#[derive(Clone, Debug)]
pub struct Preprocessed {
    /// Filtered color in L\*a\*b\*, with Hunt's adjustment of chroma to lightness.
    colors: Image<Vec3>,
    /// Strength of edges and of points.
    features: Image<[f32; 2]>,
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
            largest_color: hyab(green, blue).powf(COLOR_EXPONENT),
        }
    }

    /// The metric at the pixels per degree in the middle of `view`.
    pub fn for_view(view: &ViewGeometry) -> Self {
        let ([tangent_per_px, _], _) = view.scale_offset();
        Self::new(1.0 / (2.0 * (0.5 * tangent_per_px).atan().to_degrees()))
    }

    /// Resolution in pixels per degree.
    pub fn pixels_per_degree(&self) -> f32 {
        self.pixels_per_degree
    }

    /// Filters an image of sRGB-encoded values in \[0, 1\] and detects its features.
    pub fn preprocess(&self, encoded: &Image<[f32; 3]>) -> Preprocessed {
        let size = encoded.size();
        let width = encoded.width().max(1);
        let opponent: Vec<Vec3> = encoded.pixels().par_iter().map(|&c| self.opponent(c)).collect();
        let plane = |axis: usize| -> Plane { opponent.par_iter().map(|c| c[axis]).collect() };
        let [y, red_green, blue_yellow] = [0, 1, 2].map(plane);
        let filtered = [
            convolved(&y, width, &self.luminance),
            convolved(&red_green, width, &self.red_green),
            convolved(&blue_yellow, width, &self.blue_yellow),
        ];
        let colors = Image::from_fn_parallel(size, |[x, y]| {
            let i = y as usize * width + x as usize;
            hunt_lab(self.linear([0, 1, 2].map(|axis| filtered[axis][i])))
        });
        let across = |kernel| across(&y, width, kernel);
        let (smooth, edge, point) = (across(&self.smooth), across(&self.edge), across(&self.point));
        let down = |plane: &Plane, kernel| down(plane, width, kernel);
        let edges = [down(&edge, &self.smooth), down(&smooth, &self.edge)];
        let points = [down(&point, &self.smooth), down(&smooth, &self.point)];
        let features = Image::from_fn_parallel(size, |[x, y]| {
            let i = y as usize * width + x as usize;
            [&edges, &points].map(|[across, down]| across[i].hypot(down[i]))
        });
        Preprocessed { colors, features }
    }

    /// FLIP error at every pixel, 0 to 1.
    ///
    /// # Panics
    /// If the sizes differ.
    pub fn difference(&self, reference: &Preprocessed, output: &Preprocessed) -> Image<f32> {
        let size = reference.colors.size();
        assert_eq!(size, output.colors.size());
        Image::from_fn_parallel(size, |[x, y]| {
            let (x, y) = (x as usize, y as usize);
            let color = self.color_difference(reference.colors.at(x, y), output.colors.at(x, y));
            let [r, s] = [reference, output].map(|image| image.features.at(x, y));
            let feature = ((r[0] - s[0]).abs().max((r[1] - s[1]).abs()) * std::f32::consts::FRAC_1_SQRT_2).sqrt();
            color.powf(1.0 - feature.min(1.0))
        })
    }

    /// FLIP error at every pixel, 0 to 1, of two images that are not preprocessed yet.
    ///
    /// # Panics
    /// If the sizes differ.
    pub fn map(&self, reference: &Image<[f32; 3]>, output: &Image<[f32; 3]>) -> Image<f32> {
        self.difference(&self.preprocess(reference), &self.preprocess(output))
    }

    /// Color error, 0 to 1 (section 4.1.3).
    fn color_difference(&self, a: Vec3, b: Vec3) -> f32 {
        let difference = hyab(a, b).powf(COLOR_EXPONENT);
        let knee = COLOR_KNEE * self.largest_color;
        let share = if difference < knee {
            COLOR_BELOW_KNEE / knee * difference
        } else {
            COLOR_BELOW_KNEE + (difference - knee) / (self.largest_color - knee) * (1.0 - COLOR_BELOW_KNEE)
        };
        share.min(1.0)
    }

    /// Opponent color YCxCz (luminance, red-green, blue-yellow) of an sRGB-encoded color, divided by 116, 500 and 200.
    /// The factors cancel, because the filters are linear.
    fn opponent(&self, encoded: [f32; 3]) -> Vec3 {
        let xyz = self.xyz_from_linear * Vec3::from(encoded.map(color::srgb_decode));
        Vec3::new(xyz.y, xyz.x - xyz.y, xyz.y - xyz.z)
    }

    /// Inverse of [`Self::opponent`]: linear RGB, clamped to \[0, 1\].
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
fn hunt_lab(linear: Vec3) -> Vec3 {
    let lab = color::lab(linear);
    let chroma = 0.01 * lab.x;
    Vec3::new(lab.x, chroma * lab.y, chroma * lab.z)
}

/// HyAB distance (section 4.1.3).
fn hyab(a: Vec3, b: Vec3) -> f32 {
    let d = a - b;
    d.x.abs() + d.y.hypot(d.z)
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

/// Sum of the separable convolutions of a plane with each kernel.
fn convolved(plane: &Plane, width: usize, kernels: &[Kernel]) -> Plane {
    let mut sum: Option<Plane> = None;
    for kernel in kernels {
        let part = down(&across(plane, width, kernel), width, kernel);
        match &mut sum {
            None => sum = Some(part),
            Some(sum) => sum.par_iter_mut().zip(&part).for_each(|(sum, part)| *sum += part),
        }
    }
    sum.unwrap_or_default()
}

/// Convolution along rows, clamped to the edge.
fn across(plane: &Plane, width: usize, kernel: &Kernel) -> Plane {
    let reach = kernel.len() / 2;
    let mut out = vec![0.0; plane.len()];
    out.par_chunks_mut(width).zip(plane.par_chunks(width)).for_each_init(Vec::new, |padded, (out, row)| {
        padded.clear();
        padded.resize(reach, row[0]);
        padded.extend_from_slice(row);
        padded.resize(width + 2 * reach, row[width - 1]);
        for (k, &weight) in kernel.iter().rev().enumerate() {
            accumulate(out, &padded[k..k + width], weight);
        }
    });
    out
}

/// Convolution along columns, clamped to the edge.
fn down(plane: &Plane, width: usize, kernel: &Kernel) -> Plane {
    let reach = kernel.len() / 2;
    let last = (plane.len() / width).saturating_sub(1);
    let mut out = vec![0.0; plane.len()];
    out.par_chunks_mut(width).enumerate().for_each(|(y, out)| {
        for (k, &weight) in kernel.iter().rev().enumerate() {
            let from = (y + k).saturating_sub(reach).min(last);
            accumulate(out, &plane[from * width..(from + 1) * width], weight);
        }
    });
    out
}

fn accumulate(out: &mut [f32], values: &[f32], weight: f32) {
    for (out, value) in out.iter_mut().zip(values) {
        *out += weight * value;
    }
}

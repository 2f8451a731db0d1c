//! Gaussian pyramid of planes: halving and doubling of the size with the five-tap kernel of Burt and Adelson 1983.

use pulp::{Arch, Simd, WithSimd};
use rayon::prelude::*;

/// Weights of the kernel at distances 0, 1 and 2 (a = 0.4).
const KERNEL: [f32; 3] = [0.4, 0.25, 0.05];

/// Rows that a task computes.
pub(crate) const ROWS: usize = 16;

/// One value a pixel, row after row.
#[derive(Clone, Debug, Default)]
pub(crate) struct Plane {
    pub width: usize,
    pub height: usize,
    pub values: Vec<f32>,
}

impl Plane {
    pub fn new(width: usize, height: usize) -> Self {
        Self { width, height, values: vec![0.0; width * height] }
    }

    /// A plane of the same size, of zeros.
    pub fn like(&self) -> Self {
        Self::new(self.width, self.height)
    }

    pub fn row(&self, y: usize) -> &[f32] {
        &self.values[y * self.width..(y + 1) * self.width]
    }

    /// The plane at half the size, rounded up.
    pub fn halved(&self) -> Self {
        let mut half = Self::new(self.width.div_ceil(2), self.height.div_ceil(2));
        let width = half.width;
        half.values.par_chunks_mut(ROWS * width).enumerate().for_each(|(i, rows)| {
            Arch::new().dispatch(Halve { from: self, first: i * ROWS, width, rows });
        });
        half
    }
}

/// A Gaussian pyramid: planes of halved sizes, the finest first.
#[derive(Clone, Debug)]
pub(crate) struct Levels(Vec<Plane>);

impl Levels {
    /// `plane` and `count` levels below it.
    pub fn new(plane: Plane, count: usize) -> Self {
        let mut levels = vec![plane];
        for _ in 0..count {
            let half = levels[levels.len() - 1].halved();
            levels.push(half);
        }
        Self(levels)
    }

    pub fn at(&self, level: usize) -> &Plane {
        &self.0[level]
    }

    pub fn into_coarsest(mut self) -> Plane {
        self.0.pop().expect("the finest level always exists")
    }
}

/// Nearest index inside: pixels beyond the border repeat the border.
#[inline(always)]
fn inside(i: isize, len: usize) -> usize {
    i.clamp(0, len as isize - 1) as usize
}

/// Arguments of the loop of [`Plane::halved`].
struct Halve<'a> {
    from: &'a Plane,
    first: usize,
    width: usize,
    rows: &'a mut [f32],
}

impl WithSimd for Halve<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Self { from, first, width, rows } = self;
        let [a, b, c] = KERNEL;
        // Two pixels of border at the left, and up to three at the right.
        let mut padded = vec![0.0; 2 * width + 4];
        for (y, out) in rows.chunks_exact_mut(width).enumerate() {
            let center = 2 * (first + y) as isize;
            let [r0, r1, r2, r3, r4] = [-2, -1, 0, 1, 2].map(|d| from.row(inside(center + d, from.height)));
            let middle = &mut padded[2..2 + from.width];
            for x in 0..from.width {
                middle[x] = a * r2[x] + b * (r1[x] + r3[x]) + c * (r0[x] + r4[x]);
            }
            let [left, right] = [middle[0], middle[from.width - 1]];
            padded[..2].fill(left);
            padded[2 + from.width..].fill(right);
            for (x, out) in out.iter_mut().enumerate() {
                let v: &[f32; 5] = padded[2 * x..].first_chunk().expect("padded");
                *out = a * v[2] + b * (v[1] + v[3]) + c * (v[0] + v[4]);
            }
        }
    }
}

/// Computes rows of a halved plane at full size again.
pub(crate) struct Doubler {
    mixed: Vec<f32>,
}

impl Doubler {
    pub fn new(half_width: usize) -> Self {
        Self { mixed: vec![0.0; half_width + 2] }
    }

    /// Row `y` of the doubled plane; `out` has the full width.
    #[inline(always)]
    pub fn row(&mut self, half: &Plane, y: usize, out: &mut [f32]) {
        let i = (y / 2) as isize;
        let at = |d: isize| half.row(inside(i + d, half.height));
        let [even, odd] = [[2.0 * KERNEL[2], 2.0 * KERNEL[0]], [2.0 * KERNEL[1]; 2]];
        let mixed = &mut self.mixed[1..=half.width];
        if y.is_multiple_of(2) {
            let (above, here, below) = (at(-1), at(0), at(1));
            for x in 0..half.width {
                mixed[x] = even[1] * here[x] + even[0] * (above[x] + below[x]);
            }
        } else {
            let (here, below) = (at(0), at(1));
            for x in 0..half.width {
                mixed[x] = odd[0] * (here[x] + below[x]);
            }
        }
        let [left, right] = [mixed[0], mixed[half.width - 1]];
        self.mixed[0] = left;
        self.mixed[half.width + 1] = right;
        let mixed = &self.mixed;
        for (x, pair) in out.chunks_mut(2).enumerate() {
            let v: &[f32; 3] = mixed[x..].first_chunk().expect("padded");
            pair[0] = even[1] * v[1] + even[0] * (v[0] + v[2]);
            if let [_, second] = pair {
                *second = odd[0] * (v[1] + v[2]);
            }
        }
    }
}

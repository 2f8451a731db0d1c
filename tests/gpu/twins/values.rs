//! Tables of edge-case numbers.

use super::probe::{Row, Rows};
use afterimage_testing::Draws;
use std::f32::consts::FRAC_1_SQRT_2;

/// Random rows of each table.
const RANDOM: usize = 20_000;

/// Zeros, denormals, both ends of the normal range, powers, halves, infinities and NaNs, of both signs.
pub fn any() -> Vec<u32> {
    let denormal = [0, 1, 0x1234, 0x007f_ffff];
    let power = |exponent| 2.0_f32.powi(exponent);
    let least = f32::MIN_POSITIVE;
    // Rounding of halves at both ends of their range, and the knees of sRGB's curves.
    let halves = floats(&[power(-25), power(-14).next_down(), power(-14), 65520.0_f32.next_down(), 65520.0]);
    let knees = [0x3b4d_2e1c, 0x3d25_aee6, 0x3ed4_13cd];
    let small = floats(&[least, least.next_up(), 2.0 * least, 0.25, FRAC_1_SQRT_2, 2.0, 5.0]);
    let large = floats(&[88.0, 88.0_f32.next_up(), 87.0, 180.0, 4096.0, 65536.0, power(24), power(31), 1e30]);
    let huge = floats(&[power(100), power(100).next_up(), power(126), power(127), f32::MAX, f32::INFINITY]);
    let nans = [0x7f80_0001, 0x7fc0_0000, 0x7fff_ffff];
    let near = around(&[1e-30, 0.5, 1.0, 65504.0]);
    let magnitudes = [&denormal[..], &halves, &knees, &small, &large, &huge, &nans, &near].concat();
    magnitudes.iter().flat_map(|&m| [m, m | 0x8000_0000]).collect()
}

pub fn finite() -> Vec<u32> {
    any().into_iter().filter(|&x| f32::from_bits(x).is_finite()).collect()
}

/// Finite, +0 and above.
pub fn positive() -> Vec<u32> {
    finite().into_iter().filter(|&x| x < 0x8000_0000).collect()
}

/// Finite, at least the smallest normal number, or +0.
pub fn normal() -> Vec<u32> {
    positive().into_iter().filter(|&x| x == 0 || x >= 0x0080_0000).collect()
}

/// Draws: 0, the smallest, the largest, and ones between.
pub fn draws() -> Vec<u32> {
    [0.0, 1.0 / 16_777_216.0, 0.25, 0.5, 0.999, 16_777_215.0 / 16_777_216.0].map(f32::to_bits).to_vec()
}

/// One float below, at, and above each.
pub fn around(thresholds: &[f32]) -> Vec<u32> {
    thresholds.iter().flat_map(|t| [t.next_down(), *t, t.next_up()]).map(f32::to_bits).collect()
}

pub fn floats(values: &[f32]) -> Vec<u32> {
    values.iter().map(|x| x.to_bits()).collect()
}

/// Words of integers.
pub fn words() -> Vec<u32> {
    let powers = [1_u32 << 12, 1 << 16, 1 << 31].into_iter().flat_map(|power| [power - 1, power]);
    (0..3).chain(254..257).chain(powers).chain([63, 0x00ff_ffff, 0x0100_0001, !1, !0]).collect()
}

pub fn finite_bits(d: &mut Draws) -> u32 {
    loop {
        let x = d.bits();
        if f32::from_bits(x).is_finite() {
            return x;
        }
    }
}

/// Positive, with an exponent in `low..high` and any mantissa.
pub fn scaled(d: &mut Draws, low: i32, high: i32) -> u32 {
    let exponent = low + (d.uniform() * (high - low) as f32) as i32;
    ((exponent + 127) as u32) << 23 | d.bits() >> 9
}

/// Any sign, with an exponent in `low..high` and any mantissa.
pub fn signed(d: &mut Draws, low: i32, high: i32) -> u32 {
    scaled(d, low, high) | d.bits() & 0x8000_0000
}

pub fn range(d: &mut Draws, low: f32, high: f32) -> u32 {
    d.range(low, high).to_bits()
}

/// A random word: a float from low to high, an integer below, a multiple of 1 / n from 0 to 1, a float as [`scaled`] or
/// [`signed`], any bits; or words that a function pushes.
#[derive(Clone, Copy)]
pub enum Word {
    F(f32, f32),
    N(u32),
    Scaled(i32, i32),
    Signed(i32, i32),
    Bits,
    Of(fn(&mut Draws, &mut Vec<u32>)),
}

impl Rows {
    /// Random rows of such words, from a seed that is the probe's name.
    pub fn each(self, words: &[Word]) -> Self {
        self.random(|d, row| {
            for word in words {
                match *word {
                    Word::F(low, high) => row.push(range(d, low, high)),
                    Word::N(count) => row.push(d.bits() % count),
                    Word::Scaled(low, high) => row.push(scaled(d, low, high)),
                    Word::Signed(low, high) => row.push(signed(d, low, high)),
                    Word::Bits => row.push(d.bits()),
                    Word::Of(push) => push(d, row),
                }
            }
        })
    }

    /// Every combination of one word from each list.
    pub fn cross(mut self, lists: &[&[u32]]) -> Self {
        assert_eq!(lists.len(), self.width);
        let total: usize = lists.iter().map(|l| l.len()).product();
        assert!(total <= 1_000_000, "{total} rows");
        for i in 0..total {
            let mut rest = i;
            for list in lists {
                self.words.push(list[rest % list.len()]);
                rest /= list.len();
            }
        }
        self
    }

    /// Random combinations of one word from each list.
    pub fn mixed(self, lists: &[&[u32]]) -> Self {
        assert_eq!(lists.len(), self.width);
        self.random_of("mixed", |d, row| row.extend(lists.iter().map(|l| l[d.bits() as usize % l.len()])))
    }

    /// Random rows, from a seed that is the probe's name.
    pub fn random(self, row: impl FnMut(&mut Draws, &mut Vec<u32>)) -> Self {
        let seed = self.name.to_owned();
        self.seeded(&seed, row)
    }

    /// Random rows of another kind, from a seed with its name.
    pub fn random_of(self, kind: &str, row: impl FnMut(&mut Draws, &mut Vec<u32>)) -> Self {
        let seed = format!("{}, {kind}", self.name);
        self.seeded(&seed, row)
    }

    fn seeded(mut self, seed: &str, mut row: impl FnMut(&mut Draws, &mut Vec<u32>)) -> Self {
        let mut draws = Draws::new(&format!("twins: {seed}"));
        for _ in 0..RANDOM {
            let mut words = Vec::with_capacity(self.width);
            row(&mut draws, &mut words);
            assert_eq!(words.len(), self.width, "{}", self.name);
            self.words.append(&mut words);
        }
        self
    }

    /// Only the rows inside the function's domain.
    pub fn within(mut self, domain: impl Fn(&Row<'_>) -> bool) -> Self {
        self.words = self.words.chunks(self.width).filter(|r| domain(&Row::of(r))).flatten().copied().collect();
        self
    }
}

//! Tables of edge-case numbers.

use super::probe::{Row, Rows};
use afterimage_testing::Draws;

/// Random rows of each table.
const RANDOM: usize = 100_000;

/// Zeros, denormals, both ends of the normal range, powers, halves, infinities and NaNs, of both signs.
pub fn any() -> Vec<u32> {
    let magnitudes = [
        0,
        1,
        0x0000_1234,
        0x007f_ffff,
        0x0080_0000,
        0x0080_0001,
        0x0100_0000, // around the denormals
        0x0da2_425f,
        0x0da2_4260,
        0x0da2_4261, // 1e-30
        0x3300_0000,
        0x3880_0000,
        0x387f_ffff,
        0x3b4d_2e1c,
        0x3d25_aee6, // half's steps, sRGB's
        0x3e80_0000,
        0x3ed4_13cd,
        0x3eff_ffff,
        0x3f00_0000,
        0x3f00_0001,
        0x3f35_04f3,
        0x3f7f_ffff,
        0x3f80_0000,
        0x3f80_0001,
        0x4000_0000,
        0x40a0_0000,
        0x42b0_0000,
        0x42b0_0001,
        0x42ae_0000,
        0x4334_0000,
        0x4580_0000,
        0x477f_dfff,
        0x477f_e000,
        0x477f_e001,
        0x477f_efff,
        0x477f_f000,
        0x4780_0000,
        0x4b80_0000,
        0x4f00_0000, // 65504 ...
        0x7149_f2ca,
        0x7180_0000,
        0x7180_0001,
        0x7e80_0000,
        0x7f00_0000,
        0x7f7f_ffff, // 1e30, 2^100 ... the largest
        0x7f80_0000,
        0x7f80_0001,
        0x7fc0_0000,
        0x7fff_ffff, // infinity, NaNs
    ];
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
    vec![
        0,
        1,
        2,
        63,
        254,
        255,
        256,
        4095,
        4096,
        65535,
        65536,
        0x00ff_ffff,
        0x0100_0001,
        0x7fff_ffff,
        0x8000_0000,
        !1,
        !0,
    ]
}

/// Any bits at all.
pub fn bits(d: &mut Draws) -> u32 {
    d.bits()
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

impl Rows {
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

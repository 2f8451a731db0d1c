//! Helpers shared by tests: statistical tests with printed p-values, independent seeds, GPU access, the register of
//! hard cases.

extern crate wgpu_30 as wgpu;

pub mod agree;
mod alone;
pub mod gpu;
pub mod hard_case;
pub mod panics;
pub mod planted;
pub mod program;
pub mod resident;

pub use alone::alone;
pub use naga;

use proptest::test_runner::{Config as ProptestConfig, RngSeed};
use statrs::distribution::{ChiSquared, ContinuousCDF, Normal};

/// Significance of one statistical test. With about a hundred of them in the suite, one run in 10,000 fails by chance.
pub const ALPHA: f64 = 1e-6;

/// Two-sided p-value of a standard normal deviate.
pub fn p_of_z(z: f64) -> f64 {
    2.0 * Normal::standard().sf(z.abs())
}

/// p-value of Pearson's chi-squared of counts against expected counts.
pub fn p_of_counts(counts: &[u64], expected: &[f64]) -> f64 {
    assert_eq!(counts.len(), expected.len());
    let chi2: f64 = counts
        .iter()
        .zip(expected)
        .map(|(&n, &e)| {
            assert!(e >= 5.0, "expected count {e} is too small for the test");
            (n as f64 - e).powi(2) / e
        })
        .sum();
    ChiSquared::new((counts.len() - 1) as f64).unwrap().sf(chi2)
}

/// p-value of `hits` in `trials` against probability `p` (normal approximation of the binomial).
pub fn p_of_rate(hits: u64, trials: u64, p: f64) -> f64 {
    let n = trials as f64;
    p_of_z((hits as f64 - n * p) / (n * p * (1.0 - p)).sqrt())
}

/// Prints the p-value and fails below [`ALPHA`].
#[track_caller]
pub fn accept(what: &str, p: f64) {
    println!("{what}: p = {p:.3e}");
    assert!(p > ALPHA, "{what}: p = {p:.3e} is below {ALPHA:.0e}");
}

/// The negative control: prints the p-value and fails unless it is below [`ALPHA`].
#[track_caller]
pub fn reject(what: &str, p: f64) {
    println!("{what} (planted error): p = {p:.3e}");
    assert!(p < ALPHA, "{what}: planted error not caught, p = {p:.3e}");
}

/// Random numbers for tests, from another family of generators than the one under test. The name determines the seed.
pub struct Draws(rand_stream::SplitMix64);

/// FNV-1a hash of a name, so that seeds are not chosen by hand.
pub fn seed(name: &str) -> u64 {
    name.bytes().fold(0xcbf2_9ce4_8422_2325_u64, |h, b| (h ^ u64::from(b)).wrapping_mul(0x0100_0000_01b3))
}

/// Configuration of a property test with a fixed seed: the same cases on every machine.
pub fn property(name: &str, cases: u32) -> ProptestConfig {
    ProptestConfig {
        cases,
        rng_seed: RngSeed::Fixed(seed(name)),
        failure_persistence: None,
        ..ProptestConfig::default()
    }
}

impl Draws {
    pub fn new(name: &str) -> Self {
        Self(rand_stream::SplitMix64(seed(name)))
    }

    /// Uniform in [0, 1), a multiple of 2^-24, exact in f32.
    pub fn uniform(&mut self) -> f32 {
        (self.0.next() >> 40) as f32 / 16_777_216.0
    }

    /// Uniform in [low, high).
    pub fn range(&mut self, low: f32, high: f32) -> f32 {
        low + (high - low) * self.uniform()
    }

    pub fn bits(&mut self) -> u32 {
        (self.0.next() >> 32) as u32
    }
}

mod rand_stream {
    /// Steele, Lea and Flood, "Fast Splittable Pseudorandom Number Generators", 2014.
    pub struct SplitMix64(pub u64);

    impl SplitMix64 {
        pub fn next(&mut self) -> u64 {
            self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
            let mut z = self.0;
            z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
            z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
            z ^ (z >> 31)
        }
    }
}

/// Root folder of the workspace, which holds `fixtures` and is the working directory for the tool.
pub fn workspace() -> std::path::PathBuf {
    let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    root.canonicalize().expect("the workspace is two folders up")
}

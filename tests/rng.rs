//! Random numbers: hard cases H23-H29.

mod common;

use afterimage::kernel::rng::{self, Purpose};
use common::{accept, p_of_counts, p_of_z, reject};

const KEY_SEED: u64 = 0x5eed;

fn draw(x: u32, y: u32, view: u32, frame: u64, purpose: Purpose) -> f32 {
    let key = rng::stream_key(KEY_SEED, view, purpose, frame);
    rng::unit_draw(rng::bits(x, y, frame as u32, key))
}

/// p-value of the correlation of pairs of uniform numbers, by the normal approximation.
fn p_of_correlation(pairs: impl Iterator<Item = (f32, f32)>) -> f64 {
    let (mut sum, mut n) = (0.0_f64, 0_u64);
    for (a, b) in pairs {
        sum += (f64::from(a) - 0.5) * (f64::from(b) - 0.5) * 12.0;
        n += 1;
    }
    p_of_z(sum / (n as f64).sqrt())
}

#[test]
fn h23_draws_stay_below_1() {
    assert_eq!(rng::unit_draw(0), 0.0);
    assert!(rng::unit_draw(u32::MAX) < 1.0);
    assert_eq!(f64::from(rng::unit_draw(u32::MAX)), 1.0 - 1.0 / 16_777_216.0);
    // The planted error: straight scaling rounds the top 128 values up.
    assert_eq!(u32::MAX as f32 * (1.0 / 4_294_967_296.0), 1.0);
}

#[test]
fn h25_mean_variance_and_frequencies() {
    let n = 1_u64 << 24;
    let (mut sum, mut square) = (0.0_f64, 0.0_f64);
    let mut counts = vec![0_u64; 4096];
    for frame in 0..4 {
        for y in 0..2048 {
            for x in 0..2048 {
                let u = draw(x, y, 0, frame, Purpose::Select);
                sum += f64::from(u);
                square += (f64::from(u) - 0.5).powi(2);
                counts[(u * 4096.0) as usize] += 1;
            }
        }
    }
    let n = n as f64;
    accept("mean", p_of_z((sum / n - 0.5) * (12.0 * n).sqrt()));
    accept("variance", p_of_z((square / n - 1.0 / 12.0) * (180.0 * n).sqrt()));
    accept("4096 cells", p_of_counts(&counts, &vec![n / 4096.0; 4096]));
    counts[9] += 1500;
    reject("1500 draws too many in one cell", p_of_counts(&counts, &vec![n / 4096.0; 4096]));
}

#[test]
fn h24_h25_neighbours_and_shifted_frames_are_independent() {
    let size = 1024_u32;
    let pixels = move || (0..size).flat_map(move |y| (0..size).map(move |x| (x, y)));
    let at = |x: u32, y: u32, t: u64| draw(x, y, 0, t, Purpose::Select);
    for (name, dx, dy, dt) in [
        ("x", 1, 0, 0),
        ("y", 0, 1, 0),
        ("t", 0, 0, 1),
        ("diagonal", 1, 1, 0),
        ("anti-diagonal", 1, 2, 0),
        ("x and t", 1, 0, 1),
        ("all", 1, 1, 1),
    ] {
        let p = p_of_correlation(pixels().map(|(x, y)| (at(x, y, 5), at(x + dx, y + dy, 5 + dt))));
        accept(&format!("lag 1 in {name}"), p);
    }
    // Every shift of a frame against the next one, over a smaller picture: 31 x 31 shifts.
    let side = 128_u32;
    for sy in 0..31 {
        for sx in 0..31 {
            let p = p_of_correlation(
                (0..side)
                    .flat_map(|y| (0..side).map(move |x| (x, y)))
                    .map(|(x, y)| (at(x + 16, y + 16, 9), at(x + sx + 1, y + sy + 1, 10))),
            );
            assert!(p > common::ALPHA / 961.0, "frame t + 1 is frame t shifted by ({sx}, {sy}): p = {p:.1e}");
        }
    }
    // The planted error of H24: pixel + frame as seed.
    let bad = |x: u32, y: u32, t: u32| rng::unit_draw(rng::bits(x + y * 4096 + t, 0, 0, 0));
    reject(
        "seed = pixel + frame, shift by one",
        p_of_correlation(pixels().map(|(x, y)| (bad(x + 1, y, 9), bad(x, y, 10)))),
    );
}

#[test]
fn h26_h27_streams_of_views_purposes_seeds_and_epochs_differ() {
    let pixels = || (0..512).flat_map(|y| (0..512).map(move |x| (x, y)));
    let wrap = u64::from(u32::MAX);
    type Pair<'a> = &'a dyn Fn(u32, u32) -> (f32, f32);
    let cases: [(&str, Pair<'_>); 4] = [
        ("views", &(|x, y| (draw(x, y, 0, 3, Purpose::Select), draw(x, y, 1, 3, Purpose::Select)))),
        ("purposes", &(|x, y| (draw(x, y, 0, 3, Purpose::Select), draw(x, y, 0, 3, Purpose::Key)))),
        (
            "2^32 frames apart",
            &(move |x, y| (draw(x, y, 0, 3, Purpose::Select), draw(x, y, 0, wrap + 4, Purpose::Select))),
        ),
        (
            "frames around the wrap",
            &(move |x, y| (draw(x, y, 0, wrap, Purpose::Select), draw(x, y, 0, wrap + 1, Purpose::Select))),
        ),
    ];
    for (name, pair) in cases {
        accept(name, p_of_correlation(pixels().map(|(x, y)| pair(x, y))));
    }
    let seeds = pixels().map(|(x, y)| {
        let at = |seed| rng::unit_draw(rng::bits(x, y, 0, rng::stream_key(seed, 0, Purpose::Select, 0)));
        (at(1), at(2))
    });
    accept("neighbouring seeds", p_of_correlation(seeds));
    reject(
        "a stream with itself",
        p_of_correlation(pixels().map(|(x, y)| (draw(x, y, 0, 3, Purpose::Select), draw(x, y, 0, 3, Purpose::Select)))),
    );
}

#[test]
fn h26_no_period_at_the_row_length() {
    for width in [1_u32, 3, 4095, 4097] {
        let rows = (400_000 / width).clamp(64, 65_536);
        let p = p_of_correlation(
            (0..rows)
                .flat_map(|y| (0..width).map(move |x| (x, y)))
                .map(|(x, y)| (draw(x, y, 0, 0, Purpose::Select), draw(x, y + 1, 0, 0, Purpose::Select))),
        );
        accept(&format!("width {width}"), p);
    }
}

#[test]
fn h28_the_integer_stream_is_pinned() {
    // The published PCG-4D; the twin in WGSL must give the same words.
    assert_eq!(rng::pcg4d([0, 0, 0, 0]), reference([0, 0, 0, 0]));
    let mut fold = 0_u32;
    for i in 0..1_000_000_u32 {
        let (x, y, f) = (i % 1000, i / 1000 % 100, i / 100_000);
        let got = rng::bits(x, y, f, 7);
        assert_eq!(got, reference([x, y, f, 7])[0]);
        fold = fold.rotate_left(1) ^ got;
    }
    println!("fold of 1e6 words: {fold:#010x}");
}

/// PCG-4D written from the paper's listing, in 64-bit arithmetic.
fn reference(v: [u32; 4]) -> [u32; 4] {
    let m = |x: u64| x & 0xffff_ffff;
    let [mut x, mut y, mut z, mut w] = v.map(|a| m(u64::from(a) * 1_664_525 + 1_013_904_223));
    x = m(x + y * w);
    y = m(y + z * x);
    z = m(z + x * y);
    w = m(w + y * z);
    [x, y, z, w] = [x, y, z, w].map(|a| a ^ (a >> 16));
    x = m(x + y * w);
    y = m(y + z * x);
    z = m(z + x * y);
    w = m(w + y * z);
    [x, y, z, w].map(|a| a as u32)
}

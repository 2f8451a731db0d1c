//! Random numbers: hard cases H24-H28.

use afterimage::kernel::rng;
use afterimage::kernel::rng::Purpose;
use afterimage_testing::holds;
use afterimage_testing::{accept, p_of_counts, p_of_z, reject};

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

/// p-value of pairs of uniform numbers falling into 16 x 16 cells: detects any dependence at that scale, not only a
/// linear one.
fn p_of_cells(pairs: impl Iterator<Item = (f32, f32)>) -> f64 {
    let mut counts = vec![0_u64; 256];
    for (a, b) in pairs {
        counts[(a * 16.0) as usize * 16 + (b * 16.0) as usize] += 1;
    }
    let n: u64 = counts.iter().sum();
    p_of_counts(&counts, &[n as f64 / 256.0; 256])
}

/// Asserts that pairs are independent, by both tests.
fn independent<I: Iterator<Item = (f32, f32)>>(name: &str, pairs: impl Fn() -> I) -> f64 {
    let p = [p_of_correlation(pairs()), p_of_cells(pairs())];
    accept(&format!("{name}, correlation"), p[0]);
    accept(&format!("{name}, 16 x 16 cells"), p[1]);
    p[0].min(p[1])
}

#[test]
fn h25_draws_are_uniform_and_neighbours_independent() {
    // 2^24 draws of two frames and two purposes.
    let n = f64::from(1 << 24);
    let (mut sum, mut square) = (0.0_f64, 0.0_f64);
    let mut counts = vec![0_u64; 4096];
    for (frame, purpose) in [(0, Purpose::Select), (1, Purpose::Select), (0, Purpose::Key), (1, Purpose::Key)] {
        for y in 0..2048 {
            for x in 0..2048 {
                let u = draw(x, y, 0, frame, purpose);
                sum += f64::from(u);
                square += (f64::from(u) - 0.5).powi(2);
                counts[(u * 4096.0) as usize] += 1;
            }
        }
    }
    let mean = p_of_z((sum / n - 0.5) * (12.0 * n).sqrt());
    let variance = p_of_z((square / n - 1.0 / 12.0) * (180.0 * n).sqrt());
    let cells = p_of_counts(&counts, &vec![n / 4096.0; 4096]);
    accept("mean", mean);
    accept("variance", variance);
    accept("4096 cells", cells);
    reject("mean off by 0.001", p_of_z((sum / n - 0.501) * (12.0 * n).sqrt()));
    counts[9] += 1500;
    reject("1500 draws too many in one cell", p_of_counts(&counts, &vec![n / 4096.0; 4096]));

    // Two frames of 2^24 draws and a border.
    let side = 4096_usize;
    let wide = side + 2;
    let frame = |t| -> Vec<f32> {
        let key = rng::stream_key(KEY_SEED, 0, Purpose::Select, t);
        let at = |i: usize| rng::unit_draw(rng::bits((i % wide) as u32, (i / wide) as u32, t as u32, key));
        (0..wide * wide).map(at).collect()
    };
    let frames = [frame(5), frame(6)];
    let mut least = mean.min(variance).min(cells);
    for (name, dx, dy, dt) in [
        ("x", 1, 0, 0),
        ("y", 0, 1, 0),
        ("t", 0, 0, 1),
        ("diagonal", 1, 1, 0),
        ("steep diagonal", 1, 2, 0),
        ("x and t", 1, 0, 1),
        ("all", 1, 1, 1),
    ] {
        let pairs = || {
            let starts = (0..side).flat_map(|y| (0..side).map(move |x| y * wide + x));
            starts.map(|i| (frames[0][i], frames[dt][i + dy * wide + dx]))
        };
        least = least.min(independent(&format!("lag 1 in {name}"), pairs));
    }
    // The planted error: one draw in a thousand repeats its neighbour's.
    let repeats = (0..side * side).map(|i| (frames[0][i], frames[0][if i % 1000 < 2 { i } else { i + 1 }]));
    reject("two of a thousand repeat", p_of_correlation(repeats));
    holds!("H25", Cpu, "p >= {least:.3} of 17 tests: mean, variance, 4096 cells, lag 1 in x, y, t and diagonals");
}

#[test]
fn h24_no_frame_is_the_last_one_shifted() {
    let at = |x: u32, y: u32, t: u64| draw(x, y, 0, t, Purpose::Select);
    // Every shift of a frame against the next one, over a smaller image: 31 x 31 shifts.
    let side = 128_u32;
    let (n, mut worst) = (f64::from(side * side), 0.0_f64);
    for sy in 0..31 {
        for sx in 0..31 {
            let pixels = (0..side).flat_map(|y| (0..side).map(move |x| (x, y)));
            let sum: f64 = pixels
                .map(|(x, y)| (at(x + 16, y + 16, 9), at(x + sx + 1, y + sy + 1, 10)))
                .map(|(a, b)| (f64::from(a) - 0.5) * (f64::from(b) - 0.5) * 12.0)
                .sum();
            let rho = sum / n;
            worst = worst.max(rho.abs() * n.sqrt());
            assert!(rho.abs() < 4.0 / n.sqrt(), "frame t + 1 is frame t shifted by ({sx}, {sy}): rho = {rho}");
        }
    }
    // The planted error: pixel + frame as seed.
    let bad = |x: u32, y: u32, t: u32| rng::unit_draw(rng::bits(x + y * 4096 + t, 0, 0, 0));
    let pixels = || (0..256).flat_map(|y| (0..256).map(move |x| (x, y)));
    let shifted = || pixels().map(|(x, y)| (bad(x + 1, y, 9), bad(x, y, 10)));
    reject("seed = pixel + frame, shift by one", p_of_correlation(shifted()));
    reject("seed = pixel + frame, cells", p_of_cells(shifted()));
    holds!("H24", Cpu, "largest rho {worst:.2} / sqrt N over 961 shifts; 1 for seed = pixel + frame");
}

#[test]
fn h27_streams_of_views_purposes_and_seeds_are_independent() {
    let pixels = || (0..1024).flat_map(|y| (0..1024).map(move |x| (x, y)));
    let pairs = |a: (u32, Purpose), b: (u32, Purpose)| {
        move || pixels().map(move |(x, y)| (draw(x, y, a.0, 3, a.1), draw(x, y, b.0, 3, b.1)))
    };
    let eyes = independent("views", pairs((0, Purpose::Select), (1, Purpose::Select)));
    independent("purposes", pairs((0, Purpose::Select), (0, Purpose::Key)));
    independent("paths", pairs((0, Purpose::Select), (0, Purpose::Path)));
    independent("view and purpose", pairs((1, Purpose::Select), (0, Purpose::Key)));
    independent("neighbouring seeds", || {
        pixels().map(|(x, y)| {
            let at = |seed| rng::unit_draw(rng::bits(x, y, 0, rng::stream_key(seed, 0, Purpose::Select, 0)));
            (at(1), at(2))
        })
    });
    let same = pairs((0, Purpose::Select), (0, Purpose::Select));
    reject("a stream with itself", p_of_correlation(same()));
    reject("a stream with itself, cells", p_of_cells(same()));
    holds!("H27", Cpu, "p >= {eyes:.2} between two eyes' streams of 2^20 draws");
}

#[test]
fn h26_no_period_at_the_row_length_nor_at_the_wrap_of_the_frame_counter() {
    let mut least = 1.0_f64;
    for width in [1_u32, 3, 4095, 4097] {
        let rows = (400_000 / width).clamp(64, 65_536);
        least = least.min(independent(&format!("width {width}"), || {
            (0..rows)
                .flat_map(|y| (0..width).map(move |x| (x, y)))
                .map(|(x, y)| (draw(x, y, 0, 0, Purpose::Select), draw(x, y + 1, 0, 0, Purpose::Select)))
        }));
    }
    // Frames whose low words are equal, and neighbours across the wrap; also at the corner of the largest picture.
    let wrap = u64::from(u32::MAX);
    for (name, one, other, corner) in [
        ("2^32 frames apart", 3, wrap + 4, 0),
        ("around the wrap", wrap, wrap + 1, 0),
        ("far out", wrap, wrap + 1, 65_000),
    ] {
        least = least.min(independent(name, || {
            (0..512).flat_map(|y| (0..512).map(move |x| (x, y))).map(move |(x, y)| {
                let at = |frame| draw(x + corner, y + corner, 0, frame, Purpose::Select);
                (at(one), at(other))
            })
        }));
    }
    // Planted error: a generator with a 32-bit frame counter repeats itself.
    let key = rng::stream_key(KEY_SEED, 0, Purpose::Select, 3);
    let short = |frame: u64| move |x, y| rng::unit_draw(rng::bits(x, y, frame as u32, key));
    let pairs = (0..256).flat_map(|y| (0..256).map(move |x| (short(3)(x, y), short(wrap + 4)(x, y))));
    reject("a 32-bit frame counter", p_of_correlation(pairs));
    holds!("H26", Cpu, "p >= {least:.2} of 14 tests: widths 1, 3, 4095, 4097, frames around 2^32");
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
    holds!("H28", Cpu, "1e6 words as the paper's listing in 64 bits; their fold is {fold:#010x}");
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

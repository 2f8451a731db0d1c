//! Weight sums over long streams: the values where they stop growing, and their closed forms until then.

use super::*;
use afterimage_testing::holds;

fn half(x: f32) -> f32 {
    pack::half_value(pack::half_bits(x))
}

/// Bernoulli survival with every operation in half floats, as eq. 5 prints it.
fn recur_half(a: f32, w: f32) -> f32 {
    half(half(a * half(1.0 - half(w / half(a + w)))) + w)
}

/// A weight sum as it is stored.
fn keep(w_sum: f32) -> f32 {
    stored_reservoir::unpack(stored_reservoir::pack(stored(w_sum, 0))).w_sum
}

/// Fixed point of `next`, starting with `a` in the first frame, and the frame that reaches it.
fn stall(mut a: f32, next: impl Fn(f32) -> f32) -> (f32, u32) {
    let mut frames = 2;
    while next(a) != a {
        a = next(a);
        frames += 1;
        assert!(frames < 10_000_000);
    }
    (a, frames)
}

#[test]
fn h05_weight_sums_saturate() {
    assert_eq!(half(65504.0 + 1.0), 65504.0, "a half stays where it is");
    assert!(half(f32::MAX).is_finite());
    // Stored weight sums have a larger range: nothing happens at 65504, and they saturate at their own limit.
    assert_eq!(keep(65504.0 + 1.0), 65505.0);
    assert_eq!(keep(stored_reservoir::MAX_W_SUM + 1.0), stored_reservoir::MAX_W_SUM);
    assert_eq!([f32::MAX, f32::INFINITY].map(keep), [stored_reservoir::MAX_W_SUM; 2]);
    let (top, _) = stall(65504.0, |a| keep(a + 1.0));
    assert_eq!(top, 65536.0);
    // The floor: a candidate of weight 1 is still taken by the draws below it.
    let unbiased = WrsParams { bias: BiasCode::None, ..PAPER };
    assert!(step(&unbiased, top, 1.0, 0.999 / 65537.0).take && !step(&unbiased, top, 1.0, 1.001 / 65537.0).take);
    holds!("H05", Cpu, "a half stays at 65504; stored sums go on to {top}, replacement 1/65537, at most 2^100");
}

#[test]
fn h06_a_plain_sum_of_ones_goes_on_where_a_half_stalls() {
    let (in_half, frames) = stall(1.0, |a| half(a + 1.0));
    assert_eq!(in_half, 2048.0);
    let (here, _) = stall(1.0, |a| keep(a + 1.0));
    assert_eq!(here, 65536.0);
    holds!("H06", Cpu, "a half stalls at {in_half} in frame {frames}, a stored sum at {here}");
}

#[test]
fn h07_stored_sums_keep_the_stated_floor_of_replacement() {
    let (in_half, frames) = stall(1.0, |a| recur_half(a, 1.0));
    assert!((in_half - 32.8).abs() < 0.05 && frames == 574, "{in_half} in frame {frames}");
    assert!(stall(1.0, |a| half(recur(a, 1.0, 1.0))).0 < 64.0, "stored as half, computed in f32");
    let mut draws = Draws::new("floor");
    let (mut least, mut most) = (f32::MAX, 0.0_f32);
    for i in 0..20 {
        let w = if i == 0 { 1.0 } else { 10.0_f32.powf(draws.range(-3.0, 0.0)) };
        let (a, _) = stall(w, |a| keep(recur(a, w, 1.0)));
        (least, most) = (least.min(a / w), most.max(a / w));
        let p = w / (a * reservoir::bernoulli_survival(a, w) + w);
        assert!(p >= 1.0 / 364.0, "replacement {p}");
    }
    assert!((250.0..=363.0).contains(&least) && (250.0..=363.0).contains(&most));
    holds!(
        "H07",
        Cpu,
        "a half stalls at {in_half:.1} in frame {frames}; stored sums at {least:.0} to {most:.0} w, replacement >= 1/364"
    );
}

#[test]
fn h09_sums_grow_in_proportion_to_the_weight_where_half_floats_do_not() {
    let (in_half, frames) = stall(half(0.05), |a| recur_half(a, half(0.05)));
    assert!((in_half - 2.83).abs() < 0.005 && frames == 1401, "{in_half} in frame {frames}");
    let after = |w: f32, frames: u32| (1..frames).fold(w, |a, _| recur(a, w, 1.0)) / w;
    let of_one = after(1.0, 100_000);
    // A power of two scales exactly; other weights round differently on the way.
    for exponent in -20..4 {
        assert_eq!(after(2.0_f32.powi(exponent), 100_000), of_one);
    }
    let mut draws = Draws::new("scale invariance");
    let spread = (0..40)
        .map(|_| (after(10.0_f32.powf(draws.range(-3.0, 0.0)), 100_000) / of_one - 1.0).abs())
        .fold(0.0_f32, f32::max);
    assert!(spread < 5e-4, "{spread}");
    holds!(
        "H09",
        Cpu,
        "a half stalls at {in_half:.2} in frame {frames}; f32: s(w)/w = {of_one:.2} within {spread:.0e} after 1e5 frames"
    );
}

#[test]
fn h10_a_billion_frames_follow_the_closed_form() {
    // In blocks: (a_next + b)^2 = (a + b)^2 + 2 b^2 + b^4 / (a + b)^2, summed as 2 n + ln(1 + 2 n / s0) / 2 for b = 1.
    let closed = |n: f64, s0: f64| (s0 + 2.0 * n + 0.5 * (2.0 * n / s0).ln_1p()).sqrt() - 1.0;
    let (mut a, mut n) = (1.0_f64, 0.0);
    let mut worst = 0.0_f64;
    let (mut single, mut held) = (1.0_f32, 0.0);
    while n < 1e7 {
        a = recur64(a, 1.0, 1.0);
        single = recur(single, 1.0, 1.0);
        n += 1.0;
        // Number of frames for which f32 stays within the same bound.
        held = if held == n - 1.0 && (f64::from(single) / a - 1.0).abs() < 1e-3 { n } else { held };
    }
    worst = worst.max((a / closed(n, 4.0) - 1.0).abs());
    // On to 1e9 with the exact increment of s = (a + 1)^2 over blocks in which 1/s moves by less than 1e-5.
    while n < 1e9 {
        let s = (a + 1.0).powi(2);
        let block = (1e-6 * s).max(1.0).floor().min(1e9 - n);
        a = (s + block * (2.0 + 1.0 / s)).sqrt() - 1.0;
        n += block;
    }
    worst = worst.max((a / closed(n, 4.0) - 1.0).abs());
    assert!(worst < 1e-3, "{worst:e}");
    assert!(held >= 1e6, "f32 is off by 1e-3 after {held} frames");
    println!("f32 stays within 1e-3 for {held} frames; after 1e7 it is {single}");
    holds!("H10", Cpu, "s = {a:.0} after 1e9 frames, drift {worst:.0e}; f32 within 1e-3 for {held:.1e} frames");
}

/// Weights 1, history capped at `cap` before each candidate: survivors of `pixels` after `frames`, and their expected
/// share.
fn capped(cap: f32, start: f32, frames: u32, pixels: u64, draws: &mut Draws) -> (u64, f64) {
    let (mut share, mut alive) = (1.0, pixels);
    let mut r = Reservoir { w_sum: start, count: 0 };
    for _ in 0..frames {
        r.w_sum = r.w_sum.min(cap);
        let mut replaced = 0;
        let mut merged = r;
        for _ in 0..alive {
            let (next, second) = reservoir::combine(r, Reservoir { w_sum: 1.0, count: 1 }, draws.uniform());
            replaced += u64::from(second);
            merged = next;
        }
        share *= f64::from(r.w_sum) / f64::from(merged.w_sum);
        alive -= replaced;
        r = merged;
    }
    (alive, share)
}

#[test]
fn h16_a_capped_history_answers_a_step_in_the_time_theory_says() {
    let mut figures = vec![];
    for (name, cap, start) in [("8", 8.0_f32, 1000.0), ("32", 32.0, 1000.0), ("infinite", f32::INFINITY, 40.0)] {
        // With a cap every old sample survives a frame with M / (M + 1); without, k frames after a sum of s with s / (s
        // + k).
        let theory = if cap.is_finite() {
            0.5_f64.ln() / (f64::from(cap) / f64::from(cap + 1.0)).ln()
        } else {
            f64::from(start)
        };
        let mut draws = Draws::new(&format!("cap {name}"));
        let pixels = 200_000;
        let frames = theory.round() as u32;
        let (alive, share) = capped(cap, start, frames, pixels, &mut draws);
        accept(&format!("survivors with cap {name}"), p_of_rate(alive, pixels, share));
        // Between frames the share falls as a power.
        let half_life = f64::from(frames) + theory * (2.0 * alive as f64 / pixels as f64).log2();
        assert!((half_life / theory - 1.0).abs() < 0.05, "cap {name}: {half_life} frames, in theory {theory}");
        let wrong = 0.5_f64.powf(f64::from(frames) / (1.05 * theory));
        reject("a half-life off by 5 %", p_of_rate(alive, pixels, wrong));
        figures.push(format!("{half_life:.2} of {theory:.2}"));
    }
    holds!("H16", Cpu, "half-lives in frames, measured of theory: {}", figures.join(", "));
}

#[test]
fn eq7_survival_uses_the_sum_before_the_gate() {
    let params = WrsParams { gate: GateCode::DeltaE94, ..PAPER };
    let (a, b) = (3.0_f32, 0.4_f32);
    let d = step(&params, a, b, 0.5);
    assert!(d.gate > 0.1 && d.gate < 0.9, "the gate is half open: {}", d.gate);
    let exact = f64::from(d.gate) * f64::from(a) * f64::from(a) / f64::from(a + b) + f64::from(b);
    assert!((f64::from(d.w_sum) - exact).abs() < 1e-6);
}

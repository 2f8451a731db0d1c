//! Hard cases of the kernel's functions, H01 to H04, H08, H15, H17 to H21, H23, H30, H31, H33 and H36 to H39: laws that
//! hold for the Rust functions and for their twins on a device. A law returns what it measured, or `None` without one.

use afterimage::kernel::{reservoir, sanitize, stored_reservoir};
use afterimage_testing::Draws;
use glam::Vec3;

/// The laws as tests of an executor. `$run_law` runs one, and returns what it measured.
macro_rules! kernel_laws {
    ($side:ident, $run_law:ident) => {
        crate::laws::laws! { $side, $run_law,
            h01_an_empty_reservoir_never_wins: "H01", empty_reservoir;
            h02_two_empty_reservoirs_keep_the_newer_color: "H02", two_empty_reservoirs;
            h03_candidates_of_weight_0_change_nothing: "H03", weight_of_0;
            h04_denormal_weights_count_as_0: "H04", denormal_weights;
            h08_a_million_frames_in_f32_follow_f64_and_the_closed_form: "H08", million_frames;
            h15_counts_and_ages_saturate: "H15", saturation;
            h17_h18_bad_weights_leave_the_reservoir_as_it_was: "H17", "H18", bad_weights;
            h19_a_corrupt_key_loses_to_the_next_candidate: "H19", corrupt_key;
            h20_a_difference_beyond_100_takes_the_candidate_for_certain: "H20", shut_gate;
            h21_survival_does_not_cancel: "H21", survival;
            h23_draws_stay_below_1: "H23", largest_draw;
            h30_hue_term_never_makes_nan: "H30", same_hue;
            h31_greys_differ_by_lightness_alone: "H31", greys;
            h33_lab_is_continuous_at_its_knee: "H33", knee_of_lab;
            h36_h37_negative_and_hdr_colors_give_finite_numbers: "H36", "H37", negative_and_hdr_colors;
            h38_cbrt_is_within_2_ulp_and_exact_at_0_and_1: "H38", cube_root;
            h39_equal_colors_differ_by_exactly_0: "H39", equal_colors;
        }
    };
}
pub(crate) use kernel_laws;

/// Calls a function of the kernel by its name, with its arguments in the words of rows.
pub type Call<'a> = &'a dyn Fn(&str, &[Vec<u32>]) -> Option<Vec<Vec<u32>>>;

const LARGEST_DRAW: f32 = 16_777_215.0 / 16_777_216.0;
const DRAWS: [f32; 3] = [0.0, 0.5, LARGEST_DRAW];
/// Weights that count as 0.
const BAD: [f32; 4] = [-1.0, f32::NAN, f32::INFINITY, f32::NEG_INFINITY];

/// A function of floats.
fn of_floats(call: Call<'_>, function: &str, rows: &[Vec<f32>]) -> Option<Vec<Vec<f32>>> {
    let rows: Vec<Vec<u32>> = rows.iter().map(|row| row.iter().map(|v| v.to_bits()).collect()).collect();
    Some(call(function, &rows)?.iter().map(|out| out.iter().map(|&v| f32::from_bits(v)).collect()).collect())
}

/// `combine` of reservoirs of these sums, of 7 candidates and of 1: whether the second is kept, sum, count.
fn combined(call: Call<'_>, rows: &[([f32; 2], f32)]) -> Option<Vec<(bool, f32, u32)>> {
    let words = |&([a, b], draw): &([f32; 2], f32)| vec![a.to_bits(), 7, b.to_bits(), 1, draw.to_bits()];
    let out = call("combine", &rows.iter().map(words).collect::<Vec<_>>())?;
    Some(out.iter().map(|o| (o[0] != 0, f32::from_bits(o[1]), o[2])).collect())
}

/// `update` by each of the weights: whether it is taken, sum, count.
fn updated(call: Call<'_>, w_sum: f32, count: u32, weights: &[f32], draw: f32) -> Option<Vec<(bool, f32, u32)>> {
    let words = |w: &f32| vec![w_sum.to_bits(), count, w.to_bits(), draw.to_bits()];
    let out = call("update", &weights.iter().map(words).collect::<Vec<_>>())?;
    Some(out.iter().map(|o| (o[0] != 0, f32::from_bits(o[1]), o[2])).collect())
}

/// A history of a color and a sum, and a candidate.
#[derive(Clone, Copy)]
struct Step {
    /// 0: A-Chao; 1: A-ES.
    sampler: u32,
    color: [f32; 3],
    w_sum: f32,
    log_key: f32,
    candidate: [f32; 3],
    weight: f32,
    draw: f32,
}

/// Equal colors.
const STEP: Step =
    Step { sampler: 0, color: [0.3; 3], w_sum: 0.0, log_key: -0.3, candidate: [0.3; 3], weight: 1e-3, draw: 0.0 };

/// `decide_sample` with Bernoulli survival and the gate of the paper: whether the candidate is taken; sum, key, gate,
/// survival.
fn stepped(call: Call<'_>, steps: &[Step]) -> Option<Vec<(bool, [f32; 4])>> {
    let words = |s: &Step| {
        let past = [s.w_sum, s.log_key, s.draw];
        let floats = [&[1.0, 0.0, 0.01][..], &s.candidate, &[s.weight], &s.color, &past].concat();
        [s.sampler, 2, 1].into_iter().chain(floats.into_iter().map(f32::to_bits)).collect()
    };
    let out = call("decide_sample", &steps.iter().map(words).collect::<Vec<_>>())?;
    Some(out.iter().map(|o| (o[0] != 0, [1, 2, 3, 4].map(|k| f32::from_bits(o[k])))).collect())
}

/// Sum and age after storage.
fn kept(w_sum: f32, age: u32) -> stored_reservoir::Stored {
    stored_reservoir::unpack(stored_reservoir::pack(stored_reservoir::Stored {
        color: Vec3::ONE,
        disparity: 0.1,
        w_sum,
        age,
    }))
}

fn ulps(value: f32, exact: f64) -> f64 {
    let spacing = f64::from((exact as f32).abs().next_up()) - f64::from((exact as f32).abs());
    (f64::from(value) - exact).abs() / spacing
}

pub fn empty_reservoir(call: Call<'_>) -> Option<String> {
    let merged = combined(call, &DRAWS.map(|draw| ([0.0, 1e-3], draw)))?;
    assert!(merged.iter().all(|&m| m == (true, 1e-3, 8)), "{merged:?}");
    for draw in DRAWS {
        assert_eq!(updated(call, 0.0, 0, &[1e-3], draw)?, [(true, 1e-3, 1)]);
        let decided = stepped(call, &[0, 1].map(|sampler| Step { sampler, draw, color: [0.0; 3], ..STEP }))?;
        assert!(decided.iter().all(|d| d.0 && d.1[0] == 1e-3), "{decided:?}");
    }
    // The planted error: Alg. 2 as published keeps the first when draw * sum <= w1.
    let published = |w1: f32, w2: f32, draw: f32| draw * (w1 + w2) <= w1;
    assert!(published(0.0, 1e-3, 0.0), "the published comparison keeps the empty reservoir");
    let per_frame = 3840.0 * 2160.0 / 16_777_216.0;
    Some(format!("R2 chosen by update, combine and step; `<=` would keep {per_frame:.2} empty px a 4K frame"))
}

pub fn two_empty_reservoirs(call: Call<'_>) -> Option<String> {
    let merged = combined(call, &[([0.0, 0.0], 0.0), ([0.0, 0.0], 0.5)])?;
    assert!(merged.iter().all(|&m| m == (true, 0.0, 8)), "{merged:?}");
    for sampler in [0, 1] {
        let empty = Step { sampler, weight: 0.0, color: [0.1; 3], ..STEP };
        let (take, [w_sum, _, gate, survival]) = stepped(call, &[empty])?[0];
        assert_eq!((take, w_sum, gate, survival), (true, 0.0, 1.0, 1.0));
        // Stored and read again it is still empty, and the next candidate is taken for certain.
        let read = kept(w_sum, 0);
        assert_eq!((read.w_sum, read.color), (0.0, Vec3::ONE));
        assert!(stepped(call, &[Step { w_sum: read.w_sum, weight: 0.02, draw: 0.999_999, ..empty }])?[0].0);
    }
    Some("the second's color, w_sum 0, survival 1, for both samplers".into())
}

/// Candidates of weight 0 over a history, which is stored after each frame.
pub fn weight_of_0(call: Call<'_>) -> Option<String> {
    let mut draws = Draws::new("weight 0");
    for sampler in [0, 1] {
        let history = Step { sampler, color: [0.1, 0.2, 0.3], w_sum: 5.421_875, weight: 0.0, ..STEP };
        let drawn = [0.0].into_iter().chain((1..100_000).map(|_| draws.uniform()));
        let frames: Vec<_> = drawn.map(|draw| Step { draw, ..history }).collect();
        for (take, [w_sum, log_key, ..]) in stepped(call, &frames)? {
            // So that the next frame starts from the same history.
            assert!(!take && kept(w_sum, 3).w_sum == history.w_sum, "{w_sum}");
            assert!(sampler == 0 || log_key == history.log_key, "{log_key}");
        }
    }
    Some("w_sum 5.421875 and key -0.3 after 1e5 frames through storage, none taken".into())
}

/// Candidates of weight 1 on a history of weight 1, each on the sum of the frame before.
pub fn million_frames(call: Call<'_>) -> Option<String> {
    let (mut sums, mut exact) = (vec![1.0_f32], 1.0_f64);
    for i in 0..999_999 {
        sums.push(sums[i] * reservoir::bernoulli_survival(sums[i], 1.0) + 1.0);
        exact = exact * exact / (exact + 1.0) + 1.0;
    }
    let frames = || sums.windows(2).step_by(10);
    let survivals = of_floats(call, "bernoulli_survival", &frames().map(|w| vec![w[0], 1.0]).collect::<Vec<_>>())?;
    for (w, survival) in frames().zip(survivals.concat()) {
        assert!((w[0] * survival + 1.0 - w[1]).abs() <= 2.0 * f32::EPSILON * w[1], "{w:?}");
    }
    let (s, closed) = (sums[999_999], 2e6_f64.sqrt());
    assert!((s - 1412.7).abs() < 0.5 && (f64::from(s) / exact - 1.0).abs() < 4e-4, "{s}, {exact}");
    assert!((exact / closed - 1.0).abs() < 2e-3);
    Some(format!("s = {s:.2} in f32, {exact:.2} in f64, sqrt(2n) = {closed:.2}"))
}

pub fn denormal_weights(call: Call<'_>) -> Option<String> {
    let tiny = 1e-40;
    let merged = combined(call, &[([tiny, tiny], 0.5), ([tiny, 1.0], LARGEST_DRAW), ([1.0, tiny], 0.0)])?;
    assert_eq!(merged, [(true, 0.0, 8), (true, 1.0, 8), (false, 1.0, 8)]);
    assert_eq!(updated(call, 0.0, 0, &[tiny], 0.0)?, [(false, 0.0, 1)]);
    assert_eq!(kept(tiny, 0).w_sum, 0.0);
    // A denormal product of survival counts as 0 for any draw, not only on devices that flush denormals.
    let least = Step { w_sum: 4.0 * f32::MIN_POSITIVE, weight: 0.5, draw: LARGEST_DRAW, ..STEP };
    let decided = stepped(call, &[least])?[0];
    assert!(decided.0 && decided.1[0] == 0.5);
    Some("1e-40 counts as 0 in update, combine, storage and survival".into())
}

pub fn saturation(call: Call<'_>) -> Option<String> {
    assert_eq!(updated(call, 1.0, u32::MAX, &[1.0], 0.5)?[0].2, u32::MAX);
    let full = [1.0_f32.to_bits(), u32::MAX];
    assert_eq!(call("combine", &[[&full[..], &full, &[0.5_f32.to_bits()]].concat()])?[0][2], u32::MAX);
    let age = (0..1000).fold(250, |age, _| kept(1.0, age + 1).age);
    assert_eq!((age, kept(1.0, u32::MAX).age), (255, 255));
    Some(format!("count stays at 2^32-1, stored age at {age} after 1000 frames more"))
}

pub fn bad_weights(call: Call<'_>) -> Option<String> {
    for (count, after) in [(7, 8), (u32::MAX, u32::MAX)] {
        assert_eq!(updated(call, 2.0, count, &BAD, 0.0)?, [(false, 2.0, after); 4]);
    }
    assert_eq!(combined(call, &BAD.map(|bad| ([2.0, bad], 0.0)))?, [(false, 2.0, 8); 4]);
    // H19: a corrupt history counts as empty.
    assert_eq!(combined(call, &BAD.map(|bad| ([bad, 0.5], LARGEST_DRAW)))?, [(true, 0.5, 8); 4]);
    Some("-1, NaN and +-Inf count as 0: w_sum stays 2, the first is kept at a draw of 0".into())
}

/// A stored key that no candidate's key can exceed would keep its sample for ever.
pub fn corrupt_key(call: Call<'_>) -> Option<String> {
    let of = |log_key, draw| Step { sampler: 1, w_sum: 5.42, log_key, weight: 0.02, draw, ..STEP };
    let bad = [f32::NAN, -f32::NAN, f32::INFINITY, f32::NEG_INFINITY, f32::MIN_POSITIVE, 5.0, f32::MAX];
    let decided = stepped(call, &bad.map(|key| DRAWS.map(|draw| of(key, draw))).concat())?;
    assert!(decided.iter().all(|d| d.0 && (f32::MIN..=0.0).contains(&d.1[1])), "{decided:?}");
    assert!(stepped(call, &[0.0, -0.0, -1e-30].map(|key| of(key, 0.5)))?.iter().all(|d| !d.0), "sound keys");
    Some("NaN, +-Inf and positive A-ES keys lose to the next candidate at any draw".into())
}

pub fn shut_gate(call: Call<'_>) -> Option<String> {
    // Delta E 94 of 150, the most in sRGB, and L* of 276.
    let bright = [((276.0_f32 + 16.0) / 116.0).powi(3); 3];
    for (candidate, color) in [([0.0; 3], bright), (bright, [0.0; 3]), ([0.0; 3], [65504.0; 3])] {
        let decided =
            stepped(call, &DRAWS.map(|draw| Step { candidate, weight: 0.25, color, w_sum: 1e6, draw, ..STEP }))?;
        for (take, [w_sum, _, gate, survival]) in decided {
            assert_eq!((take, w_sum, gate, survival), (true, 0.25, 0.0, 0.0));
        }
    }
    Some("gate 0 and w_sum the candidate's 0.25 for L* 276 and 4660 against black, at any draw".into())
}

pub fn survival(call: Call<'_>) -> Option<String> {
    let mut draws = Draws::new("survival");
    let mut row = |i: u32| {
        let a = 10.0_f32.powf(draws.range(-6.0, 6.0));
        vec![a, a * if i.is_multiple_of(4) { 1e7 } else { 10.0_f32.powf(draws.range(-7.0, 7.0)) }]
    };
    let rows: Vec<_> = (0..100_000).map(&mut row).collect();
    let (mut worst, mut worst_printed) = (0.0_f64, 0.0_f64);
    for (row, out) in rows.iter().zip(of_floats(call, "bernoulli_survival", &rows)?) {
        let exact = f64::from(row[0]) / (f64::from(row[0]) + f64::from(row[1]));
        worst = worst.max(ulps(out[0], exact));
        worst_printed = worst_printed.max((f64::from(1.0 - row[1] / (row[0] + row[1])) / exact - 1.0).abs());
    }
    assert!(worst < 4.0, "{worst} ulp");
    assert!(worst_printed > 0.1, "the printed form must show its cancellation");
    let percent = 100.0 * worst_printed;
    Some(format!("{worst:.2} ulp for ratios 1e-7 to 1e7; eq. 5 as printed is {percent:.0} % off"))
}

pub fn largest_draw(call: Call<'_>) -> Option<String> {
    let top: Vec<_> = (0..1000).map(|k| vec![u32::MAX - k]).chain([vec![0]]).collect();
    let drawn: Vec<f32> = call("unit_draw", &top)?.iter().map(|o| f32::from_bits(o[0])).collect();
    let largest = drawn.iter().copied().fold(0.0, f32::max);
    assert_eq!((largest, drawn[0], drawn[1000]), (LARGEST_DRAW, LARGEST_DRAW, 0.0));
    // Planted error: scaling without the shift rounds the top 128 values to 1.
    let rounded_up = (0..1000).filter(|k| (u32::MAX - k) as f32 * (1.0 / 4_294_967_296.0) == 1.0).count();
    assert_eq!(rounded_up, 128);
    let below = 1.0 - f64::from(largest);
    Some(format!("largest draw 1 - {below:.2e}; by x2^-32 the top {rounded_up} values would be 1"))
}

pub fn same_hue(call: Call<'_>) -> Option<String> {
    let mut draws = Draws::new("same hue");
    // How often the term under the root is negative before the clamp, and how often the whole sum under it would be.
    let (mut negative_term, mut negative_sum, mut spread_pairs) = (0, 0, 0);
    let mut rows = vec![];
    for i in 0..400_000 {
        let (l, a, b) = (draws.range(0.0, 100.0), draws.range(-80.0, 80.0), draws.range(-80.0, 80.0));
        // Half of the pairs differ in chroma, half by rounding alone.
        let s = if i % 2 == 0 { draws.range(0.1, 2.0) } else { 1.0 + draws.range(-4e-7, 4e-7) };
        let (x, y) = (Vec3::new(l, a, b), Vec3::new(l, a * s, b * s));
        let d = x - y;
        let c1 = (x.y * x.y + x.z * x.z).sqrt();
        let dc = c1 - (y.y * y.y + y.z * y.z).sqrt();
        let dh2 = d.y * d.y + d.z * d.z - dc * dc;
        let (sc, sh) = (1.0 + 0.045 * c1, 1.0 + 0.015 * c1);
        spread_pairs += usize::from(i % 2 == 0 && dh2 < 0.0);
        negative_term += usize::from(dh2 < 0.0);
        negative_sum += usize::from(dc * dc / (sc * sc) + dh2 / (sh * sh) < 0.0);
        rows.push([x.to_array(), y.to_array()].concat());
    }
    assert!(negative_term > 40_000 && negative_sum > 100, "the case must really occur");
    assert!(of_floats(call, "delta_e94", &rows)?.iter().all(|e| e[0].is_finite() && e[0] >= 0.0));
    let percent = spread_pairs as f64 / 2_000.0;
    Some(format!("hue term negative in {percent:.0} % of same-hue pairs, no NaN in 400,000"))
}

pub fn greys(call: Call<'_>) -> Option<String> {
    let heights: Vec<f32> = (0..=60).map(|e| 2.0_f32.powi(e - 60)).collect();
    let ways = [[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]];
    let grey = [40.0, 0.0, 0.0];
    let row = |from: [f32; 3], to: [f32; 3]| [from, to].concat();
    let rows = heights.iter().flat_map(|h| ways.map(|[a, b]| [40.0, 65.0].map(|l| [l, h * a, h * b])));
    let rows = rows.flat_map(|[equal, other]| [row(grey, equal), row(grey, other), row(equal, grey)]);
    let rows: Vec<_> = rows.chain([row(grey, [65.0, 0.0, 0.0])]).collect();
    let found = of_floats(call, "delta_e94", &rows)?.concat();
    assert_eq!(found.last(), Some(&25.0));
    // Its slope towards any chroma is at most 1, as for a distance, and 1 where lightness is equal.
    let mut steepest = 0.0_f32;
    for (found, h) in found.chunks_exact(3).zip(heights.iter().flat_map(|&h| [h; 4])) {
        let (from_equal, from_other) = (found[0] / h, (found[1] - 25.0) / h);
        assert!(from_other.is_finite() && (0.0..1.0).contains(&from_other), "{from_other} at {h:e}");
        assert!((from_equal - 1.0).abs() < 1e-6, "{from_equal} at {h:e}");
        steepest = steepest.max(from_equal).max(from_other);
        assert!(found[2].is_finite(), "no division by a small chroma");
    }
    Some(format!("25 for L* 40 and 65; slope at most {steepest:.6} for chroma 2^-60 to 1"))
}

pub fn knee_of_lab(call: Call<'_>) -> Option<String> {
    let knee = 216.0_f32 / 24389.0;
    let levels = [knee.next_down(), knee, knee.next_up(), knee - 1e-5, knee + 1e-5];
    let l: Vec<f32> = of_floats(call, "lab", &levels.map(|y| vec![y; 3]))?.iter().map(|lab| lab[0]).collect();
    let off = l[..3].iter().map(|l| (l - 8.0).abs()).fold(0.0, f32::max);
    assert!(off < 2e-5);
    // Slope of 903.3 from both sides, over steps wide enough for f32. Above, the curve bends: its mean over the step is
    // (2/3) (step / 2) / knee lower, 0.04 %.
    let [below, above] = [3, 4].map(|i| (l[i] - l[1]) / (levels[i] - levels[1]));
    assert!((below - 903.3).abs() < 0.2 && (above - 903.3 * (1.0 - 1e-5 / (3.0 * knee))).abs() < 0.2);
    Some(format!("L* 8 within {off:.1e} at the knee +- 1 ulp; slopes {below:.1} and {above:.1}"))
}

pub fn negative_and_hdr_colors(call: Call<'_>) -> Option<String> {
    // As the passes get them.
    let sanitized = |x: f32| sanitize::color(Vec3::splat(x)).0.x;
    let values = [0.0, -0.0, -1e-30, -1e-3, -1.0, 1.0, 1e4, 65504.0, -65504.0, 1e30, -1e30, f32::MAX, f32::MIN];
    let values = values.map(sanitized);
    let pairs = values.into_iter().flat_map(|a| values.map(|b| (a, b)));
    // By Delta E 94.
    let row = |colors: [f32; 6]| colors.map(f32::to_bits).into_iter().chain([1]).collect();
    let rows: Vec<Vec<u32>> = pairs.flat_map(|(a, b)| [row([a, a, a, b, b, b]), row([a, b, 0.5, b, 0.1, a])]).collect();
    let found: Vec<f32> = call("difference", &rows)?.iter().map(|o| f32::from_bits(o[0])).collect();
    assert!(found.iter().all(|d| d.is_finite() && *d >= 0.0));
    let gates = of_floats(call, "gate", &found.iter().map(|&d| vec![d, 0.0, 0.01]).collect::<Vec<_>>())?;
    assert!(gates.iter().all(|gate| (0.0..=1.0).contains(&gate[0])));
    let most = found.iter().copied().fold(0.0, f32::max);
    assert!(most > 100.0);
    let l = of_floats(call, "lab", &[1e4, 65504.0, 1e30].map(|x| vec![sanitized(x); 3]))?;
    assert_eq!(l[1], l[2], "saturates");
    let (pairs, [ten_thousand, half]) = (rows.len(), [l[0][0], l[1][0]]);
    Some(format!(
        "no NaN in {pairs} pairs; L* {ten_thousand:.0} at 1e4, {half:.0} at 65504 and 1e30; Delta E at most {most:.2e}"
    ))
}

pub fn cube_root(call: Call<'_>) -> Option<String> {
    let rows: Vec<_> = (0..=400_000).map(|i| vec![(1e-30 * 1e60_f64.powf(f64::from(i) / 4e5)) as f32]).collect();
    let found = of_floats(call, "cbrt", &rows)?;
    let errors = rows.iter().zip(&found).map(|(x, y)| ulps(y[0], f64::from(x[0]).cbrt()));
    let worst = errors.fold(0.0, f64::max);
    assert!(worst <= 2.0, "{worst}");
    let exact = of_floats(call, "cbrt", &[vec![0.0], vec![1.0], vec![-1.0]])?.concat();
    assert_eq!(exact.iter().map(|v| v.to_bits()).collect::<Vec<_>>(), [0.0, 1.0, -1.0].map(f32::to_bits));
    // The planted error: a polynomial of degree 3 is not enough.
    let shorter = |x: f32| {
        let y = f32::from_bits(0x54a1_f800 - (x.to_bits() as f32 * (1.0 / 3.0)) as u32);
        let (d, e) = (x * y * y, 1.0 - x * y * y * y);
        d + d * (e * (((0.456_643_1 * e + 0.498_263_66) * e + 0.555_551_23) * e + 0.666_660_9))
    };
    let shorter = (100..800).map(|i| i as f32 / 100.0).map(|x| ulps(shorter(x), f64::from(x).cbrt()));
    assert!(shorter.fold(0.0, f64::max) > 4.0);
    Some(format!("worst error {worst:.2} ulp over 1e-30 to 1e30, exact at 0 and +-1"))
}

pub fn equal_colors(call: Call<'_>) -> Option<String> {
    let mut draws = Draws::new("equal colors");
    let mut any = || loop {
        let x = f32::from_bits(draws.bits());
        if x.is_finite() {
            return x;
        }
    };
    let colors: Vec<[f32; 3]> = (0..50_000).map(|_| [any(), any(), any()]).collect();
    let twice = |c: &[f32; 3]| [*c, *c].concat();
    for gate in [1, 2] {
        let row = |c| twice(c).into_iter().map(f32::to_bits).chain([gate]).collect();
        assert!(call("difference", &colors.iter().map(row).collect::<Vec<_>>())?.iter().all(|o| o == &[0]));
    }
    // As the passes get them.
    let colors: Vec<[f32; 3]> = colors.into_iter().map(|c| sanitize::color(c.into()).0.to_array()).collect();
    let labs = of_floats(call, "lab", &colors.iter().map(|c| c.to_vec()).collect::<Vec<_>>())?;
    let equal: Vec<_> = labs.iter().map(|lab| [&lab[..], lab].concat()).collect();
    assert!(of_floats(call, "delta_e94", &equal)?.iter().all(|o| o[0].to_bits() == 0));
    let step = |&color: &[f32; 3]| Step {
        color,
        candidate: color,
        w_sum: draws.range(1e-3, 1e3),
        weight: draws.range(1e-3, 1.0),
        draw: draws.uniform(),
        ..STEP
    };
    let steps: Vec<_> = colors.iter().map(step).collect();
    let sums: Vec<_> = steps.iter().map(|s| vec![s.w_sum, s.weight]).collect();
    let survivals = of_floats(call, "bernoulli_survival", &sums)?.concat();
    for ((_, [_, _, gate, survival]), expected) in stepped(call, &steps)?.into_iter().zip(survivals) {
        assert_eq!((gate, survival), (1.0, expected));
    }
    assert_eq!(of_floats(call, "gate", &[vec![0.0, 0.0, 0.01], vec![0.0, 2.3, 1e6]])?, [[1.0], [1.0]]);
    // Colors one ulp apart are not equal; a difference above 0 is allowed.
    let near = [[0.5; 3], [0.5_f32.next_up(); 3]].concat().into_iter().map(f32::to_bits).chain([1]).collect();
    assert!(f32::from_bits(call("difference", &[near])?[0][0]) < 1e-4);
    Some(format!("exactly 0 and factor 1 for {} colors of any finite bits", colors.len()))
}

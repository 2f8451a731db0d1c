//! The decision of a pixel for random inputs: S4 to S7.

use super::rig::*;
use afterimage::kernel::color::root_difference;
use afterimage::kernel::smr::{Evidence, Matched, SmrParams, decide};
use glam::Vec3;

const PARAMS: SmrParams = SmrParams {
    accumulate: 0.9,
    accumulate_tolerance: 0.17,
    tolerance: 1.0,
    blocks: false,
    relight: true,
    noisy: false,
};

fn color(draws: &mut Draws) -> Vec3 {
    Vec3::new(draws.uniform(), draws.uniform(), draws.uniform())
}

/// Colors that are far apart, near each other or equal, in equal parts.
fn near(draws: &mut Draws, c: Vec3) -> Vec3 {
    let by = [0.0, 0.03, 0.5][draws.bits() as usize % 3];
    (c + (color(draws) - 0.5) * by).max(Vec3::ZERO)
}

fn evidence(draws: &mut Draws) -> Evidence {
    let candidate = color(draws);
    let light = [1.0, 1.0, 0.5, 2.0][draws.bits() as usize % 4];
    let matched = near(draws, candidate) * light;
    Evidence {
        compared_coarser: near(draws, candidate),
        observed: near(draws, candidate),
        lod: draws.range(0.01, 5.0),
        history: near(draws, matched),
        history_lod: draws.range(0.0, 5.0),
        resampled: draws.uniform() < 0.7,
        next_level: near(draws, matched),
        matched_coarser: near(draws, matched),
        predicted: near(draws, matched),
        trust: if draws.uniform() < 0.5 { 1.0 } else { draws.range(0.01, 1.0) },
        noise: if draws.uniform() < 0.5 { 0.0 } else { draws.range(0.0, 20.0) },
        ..unlike(matched, candidate)
    }
}

fn params(draws: &mut Draws) -> SmrParams {
    SmrParams {
        accumulate: draws.range(0.0, 0.98),
        tolerance: draws.range(0.1, 10.0),
        blocks: draws.uniform() < 0.3,
        relight: draws.uniform() < 0.7,
        noisy: draws.uniform() < 0.3,
        ..PARAMS
    }
}

/// Runs a check over 200,000 draws, prints to how many of them it applied, and asserts that these are not few.
fn over(name: &str, mut check: impl FnMut(&mut Draws) -> bool) {
    let mut draws = Draws::new(name);
    let concerned = (0..200_000).filter(|_| check(&mut draws)).count();
    assert!(concerned > 5_000, "{concerned}");
}

#[test]
fn s4_the_level_of_detail_lies_between_both_and_falls_with_the_share() {
    over("s4", |draws| {
        let (e, p) = (evidence(draws), params(draws));
        let m = decide(&e, &p);
        assert!((0.0..=1.0).contains(&m.share) && (0.0..=1.0).contains(&m.fit));
        if p.noisy && e.history_lod > e.lod {
            let expected = e.lod + (e.history_lod - e.lod) * m.share;
            assert!(
                (m.lod - expected).abs() < 1e-5,
                "coarser by the share of a coarser history: {} for {expected}",
                m.lod
            );
            return false;
        }
        assert!(m.lod <= e.lod, "never coarser than the candidate");
        if e.history_lod >= e.lod {
            assert_eq!(m.lod, e.lod, "what is no finer does not sharpen");
            return false;
        }
        assert!(m.lod >= e.history_lod, "never finer than what was seen");
        let less = decide(&Evidence { trust: 0.5 * e.trust, ..e }, &p);
        assert!(less.lod >= m.lod && less.share <= m.share);
        // From the candidate's level to the history's, by history's acceptance. A gain makes it coarser.
        let finer = ((e.lod - e.history_lod) / 0.1).min(1.0);
        let expected = e.lod - (e.lod - e.history_lod) * finer * m.fit * e.trust;
        assert!(m.lod > expected - 1e-5, "{} for {expected}", m.lod);
        let plain = decide(&e, &SmrParams { relight: false, ..p });
        let expected = e.lod - (e.lod - e.history_lod) * finer * plain.fit * e.trust;
        assert!((plain.lod - expected).abs() < 1e-5, "{} for {expected}", plain.lod);
        true
    });
}

/// Finer history with `gain`, and with `share` of what it then misses.
fn corrected(e: &Evidence, i: usize, gain: f32, share: f32) -> f32 {
    (gain * e.history[i] + share * (e.observed[i] - gain * e.predicted[i])).max(0.0)
}

/// Largest share of what history misses that is added to it.
fn correction(e: &Evidence, p: &SmrParams) -> f32 {
    let finer = ((e.lod - e.history_lod) / 0.1).clamp(0.0, 1.0);
    let share = if p.noisy || !e.resampled { 0.0 } else { [0.2, 0.1][usize::from(p.blocks)] };
    finer * share
}

#[test]
fn s5_each_channel_lies_between_the_candidate_and_the_relit_and_corrected_history() {
    over("s5", |draws| {
        let (e, p) = (evidence(draws), params(draws));
        let m = decide(&e, &p);
        for i in 0..3 {
            // The gain lies between 1 and the limited ratio of what is observed and predicted.
            let ratio = ((e.observed[i] + 0.002) / (e.predicted[i] + 0.002)).clamp(0.2, 5.0);
            let gains = if p.relight { [1.0, ratio] } else { [1.0; 2] };
            let histories = gains.map(|gain| corrected(&e, i, gain, correction(&e, &p)));
            let (low, high) =
                histories.iter().fold((e.candidate[i], e.candidate[i]), |(l, h), &v| (l.min(v), h.max(v)));
            let rounding = 2e-6 * (high + ratio * (e.history[i] + e.predicted[i]));
            assert!((low - rounding..=high + rounding).contains(&m.color[i]), "{} in {low} to {high}", m.color[i]);
        }
        // A share of 1 is the history, one of 0 the candidate, bit for bit; without relighting nothing else enters.
        let plain = decide(&e, &SmrParams { relight: false, ..p });
        let history = Vec3::from([0, 1, 2].map(|i| corrected(&e, i, 1.0, correction(&e, &p))));
        assert!(plain.share > 0.0 || plain.color == e.candidate);
        let mix = e.candidate.lerp(history, plain.share);
        assert!((plain.color - mix).abs().max_element() < 2e-6);
        // History that misses nothing is shown bit for bit.
        let right = decide(&Evidence { observed: e.predicted, ..e }, &SmrParams { relight: false, ..p });
        assert!(right.share < 1.0 || right.color == e.history);
        m.share > 0.0
    });
}

/// History that explains the candidate except for the light.
fn relit(draws: &mut Draws, step: Vec3) -> Evidence {
    let matched = color(draws) * 0.9 + 0.1;
    let coarser = (matched + (color(draws) - 0.5) * 0.05).max(Vec3::splat(0.05));
    Evidence {
        compared_coarser: coarser * step,
        lod: 3.0,
        history: near(draws, matched),
        next_level: coarser,
        matched_coarser: coarser,
        ..unlike(matched, matched * step)
    }
}

/// A sharp history of one color below a candidate of another one, two levels coarser.
fn unlike(history: Vec3, candidate: Vec3) -> Evidence {
    Evidence {
        candidate,
        unit: 1.0,
        compared: candidate,
        compared_coarser: candidate,
        observed: candidate,
        lod: 2.0,
        history,
        history_lod: 0.0,
        resampled: true,
        matched: history,
        level: history,
        next_level: history,
        matched_coarser: history,
        predicted: history,
        trust: 1.0,
        noise: 0.0,
        confidence: [1.0; 2],
    }
}

#[test]
fn s6_a_step_of_light_from_a_fifth_to_five_keeps_detail() {
    over("s6", |draws| {
        let step = [0.2, 0.3, 0.45, 0.5, 2.0, 3.0, 5.0][draws.bits() as usize % 7];
        let e = relit(draws, Vec3::splat(step));
        let m = decide(&e, &PARAMS);
        // The constant of 0.002 that keeps ratios finite reduces the gain by up to 0.002 |step - 1| / 0.05.
        let expected = e.history * step;
        // A fifth of what the gain then misses is added.
        let bound = (0.05 * e.history.max_element() + 0.2 * 0.002) * (step - 1.0).abs() + 1e-5;
        // A level of detail for each doubling or halving, but for the same constant.
        assert_eq!(m.share, 1.0, "step {step}");
        assert!((m.lod - step.log2().abs()).abs() < 0.15, "step {step}: {}", m.lod);
        assert!((m.color - expected).abs().max_element() <= bound, "{} for {expected}", m.color);
        let without = decide(&e, &SmrParams { relight: false, ..PARAMS });
        without.share < 0.01
    });
}

#[test]
fn s6_colored_light_is_followed_channel_by_channel_and_a_few_percent_are_not() {
    over("s6 color", |draws| {
        let step = Vec3::new(2.0, 1.0, 0.5);
        let e = relit(draws, step);
        let m = decide(&e, &PARAMS);
        let bound = Vec3::new(0.05, 0.0, 0.03) * e.history.max_element() + 0.2 * 0.002 + 1e-5;
        assert!((m.color - e.history * step).abs().cmple(bound).all() || m.share < 1.0);
        let e = relit(draws, Vec3::splat(1.03));
        let percent = decide(&e, &PARAMS);
        assert_eq!(percent.lod, 0.0, "no gain");
        assert!((percent.color - (e.history + 0.2 * 0.03 * e.matched)).abs().max_element() < 1e-6);
        m.share == 1.0
    });
}

/// The color bit for bit. The level of detail up to rounding, which is far below a step of storage.
fn shows_the_candidate(e: &Evidence, m: &Matched) -> bool {
    m.color == e.candidate && (m.lod - e.lod).abs() < 1e-6 && m.share == 0.0 && m.fit == 0.0
}

#[test]
fn s7_far_from_the_candidate_is_the_candidate() {
    over("s7", |draws| {
        let (e, p) = (evidence(draws), SmrParams { relight: false, ..params(draws) });
        let m = decide(&e, &p);
        let finer = ((e.lod - e.history_lod) / 0.1).clamp(0.0, 1.0);
        let width = p.tolerance * (0.17 + 0.83 * finer);
        let slack = p.tolerance * (0.5 + 0.5 * finer);
        let scale = if p.blocks { 4.0 } else { 1.0 };
        let d = root_difference(e.compared, e.matched);
        let contrast = root_difference(e.level, e.next_level);
        let keep = width * (3.0 * scale) + slack * contrast + e.noise;
        let drop = keep + width * (6.0 * scale);
        if d > drop * 1.0001 {
            assert!(shows_the_candidate(&e, &m), "{d} beyond {drop}");
        } else if d < keep * 0.9999 {
            assert_eq!(m.fit, 1.0, "{d} within {keep}");
        } else if (keep * 1.01..drop * 0.99).contains(&d) {
            assert!(m.fit > 0.0 && m.fit < 1.0, "{d} in {keep} to {drop}");
        }
        d > drop
    });
}

#[test]
fn s7_relighting_explains_no_change_of_structure() {
    // The coarse colors agree, so light did not change; the fine ones do not.
    over("s7 structure", |draws| {
        let ground = color(draws) * 0.5 + 0.25;
        let e = Evidence { compared_coarser: ground, ..unlike(ground, ground * 2.0) };
        assert!(shows_the_candidate(&e, &decide(&e, &PARAMS)));
        true
    });
}

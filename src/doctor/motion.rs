//! Rule of the motion vectors: the right convention predicts each frame best from the previous one.

use super::Door;
use super::finding::{Check, Fault, Finding};
use super::observation::{Hypothesis, Observation, hypotheses};
use crate::context::ContextDesc;
use crate::convention::{MotionConvention, MotionDirection, YAxis};
use crate::kernel::doctor::{ERRORS, HYPOTHESES, MATCHED};

/// Noise floor: a tile whose mean difference of roots of light is below this counts little.
const FLOOR: f64 = 0.002;
/// Least number of samples of a tile.
pub(super) const SAMPLES: u32 = 32;
/// Least significance, in standard deviations over tiles, at which one hypothesis is better than another.
pub(super) const BETTER: f64 = 4.0;
/// Least significance at which the stated convention is reported as wrong. It is higher, because tiles of neighbouring
/// frames are not independent.
pub(super) const WRONG: f64 = 7.0;

/// Least gain over no motion at which vectors explain a frame. Tiny vectors gain little, but in every tile.
const GAIN: f64 = 0.025;

/// Reason why the direction of the vertical axis is unknown, although direction and unit fit.
pub(super) const OPEN_Y_AXIS: &str = "direction and unit fit, but nothing moves up or down: the y axis is open";

const NOTHING: usize = 0;
const STATED: usize = 1;

/// Mean errors of the hypotheses in the comparable tiles.
fn tiles(observations: &[Observation]) -> Vec<[f64; HYPOTHESES as usize]> {
    let pairs = observations.iter().filter(|o| o.now.has_past && o.now.has_motion);
    let tiles = pairs.flat_map(Observation::tiles).filter(|(t, e)| t.is_comparable && e.word(MATCHED) >= SAMPLES);
    tiles.map(|(_, e)| std::array::from_fn(|h| e.sum(ERRORS + h as u32) / f64::from(e.word(MATCHED)))).collect()
}

/// Comparison of two hypotheses over tiles.
#[derive(Clone, Copy, Debug)]
pub(super) struct Comparison {
    /// Number of standard deviations by which the first predicts better.
    pub significance: f64,
    /// Share of the errors by which the first predicts better, -1 to 1; mean over the tiles.
    pub gain: f64,
}

pub(super) fn compare<const N: usize>(tiles: &[[f64; N]], a: usize, b: usize) -> Comparison {
    let (mut sum, mut squares) = (0.0, 1e-9);
    for errors in tiles {
        let contrast = (errors[b] - errors[a]) / (errors[b] + errors[a] + FLOOR);
        sum += contrast;
        squares += contrast * contrast;
    }
    Comparison { significance: sum / f64::sqrt(squares), gain: sum / tiles.len() as f64 }
}

pub(super) fn check(desc: &ContextDesc, observations: &[Observation], door: Door) -> Finding {
    if !observations.iter().any(|o| o.now.has_vectors) {
        return Finding::cannot_tell(Check::Motion, "no motion vectors");
    }
    if desc.motion.lacks_camera() {
        return Finding::cannot_tell(
            Check::Motion,
            "some vectors lack the camera's motion (MotionConvention::without_camera, no_vector)",
        );
    }
    let tiles = tiles(observations);
    if tiles.is_empty() {
        return Finding::cannot_tell(Check::Motion, "no two consecutive frames to compare");
    }
    let hypotheses = hypotheses(desc);
    let all = STATED..HYPOTHESES as usize;
    let better = |a, b| compare(&tiles, a, b).significance;
    let best = all.clone().fold(STATED, |best, h| if better(h, best) > 0.0 { h } else { best });
    // In the order of the hypotheses, which begins with single changes.
    let plainest = all.clone().find(|&h| better(best, h) < BETTER).unwrap_or(best);
    let (over_nothing, over_stated) = (compare(&tiles, plainest, NOTHING), compare(&tiles, plainest, STATED));
    let evidence = vec![
        ("tiles", tiles.len() as f64),
        ("gain over no motion", over_nothing.gain),
        ("significance over no motion", over_nothing.significance),
        ("significance over the stated convention", over_stated.significance),
    ];
    let cannot_tell = |why| Finding { evidence: evidence.clone(), ..Finding::cannot_tell(Check::Motion, why) };
    if over_nothing.significance < BETTER || over_nothing.gain < GAIN {
        return cannot_tell("too little moves, or the vectors do not explain it");
    }
    let confidence = |significance: f64| 1.0 - (-significance / BETTER).exp();
    if plainest == STATED {
        let mut rivals = all.filter(|&h| h != STATED && better(STATED, h) < BETTER).peekable();
        return if rivals.peek().is_none() {
            Finding::fits(Check::Motion, confidence(over_nothing.significance), evidence)
        } else if rivals.all(|h| hypotheses[h] == Hypothesis { factors: [1.0, -1.0], ..hypotheses[STATED] }) {
            cannot_tell(OPEN_Y_AXIS)
        } else {
            cannot_tell("several conventions explain the motion")
        };
    }
    let right = &hypotheses[plainest];
    // Comparisons on a coarse lattice favor short vectors. Vectors that are too long by a factor of 2 explain little.
    let is_shorter = right.factors[0].abs() == 0.5 && !right.swapped;
    let stated_gain = compare(&tiles, STATED, NOTHING).gain;
    if over_stated.significance < WRONG || is_shorter && stated_gain > 0.3 * over_nothing.gain {
        return cannot_tell("several conventions explain the motion");
    }
    let (fault, mend) = mend(desc.motion, right, door);
    Finding::wrong(
        Check::Motion,
        fault,
        confidence(over_stated.significance.min(over_nothing.significance)),
        evidence,
        mend,
    )
}

/// The fault of the stated convention if `right` is the true one, and the line of code that mends it.
fn mend(stated: MotionConvention, right: &Hypothesis, door: Door) -> (Fault, String) {
    let [x, y] = right.factors.map(|f| f < 0.0);
    let mut fields = vec![];
    let mut fault = None;
    if x {
        fault = Some(Fault::MotionDirection);
        fields.push(format!("direction: MotionDirection::{:?}", flipped(stated.direction)));
    }
    if x != y {
        fault = fault.or(Some(Fault::MotionYAxis));
        fields.push(format!("y_axis: YAxis::{:?}", if stated.y_axis == YAxis::Up { YAxis::Down } else { YAxis::Up }));
    }
    if let Some(unit) = right.unit {
        fault = fault.or(Some(Fault::MotionUnit));
        fields.push(format!("unit: MotionUnit::{unit:?}"));
    }
    if right.swapped {
        return (Fault::MotionAxes, format!("motion = motion.yx; // where your shader writes it{}", also(&fields)));
    }
    let factor = right.factors[0].abs();
    if right.unit.is_none() && factor != 1.0 {
        let line = format!("motion *= {factor}; // where your shader writes it{}", also(&fields));
        return (Fault::MotionScale, line);
    }
    (fault.expect("a hypothesis differs from the stated one"), door.motion(&fields.join(", ")))
}

fn also(fields: &[String]) -> String {
    if fields.is_empty() { String::new() } else { format!(", and {}", fields.join(", ")) }
}

fn flipped(direction: MotionDirection) -> MotionDirection {
    match direction {
        MotionDirection::PreviousMinusCurrent => MotionDirection::CurrentMinusPrevious,
        MotionDirection::CurrentMinusPrevious => MotionDirection::PreviousMinusCurrent,
    }
}

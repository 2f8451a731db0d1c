//! Rule of jitter: vectors that contain the projection's jitter change with it from frame to frame.

use super::Door;
use super::finding::{Check, Fault, Finding, Outcome};
use super::observation::Observation;
use crate::context::ContextDesc;

/// Least number of changes of jitter.
const CHANGES: usize = 3;
/// Least length of a change in pixels.
const LENGTH_PX: f64 = 0.05;
/// Share of the changes that may remain unexplained.
const UNEXPLAINED: f64 = 0.2;

/// Finding on jitter, after that on motion.
pub(super) fn check(desc: &ContextDesc, observations: &[Observation], motion: &Finding, door: Door) -> Finding {
    let cannot_tell = |why| Finding::cannot_tell(Check::Jitter, why);
    if observations.iter().all(|o| o.now.view.jitter_px == [0.0; 2]) {
        return cannot_tell("ViewFrame::jitter_px is (0, 0)");
    }
    if !observations.iter().any(|o| o.now.has_motion) {
        return cannot_tell("there are no motion vectors with the camera's motion");
    }
    let steps: Vec<_> = observations.iter().map(|o| step(desc, o)).collect();
    let (mut product, mut of_jitter, mut of_motion, mut count) = (0.0, 0.0, 0.0, 0);
    for pair in steps.windows(2) {
        let [Some((motion_before, jitter_before)), Some((motion, jitter))] = pair else { continue };
        for axis in 0..2 {
            let change = jitter[axis] - jitter_before[axis];
            let moved = motion[axis] - motion_before[axis];
            if change.abs() >= LENGTH_PX {
                product += change * moved;
                of_jitter += change * change;
                of_motion += moved * moved;
                count += 1;
            }
        }
    }
    if count < CHANGES {
        return cannot_tell("the jitter does not change");
    }
    let share = product / of_jitter;
    let unexplained = (of_motion - share * product) / of_jitter;
    let evidence = vec![("share of the jitter in the vectors", share), ("unexplained share", unexplained)];
    let confidence = 1.0 - unexplained.max(0.0) / UNEXPLAINED;
    if unexplained > UNEXPLAINED || (0.25..0.75).contains(&share) || !(-0.25..1.25).contains(&share) {
        return Finding { evidence, ..cannot_tell("the camera moves too irregularly") };
    }
    let contained = share >= 0.5;
    // Motion vectors in a larger unit, or that are too short, hide their jitter.
    if !contained && matches!(motion.outcome, Outcome::Wrong(_)) {
        return cannot_tell("the motion vectors are wrong");
    }
    if contained == desc.motion.jittered {
        return Finding::fits(Check::Jitter, confidence, evidence);
    }
    Finding::wrong(Check::Jitter, Fault::MotionJitter, confidence, evidence, door.jittered(contained))
}

/// Median motion of a frame, and the motion that jitter adds, in pixels.
fn step(desc: &ContextDesc, observation: &Observation) -> Option<([f64; 2], [f64; 2])> {
    let (now, past) = (observation.now.view.jitter_px, observation.past_jitter_px?);
    if !(observation.now.has_motion && observation.now.has_past) {
        return None;
    }
    let scale = desc.motion.to_internal(desc.size_px);
    let median = |axis: usize| {
        let vectors = observation.tiles().map(|(_, e)| f64::from(e.motion()[axis] * scale[axis]));
        let mut finite: Vec<f64> = vectors.filter(|v| v.is_finite()).collect();
        let middle = finite.len() / 2;
        (!finite.is_empty()).then(|| *finite.select_nth_unstable_by(middle, f64::total_cmp).1)
    };
    let jitter = [0, 1].map(|i| f64::from(past[i] - now[i]));
    Some(([median(0)?, median(1)?], jitter))
}

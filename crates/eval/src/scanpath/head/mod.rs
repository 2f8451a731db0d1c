//! Head and eye together, as in a headset: gaze shifts in space that eye and head share, the eye's counter-rotation
//! while the head still turns (vestibulo-ocular reflex), pursuit, and gait.
//!
//! ```text
//! gaze shift:  gaze leaves; the head follows 20 to 60 ms later if the target is farther from its axis than 5 to
//!              20 degrees
//!              gaze lands; the head turns on for some tenths of a second, and the eye turns back in it
//! rest:        on a point of the space, not of a screen: the eye makes up for rotation and translation of the head
//! ```
//!
//! Fixations, drift, microsaccades, undershoot and correctives follow the model of the eye on a screen (`viewing`). The
//! result is a [`Scanpath`] on a screen that is fixed to the head, with a [`HeadPose`](super::HeadPose) for each
//! sample.
//!
//! Sources: Bischof et al. 2020, J. Vision 20(7):23. Chen et al. 2012, PLoS ONE 7(11):e47565. Freedman & Sparks 1997,
//! J. Neurophysiol. 77:2328. Goossens & Van Opstal 1997, Exp. Brain Res. 114:542. Guitton & Volle 1987, J.
//! Neurophysiol. 58:427. Hirasaki et al. 1999, Exp. Brain Res. 127:117. Hu et al. 2026, arXiv:2602.06164. Imai et al.
//! 2001, Exp. Brain Res. 136:1. Liao et al. 2009, Ann. N. Y. Acad. Sci. 1164:68. Malinov et al. 2000, Vision Res.
//! 40:2083. Meyer et al. 1985, Vision Res. 25:561. Peters, van Emmerik & Bloomberg, Stride-cycle influences on
//! goal-directed head movements made during walking, NASA Johnson Space Center. Pozzo et al. 1989, Prog. Brain Res.
//! 80:377. Sitzmann et al. 2018, arXiv:1612.04335.

mod coordination;
mod neck;
mod options;
mod simulation;

pub use coordination::{HeadTurn, Regarded};
pub use options::{DistanceOf, HeadOptions, in_a_room};

use super::sample_times::sample_times;
use super::viewing::Event;
use super::{About, Sample, Scanpath, Screen};
use crate::error::InputError;
use afterimage::ViewGeometry;
use simulation::{HeadSample, Simulation};

/// Side in pixels, and field of view in degrees, of the square screen on which gaze is written: that of a headset, and
/// 20 pixels a degree at the middle.
const SCREEN_PX: u32 = 2000;
const SCREEN_DEG: f32 = 100.0;

/// A generated head and eye, and the ground truth behind it.
#[derive(Clone, Debug, PartialEq)]
pub struct SyntheticHead {
    /// Samples with poses. No sample is lost.
    pub path: Scanpath,
    /// Events by begin. All but microsaccades are contiguous, from 0 s to past the last sample. Saccades are gaze
    /// shifts, with or without the head.
    pub events: Vec<Event>,
    /// Turns of the head by begin.
    pub turns: Vec<HeadTurn>,
    /// Points that the gaze rests on, by begin.
    pub regarded: Vec<Regarded>,
}

/// Generates a scanpath of a person who looks around in surroundings with these distances: [`in_a_room`], or the
/// distances in a scene. It begins with head and gaze straight ahead.
///
/// # Errors
/// Those of [`HeadOptions::validate`].
pub fn generate_head(options: &HeadOptions, distance_of: DistanceOf<'_>) -> Result<SyntheticHead, InputError> {
    options.validate()?;
    let mut simulation = Simulation::new(*options, distance_of, sample_times(options.duration_s, options.rate_hz));
    while !simulation.done() {
        simulation.rest();
        simulation.look_elsewhere();
    }
    let Simulation { samples, mut events, turns, regarded, .. } = simulation;
    events.sort_by(|a, b| a.start_s.total_cmp(&b.start_s));
    let view = ViewGeometry::flat([SCREEN_PX; 2], SCREEN_DEG).expect("a field of view below 180 degrees");
    let screen = Screen::of_view(&view);
    let slope = screen.tangent_per_px().expect("the screen's size and distance are known");
    let task = if options.is_walking { "walking and looking around" } else { "looking around" };
    let head = ("head", "metres and a quaternion; x right, y up, -z ahead");
    let source = format!("afterimage, synthetic head and eye, seed {}", options.seed);
    let about = About::generated(task, options.rate_hz, &[head, ("source", &source)]);
    let poses = samples.iter().map(|s| s.2).collect();
    let sample = |&(t_s, tangent, _): &HeadSample| Sample { t_s, px: Some(screen.px(slope, tangent)) };
    let samples = samples.iter().map(sample).collect();
    let path = Scanpath::new(format!("synthetic:{}", options.seed), screen, about, samples)?.with_poses(poses)?;
    Ok(SyntheticHead { path, events, turns, regarded })
}

//! Rule of the camera's part of motion vectors: a camera that moves shows whether the vectors contain its motion.

use super::Door;
use super::finding::{Check, Fault, Finding};
use super::observation::Observation;
use crate::context::ContextDesc;
use crate::kernel::depth::disparity;
use crate::kernel::doctor::TILE_PX;

/// Least motion of a tile by the camera in pixels, and number of such tiles.
const MOTION_PX: f64 = 0.5;
const TILES: usize = 20;
/// Largest difference of two vectors that are alike, as a share of the camera's motion.
const ALIKE: f64 = 0.15;
/// Largest length of a vector that is 0 but for rounding, as it is stored.
const ZERO: f64 = 1e-5;
/// Majority of the tiles that decides.
const MAJORITY: f64 = 0.7;

/// Finding on vectors that contain the camera's motion although the description says that they do not, or lack it
/// although it says that they contain it; `None` if nothing contradicts the description.
pub(super) fn check(desc: &ContextDesc, observations: &[Observation], door: Door) -> Option<Finding> {
    // Pixels with vectors contain the motion, and those without are known.
    if desc.motion.no_vector.is_some() {
        return None;
    }
    let pairs: Vec<_> = observations.iter().flat_map(|o| pairs(desc, o)).collect();
    if pairs.len() < TILES {
        return None;
    }
    let share = |alike: fn(&Pair) -> bool| pairs.iter().filter(|p| alike(p)).count() as f64 / pairs.len() as f64;
    let contain = share(Pair::contains_camera);
    let lack = share(|pair| length(pair.stored) < ZERO);
    let is_stated = desc.motion.without_camera;
    let wrong = if is_stated { contain } else { lack };
    let evidence = vec![
        ("tiles that the camera moves", pairs.len() as f64),
        ("share with its motion", contain),
        ("share without motion", lack),
    ];
    let mend = door.motion(&format!("without_camera: {}", !is_stated));
    let confidence = 1.0 - (-(pairs.len() as f64) / 50.0).exp();
    (wrong >= MAJORITY).then(|| Finding::wrong(Check::Motion, Fault::MotionCamera, confidence, evidence, mend))
}

/// Motion of a tile by the camera alone, and the tile's vector; in pixels, previous minus current, and as stored. The
/// vector is 0 if there is none.
struct Pair {
    camera: [f64; 2],
    given: [f64; 2],
    stored: [f64; 2],
}

impl Pair {
    fn contains_camera(&self) -> bool {
        length([0, 1].map(|i| self.given[i] - self.camera[i])) < ALIKE * length(self.camera)
    }
}

fn length([x, y]: [f64; 2]) -> f64 {
    x.hypot(y)
}

/// Vectors of the tiles that the camera moves.
fn pairs(desc: &ContextDesc, observation: &Observation) -> Vec<Pair> {
    let view = &observation.now.view;
    let Some(matrix) = view.previous_from_current.filter(|_| observation.now.has_depth && observation.now.has_past)
    else {
        return vec![];
    };
    let to_px = desc.motion.to_internal(desc.size_px).map(f64::from);
    let (scale, offset) = view.geometry.scale_offset();
    let of_tile = |origin_px: [u32; 2], stored: f32, motion: [f32; 2]| {
        let px = origin_px.map(|o| f64::from(o + TILE_PX / 2));
        let ray = [0, 1].map(|i| px[i] * f64::from(scale[i]) + f64::from(offset[i]));
        let d = f64::from(disparity(stored, desc.depth.disparity_map()));
        let p = matrix.map(|row| {
            let m = row.map(f64::from);
            m[0] * ray[0] + m[1] * ray[1] + m[2] + m[3] * d
        });
        let camera = [0, 1].map(|i| (p[i] / p[2] - f64::from(offset[i])) / f64::from(scale[i]) - px[i]);
        let stored = [0, 1].map(|i| if observation.now.has_vectors { f64::from(motion[i]) } else { 0.0 });
        Pair { camera, given: [0, 1].map(|i| stored[i] * to_px[i]), stored }
    };
    let tiles = observation.tiles().map(|(tile, e)| of_tile(tile.origin_px, e.depths()[0], e.motion()));
    tiles.filter(|pair| length(pair.camera) >= MOTION_PX && length(pair.given).is_finite()).collect()
}

//! Rule of depth. A camera that moves sideways shows how far surfaces are: their parallax, the motion beyond that of
//! infinitely far surfaces, is proportional to their disparity. The stored depths must agree with that disparity, which
//! motion vectors show, and pictures.
//! Without such a camera, slanted planes tell distances from depth buffers, and implausible distances tell a reversed
//! buffer from a forward one.

use super::Door;
use super::finding::{Check, Fault, Finding, Outcome};
use super::motion::{BETTER, OPEN_Y_AXIS, SAMPLES, WRONG, compare};
use super::observation::Observation;
use super::shape::Shape;
use crate::context::ContextDesc;
use crate::convention::DepthConvention;
use crate::kernel::depth::disparity;
use crate::kernel::doctor::{DEPTHS, DISTANCE_ERRORS, DISTANCES, PLACED, TILE_PX, disparity_factor};

/// Least parallax of a tile in pixels, and number of such tiles.
const PARALLAX_PX: f64 = 0.2;
const TILES: usize = 20;
/// A convention explains the motion if its disparities agree with the disparities that the motion shows: the median
/// deviation of the logarithm of their ratio is at most this.
const SPREAD: f64 = 0.12;
/// Distances that are wrong by this factor are a fault.
const FACTOR: f64 = 1.3;
/// Hypothesis that distances are as described.
const AS_STATED: usize = DISTANCES as usize / 2;
/// Least number of tiles on slanted planes, and majority that decides.
const PLANES: usize = 16;
const MAJORITY: f64 = 0.85;

/// Stored depth of a tile, and the disparity that its motion shows.
struct Parallax {
    stored: f64,
    disparity: f64,
}

/// Finding on depth, after that on motion.
pub(super) fn check(desc: &ContextDesc, observations: &[Observation], motion: &Finding, door: Door) -> Finding {
    let cannot_tell = |why| Finding::cannot_tell(Check::Depth, why);
    if !observations.iter().any(|o| o.now.has_depth) {
        return cannot_tell("no depth");
    }
    let Some(stated) = Shape::of(desc.depth) else {
        return cannot_tell("orthographic views show no parallax");
    };
    let parallax = by_parallax(desc, observations, stated, motion, door);
    let is_decided = |finding: &Finding| !matches!(finding.outcome, Outcome::CannotTell(_));
    by_range(observations, stated, door)
        .or_else(|| parallax.clone().filter(is_decided))
        .or_else(|| by_pictures(desc, observations, stated, motion, door))
        .or(parallax)
        .or_else(|| by_planes(desc, observations, stated, door))
        .unwrap_or_else(|| cannot_tell("the camera does not move sideways, and no slanted plane shows it"))
}

/// Depth buffers are in 0 to 1.
fn by_range(observations: &[Observation], stated: Shape, door: Door) -> Option<Finding> {
    let depths = middles(observations);
    let beyond = depths.iter().filter(|d| **d > 1.001 || **d < -0.001).count() as f64 / depths.len().max(1) as f64;
    if stated == Shape::Linear || depths.len() < TILES || beyond < 0.2 {
        return None;
    }
    let evidence = vec![("share outside 0 to 1", beyond)];
    let mend = door.depth(Shape::Linear, None);
    Some(Finding::wrong(Check::Depth, Fault::DepthConvention, 0.95, evidence, mend))
}

fn by_parallax(
    desc: &ContextDesc,
    observations: &[Observation],
    stated: Shape,
    motion: &Finding,
    door: Door,
) -> Option<Finding> {
    let tiles = parallax(desc, observations)?;
    let map = desc.depth.disparity_map();
    let of_stated = |p: &Parallax| f64::from(disparity(p.stored as f32, map));
    let (scale, spread) = fit(&tiles, of_stated)?;
    let fits = Shape::ALL.map(|s| (s, fit(&tiles, |p| s.disparity(p.stored))));
    let (best, (best_scale, best_spread)) =
        fits.into_iter().filter_map(|(s, f)| Some((s, f?))).min_by(|a, b| a.1.1.total_cmp(&b.1.1))?;
    // Spread of the distances: if all are equal, every convention explains the motion.
    let (_, variety) = fit(&tiles, |_| 1.0)?;
    let evidence = vec![
        ("tiles with parallax", tiles.len() as f64),
        ("variety of distances", variety),
        ("deviation of the stated convention", spread),
        ("least deviation", best_spread.min(spread)),
        ("factor of the stated disparities", 1.0 / scale),
    ];
    let confidence = (1.0 - (-(tiles.len() as f64) / 50.0).exp()) * (1.0 - best_spread / variety).clamp(0.0, 1.0);
    if variety < 0.2 || best_spread.min(spread) > SPREAD {
        return None;
    }
    if spread > SPREAD && spread > 3.0 * best_spread && best != stated {
        let line = door.depth(best, Some(1.0 / best_scale));
        return Some(Finding::wrong(Check::Depth, Fault::DepthConvention, confidence, evidence, line));
    }
    if spread > SPREAD {
        return None;
    }
    if scale.ln().abs() < FACTOR.ln() {
        return Some(Finding::fits(Check::Depth, confidence, evidence));
    }
    // Motion vectors of a wrong length also look like wrong distances.
    let why = match motion.outcome {
        Outcome::Fits => None,
        Outcome::CannotTell(why) if why == OPEN_Y_AXIS => None,
        Outcome::Wrong(_) => Some("the motion vectors are wrong"),
        Outcome::CannotTell(_) => Some("distances or the length of the motion vectors are wrong"),
    };
    if let Some(why) = why {
        return Some(Finding { evidence, ..Finding::cannot_tell(Check::Depth, why) });
    }
    let line = scaled_distances(desc, stated, 1.0 / scale, door);
    Some(Finding::wrong(Check::Depth, Fault::DepthPlanes, confidence, evidence, line))
}

/// Line that multiplies all distances by `factor`.
fn scaled_distances(desc: &ContextDesc, stated: Shape, factor: f64, door: Door) -> String {
    match desc.depth {
        DepthConvention::Forward { near, .. } | DepthConvention::Reversed { near, .. } => {
            door.depth(stated, Some(f64::from(near) * factor))
        }
        _ => format!("depth *= {factor:.4}; // or another unit of previous_from_current"),
    }
}

/// The right distances predict each frame best from the previous one.
fn by_pictures(
    desc: &ContextDesc,
    observations: &[Observation],
    stated: Shape,
    motion: &Finding,
    door: Door,
) -> Option<Finding> {
    const ALL: usize = DISTANCES as usize;
    let seen = observations.iter().filter(|o| o.now.has_past && o.now.still.is_some());
    let tiles = seen.flat_map(|o| o.tiles().map(move |(tile, evidence)| (o, tile, evidence)));
    // Objects that move by themselves have vectors where those of the camera are left out.
    let is_still = |o: &Observation, motion: [f32; 2]| !o.now.has_vectors || o.now.has_motion || motion == [0.0; 2];
    let tiles: Vec<[f64; ALL]> = tiles
        .filter(|(o, tile, e)| tile.is_comparable && e.word(PLACED) >= SAMPLES && is_still(o, e.motion()))
        .map(|(_, _, e)| std::array::from_fn(|i| e.sum(DISTANCE_ERRORS + i as u32) / f64::from(e.word(PLACED))))
        .collect();
    if tiles.len() < TILES || motion.fault().is_some() {
        return None;
    }
    let better = |a, b| compare(&tiles, a, b).significance;
    let best = (0..ALL).fold(AS_STATED, |best, i| if better(i, best) > 0.0 { i } else { best });
    // The least change that explains the pictures as well as the best one.
    let mut by_change: Vec<usize> = (0..ALL).collect();
    by_change.sort_by_key(|i| i.abs_diff(AS_STATED));
    let found = by_change.into_iter().find(|&i| better(best, i) < BETTER).unwrap_or(best);
    // Neighbours must be worse: a camera that only turns shows no distances.
    let beside = [found.checked_sub(1), Some(found + 1).filter(|i| *i < ALL)].into_iter().flatten();
    let significance = beside.map(|i| better(found, i)).fold(f64::INFINITY, f64::min);
    let factor = 1.0 / f64::from(disparity_factor(found as u32));
    let evidence = vec![
        ("tiles", tiles.len() as f64),
        ("factor of the distances", factor),
        ("significance over half and twice", significance),
        ("significance over the stated distances", if found == AS_STATED { 0.0 } else { better(found, AS_STATED) }),
    ];
    if significance < BETTER {
        return None;
    }
    let confidence = 1.0 - (-significance / BETTER).exp();
    if found == AS_STATED {
        return Some(Finding::fits(Check::Depth, confidence, evidence));
    }
    if better(found, AS_STATED) < WRONG {
        return None;
    }
    let line = scaled_distances(desc, stated, factor, door);
    Some(Finding::wrong(Check::Depth, Fault::DepthPlanes, confidence, evidence, line))
}

/// Whether stored values, or their inverses, are affine on slanted planes, and which distances are plausible.
fn by_planes(desc: &ContextDesc, observations: &[Observation], stated: Shape, door: Door) -> Option<Finding> {
    let (mut linear, mut buffer) = (0_usize, 0_usize);
    for (_, evidence) in observations.iter().filter(|o| o.now.has_depth).flat_map(Observation::tiles) {
        let depths = evidence.depths().map(f64::from);
        for (before, after) in [(1, 2), (3, 4)] {
            match slanted(&depths, before, after) {
                Some(true) => buffer += 1,
                Some(false) => linear += 1,
                None => {}
            }
        }
    }
    let votes = linear + buffer;
    let share = buffer as f64 / votes.max(1) as f64;
    let depths = middles(observations);
    let quantile = |values: &mut Vec<f64>, q: f64| {
        values.sort_by(f64::total_cmp);
        values.get((q * values.len() as f64) as usize).copied()
    };
    // Distances relative to the near plane's: for a forward buffer, and for a reversed one.
    let [forward, reversed] = [Shape::Forward, Shape::Reversed].map(|s| {
        let mut z: Vec<f64> = depths.iter().map(|d| 1.0 / s.disparity(*d).max(1e-9)).collect();
        (quantile(&mut z, 0.1), quantile(&mut z, 0.9))
    });
    let evidence = vec![("slanted planes", votes as f64), ("share affine as stored", share)];
    let confidence = 0.9 * (1.0 - (-(votes as f64) / 30.0).exp());
    let is_decided = votes >= PLANES && (share >= MAJORITY || share <= 1.0 - MAJORITY);
    let wrong = |shape: Shape, near| {
        Some(Finding::wrong(
            Check::Depth,
            Fault::DepthConvention,
            confidence,
            evidence.clone(),
            door.depth(shape, near),
        ))
    };
    if is_decided && share < 0.5 {
        return match stated {
            Shape::Linear => Some(Finding::fits(Check::Depth, confidence, evidence)),
            _ => wrong(Shape::Linear, None),
        };
    }
    if !is_decided && stated == Shape::Linear {
        return None;
    }
    // A direction is implausible if it puts nearly all surfaces at the near plane.
    let plausible = match (forward, reversed) {
        ((Some(f10), Some(f90)), (Some(r10), Some(r90))) if f90 < 1.5 && r10 > 3.0 && r90 >= f90 && f10 >= 0.0 => {
            Some(Shape::Reversed)
        }
        ((Some(f10), _), (_, Some(r90))) if r90 < 1.5 && f10 > 3.0 => Some(Shape::Forward),
        _ => None,
    }?;
    if plausible == stated {
        let why = "the direction is plausible, but nothing shows the distance of the near plane";
        return Some(Finding { evidence, ..Finding::cannot_tell(Check::Depth, why) });
    }
    let near = match desc.depth {
        DepthConvention::Forward { near, .. } | DepthConvention::Reversed { near, .. } => Some(f64::from(near)),
        _ => None,
    };
    let confidence = 0.8 * confidence.max(0.5);
    Some(Finding::wrong(
        Check::Depth,
        Fault::DepthConvention,
        confidence,
        evidence.clone(),
        door.depth(plausible, near),
    ))
}

/// Whether three depths on a slanted plane are affine as stored (`true`), or their inverses are (`false`).
fn slanted(depths: &[f64; DEPTHS as usize], before: usize, after: usize) -> Option<bool> {
    let taps = [depths[before], depths[0], depths[after]];
    if taps.iter().any(|d| !d.is_finite() || *d <= 1e-6 || *d > 1e9) {
        return None;
    }
    // Curvature relative to the slope: 0 where affine.
    let bend = |[a, b, c]: [f64; 3]| ((a - b) - (b - c)).abs() / (a - c).abs();
    let is_monotonic = (taps[0] - taps[1]) * (taps[1] - taps[2]) > 0.0;
    if !is_monotonic || (taps[0] - taps[2]).abs() < 1e-4 * taps[1] {
        return None;
    }
    let (stored, inverse) = (bend(taps), bend(taps.map(|d| 1.0 / d)));
    if stored.max(inverse) < 2e-3 || stored.max(inverse) > 0.3 {
        return None;
    }
    if stored < 0.25 * inverse {
        Some(true)
    } else if inverse < 0.25 * stored {
        Some(false)
    } else {
        None
    }
}

/// Stored depths in the middles of all tiles, finite ones.
fn middles(observations: &[Observation]) -> Vec<f64> {
    let tiles = observations.iter().filter(|o| o.now.has_depth).flat_map(Observation::tiles);
    tiles.map(|(_, e)| f64::from(e.depths()[0])).filter(|d| d.is_finite() && *d != 0.0 && d.abs() < 1e9).collect()
}

/// Disparities that the motion shows, where it follows the camera; `None` if it does not follow the camera, or with too
/// little parallax.
fn parallax(desc: &ContextDesc, observations: &[Observation]) -> Option<Vec<Parallax>> {
    let to_px = desc.motion.to_internal(desc.size_px).map(f64::from);
    let (mut found, mut strange) = (vec![], 0_usize);
    for observation in observations.iter().filter(|o| o.now.has_depth && o.now.has_motion) {
        let view = &observation.now.view;
        let Some(matrix) = view.previous_from_current else { continue };
        let m = matrix.map(|row| row.map(f64::from));
        let (scale, offset) = view.geometry.scale_offset();
        for (tile, evidence) in observation.tiles() {
            let stored = f64::from(evidence.depths()[0]);
            let motion = evidence.motion();
            if !(stored.is_finite() && motion.iter().all(|v| v.is_finite())) {
                continue;
            }
            let px = tile.origin_px.map(|o| f64::from(o + TILE_PX / 2));
            let axis = |i: usize, v: f64| v * f64::from(scale[i]) + f64::from(offset[i]);
            let ray = [axis(0, px[0]), axis(1, px[1]), 1.0];
            let previous = [0, 1].map(|i| axis(i, px[i] + f64::from(motion[i]) * to_px[i]));
            // The point at disparity d was at far + d * shift: collinear with the ray through `previous`.
            let far: [f64; 3] = std::array::from_fn(|i| m[i][0] * ray[0] + m[i][1] * ray[1] + m[i][2]);
            let per_disparity = [0, 1].map(|i| m[i][3] - previous[i] * m[2][3]);
            let moved = [0, 1].map(|i| previous[i] * far[2] - far[i]);
            let length = per_disparity[0].hypot(per_disparity[1]);
            let along = (moved[0] * per_disparity[0] + moved[1] * per_disparity[1]) / length;
            let across = (moved[0] * per_disparity[1] - moved[1] * per_disparity[0]) / length;
            let px_long = f64::from(scale[0]);
            if length.is_nan() || length <= 0.0 || along.abs().max(across.abs()) < PARALLAX_PX * px_long {
                continue;
            }
            if along <= 0.0 || across.abs() > 0.3 * along {
                strange += 1;
                continue;
            }
            found.push(Parallax { stored, disparity: along / length });
        }
    }
    (found.len() >= TILES && found.len() > strange).then_some(found)
}

/// Median ratio of the disparities that the motion shows to the disparities of a convention, and the median deviation
/// of the ratio's logarithm. `None` if too few disparities are above 0.
fn fit(tiles: &[Parallax], of: impl Fn(&Parallax) -> f64) -> Option<(f64, f64)> {
    let ratios = tiles.iter().map(|p| (p.disparity / of(p)).ln()).filter(|r| r.is_finite());
    let mut ratios: Vec<f64> = ratios.collect();
    if ratios.len() < TILES || 2 * ratios.len() < tiles.len() {
        return None;
    }
    let median = |values: &mut Vec<f64>| {
        let middle = values.len() / 2;
        *values.select_nth_unstable_by(middle, f64::total_cmp).1
    };
    let center = median(&mut ratios);
    let mut deviations: Vec<f64> = ratios.iter().map(|r| (r - center).abs()).collect();
    Some((center.exp(), median(&mut deviations)))
}

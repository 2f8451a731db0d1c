//! Rule of colors: a foveating renderer interpolates linear light, so that coarse regions are piecewise linear before
//! an encoding, and not after it.

use super::finding::{Check, Fault, Finding};
use super::observation::Observation;
use super::sharpness::{bends, is_inside};
use crate::context::ContextDesc;
use crate::foveation::FoveationKind;
use crate::kernel::doctor::{CODES, TILE_PX};

/// Least number of tiles that vote.
const VOTES: usize = 10;
/// Share of the votes that decides.
const MAJORITY: f64 = 0.85;
/// Kinks smaller than this are lost in the noise of halves.
const KINK: f64 = 1e-3;

pub(super) fn check(desc: &ContextDesc, observations: &[Observation]) -> Finding {
    let foveation = desc.settings.foveation;
    let (mut linear, mut encoded, mut coarse, mut codes, mut all) = (0_usize, 0_usize, 0_usize, 0.0, 0.0);
    for observation in observations {
        for (tile, evidence) in observation.tiles() {
            codes += f64::from(evidence.word(CODES));
            all += f64::from(TILE_PX * TILE_PX);
            let middle = tile.origin_px.map(|o| (o + TILE_PX / 2) as f32);
            let now = &observation.now;
            let lod = foveation.lod(foveation.region_angle_deg(&now.view.geometry, middle, now.gaze_px));
            if !is_inside(tile, desc.size_px) || foveation.kind != FoveationKind::Mip || lod < 1.5 {
                continue;
            }
            coarse += 1;
            // Second differences where the frame has no kinks, as a share of the second differences at kinks.
            let [given, decoded] = bends(&evidence).map(|bends| {
                let most = bends.iter().copied().fold(0.0, f64::max);
                let least = bends.iter().copied().fold(f64::INFINITY, f64::min);
                (most > KINK).then_some(least / most)
            });
            let (Some(given), Some(decoded)) = (given, decoded) else { continue };
            linear += usize::from(given < 0.02 && given < 0.25 * decoded);
            encoded += usize::from(decoded < 0.02 && decoded < 0.25 * given);
        }
    }
    let votes = linear + encoded;
    let share = encoded as f64 / votes.max(1) as f64;
    let evidence = vec![
        ("tiles", votes as f64),
        ("share that is linear once decoded", share),
        ("share on 8-bit codes", codes / f64::max(all, 1.0)),
    ];
    let confidence = |share: f64| share * (1.0 - (-(votes as f64) / (2 * VOTES) as f64).exp());
    if votes < VOTES || votes < coarse / 12 || (1.0 - MAJORITY..MAJORITY).contains(&share) {
        return Finding { evidence, ..Finding::cannot_tell(Check::Color, "too few regions are interpolated coarsely") };
    }
    if share < 0.5 {
        return Finding::fits(Check::Color, confidence(1.0 - share), evidence);
    }
    let mend = "color = select(color / 12.92, pow((color + 0.055) / 1.055, vec3(2.4)), color > vec3(0.04045)); \
                // or read the texture through an sRGB view";
    Finding::wrong(Check::Color, Fault::ColorEncoded, confidence(share), evidence, mend.into())
}

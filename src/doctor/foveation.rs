//! Rule of the gaze and of the foveation: the frame's sharpness must match both.

use super::finding::{Check, Fault, Finding};
use super::observation::Observation;
use super::sharpness::{Measured, agrees, is_inside, measure, range};
use crate::context::ContextDesc;
use crate::foveation::{Foveation, FoveationKind};
use crate::geometry::ViewGeometry;
use crate::kernel::doctor::TILE_PX;

/// Least number of tiles with measurable sharpness.
const TILES: usize = 12;
/// One description is better than another if it agrees with more tiles, by at least this number and this share of all.
const BETTER_TILES: f64 = 6.0;
const BETTER_SHARE: f64 = 0.03;
/// Share of the tiles that agree with a right description.
const AGREE: f64 = 0.94;

/// A measured tile.
struct Measurement {
    measured: Measured,
    /// Corners, midpoints of the sides, and centre, in pixels.
    points: [[f32; 2]; 9],
    /// Eccentricities of the points.
    ecc_deg: [f32; 9],
    geometry: ViewGeometry,
    gaze_px: [f32; 2],
}

/// A change of gaze positions, and the line of code that makes it.
struct Change {
    line: &'static str,
    apply: fn([f32; 2], [f32; 2]) -> [f32; 2],
}

/// Mistakes with positions: axes, origins and units. `size`: of the view.
const CHANGES: [Change; 8] = [
    Change { line: "[x, height - 1.0 - y]", apply: |[x, y], [_, h]| [x, h - 1.0 - y] },
    Change { line: "[width - 1.0 - x, y]", apply: |[x, y], [w, _]| [w - 1.0 - x, y] },
    Change { line: "[y, x]", apply: |[x, y], _| [y, x] },
    Change { line: "[x * width - 0.5, y * height - 0.5]", apply: |[x, y], [w, h]| [x * w - 0.5, y * h - 0.5] },
    Change {
        line: "[x * width - 0.5, (1.0 - y) * height - 0.5]",
        apply: |[x, y], [w, h]| [x * w - 0.5, (1.0 - y) * h - 0.5],
    },
    Change { line: "[x + 0.5 * width, y + 0.5 * height]", apply: |[x, y], [w, h]| [x + 0.5 * w, y + 0.5 * h] },
    Change { line: "[2.0 * x, 2.0 * y]", apply: |[x, y], _| [2.0 * x, 2.0 * y] },
    Change { line: "[0.5 * x, 0.5 * y]", apply: |[x, y], _| [0.5 * x, 0.5 * y] },
];

/// A foveation that differs in one respect from the stated one.
#[derive(Clone)]
struct Candidate {
    foveation: Foveation,
    fault: Fault,
    /// Whether it differs much. Regions that differ by less than a factor of 2 often agree with the tiles equally well.
    is_coarse: bool,
}

/// Numbers of tiles that agree with descriptions.
struct Agreement {
    all: f64,
    stated: f64,
    /// Number of tiles by which one description must exceed another to be better.
    better: f64,
}

impl Agreement {
    fn evidence(&self, best: f64) -> Vec<(&'static str, f64)> {
        vec![
            ("tiles with detail", self.all),
            ("share that agrees", self.stated / self.all),
            ("share that agrees with the best alternative", best / self.all),
        ]
    }

    fn confidence(&self, gain: f64) -> f64 {
        1.0 - (-gain / (2.0 * self.better)).exp()
    }

    /// Whether a description with `count` agreeing tiles is right, while the stated one and its rivals with `rival`
    /// agreeing tiles are wrong.
    fn is_right(&self, count: f64, rival: f64) -> bool {
        count >= AGREE * self.all && count >= self.stated.max(rival) + self.better
    }

    /// Finding that the description is right, if no alternative agrees with as many tiles.
    fn fits(&self, check: Check, best: f64, why_not: &'static str) -> Finding {
        if self.stated >= best + self.better {
            Finding::fits(check, self.confidence(self.stated - best), self.evidence(best))
        } else {
            Finding { evidence: self.evidence(best), ..Finding::cannot_tell(check, why_not) }
        }
    }
}

/// The first element with the largest count.
fn largest<T>(counts: &[(T, f64)]) -> &(T, f64) {
    counts.iter().reduce(|best, c| if c.1 > best.1 { c } else { best }).expect("the lists are not empty")
}

/// Findings on the gaze and on the foveation.
pub(super) fn check(desc: &ContextDesc, observations: &[Observation]) -> [Finding; 2] {
    let neither = |why| [Check::Gaze, Check::Foveation].map(|check| Finding::cannot_tell(check, why));
    if desc.settings.foveation.kind == FoveationKind::Quads {
        return neither("every pixel is shaded at full rate here, in place of chosen quads");
    }
    if observations.iter().any(|o| o.now.has_lod) {
        return neither("levels of detail are given, so that gaze and foveation are not used");
    }
    if !observations.iter().any(|o| o.now.has_gaze) {
        return neither("the gaze is lost");
    }
    let tiles = measurements(desc, observations);
    if tiles.len() < TILES {
        return neither("too few tiles show detail");
    }
    let stated = desc.settings.foveation;
    let agreeing = |foveation: &Foveation, change: Option<&Change>| {
        tiles.iter().filter(|t| t.agrees(foveation, change)).count() as f64
    };
    let all = tiles.len() as f64;
    let agreement = Agreement { all, stated: agreeing(&stated, None), better: (BETTER_SHARE * all).max(BETTER_TILES) };
    let changes: Vec<_> = CHANGES.iter().map(|c| (c, agreeing(&stated, Some(c)))).collect();
    let count = |c: Candidate| {
        let count = agreeing(&c.foveation, None);
        (c, count)
    };
    let candidates: Vec<_> = candidates(&stated).into_iter().map(count).collect();
    let (change, of_change) = *largest(&changes);
    let of_candidate = largest(&candidates).1;

    if agreement.is_right(of_change, of_candidate) {
        let mend = format!("let gaze = Gaze::At {{ px: {} }}; // of the position x, y", change.line);
        let confidence = agreement.confidence(of_change - agreement.stated);
        let gaze = Finding::wrong(Check::Gaze, Fault::Gaze, confidence, agreement.evidence(of_change), mend);
        return [gaze, Finding::cannot_tell(Check::Foveation, "the gaze is wrong")];
    }
    if agreement.is_right(of_candidate, of_change)
        && let Some(finding) = another(&agreement, &stated, &candidates)
    {
        return [Finding::cannot_tell(Check::Gaze, "the foveation is wrong"), finding];
    }
    if agreement.stated < AGREE * all {
        let why = "the frame is as sharp as several descriptions say, or as none";
        let gaze = Finding { evidence: agreement.evidence(of_change), ..Finding::cannot_tell(Check::Gaze, why) };
        let evidence = agreement.evidence(of_candidate);
        return [gaze, Finding { evidence, ..Finding::cannot_tell(Check::Foveation, why) }];
    }
    let of_coarse = candidates.iter().filter(|c| c.0.is_coarse).map(|c| c.1).fold(0.0, f64::max);
    [
        agreement.fits(Check::Gaze, of_change, "other positions agree as well: look away from the middle of the view"),
        agreement.fits(Check::Foveation, of_coarse, "other regions and rates agree as well"),
    ]
}

/// Finding that the foveation differs from the stated one; `None` if several kinds of faults agree equally well.
fn another(agreement: &Agreement, stated: &Foveation, candidates: &[(Candidate, f64)]) -> Option<Finding> {
    let (mut best, count) = largest(candidates).clone();
    let enough = count - 0.5 * agreement.better;
    let mut rival = 0.0;
    // If nothing is foveated, descriptions with huge regions also agree.
    match candidates.iter().find(|c| c.0.fault == Fault::NotFoveated && c.1 > enough) {
        Some((plain, _)) => best = plain.clone(),
        None => {
            let others = candidates.iter().filter(|c| c.0.fault != best.fault);
            rival = others.map(|c| c.1).fold(0.0, f64::max);
        }
    }
    (rival <= enough).then(|| {
        let confidence = agreement.confidence(count - agreement.stated.max(rival));
        let line = line(stated, &best.foveation);
        Finding::wrong(Check::Foveation, best.fault, confidence, agreement.evidence(count), line)
    })
}

fn measurements(desc: &ContextDesc, observations: &[Observation]) -> Vec<Measurement> {
    let mut found = vec![];
    for observation in observations.iter().filter(|o| o.now.has_gaze) {
        for (tile, evidence) in observation.tiles().filter(|(tile, _)| is_inside(tile, desc.size_px)) {
            let Some(measured) = measure(&evidence) else { continue };
            let [x, y] = tile.origin_px.map(|o| o as f32);
            let half = 0.5 * (TILE_PX - 1) as f32;
            let points: [[f32; 2]; 9] = std::array::from_fn(|i| [x + half * (i % 3) as f32, y + half * (i / 3) as f32]);
            let (geometry, gaze_px) = (observation.now.view.geometry, observation.now.gaze_px);
            let ecc_deg = points.map(|px| desc.settings.foveation.region_angle_deg(&geometry, px, gaze_px));
            found.push(Measurement { measured, points, ecc_deg, geometry, gaze_px });
        }
    }
    found
}

impl Measurement {
    fn agrees(&self, foveation: &Foveation, change: Option<&Change>) -> bool {
        let ecc_deg = match change {
            None => self.ecc_deg,
            Some(change) => {
                let gaze_px = (change.apply)(self.gaze_px, self.geometry.size_px().map(|s| s as f32));
                self.points.map(|px| foveation.region_angle_deg(&self.geometry, px, gaze_px))
            }
        };
        agrees(self.measured, foveation.kind, range(foveation, &ecc_deg))
    }
}

/// Foveations that differ in one respect.
fn candidates(stated: &Foveation) -> Vec<Candidate> {
    let mut all = vec![];
    let mut add = |fault, foveation: Foveation| {
        if foveation.validate().is_ok() && foveation.rate_far > 1 && foveation != *stated {
            let ratios = [foveation.fovea_deg / stated.fovea_deg, foveation.mid_deg / stated.mid_deg];
            let is_coarse = ratios.iter().all(|r| *r == 1.0) || ratios.iter().any(|r| *r <= 0.5 || *r >= 2.0);
            all.push(Candidate { foveation, fault, is_coarse });
        }
    };
    add(Fault::NotFoveated, Foveation { kind: FoveationKind::Off, ..*stated });
    for filter in [FoveationKind::Mip, FoveationKind::Block] {
        if filter != stated.kind {
            add(Fault::FoveationFilter, Foveation { kind: filter, ..*stated });
        }
    }
    for factor in [0.5, 2.0, 0.67, 1.5, 0.33, 3.0] {
        let [fovea_deg, mid_deg] = [stated.fovea_deg, stated.mid_deg].map(|deg| (factor * deg).min(180.0));
        add(Fault::FoveationRegions, Foveation { fovea_deg, mid_deg, ..*stated });
        add(Fault::FoveationRegions, Foveation { fovea_deg, ..*stated });
        add(Fault::FoveationRegions, Foveation { mid_deg, ..*stated });
    }
    for (mul, div) in [(1, 2), (2, 1), (1, 4), (4, 1), (1, 8), (8, 1)] {
        let [rate_mid, rate_far] = [stated.rate_mid, stated.rate_far].map(|rate| rate * mul / div);
        add(Fault::FoveationRates, Foveation { rate_mid, rate_far, ..*stated });
        add(Fault::FoveationRates, Foveation { rate_mid, ..*stated });
        add(Fault::FoveationRates, Foveation { rate_far, ..*stated });
    }
    all
}

/// Line of code that changes the stated foveation to the right one.
fn line(stated: &Foveation, right: &Foveation) -> String {
    let mut fields = vec![];
    let mut field = |differs: bool, text: String| fields.extend(differs.then_some(text));
    field(stated.kind != right.kind, format!("filter: Filter::{:?}", right.kind));
    field(stated.fovea_deg != right.fovea_deg, format!("fovea_deg: {:?}", right.fovea_deg));
    field(stated.mid_deg != right.mid_deg, format!("mid_deg: {:?}", right.mid_deg));
    field(stated.rate_mid != right.rate_mid, format!("rate_mid: {}", right.rate_mid));
    field(stated.rate_far != right.rate_far, format!("rate_far: {}", right.rate_far));
    let fields = fields.join(", ");
    format!("desc.settings.foveation = Foveation {{ {fields}, ..desc.settings.foveation }};")
}

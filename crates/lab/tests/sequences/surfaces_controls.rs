//! Negative controls of the sequence tests of taa, taau and smr: each error planted in a pass must make the executors
//! differ.

use super::rig::{Rig, View};
use super::sequences::{SIZE, foveated, trust};
use super::surfaces_variants::noisy;
use afterimage::shader::SHADERS;
use afterimage::{ContextDesc, Exposure, Filter, Foveation, Gaze, Image, MethodKind, Reset, Settings};
use afterimage_lab::source::AnalyticSource;
use afterimage_testing::planted;

fn eyes() -> ContextDesc {
    ContextDesc { view_count: 2, ..ContextDesc::new(SIZE) }
}

fn settings(method: MethodKind, filter: Filter) -> Settings {
    let foveation = Foveation { filter, rate_mid: 4, rate_far: 8, ..Foveation::default() };
    Settings { method: method.into(), foveation, ..Settings::paper() }
}

/// Whether the device differs from the CPU in one of 12 frames. The left view has an occluder that moves sideways, the
/// right view a change of lighting; every other frame also has vertical motion. `has_lod`: the frame has a map of
/// levels of detail.
pub fn differs(settings: Settings, source: &str, has_lod: bool) -> Option<bool> {
    let mut scenes = ["occluder", "light-step"].map(|s| AnalyticSource::new(s, SIZE, 70.0, 60.0).unwrap());
    let mut rig = Rig::with_shader(eyes(), settings, source)?;
    Some((0..12).any(|index| {
        rig.exposure = if index == 6 { Exposure::Changed { ratio: 2.0 } } else { Exposure::Same };
        let shake = (index % 2) as f32 * 3.0;
        let views: Vec<View> = scenes
            .iter_mut()
            .enumerate()
            .map(|(eye, scene)| {
                let mut view = foveated(scene, index, &settings.foveation);
                view.facts.gaze = Gaze::At { px: [30.0 + 60.0 * eye as f32, 50.0] };
                view.motion = view.motion.map(|m| m.map(|[x, y]| [x, y + shake]));
                view.trust = Some(trust(index));
                if settings.noisy {
                    view = noisy(2 * index + eye as u64, view);
                }
                view.lod = has_lod.then(|| Image::from_fn(SIZE, |[x, _]| (x / 16) as f32 / 3.0));
                view
            })
            .collect();
        rig.differs(index, Reset::None, &views)
    }))
}

#[track_caller]
fn all_caught(pass: &str, settings: Settings, has_lod: bool, errors: &[(&str, &str)]) {
    let right = SHADERS.compose(pass).source;
    planted::all_caught_once(right, errors, |source| differs(settings, source, has_lod));
}

/// Errors in the code that all three methods share, planted in smr's pass.
const SHARED: &[(&str, &str)] = &[
    // Motion with the opposite sign: of the nearest texel, and of the resampling position.
    ("f32(x) + motion.x", "f32(x) - motion.x"),
    ("f32(y) + motion.y", "f32(y) - motion.y"),
    ("vec2<f32>(px) + motion", "vec2<f32>(px) - motion"),
    // Surfaces of the other view.
    ("textureLoad(past_surfaces, at, view, 0)", "textureLoad(past_surfaces, at, 1u - view, 0)"),
    ("textureStore(next_surfaces, px, view,", "textureStore(next_surfaces, px, 1u - view,"),
    // Taps one texel off, and weights of the other axis.
    ("taps_around(source.texel,", "taps_around(source.texel + 1,"),
    ("fraction, catmull_rom(fraction.x)", "fraction, catmull_rom(fraction.y)"),
    // Inputs ignored (trust, exposure) and depth tests omitted.
    ("confidence = trust(trust_at(px, view));", ""),
    ("return expose(stored, frame.exposure);", "return stored;"),
    ("let is_same = is_same_surface(", "let is_same = true || is_same_surface("),
    ("let stands_in = previous.verdict", "let stands_in = false && previous.verdict"),
    ("corner_weight(corner, fraction) > STAND_IN_WEIGHT", "true"),
    ("same_surface(previous.expected, other.disparity, frame.depth_relative, 0.0)", "true"),
    ("return (word >> 16u) - codes.x < codes.y;", "return true;"),
    // Wrong counters.
    ("count_if(!usable, COUNT_NONFINITE);", ""),
];

#[test]
fn every_planted_error_in_taa_is_caught() {
    let errors = [
        // Candidate and history swapped; a blend factor 1 % too large.
        ("clipped + (roots(candidate) - clipped)", "roots(candidate) + (clipped - roots(candidate))"),
        ("(roots(candidate) - clipped) * alpha", "(roots(candidate) - clipped) * (1.01 * alpha)"),
        // A neighbor omitted, a wider clipping box, non-finite candidates stored as valid.
        ("vec2<i32>(tap % 3, tap / 3) - 1", "vec2<i32>(tap % 3, min(tap / 3, 1)) - 1"),
        ("BOX_SIGMAS: vec2<f32> = vec2<f32>(2.0, 5.0)", "BOX_SIGMAS: vec2<f32> = vec2<f32>(2.02, 5.0)"),
        ("select(-1.0, lod_of(confidence), candidate.usable || valid)", "lod_of(confidence)"),
        // Settled history that does not agree with its neighbourhood, and samples counted one too many.
        ("confidence = min(confidence, agreeing(", "confidence = max(confidence, agreeing("),
        ("confidence = 1.0 / alpha;", "confidence = 1.0 / alpha + 1.0;"),
    ];
    all_caught("taa_pass", settings(MethodKind::Taa, Filter::Mip), false, &errors);
}

#[test]
fn every_planted_error_in_taau_is_caught() {
    let errors = [
        // Confidence ignored or not limited, samples and history swapped, non-finite candidates stored as valid.
        ("min(confidence_of(resampled.lod), confidence_limit(source.fraction, UPSAMPLED_SPREAD))", "1.0"),
        (
            "min(confidence_of(resampled.lod), confidence_limit(source.fraction, UPSAMPLED_SPREAD))",
            "confidence_of(resampled.lod)",
        ),
        (
            "clipped + (roots(upsampled(a, centre)) - clipped) * share",
            "roots(upsampled(a, centre)) + (clipped - roots(upsampled(a, centre))) * share",
        ),
        // Settled history that does not agree with its neighbourhood.
        ("confidence = min(confidence, agreeing(near.", "confidence = max(confidence, agreeing(near."),
        ("vec2<i32>(tap % 3, tap / 3) - 1", "vec2<i32>(tap % 3, min(tap / 3, 1)) - 1"),
        ("select(-1.0, lod_of(result.confidence), sampled || valid || is_filled)", "lod_of(result.confidence)"),
    ];
    all_caught("taau_pass", settings(MethodKind::Taau, Filter::Mip), false, &errors);
}

#[test]
fn every_planted_error_in_smr_is_caught() {
    let errors = [
        SHARED,
        &[
            // Candidate and history swapped: in the output, the comparison and the gain.
            ("e.candidate + (history - e.candidate) * share", "history + (e.candidate - history) * share"),
            ("past_difference(e.compared, e.matched)", "past_difference(e.compared, e.history)"),
            ("(observed + DARK) / (predicted + DARK)", "(predicted + DARK) / (observed + DARK)"),
            // Fit, gate and gain 1 % off.
            ("let fit = 1.0 - smooth_step", "let fit = 1.0 - 1.01 * smooth_step"),
            ("const GATE_FROM: f32 = 3.0;", "const GATE_FROM: f32 = 3.03;"),
            ("clamp((observed + DARK)", "clamp(1.01 * (observed + DARK)"),
            // Mip chain of the other view; levels and texels one off.
            ("past_mips, four.low, view, level - 1u", "past_mips, four.low, 1u - view, level - 1u"),
            ("textureStore(next_mips, id.xy, view,", "textureStore(next_mips, id.xy, 1u - view,"),
            ("first = past_level(at, level, view);", "first = past_level(at, min(level + 1u, last), view);"),
            ("past_level(at, min(level + 1u, last), view)", "past_level(at, max(level, 1u), view)"),
            ("past_level(at, min(level + 1u, last), view)", "past_level(at, level, view)"),
            ("words_1 = select(words_1, words, i == 1u);", ""),
            // Rules omitted: coarse levels at motion edges, empty texels for non-finite candidates, mip means weighted
            // by coverage.
            ("select(MAX_LOD, result.lod, coherent_motion || result.lod < 0.0)", "result.lod"),
            ("if source.previous.verdict == VERDICT_VALID && !coherent_motion {", "if false {"),
            ("select(-1.0, lod, candidate.usable)", "lod"),
            ("v.xyz * (1.0 / max(v.w, 1e-3))", "v.xyz"),
            // Relighting threshold, stored level of detail, counter of replaced pixels.
            ("return (relight.x + relight.y * contrast) + noise;", "return relight.x + noise;"),
            ("1.0 - reuse.finer * acceptance", "1.0 - acceptance"),
            ("count_if(valid && result.share == 0.0, COUNT_REPLACED);", ""),
        ],
    ]
    .concat();
    all_caught("smr_pass", settings(MethodKind::Smr, Filter::Mip), false, &errors);
}

#[test]
fn every_planted_error_in_smr_of_other_filters_is_caught() {
    all_caught(
        "smr_pass",
        settings(MethodKind::Smr, Filter::Block),
        false,
        &[
            ("let shift = select(0.0, 1.0, FILTER == FILTER_BLOCK);", "let shift = 0.0;"),
            ("select(own, around, blocks)", "own"),
            ("predicted = past_sampled(source, px, lod, view) * per_stored;", ""),
            ("const RELIGHT_BLOCKS: vec2<f32> = vec2<f32>(8.0, 0.5);", "const RELIGHT_BLOCKS: vec2<f32> = RELIGHT;"),
            ("let scale = select(1.0, 4.0, p.blocks);", "let scale = 1.0;"),
        ],
    );
    let gauss = [("if FILTER == FILTER_GAUSS {", "if false {")];
    all_caught("smr_pass", settings(MethodKind::Smr, Filter::Gauss), false, &gauss);
    let given_lod = [("if HAS_LOD != 0u {", "if false {"), ("clamp(given, 0.0, MAX_LOD)", "clamp(given, 0.0, 1.0)")];
    all_caught("smr_pass", settings(MethodKind::Smr, Filter::Mip), true, &given_lod);
}

#[test]
fn every_planted_error_in_noisy_smr_is_caught() {
    let settings = Settings { noisy: true, ..settings(MethodKind::Smr, Filter::Mip) };
    all_caught(
        "smr_pass",
        settings,
        false,
        &[
            // Noise and candidates of the other view.
            ("past_noise, source.previous.nearest_at, view", "past_noise, source.previous.nearest_at, 1u - view"),
            ("candidate_mips, four.low, view, level - 1u", "candidate_mips, four.low, 1u - view, level - 1u"),
            ("textureStore(next_noise, px, view,", "textureStore(next_noise, px, 1u - view,"),
            // Stored noise not scaled to the exposure; two sigmas instead of three.
            (
                "return expose_noise(unpack_noise(textureLoad(past_noise, source.previous.nearest_at, view, 0).x), frame.exposure);",
                "return unpack_noise(textureLoad(past_noise, source.previous.nearest_at, view, 0).x);",
            ),
            ("const SIGMAS: f32 = 3.0;", "const SIGMAS: f32 = 2.0;"),
            // Weights of the mean, and confidence in a finer or a coarser history.
            ("history.samples / (history.samples + candidate.samples)", "0.5"),
            ("candidate.samples / max(1.0 - share", "candidate.samples / max(1.01 - share"),
            (") * confidence.x;", ");"),
            ("/ COARSER_WIDTH, 0.0, 1.0) * confidence.y", "/ COARSER_WIDTH, 0.0, 1.0)"),
            ("const COARSER_FRAMES: f32 = 4.0;", "const COARSER_FRAMES: f32 = 5.0;"),
        ],
    );
}

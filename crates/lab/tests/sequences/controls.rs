//! Negative controls of the sequence tests: an error planted in each pass, or in how it reads an input, must make the
//! executors differ.

use super::rig::{Rig, View};
use super::sequences::{SIZE, foveated, trust};
use super::surfaces_variants::noisy;
use afterimage::shader::SHADERS;
use afterimage::{
    ContextDesc, Exposure, Filter, Foveation, Gaze, Image, Method, MethodKind, Reset, Sampler, Settings, Wrs,
};
use afterimage_lab::source::AnalyticSource;
use afterimage_testing::planted;

fn settings(method: impl Into<Method>, filter: Filter) -> Settings {
    let foveation = Foveation { filter, rate_mid: 4, rate_far: 8, ..Foveation::default() };
    Settings { method: method.into(), foveation, ..Settings::paper() }
}

/// Whether the device differs from the CPU in one of 12 frames. The left view has an occluder that moves sideways, the
/// right view a change of lighting; every other frame also has vertical motion. `has_lod`: the frame has a map of
/// levels of detail.
fn differs(settings: Settings, source: &str, has_lod: bool) -> Option<bool> {
    let mut scenes = ["occluder", "light-step"].map(|s| AnalyticSource::new(s, SIZE, 70.0, 60.0).unwrap());
    let mut rig = Rig::with_shader(ContextDesc { view_count: 2, ..ContextDesc::new(SIZE) }, settings, source)?;
    Some((0..12).any(|index| {
        rig.exposure = if index == 6 { Exposure::Changed { ratio: 2.0 } } else { Exposure::Same };
        let shake = (index % 2) as f32 * 3.0;
        let views = [0, 1].map(|eye| {
            let mut view = foveated(&mut scenes[eye], index, &settings.foveation);
            view.facts.gaze = Gaze::At { px: [30.0 + 60.0 * eye as f32, 50.0] };
            view.motion = view.motion.map(|m| m.map(|[x, y]| [x, y + shake]));
            view.trust = Some(trust(index));
            if settings.noisy {
                view = noisy(2 * index + eye as u64, view);
            }
            View { lod: has_lod.then(|| Image::from_fn(SIZE, |[x, _]| (x / 16) as f32 / 3.0)), ..view }
        });
        rig.differs(index, Reset::None, &views)
    }))
}

#[track_caller]
fn all_caught(pass: &str, settings: Settings, has_lod: bool, errors: &[(&str, &str)]) {
    let right = SHADERS.compose(pass).source;
    planted::all_caught_once(right, errors, |source| differs(settings, source, has_lod));
}

#[test]
fn planted_errors_in_wrs_are_caught() {
    let errors = [
        // Motion with the opposite sign, inputs ignored (trust, exposure, depth), a wrong counter.
        ("f32(x) + motion.x", "f32(x) - motion.x"),
        ("past = scale_by_trust(past, trust_at(px, view), SAMPLER);", ""),
        ("past.color = expose(past.color, frame.exposure);", ""),
        ("if !is_same_surface(", "if false && !is_same_surface("),
        ("count_if(!usable, COUNT_NONFINITE);", ""),
    ];
    all_caught("wrs_pass", settings(MethodKind::Wrs, Filter::Mip), false, &errors);
    let keys = settings(Method::Wrs(Wrs { sampler: Sampler::AEs, ..Wrs::default() }), Filter::Mip);
    let not_stored = (
        "textureStore(next_extras, px, view, vec4<u32>(bitcast<u32>(decision.log_key),",
        "textureStore(next_extras, px, view, vec4<u32>(0u,",
    );
    all_caught("wrs_pass", keys, false, &[not_stored]);
}

#[test]
fn planted_errors_in_taa_and_taau_are_caught() {
    let wide = ("BOX_SIGMAS: vec2<f32> = vec2<f32>(2.0, 5.0)", "BOX_SIGMAS: vec2<f32> = vec2<f32>(2.02, 5.0)");
    all_caught("taa_pass", settings(MethodKind::Taa, Filter::Mip), false, &[wide]);
    let lax = ("confidence = min(confidence, agreeing(near.", "confidence = max(confidence, agreeing(near.");
    all_caught("taau_pass", settings(MethodKind::Taau, Filter::Mip), false, &[lax]);
}

#[test]
fn planted_errors_in_smr_are_caught() {
    let errors = [
        // Taps one texel off, the other view's surfaces, inputs ignored (trust, exposure, depth), a wrong counter.
        ("taps_around(source.texel,", "taps_around(source.texel + 1,"),
        ("textureLoad(past_surfaces, at, view, 0)", "textureLoad(past_surfaces, at, 1u - view, 0)"),
        ("confidence = trust(trust_at(px, view));", ""),
        ("return expose(stored, frame.exposure);", "return stored;"),
        ("let is_same = is_same_surface(", "let is_same = true || is_same_surface("),
        ("count_if(valid && result.share == 0.0, COUNT_REPLACED);", ""),
        // A gate 1 % off, a level of the mip chain one off.
        ("const GATE_FROM: f32 = 3.0;", "const GATE_FROM: f32 = 3.03;"),
        ("past_level(at, min(level + 1u, last), view)", "past_level(at, level, view)"),
    ];
    let of = |filter| settings(MethodKind::Smr, filter);
    all_caught("smr_pass", of(Filter::Mip), false, &errors);
    all_caught(
        "smr_pass",
        of(Filter::Block),
        false,
        &[("let scale = select(1.0, 4.0, p.blocks);", "let scale = 1.0;")],
    );
    all_caught("smr_pass", of(Filter::Gauss), false, &[("if FILTER == FILTER_GAUSS {", "if false {")]);
    all_caught("smr_pass", of(Filter::Mip), true, &[("if HAS_LOD != 0u {", "if false {")]);
    let noise = [("const SIGMAS: f32 = 3.0;", "const SIGMAS: f32 = 2.0;")];
    all_caught("smr_pass", Settings { noisy: true, ..of(Filter::Mip) }, false, &noise);
}

//! Negative controls of the sequence tests: an error planted in each pass, or in how it reads an input, must make the
//! executors differ.

use super::rig::{Rig, View};
use super::sequences::{SIZE, foveated, noisy, trust};
use afterimage::internal::{ContextDesc, Foveation, FoveationKind, Method, MethodKind, Reset, Sampler, Settings, Wrs};
use afterimage::shader::SHADERS;
use afterimage::{Exposure, Gaze, Image};
use afterimage_lab::source::AnalyticSource;
use afterimage_testing::planted;

fn settings(method: impl Into<Method>, filter: FoveationKind) -> Settings {
    let foveation = Foveation { kind: filter, rate_mid: 4, rate_far: 8, ..Foveation::default() };
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

/// One of motion, trust, exposure, depth, noise and levels of detail, and of each filter.
#[test]
fn planted_errors_are_caught() {
    let of = |filter| settings(MethodKind::Smr, filter);
    let keys = settings(Method::Wrs(Wrs { sampler: Sampler::AEs, ..Wrs::default() }), FoveationKind::Mip);
    let noisy = Settings { noisy: true, ..of(FoveationKind::Mip) };
    all_caught(
        "wrs_pass",
        settings(MethodKind::Wrs, FoveationKind::Mip),
        false,
        &[
            ("f32(x) + motion.x", "f32(x) - motion.x"),
            ("past = scale_by_trust(past, trust_at(px, view), SAMPLER);", ""),
            ("past.color = expose(past.color, frame.exposure);", ""),
        ],
    );
    let not_stored = ("view, vec4u(bitcast<u32>(decision.log_key),", "view, vec4u(0u,");
    let wide = ("BOX_SIGMAS: vec2f = vec2f(2.0, 5.0)", "BOX_SIGMAS: vec2f = vec2f(2.02, 5.0)");
    let blind = ("let is_same = is_same_surface(", "let is_same = true || is_same_surface(");
    let lax = ("confidence = min(confidence, agreeing(near.", "confidence = max(confidence, agreeing(near.");
    for (pass, settings, has_lod, error) in [
        ("wrs_pass", keys, false, not_stored),
        ("taa_pass", settings(MethodKind::Taa, FoveationKind::Mip), false, wide),
        ("taau_pass", settings(MethodKind::Taau, FoveationKind::Mip), false, lax),
        ("smr_pass", of(FoveationKind::Mip), false, blind),
        ("smr_pass", of(FoveationKind::Block), false, ("let scale = select(1.0, 4.0, p.blocks);", "let scale = 1.0;")),
        ("smr_pass", of(FoveationKind::Gauss), false, ("if FILTER == FILTER_GAUSS {", "if false {")),
        ("smr_pass", of(FoveationKind::Mip), true, ("if HAS_LOD != 0u {", "if false {")),
        ("smr_pass", noisy, false, ("const SIGMAS: f32 = 3.0;", "const SIGMAS: f32 = 2.0;")),
    ] {
        all_caught(pass, settings, has_lod, &[error]);
    }
}

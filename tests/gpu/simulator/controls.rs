//! Planted errors in the passes: the comparison of the executors must find each. Errors in the mathematics are
//! planted in tests/gpu/twins/controls.rs.

use super::rig::*;
use afterimage::internal::Sources;
use afterimage::internal::{Foveation, FoveationKind};
use afterimage::shader::SHADERS;
use afterimage_testing::planted::all_caught;

/// Every pass of the simulators.
const PASSES: [&str; 4] = ["mip_level", "mip_show", "block_show", "gauss_axis"];

/// Fails unless each planted error in the passes makes the executors differ on a frame that is filtered.
fn caught(filter: FoveationKind, errors: &[(&str, &str)]) {
    // Even and odd: the one reads beyond the last texel's centre, the other has texels of one pixel.
    let size = [96, 61];
    // A fovea wide enough to contain non-finite pixels.
    let foveation = Foveation { fovea_deg: 15.0, mid_deg: 30.0, ..foveation(filter, [2, 16]) };
    let scene = Scene::stereo(size, [[20.0, 30.0], [70.0, 10.0]]);
    all_caught(&PASSES.map(|name| SHADERS.compose(name).source), errors, |sources| {
        let (device, queue) = afterimage_testing::gpu::device()?;
        let texts = PASSES.into_iter().zip(sources);
        let sources = texts.fold(Sources::default(), |all, (name, text)| all.with(name, text));
        let mut rig = Rig::with_sources(device, queue, &desc(size, 2, foveation), &sources);
        Some(rig.on_gpu(&scene).agrees(&scene.on_cpu(&foveation)).is_err())
    });
}

/// Of one eye, whatever the filter.
const OF_ONE_EYE: [(&str, &str); 2] = [
    ("frame.views[view].gaze_ray", "frame.views[1u - view].gaze_ray"),
    ("frame.views[view].ray_offset", "frame.views[0].ray_offset"),
];

#[test]
fn planted_errors_in_mip_are_caught() {
    let planted = [
        ("let mip = level - 1u;", "let mip = max(level, 2u) - 2u;"),
        ("vec2f(x.fraction, y.fraction)", "vec2f(y.fraction, x.fraction)"),
        ("textureLoad(full, px, view, 0)", "textureLoad(full, px, 0u, 0)"),
        ("shown = color(shown).color;", ""),
    ];
    caught(FoveationKind::Mip, &[&OF_ONE_EYE[..], &planted].concat());
}

#[test]
fn planted_errors_in_gauss_are_caught() {
    let planted = [
        ("AXIS == 0u", "AXIS == 1u"),
        ("color(textureLoad(color_in, at, view, 0).xyz).color", "textureLoad(color_in, at, view, 0).xyz"),
    ];
    caught(FoveationKind::Gauss, &[&OF_ONE_EYE[..], &planted].concat());
}

#[test]
fn planted_errors_in_block_are_caught() {
    let planted = [("view, source - 1u)", "view, source)"), ("lod >= f32(level)", "lod > f32(level)")];
    caught(FoveationKind::Block, &[&OF_ONE_EYE[..], &planted].concat());
}

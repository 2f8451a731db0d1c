//! Planted errors in the passes: the comparison of the executors must find each. Errors in the mathematics are
//! planted in tests/gpu/twins/controls.rs.

use super::rig::*;
use afterimage::internal::Sources;
use afterimage::shader::SHADERS;
use afterimage::{Filter, Foveation};
use afterimage_testing::planted::all_caught;

/// Every pass of the simulators.
const PASSES: [&str; 4] = ["mip_level", "mip_show", "block_show", "gauss_axis"];

/// Fails unless each planted error in the passes makes the executors differ on a frame that is filtered.
fn caught(filter: Filter, errors: &[(&str, &str)]) {
    // Even and odd: the one reads beyond the last texel's centre, the other has texels of one pixel.
    let size = [96, 61];
    // A fovea wide enough to contain non-finite pixels.
    let foveation = Foveation { fovea_deg: 15.0, mid_deg: 30.0, ..foveation(filter, [2, 16]) };
    let scene = Scene::stereo(size, [[20.0, 30.0], [70.0, 10.0]]);
    all_caught(&PASSES.map(|name| SHADERS.compose(name).source), errors, |sources| {
        let (device, queue) = afterimage_testing::gpu::device()?;
        let texts = PASSES.into_iter().zip(sources);
        let sources = texts.fold(Sources::default(), |all, (name, text)| all.with(name, text));
        let mut rig = Rig::with_sources(device, queue, &desc(size, 2, foveation), FORMAT, &sources);
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
        // Shifted levels, swapped fractions, a wrong border.
        ("let mip = level - 1u;", "let mip = max(level, 2u) - 2u;"),
        ("read_level(px, view, level.whole + 1u)", "read_level(px, view, max(level.whole, 1u))"),
        ("vec2<f32>(x.fraction, y.fraction)", "vec2<f32>(y.fraction, x.fraction)"),
        ("vec2<u32>(next.x, near.y)", "vec2<u32>(near.x, next.y)"),
        ("level_len(frame.size.x, level)", "(level_len(frame.size.x, level) + 1u)"),
        ("min(at, fine_size - 1u)", "at"),
        // The other eye's frame.
        ("textureLoad(full, px, view, 0)", "textureLoad(full, px, 0u, 0)"),
        ("min(at, fine_size - 1u), view", "min(at, fine_size - 1u), 0u"),
        // Bad pixels that spread, and a sanitized fovea.
        (
            "color(textureLoad(fine, min(at, fine_size - 1u), view, 0).xyz).color",
            "textureLoad(fine, min(at, fine_size - 1u), view, 0).xyz",
        ),
        ("shown = color(shown).color;", ""),
        ("shown = textureLoad(full, px, view, 0).xyz;", "shown = color(textureLoad(full, px, view, 0).xyz).color;"),
    ];
    caught(Filter::Mip, &[&OF_ONE_EYE[..], &planted].concat());
}

#[test]
fn planted_errors_in_gauss_are_caught() {
    let planted = [
        ("vec2<i32>(frame.size) - 1)", "vec2<i32>(frame.size))"),
        ("textureLoad(color_in, at, view, 0)", "textureLoad(color_in, at, 1u, 0)"),
        ("AXIS == 0u", "AXIS == 1u"),
        ("color(textureLoad(color_in, at, view, 0).xyz).color", "textureLoad(color_in, at, view, 0).xyz"),
        ("if lod <= 0.0 {", "if lod < 0.0 {"),
    ];
    caught(Filter::Gauss, &[&OF_ONE_EYE[..], &planted].concat());
}

#[test]
fn planted_errors_in_block_are_caught() {
    let planted = [
        ("view, source - 1u)", "view, source)"),
        ("textureLoad(levels, at, view", "textureLoad(levels, at, 0u"),
        ("lod >= f32(level)", "lod > f32(level)"),
        ("shown = color(shown).color;", ""),
        ("if level > 0u {", "if true {"),
    ];
    caught(Filter::Block, &[&OF_ONE_EYE[..], &planted].concat());
}

//! Planted errors in the passes: the comparison of the executors must find each. Errors in the mathematics are
//! planted in tests/gpu/twins/controls.rs.

use super::rig::*;
use afterimage::shader::SHADERS;
use afterimage::{Filter, Foveation};

#[track_caller]
fn caught(filter: Filter, right: &str, wrong: &str) {
    // Even and odd: the one reads beyond the last texel's centre, the other has texels of one pixel.
    let size = [96, 61];
    // A fovea wide enough to contain non-finite pixels.
    let foveation = Foveation { fovea_deg: 15.0, mid_deg: 30.0, ..foveation(filter, [2, 16]) };
    let Some((device, queue)) = afterimage_testing::gpu::device() else { return };
    let planted = std::cell::Cell::new(0);
    let mut rig = Rig::with_shaders(device, queue, &desc(size, 2, foveation), FORMAT, |name| {
        let source = SHADERS.compose(name).source;
        planted.set(planted.get() + source.matches(right).count());
        source.replace(right, wrong)
    });
    assert!(planted.get() > 0, "'{right}' in the shaders of {filter:?}");
    let scene = Scene::stereo(size, [[20.0, 30.0], [70.0, 10.0]]);
    let (gpu, cpu) = (rig.on_gpu(&scene), scene.on_cpu(&foveation));
    let differ = gpu.shown.iter().zip(&cpu.shown).filter(|(g, c)| g != c).count();
    println!("{filter:?}, '{right}' -> '{wrong}': {differ} pixels differ");
    assert!(gpu != cpu, "planted error not caught: {filter:?}, '{right}' -> '{wrong}'");
}

const FILTERS: [Filter; 3] = [Filter::Mip, Filter::Gauss, Filter::Block];

#[test]
fn a_shifted_level_is_caught() {
    caught(Filter::Mip, "let mip = level - 1u;", "let mip = max(level, 2u) - 2u;");
    caught(Filter::Mip, "read_level(px, view, level.whole + 1u)", "read_level(px, view, max(level.whole, 1u))");
    caught(Filter::Block, "view, source - 1u)", "view, source)");
}

#[test]
fn swapped_bilinear_fractions_are_caught() {
    caught(Filter::Mip, "vec2<f32>(x.fraction, y.fraction)", "vec2<f32>(y.fraction, x.fraction)");
    caught(Filter::Mip, "vec2<u32>(next.x, near.y)", "vec2<u32>(near.x, next.y)");
}

#[test]
fn a_wrong_border_is_caught() {
    caught(Filter::Mip, "level_len(frame.size.x, level)", "(level_len(frame.size.x, level) + 1u)");
    caught(Filter::Mip, "min(at, fine_size - 1u)", "at");
    caught(Filter::Gauss, "vec2<i32>(frame.size) - 1)", "vec2<i32>(frame.size))");
}

#[test]
fn the_other_eye_s_gaze_or_frame_is_caught() {
    for filter in FILTERS {
        caught(filter, "frame.views[view].gaze_ray", "frame.views[1u - view].gaze_ray");
        caught(filter, "frame.views[view].ray_offset", "frame.views[0].ray_offset");
    }
    caught(Filter::Mip, "textureLoad(full, px, view, 0)", "textureLoad(full, px, 0u, 0)");
    caught(Filter::Mip, "min(at, fine_size - 1u), view", "min(at, fine_size - 1u), 0u");
    caught(Filter::Gauss, "textureLoad(color_in, at, view, 0)", "textureLoad(color_in, at, 1u, 0)");
    caught(Filter::Block, "textureLoad(levels, at, view", "textureLoad(levels, at, 0u");
}

#[test]
fn axes_in_the_wrong_order_are_caught() {
    caught(Filter::Gauss, "AXIS == 0u", "AXIS == 1u");
}

#[test]
fn a_lax_comparison_is_caught() {
    caught(Filter::Block, "lod >= f32(level)", "lod > f32(level)");
}

#[test]
fn bad_pixels_that_spread_are_caught() {
    caught(
        Filter::Mip,
        "color(textureLoad(fine, min(at, fine_size - 1u), view, 0).xyz).color",
        "textureLoad(fine, min(at, fine_size - 1u), view, 0).xyz",
    );
    caught(Filter::Mip, "shown = color(shown).color;", "");
    caught(
        Filter::Gauss,
        "color(textureLoad(color_in, at, view, 0).xyz).color",
        "textureLoad(color_in, at, view, 0).xyz",
    );
    caught(Filter::Block, "shown = color(shown).color;", "");
}

#[test]
fn a_sanitized_fovea_is_caught() {
    caught(
        Filter::Mip,
        "shown = textureLoad(full, px, view, 0).xyz;",
        "shown = color(textureLoad(full, px, view, 0).xyz).color;",
    );
    caught(Filter::Block, "if level > 0u {", "if true {");
    caught(Filter::Gauss, "if lod <= 0.0 {", "if lod < 0.0 {");
}

//! Albedo of planned frames: both executors with it, what is refused, and what it costs.

use super::quads::{reset_of, settings, views};
use super::sparse::{SIZE, desc};
use super::*;
use crate::images::pixel;

const FRAMES: u64 = 12;

/// Two views with albedo.
fn with_albedo(desc: ContextDesc) -> ContextDesc {
    ContextDesc { keep_alpha: false, has_albedo: true, ..desc }
}

/// A texture of stripes and a slope that moves, with a flat part, and with albedos that are above 1 or no numbers.
fn texture(size: [u32; 2], index: u64) -> Image<[f32; 3]> {
    Image::from_fn(size, |[x, y]| {
        let moved = u64::from(x) + 2 * index;
        match (moved % 12, (u64::from(x) * 7 + u64::from(y) * 3 + index) % 97) {
            (_, 0) => [f32::NAN, 0.5, 0.5],
            (_, 1) => [0.5, f32::INFINITY, 0.0],
            (_, 2) => [1.5, 0.5, -0.2],
            _ if x > 50 => [0.37; 3],
            (0..5, _) => [0.8, 0.1, 0.05],
            (5..8, _) => [0.0; 3],
            _ => [0.02 * (y % 40) as f32, 0.3, 0.6],
        }
    })
}

/// Colors that are light times this texture, half of the frame; and gloss.
fn textured(view: View, index: u64) -> View {
    let albedo = texture(view.color.size(), index);
    let lit = Image::from_fn(albedo.size(), |px| {
        let (color, albedo) = (pixel(&view.color, px), pixel(&albedo, px));
        [0, 1, 2].map(|i| if px[1] % 16 < 9 && albedo[i].is_finite() { color[i] * albedo[i] } else { color[i] })
    });
    View { color: lit, albedo: Some(albedo), ..view }
}

fn frame(index: u64) -> Vec<View> {
    views(index, &settings(true)).into_iter().map(|view| textured(view, index)).collect()
}

/// With a cut, changes of exposure, regions and debug views, as `reset_of` arranges them.
#[test]
fn albedo_is_bit_equal_on_both_executors() {
    let Some(mut rig) = Rig::new(with_albedo(desc()), settings(true)) else { return };
    let mut counts = vec![];
    for index in 0..FRAMES {
        let reset = reset_of(index, &mut rig);
        let (made, _) = rig.both(index, reset, &frame(index));
        assert_eq!(made.albedo.len(), made.shown.len());
        assert!(made.shown.iter().flatten().all(|&channel| f32::from_bits(channel).is_finite()));
        counts.push(made.albedo.iter().map(|word| word >> 27).max());
    }
    println!("most albedos in a mean, frame by frame: {counts:?}");
    assert!(counts.iter().flatten().max() > Some(&5));
}

#[test]
fn albedo_follows_a_change_of_size() {
    let Some(mut rig) = Rig::new(with_albedo(ContextDesc::new([40, 30])), settings(true)) else { return };
    for (index, size) in (0..).zip([[40, 30], [40, 30], [40, 30], [52, 36], [52, 36], [33, 21]]) {
        if rig.context.size_px != size {
            rig.resize_keeping_history(size);
        }
        let view = textured(View::still(noise(size, "albedo"), [20.0, 12.0]), index);
        let (made, _) = rig.both(index, Reset::None, &[view]);
        assert!(index == 0 || made.albedo.iter().any(|word| word >> 27 > 1), "frame {index} starts again");
    }
}

/// Of the same frames: a picture with albedo is another one, unless the albedo is the same everywhere.
#[test]
fn albedo_that_is_the_same_everywhere_changes_nothing() {
    let made = |albedo: Option<fn([u32; 2]) -> [f32; 3]>| {
        let desc = if albedo.is_some() { with_albedo(desc()) } else { desc() };
        let mut rig = Rig::new(desc, settings(true))?;
        let frame = |index| {
            let views = views(index, &settings(true)).into_iter();
            views.map(|view| View { albedo: albedo.map(|of| Image::from_fn(SIZE, of)), ..view }).collect::<Vec<_>>()
        };
        let shown = |index| {
            let reset = reset_of(index, &mut rig);
            rig.on_gpu(index, reset, &frame(index)).shown
        };
        Some((0..FRAMES).map(shown).collect())
    };
    let Some::<Vec<Vec<[u32; 3]>>>(without) = made(None) else { return };
    let constant: [fn([u32; 2]) -> [f32; 3]; 4] =
        [|_| [0.3, 0.123, 0.777], |_| [0.0; 3], |_| [7.0, 1.0, 0.5], |_| [f32::NAN; 3]];
    for of in constant {
        assert!(made(Some(of)).unwrap() == without, "{:?}", of([0; 2]));
    }
    assert!(made(Some(|[x, _]| [0.1 * (x % 8) as f32; 3])).unwrap() != without);
}

#[test]
fn wrong_albedo_is_caught() {
    let planted = [
        ("let word = extra_word(texel, view);", "let word = extra_word(first, view);"),
        ("candidate = times(candidate, albedos.factor);", ""),
        ("candidate.lowest *= factor;", ""),
        ("candidate.beside *= factor;", ""),
        ("past.interpolated = of_history(texture, history);", ""),
        ("candidate = times(candidate, on_sample(texture));", ""),
        ("next.nearest.color *= textured(given.texture, given.past.kept);", ""),
        ("lumas = with_luma(lumas, c, of_sample);", ""),
        ("exposed_lumas(past.lumas, frame.exposure)", "past.lumas"),
        ("pixel.result.stored.color *= retextured.factor;", ""),
        ("* retextured.place_share;", "* 0.0;"),
        ("vec4u(albedo_word, 0u, 0u, 0u)", "vec4u(0u)"),
        ("select(given.past.shown, given.past.kept, result.keeps_nearest)", "given.past.shown"),
        ("level > 0u && history.lod >= 0.0", "history.lod >= 0.0"),
        ("past.is_known && past.own.w > 0.0", "past.own.w > 0.0"),
        ("is_known && !at_edge", "is_known"),
        (
            "select(given.texture.kept + 1.0, samples, is_new), given.is_known",
            "select(given.texture.kept + 1.0, samples, is_new), true",
        ),
        ("let at = clamp(px + offset, vec2u(1u), frame.size) - 1u;", "let at = px;"),
        ("texel_of(at, view, ALBEDO_IN)", "at"),
        ("select(a.kept, word, is_nearest)", "word"),
        ("albedos = with_shown(albedos, around);", ""),
        ("texel_of(px, view, ALBEDO_IN)", "px"),
    ];
    let observed = [
        (
            "let texture = pixel_texture(px, view, level, at_edge, found.albedos",
            "let texture = pixel_texture(px, view, 0u, at_edge, found.albedos",
        ),
        ("history = of_history(of_sample(texture), history);", ""),
        ("of_history(of_sample(texture), history)", "of_history(texture, history)"),
        ("sampled.color, of_own", "vec3f(0.0), of_own"),
    ];
    let passes = [("quad_albedo_pass", &planted[..]), ("quad_observe_albedo_pass", &observed[..])];
    for (pass, planted) in passes {
        rig::all_caught_in([pass], with_albedo(desc()), settings(true), FRAMES, planted, |index, rig| {
            (reset_of(index, rig), frame(index))
        });
    }
}

/// An albedo without `has_albedo`, none with it, settings that have no use for it, and alpha beside it.
#[test]
fn albedo_that_does_not_fit_is_refused() {
    let settings = settings(true);
    let Some(mut rig) = Rig::new(with_albedo(ContextDesc::new(SIZE)), settings) else { return };
    let view = View::still(noise(SIZE, "albedo"), [20.0, 12.0]);
    let expected = "albedo of view 0 is None: expected the albedo of every pixel, because has_albedo is set";
    assert_eq!(rig.refusal(&view), expected);
    let other = Settings { noisy: true, ..settings };
    let refused = rig.gpu.set_settings(&rig.device, other).unwrap_err().to_string();
    assert_eq!(refused, rig.cpu.set_settings(other).unwrap_err().to_string());
    assert!(refused.contains("has_albedo"), "{refused}");
    let desc = ContextDesc { keep_alpha: true, settings, ..with_albedo(ContextDesc::new(SIZE)) };
    let refused = Afterimage::new(&rig.device, &desc, TextureFormat::Rgba16Float).unwrap_err().to_string();
    assert!(refused.contains("keep_alpha"), "{refused}");
    let Some(mut rig) = Rig::new(ContextDesc::new(SIZE), settings) else { return };
    let expected = "albedo of view 0 is given: expected None; or set has_albedo";
    assert_eq!(rig.refusal(&textured(view, 0)), expected);
}

/// Two texels of four bytes a pixel.
#[test]
fn albedo_takes_eight_bytes_a_pixel() {
    let bytes = |has_albedo| {
        let desc = ContextDesc { keep_alpha: false, has_albedo, settings: settings(true), ..ContextDesc::new(SIZE) };
        let cpu = afterimage::cpu::CpuAfterimage::new(&desc).unwrap();
        [Afterimage::memory_bytes_of(&desc), cpu.history().memory_bytes() as u64]
    };
    let (with, without) = (bytes(true), bytes(false));
    assert_eq!([0, 1].map(|i| with[i] - without[i]), [8 * u64::from(SIZE[0] * SIZE[1]); 2]);
}

//! Alpha of planned frames: history of it on both executors, and what it costs.

use super::quads::{settings, views};
use super::sparse::{SIZE, desc};
use super::*;

const FRAMES: u64 = 12;

fn noisy() -> Settings {
    Settings { noisy: true, ..settings(false) }
}

/// Frame `index`, with noise if the settings have it.
fn frame(index: u64, settings: &Settings) -> Vec<View> {
    let error = |[x, y]: [u32; 2]| [0.01 * ((x + y) % 5) as f32, 1.0 + (x % 4) as f32];
    let noise = settings.noisy.then(|| Image::from_fn(SIZE, error));
    views(index, settings).into_iter().map(|view| View { noise: noise.clone(), ..view }).collect()
}

/// Alpha of both views: edges that move, a slope, and a few that are not numbers.
fn alpha(index: u64) -> Option<Vec<Image<f32>>> {
    let of = |v: u64| {
        Image::from_fn(SIZE, |[x, y]| match (u64::from(x) + 3 * index, u64::from(x + y) + v) {
            (moved, _) if moved % 24 < 10 => 0.0,
            (_, place) if place % 31 == 0 => f32::NAN,
            (_, place) => 0.3 + 0.01 * (place % 70) as f32,
        })
    };
    Some((0..2).map(of).collect())
}

fn arrange(index: u64, rig: &mut Rig) -> Reset {
    rig.alpha = alpha(index);
    super::quads::reset_of(index, rig)
}

#[test]
fn alpha_is_bit_equal_on_both_executors() {
    for settings in [settings(false), settings(true), noisy()] {
        let Some(mut rig) = Rig::new(desc(), settings) else { return };
        for index in 0..FRAMES {
            let reset = arrange(index, &mut rig);
            let (made, _) = rig.both(index, reset, &frame(index, &settings));
            assert_eq!(made.alpha.len(), made.shown.len());
            assert!(made.alpha.iter().all(|&alpha| (0.0..=1.0).contains(&f32::from_bits(alpha))));
        }
    }
}

#[test]
fn alpha_follows_a_change_of_size() {
    for settings in [settings(false), settings(true)] {
        let Some(mut rig) = Rig::new(ContextDesc::new([40, 30]), settings) else { return };
        for (index, size) in (0..).zip([[40, 30], [40, 30], [40, 30], [52, 36], [52, 36], [33, 21]]) {
            if rig.context.size_px != size {
                rig.resize_keeping_history(size);
            }
            rig.alpha = Some(vec![Image::from_fn(size, |[x, y]| ((x * y) % 7) as f32 / 7.0)]);
            rig.both(index, Reset::None, &[View::still(noise(size, "alpha"), [20.0, 12.0])]);
        }
    }
}

#[test]
fn wrong_alpha_is_caught() {
    let planted = [
        ("select(candidate.alpha, pixel.alpha.x, HAS_ALPHA != 0u)", "candidate.alpha"),
        ("bitcast<f32>(extra_word(texel, view))", "bitcast<f32>(extra_word(first, view))"),
        ("clamp(shown.color.x, shown.lowest.x, shown.highest.x)", "shown.color.x"),
        ("bitcast<u32>(pixel.alpha.y)", "bitcast<u32>(pixel.alpha.x)"),
        ("past.mean, noise, past.alpha, 1.0)", "past.mean, noise, vec2f(1.0), 1.0)"),
        ("let old = select(history, nearest, r.keeps_nearest);", "let old = history;"),
        ("history * r.share", "history * r.stored_share"),
        ("return select(1.0, given, is_finite(given));", "return select(0.0, given, is_finite(given));"),
    ];
    let of = |settings: Settings, planted: &[(&str, &str)]| {
        rig::all_caught_in(["quad_pass"], desc(), settings, FRAMES, planted, |index, rig| {
            (arrange(index, rig), frame(index, &settings))
        });
    };
    of(settings(false), &planted);
    of(settings(true), &[("select(history, nearest, r.keeps_nearest)", "history"), planted[1]]);
}

/// Two texels of four bytes a pixel, of planned frames with alpha alone.
#[test]
fn alpha_that_is_not_kept_takes_no_memory() {
    let Some(device) = afterimage_testing::gpu::device() else { return };
    let bytes = |settings, keep_alpha| {
        let desc = ContextDesc { settings, keep_alpha, ..ContextDesc::new(SIZE) };
        let post = Afterimage::new(&device.0, &desc, TextureFormat::Rgba16Float).unwrap();
        let is_planned_smr =
            settings.method.kind() == MethodKind::Smr && settings.foveation.kind == FoveationKind::Quads;
        assert_eq!(post.alpha_texture().is_some(), keep_alpha && is_planned_smr);
        post.memory_bytes()
    };
    let pixels = u64::from(SIZE[0] * SIZE[1]);
    for settings in [settings(false), settings(true), noisy()] {
        assert_eq!(bytes(settings, true) - bytes(settings, false), 8 * pixels);
    }
    let taa = Settings { method: Method::Taa, ..settings(false) };
    for settings in [taa, Settings::default()] {
        assert_eq!(bytes(settings, true), bytes(settings, false));
    }
}

//! Planned frames: filled for the methods that read whole frames, and what smr keeps of them.

use super::*;

pub(super) const SIZE: [u32; 2] = [70, 41];

pub(super) fn settings(method: MethodKind) -> Settings {
    let regions = Foveation { fovea_deg: 12.0, mid_deg: 30.0, ..Foveation::quads() };
    let foveation = Foveation { rate_mid: 2, rate_far: 8, single_pixels: true, ..regions };
    Settings { method: method.into(), foveation, ..Settings::paper() }
}

pub(super) fn desc() -> ContextDesc {
    ContextDesc { view_count: 2, ..ContextDesc::new(SIZE) }
}

/// Two views with noise; some samples are not finite.
fn noisy_views(index: u64, _: &Settings) -> Vec<View> {
    let view = |v: u32| {
        let mut draws = Draws::new(&format!("noisy {index} {v}"));
        let noise = Image::from_fn(SIZE, |[x, _]| {
            let error = [0.0, 0.02, 0.2][(x / 11) as usize % 3] * draws.uniform();
            [if draws.uniform() < 0.02 { f32::NAN } else { error }, 1.0 + (draws.bits() % 4) as f32]
        });
        View { noise: Some(noise), ..gliding_view(index, v) }
    };
    (0..2).map(view).collect()
}

fn views(index: u64, _: &Settings) -> Vec<View> {
    (0..2).map(|v| gliding_view(index, v)).collect()
}

/// Regions and exposures of frame `index`.
pub(super) fn arrange(index: u64, rig: &mut Rig) {
    rig.scattered = index % 4 == 3;
    rig.exposure = if index % 3 == 2 { Exposure::Changed { ratio: 1.25 } } else { Exposure::Same };
}

/// A view of a texture that glides across two depths under a light that changes; some samples are not finite.
pub(super) fn gliding_view(index: u64, v: u32) -> View {
    let t = index as f32;
    let mut draws = Draws::new(&format!("gliding {index} {v}"));
    let mut view = noise_view("gliding", &desc());
    let shift = |y: u32| if y < SIZE[1] / 2 { 1.3 } else { 0.4 };
    let light = [1.0, 1.0, 0.5, 1.5][index as usize % 4];
    view.color = Image::from_fn(SIZE, |[x, y]| {
        let (u, w) = (x as f32 + shift(y) * t, y as f32 - 0.8 * t + 7.0 * v as f32);
        let wave = |a: f32, b: f32| (0.5 + 0.4 * (a * u + b * w).sin()) * light;
        if draws.uniform() < 0.1 { [f32::NAN; 3] } else { [wave(1.1, 0.4), wave(0.3, 1.3), wave(0.9, 0.9)] }
    });
    view.depth = Some(Image::from_fn(SIZE, |[_, y]| if y < SIZE[1] / 2 { 2.0 + 0.01 * t } else { 6.5 }));
    // Vectors that contradict their depth in a corner.
    view.motion = Some(Image::from_fn(SIZE, |[x, y]| if x < 12 { [0.0, 25.0] } else { [shift(y), -0.8] }));
    view.trust = Some(Image::from_fn(SIZE, |[x, _]| if x % 9 == 0 { draws.uniform() } else { 1.0 }));
    view
}

#[test]
fn a_wrong_pass_beside_those_of_smr_is_caught() {
    type Views = fn(u64, &Settings) -> Vec<View>;
    let [none, taau, wrs] = [MethodKind::None, MethodKind::Taau, MethodKind::Wrs].map(settings);
    let noisy = Settings { noisy: true, ..wrs };
    let views: Views = views;
    let planted: [(Settings, Views, &str, (&str, &str)); 8] = [
        (none, views, "quad_fill_pass", ("bitcast<f32>(frame.missing)", "0.0")),
        (none, views, "quad_fill_pass", (", view, COLOR_IN)", ", 0u, COLOR_IN)")),
        (taau, views, "taau_pass", ("tail(confidence * source.previous.trust)", "tail(0.0)")),
        (taau, views, "taau_pass", ("!is_shaded(at, view)", "false")),
        (wrs, views, "wrs_quad_pass", ("place_weight(vec2f(offset))", "1.0")),
        (noisy, noisy_views, "wrs_quad_pass", ("px2 < nearest_px2", "px2 <= nearest_px2")),
        (wrs, views, "wrs_quad_pass", ("if is_shaded(mask_word, px) {", "if false {")),
        (noisy, noisy_views, "wrs_quad_pass", ("noise_at(place.px, view)", "noise_at(px, view)")),
    ];
    for (settings, views, pass, error) in planted {
        rig::all_caught_in([pass], desc(), settings, 6, &[error], |index, rig| {
            rig.scattered = index > 1;
            (Reset::None, views(index, &settings))
        });
    }
}

/// Pictures, decisions and history of every method, with noise and without it.
#[test]
fn every_method_is_bit_equal_on_both_executors() {
    let wrs = Wrs { sampler: Sampler::AEs, ..Wrs::default() };
    let keyed = Settings { method: Method::Wrs(wrs), ..settings(MethodKind::Wrs) };
    let weighted = Settings { foveation: settings(MethodKind::Wrs).foveation, ..Settings::weighted() };
    let noisy = MethodKind::ALL.map(|method| Settings { noisy: true, ..settings(method) });
    let all = MethodKind::ALL.map(settings).into_iter().chain([keyed, weighted]).chain(noisy);
    for settings in all {
        let Some(mut rig) = Rig::new(desc(), settings) else { return };
        for index in 0..8 {
            arrange(index, &mut rig);
            let views = if settings.noisy { noisy_views(index, &settings) } else { views(index, &settings) };
            rig.both(index, Reset::None, &views);
        }
    }
}

#[test]
fn filled_color_follows_size_and_settings() {
    let context = ContextDesc::new(SIZE);
    let Some(mut rig) = Rig::new(context, settings(MethodKind::Taa)) else { return };
    let view = |size: [u32; 2], index: u64| [View::still(noise(size, &format!("follows {index}")), [20.0, 20.0])];
    rig.both(0, Reset::None, &view(SIZE, 0));
    rig.resize([33, 50]);
    rig.both(1, Reset::None, &view([33, 50], 1));
    rig.resize_keeping_history([40, 20]);
    rig.both(2, Reset::None, &view([40, 20], 2));
    // Settings with and without planned frames; history survives.
    let whole = Settings { method: Method::Taa, ..Settings::paper() };
    for (index, settings) in [(3, whole), (4, settings(MethodKind::Taa)), (5, settings(MethodKind::Wrs))] {
        rig.set_settings(settings);
        rig.both(index, Reset::None, &view([40, 20], index));
    }
}

#[test]
fn alpha_is_filled_as_color_is() {
    let format = TextureFormat::Rgba32Float;
    let desc = ContextDesc { settings: settings(MethodKind::None), ..ContextDesc::new(SIZE) };
    let Some(bare) = Bare::new(desc) else { return };
    // A constant, which is filled as it is, with an alpha that is not finite in the first pixel.
    let texel = |i: u32| [0.5, 0.5, 0.5, if i == 0 { f32::NAN } else { 0.25 }];
    let color = bare.filled(format, &(0..70 * 41).map(texel).collect::<Vec<_>>());
    let mask = Image::from_fn(SIZE, |px| if px.map(|v| v % 8) == [0, 0] { 1.0_f32 } else { 0.0 });
    let mask = bare.filled(TextureFormat::R32Float, &mask.pixels().iter().map(|&v| [v]).collect::<Vec<_>>());
    let output = bare.output(format);
    let frame = Frame { mask: Some((&mask).into()), ..Frame::new(&color, &bare.views, 0) };
    bare.record(&mut bare.context(format), &frame, &output).unwrap();
    let alpha: Vec<f32> = bare.read(&output).chunks(4).map(|c| f32::from_bits(c[3])).collect();
    assert_eq!(alpha[0], 1.0, "{:?}", &alpha[..20]);
    // Far from the first pixel all samples have the same alpha; beside it, it counts as 1.
    assert!(alpha[1] > 0.9);
    assert!(alpha.iter().skip(70 * 18).all(|alpha| (alpha - 0.25).abs() < 1e-6));
}

#[test]
fn prewarmed_pipelines_suffice_for_planned_frames() {
    let settings = settings(MethodKind::None);
    let Some(bare) = Bare::new(ContextDesc { settings, ..ContextDesc::new(SIZE) }) else { return };
    let mut post = bare.context(TextureFormat::Rgba32Float);
    let [color, output] = [(); 2].map(|()| bare.texture(TextureFormat::Rgba32Float, super::limits::READ_AND_WRITE));
    let counters = rig::make_counters(&bare.device);
    let counted = Target { counters: Some(&counters), ..Target::new(&output) };
    let frame = Frame::new(&color, &bare.views, 0);
    // A region for the output alone.
    let region = [Region::new(&output, [0, 0])];
    post.prewarm(&bare.device, &frame, counted);
    post.prewarm(&bare.device, &frame, Textures::Regions(&region));
    let prewarmed = post.pipelines().len();
    bare.plan(&mut post, &frame);
    bare.record(&mut post, &frame, counted).unwrap();
    let frame = Frame { index: 1, ..frame };
    bare.plan(&mut post, &frame);
    bare.record(&mut post, &frame, Textures::Regions(&region)).unwrap();
    assert_eq!(post.pipelines().len(), prewarmed);
    let counted = afterimage_testing::gpu::read_buffer(&bare.device, &bare.queue, &counters);
    assert_eq!(afterimage::FrameStats::from_counters(&counted).unwrap().pixels, 70 * 41);
}

const PASSES: [&str; 3] = ["quad_observe_pass", "quad_rectify_pass", "quad_pass"];

#[test]
fn a_wrong_reconstruction_is_caught() {
    let planted = [
        ("vec2i(frame.size) - 1), view, 0)", "vec2i(frame.size) - 1), 1u - view, 0)"),
        ("found.highest = expose(found.highest, frame.exposure);", ""),
        ("without += errors * near.weight;", ""),
        ("pixel.result.stored.disparity = surface.stored_disparity;", ""),
    ];
    let settings = super::quads::settings(false);
    rig::all_caught_in(PASSES, desc(), settings, 8, &planted, |index, rig| {
        arrange(index, rig);
        (Reset::None, views(index, &settings))
    });
    let noisy = Settings { foveation: settings.foveation, ..Settings::traced() };
    let planted = [
        ("textureLoad(past_noise, at, view, 0)", "textureLoad(past_noise, at, 1u - view, 0)"),
        ("blended.noise = accumulated.noise;", ""),
    ];
    rig::all_caught_in(PASSES, desc(), noisy, 8, &planted, |index, rig| {
        arrange(index, rig);
        (Reset::None, noisy_views(index, &noisy))
    });
}

#[test]
fn any_masks_and_any_bits_agree_bit_for_bit_and_are_finite() {
    use crate::any_frame::{SIZE, any_frame};
    for method in MethodKind::ALL {
        let settings = settings(method);
        let Some(mut rig) = Rig::new(ContextDesc { view_count: 2, ..ContextDesc::new(SIZE) }, settings) else { return };
        let mut draws = Draws::new("any masks");
        for index in 0..40 {
            rig.scattered = index % 5 == 4;
            let wild = [0.0, 0.02, 0.3, 1.0][index as usize % 4];
            let share = [0.0, 0.02, 0.2, 0.9][index as usize / 4 % 4];
            let views = [0; 2].map(|_| {
                let frame = any_frame(&mut draws, wild);
                let mask = Image::from_fn(SIZE, |_| if draws.uniform() < share { 1.0 } else { 0.0 });
                // Every third frame is planned.
                let mask = (index % 3 > 0).then_some(mask);
                View { lod: None, noise: None, mask, ..frame }
            });
            let (made, _) = rig.both(index, if index % 6 == 0 { Reset::All } else { Reset::None }, &views);
            assert!(made.shown.iter().flatten().all(|&v| f32::from_bits(v).abs() <= 65504.0));
        }
    }
}

#[test]
fn history_of_planned_frames_follows_a_change_of_size() {
    let of = settings(MethodKind::Smr);
    let settings = Settings { foveation: Foveation { rate_far: 4, ..of.foveation }, ..of };
    let Some(mut rig) = Rig::new(ContextDesc::new([64, 40]), settings) else { return };
    let view = |size: [u32; 2]| {
        let wave = |v: u32, n: u32| 0.5 + 0.4 * ((v as f32 + 0.5) / n as f32 * 40.0).sin();
        let color = Image::from_fn(size, |[x, y]| [wave(x, size[0]), wave(y, size[1]), 0.3]);
        View::still(color, size.map(|side| side as f32 * 0.5))
    };
    for index in 0..48 {
        rig.both(index, Reset::None, &[view([64, 40])]);
    }
    for (index, size) in [(48, [64, 40]), (49, [80, 50]), (50, [64, 40]), (51, [33, 21])] {
        rig.resize_keeping_history(size);
        let now = view(size);
        let (made, _) = rig.both(index, Reset::None, std::slice::from_ref(&now));
        let pairs = made.shown.iter().flatten().zip(now.color.pixels().iter().flatten());
        let sum: f32 = pairs.map(|(&shown, full)| (f32::from_bits(shown) - full).powi(2)).sum();
        let rms = (sum / (3 * made.shown.len()) as f32).sqrt();
        println!("{size:?}: {rms:.4}");
        // Without history, what lies between samples is off by 0.2.
        assert!(rms < 0.1, "{size:?}: {rms}");
    }
}

#[test]
fn noise_of_planned_frames_takes_8_bytes_a_pixel_and_means_take_none() {
    let bytes = |size: [u32; 2], view_count, settings| {
        let desc = ContextDesc { settings, view_count, ..ContextDesc::new(size) };
        Afterimage::memory_bytes_of(&desc) as f64 / f64::from(size[0] * size[1] * view_count)
    };
    for (size, view_count) in [([1920, 1080], 1), ([480, 270], 2), ([3840, 2160], 1)] {
        let calm = bytes(size, view_count, settings(MethodKind::Smr));
        println!("{size:?}: {calm:.2} bytes a pixel and view");
        let method = Method::Smr(Smr { antialias: true, ..Smr::default() });
        let antialiased = Settings { method, ..settings(MethodKind::Smr) };
        assert_eq!(bytes(size, view_count, antialiased), calm, "means take no memory");
        let noisy = bytes(size, view_count, Settings { noisy: true, ..settings(MethodKind::Smr) });
        assert!((noisy - calm - 8.0).abs() < 1e-9, "{noisy}, {calm}");
    }
}

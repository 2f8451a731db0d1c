//! What engines bring: regions, jitter, depth conventions that change, alpha, formats, prewarmed pipelines, debug views
//! beside the frame, resolutions that change.

use super::*;
use afterimage::wgpu::Features;
use std::collections::HashSet;

const SIZE: [u32; 2] = [70, 41];

fn all_settings() -> impl Iterator<Item = Settings> {
    let plain = MethodKind::ALL.map(|kind| Settings { method: kind.into(), ..Settings::default() });
    plain.into_iter().chain([Settings::traced(), Settings::weighted()])
}

/// Views with all inputs that the settings allow.
fn full_views(index: u64, desc: &ContextDesc, settings: &Settings) -> Vec<View> {
    let view = |v: u32| {
        let name = format!("engine {index} {v}");
        let mask = noise(desc.size_px, &format!("{name} mask")).map(|c| c[0]);
        let noisy = || noise(desc.size_px, &format!("{name} noise")).map(|c| [0.1 * c[0], 1.0 + 8.0 * c[1]]);
        View {
            trust: Some(mask.map(|t| 0.5 + 0.5 * t)),
            lod: Some(mask.map(|t| 4.0 * t)),
            noise: settings.noisy.then(noisy),
            ..noise_view(&name, desc)
        }
    };
    (0..desc.view_count).map(view).collect()
}

#[test]
fn regions_that_cannot_be_are_refused() {
    let Some(bare) = Bare::new(ContextDesc::new(SIZE)) else { return };
    let mut post = bare.context(TextureFormat::Rgba16Float);
    let large = ContextDesc { view_count: 2, ..ContextDesc::new([100, 50]) };
    let color = make_texture(&bare.device, &large, TextureFormat::Rgba16Float, Afterimage::INPUT_USAGE);
    let output = bare.texture(TextureFormat::Rgba16Float, Afterimage::OUTPUT_USAGE);
    let mut try_regions = |regions: &[Region<'_>]| {
        let frame = Frame::new(Textures::Regions(regions), &bare.views, 0);
        bare.record(&mut post, &frame, &output).map_err(|error| error.to_string())
    };
    let fits = Region { layer: 1, ..Region::new(&color, [30, 9]) };
    assert_eq!(try_regions(&[fits]), Ok(()));
    let refusals = [
        (&[][..], "0 views given: expected 1, the context's view_count"),
        (&[fits, fits], "2 views given: expected 1, the context's view_count"),
        (
            &[Region::new(&color, [31, 9])],
            "color of view 0 is a region of 70x41 from (31, 9) in a texture of 100x50: expected a rectangle of the \
             context's size inside the texture",
        ),
        (
            &[Region { layer: 2, ..fits }],
            "color is a texture of format Rgba16Float, with 2 layers, for layer 2: expected a layer that exists",
        ),
        (
            &[Region::new(&output, [0, 0])],
            "color is a texture of format Rgba16Float, without a required usage: expected the usage TEXTURE_BINDING",
        ),
    ];
    for (regions, expected) in refusals {
        assert_eq!(try_regions(regions), Err(expected.to_owned()));
    }
}

#[test]
fn a_view_beside_the_frame_is_the_view_alone_and_changes_no_frame() {
    let desc = ContextDesc { view_count: 2, ..ContextDesc::new(SIZE) };
    // Each view of each method compiles two pipelines: the methods take turns.
    let mut in_turn = DebugView::ALL.into_iter().cycle();
    for settings in all_settings() {
        let Some(mut rig) = Rig::new(desc, settings) else { return };
        let mut seen = HashSet::new();
        for (index, view) in (0..).zip(in_turn.by_ref().take(3)) {
            let views = full_views(index, &desc, &settings);
            rig.scattered = index % 2 == 1;
            let alone = rig.decisions(index, Reset::None, &views, view);
            rig.beside = Some(view);
            rig.both(index, Reset::None, &views);
            rig.beside = None;
            // Halves, two in a word: red and green, blue and alpha. Devices may round them differently.
            let beside = rig.beside();
            let half = |bits: u32| pack::half_value(bits & 0xffff);
            let drawn = beside.chunks_exact(2).map(|w| [half(w[0]), half(w[0] >> 16), half(w[1])]);
            for (drawn, alone) in drawn.zip(alone) {
                let expected = alone.map(f32::from_bits);
                let is_near = |i: usize| (drawn[i] - expected[i]).abs() <= expected[i] / 1024.0 + 1e-7;
                assert!((0..3).all(is_near), "{:?}, {view:?}: {drawn:?}, {alone:?}", settings.method);
            }
            seen.insert(beside);
        }
        assert!(seen.len() > 1 || settings.method == Method::None, "views differ from each other");
    }
}

#[test]
fn a_view_beside_the_frame_needs_a_limit() {
    // WebGPU's default limit is 4.
    let Some(bare) = Bare::new(ContextDesc::new(SIZE)) else { return };
    let mut post = bare.context(TextureFormat::Rgba16Float);
    let (color, output) = (bare.input(TextureFormat::Rgba16Float), bare.output(TextureFormat::Rgba16Float));
    let debug = DebugTarget { view: DebugView::Agreement, output: (&output).into() };
    let target = Target { debug: Some(debug), ..Target::new(&output) };
    let error = bare.refusal(&mut post, &Frame::new(&color, &bare.views, 0), target);
    assert!(error.ends_with("expected a limit of 5; or Afterimage::record_view"), "{error}");
}

/// Inputs and outputs that a frame has.
#[derive(Clone, Copy, Default)]
struct Has {
    depth: bool,
    motion: bool,
    trust: bool,
    lod: bool,
    counters: bool,
    regions: bool,
    exposure: bool,
    debug: bool,
}

impl Has {
    /// All combinations without regions, exposures and debug views.
    fn all() -> impl Iterator<Item = Self> {
        (0..32_u32).map(|bits| {
            let bit = |i: u32| bits >> i & 1 == 1;
            Self { depth: bit(0), motion: bit(1), trust: bit(2), lod: bit(3), counters: bit(4), ..Self::default() }
        })
    }
}

#[test]
fn record_compiles_nothing_after_prewarm() {
    let Some(device) = rig::device_of_five_outputs() else { return };
    for settings in all_settings() {
        let bare = Bare::on(device.clone(), ContextDesc { settings, ..ContextDesc::new([16, 16]) });
        let output = bare.output(TextureFormat::Rgba16Float);
        let [color, one, two] = [TextureFormat::Rgba16Float, TextureFormat::R32Float, TextureFormat::Rg32Float]
            .map(|format| bare.input(format));
        let counters = rig::make_counters(&bare.device);
        let mut post = bare.context(output.format());
        let beside = Has { depth: true, debug: true, regions: true, ..Has::default() };
        let usual = Has { depth: true, motion: true, ..Has::default() };
        let rest = Has { trust: true, lod: true, counters: true, ..usual };
        let exposed = Has { exposure: true, ..usual };
        let mut variants = vec![Has::default(), usual, rest, beside, exposed];
        if settings.method == Method::None {
            // All of them only for the method that compiles fastest.
            variants.extend(Has::all());
        }
        let region = [Region::new(&color, [0, 0])];
        let with = |index: usize, has: Has, then: &mut dyn FnMut(&Frame<'_>, Target<'_>)| {
            let color = if has.regions { Textures::Regions(&region) } else { (&color).into() };
            let frame = Frame {
                depth: has.depth.then_some((&one).into()),
                motion: has.motion.then_some((&two).into()),
                trust: has.trust.then_some((&one).into()),
                lod: has.lod.then_some((&one).into()),
                noise: settings.noisy.then_some((&two).into()),
                exposure: match index {
                    _ if has.exposure => Exposure::Scene { exposure: 0.5 },
                    i if i.is_multiple_of(3) => Exposure::Changed { ratio: 2.0 },
                    _ => Exposure::Same,
                },
                reset: if index.is_multiple_of(5) { Reset::All } else { Reset::None },
                ..Frame::new(color, &bare.views, index as u64)
            };
            let debug = has.debug.then_some(DebugTarget { view: DebugView::Agreement, output: (&output).into() });
            // The debug view and the frame are never the same texture.
            let shown = bare.output(TextureFormat::Rgba16Float);
            let counters = has.counters.then_some(&counters);
            then(&frame, Target { debug, counters, ..Target::new(&shown) });
        };
        let record = |post: &mut Afterimage, index: usize, has: Has| {
            with(index, has, &mut |frame, target| bare.record(post, frame, target).unwrap());
        };
        // The counter counts: without prewarming, a frame compiles.
        record(&mut post, 1, variants[2]);
        assert!(!post.pipelines().is_empty());
        for &variant in &variants {
            with(0, variant, &mut |frame, target| post.prewarm(&bare.device, frame, target));
        }
        let count = post.pipelines().len();
        for (index, variant) in variants.into_iter().enumerate() {
            record(&mut post, index, variant);
        }
        assert_eq!(post.pipelines().len(), count, "{:?}", settings.method);
    }
}

#[test]
fn jitter_is_removed_from_vectors_that_contain_it() {
    let jitters = [[0.25, -0.375], [-0.5, 0.125], [0.375, 0.25], [0.0, -0.25]];
    let conventions = [MotionConvention::FSR2, MotionConvention::UNREAL].into_iter().cycle();
    for (settings, motion) in all_settings().zip(conventions) {
        let with = MotionConvention { jittered: true, ..motion };
        let desc = ContextDesc { motion: with, ..ContextDesc::new([64, 32]) };
        let plain = ContextDesc { motion, ..desc };
        let Some([mut rig, mut other]) = Rig::each([desc, plain].map(|desc| (desc, settings))) else { return };
        let mut before = [0.0; 2];
        for (index, jitter_px) in (0..).zip(jitters) {
            let views = full_views(index, &plain, &settings);
            let scale = motion.to_internal(plain.size_px);
            // Previous minus current position, both jittered.
            let added = [0, 1].map(|i| (before[i] - jitter_px[i]) / scale[i]);
            let aware = |view: &View| view.clone().with(|view| view.facts.jitter_px = jitter_px);
            let jittered = |view: &View| View {
                motion: view.motion.as_ref().map(|m| m.map(|v| [v[0] + added[0], v[1] + added[1]])),
                ..aware(view)
            };
            let (with, without): (Vec<_>, Vec<_>) = views.iter().map(|v| (jittered(v), aware(v))).unzip();
            let (made, _) = rig.both(index, Reset::None, &with);
            if index == 3 && settings.method != Method::None {
                // The planted error: vectors with jitter, said to have none.
                assert!(made.shown != other.on_gpu(index, Reset::None, &with).shown, "{:?}", settings.method);
            } else {
                let (expected, _) = other.both(index, Reset::None, &without);
                assert!(made.shown == expected.shown, "{:?}, frame {index}", settings.method);
            }
            before = jitter_px;
        }
    }
}

#[test]
fn history_survives_a_change_of_the_near_plane() {
    let desc = ContextDesc { depth: DepthConvention::Linear, ..ContextDesc::new(SIZE) };
    let Some(mut rig) = Rig::new(desc, Settings::paper()) else { return };
    let planes = [
        None,
        Some(DepthConvention::Reversed { near: 0.1, far: f32::INFINITY }),
        Some(DepthConvention::Reversed { near: 0.5, far: 200.0 }),
        Some(DepthConvention::Forward { near: 0.05, far: 100.0 }),
    ];
    for (index, depth) in (0..).zip(planes) {
        let stated = ContextDesc { depth: depth.unwrap_or(desc.depth), ..desc };
        let view = View { motion: None, ..noise_view("near plane", &stated) };
        let view = View { facts: ViewFrame { depth, ..view.facts }, ..view };
        let (made, _) = rig.both(index, Reset::None, std::slice::from_ref(&view));
        if index > 0 {
            assert_eq!(made.stats.valid(), made.stats.pixels, "frame {index}: {:?}", made.stats);
            // The planted error: the plane of the frame before.
            let stale = View { facts: ViewFrame { depth: planes[index as usize - 1], ..view.facts }, ..view };
            rig.decisions(index + 1, Reset::None, &[stale], DebugView::Rejection);
            let stats = rig.read().stats;
            assert!(stats.valid() < stats.pixels, "frame {index}: {stats:?}");
        }
    }
}

#[test]
fn alpha_is_kept_or_one() {
    let Some(device) = afterimage_testing::gpu::device() else { return };
    for (settings, keep_alpha) in all_settings().flat_map(|s| [(s, true), (s, false)]) {
        let bare = Bare::on(device.clone(), ContextDesc { settings, keep_alpha, ..ContextDesc::new([16, 8]) });
        let alphas = |i: u32| if i.is_multiple_of(7) { f32::NAN } else { i as f32 / 128.0 };
        let pixels: Vec<[f32; 4]> = (0..128).map(|i| [0.5, 0.25, 0.125, alphas(i)]).collect();
        let color = bare.filled(TextureFormat::Rgba32Float, &pixels);
        let noisy = bare.filled(TextureFormat::Rg32Float, &[[0.1_f32, 4.0]; 128]);
        let output = bare.output(TextureFormat::Rgba32Float);
        let mut post = bare.context(output.format());
        for index in 0..2 {
            let noise = settings.noisy.then_some((&noisy).into());
            let frame = Frame { noise, ..Frame::new(&color, &bare.views, index) };
            bare.record(&mut post, &frame, &output).unwrap();
            for (i, alpha) in (0_u32..).zip(bare.read(&output).iter().skip(3).step_by(4)) {
                let expected = if keep_alpha && !i.is_multiple_of(7) { alphas(i) } else { 1.0 };
                assert_eq!(f32::from_bits(*alpha), expected, "{:?}, pixel {i}", settings.method);
            }
        }
    }
}

#[test]
fn every_storable_format_is_written_and_others_say_what_to_change() {
    let Some(adapter) = afterimage_testing::gpu::adapter() else { return };
    let wanted = Features::BGRA8UNORM_STORAGE
        | Features::TEXTURE_FORMAT_16BIT_NORM
        | Features::TEXTURE_ADAPTER_SPECIFIC_FORMAT_FEATURES;
    let desc = wgpu::DeviceDescriptor { required_features: adapter.features() & wanted, ..Default::default() };
    let bare = Bare::on(pollster::block_on(adapter.request_device(&desc)).unwrap(), ContextDesc::new([16, 8]));
    let (plain, _) = afterimage_testing::gpu::device().unwrap();
    let color = bare.filled(TextureFormat::Rgba16Float, &[[0x3800_u16, 0x3400, 0x3000, 0x3c00]; 128]);
    let formats = [
        (TextureFormat::Rgba16Float, true),
        (TextureFormat::Rgba32Float, true),
        (TextureFormat::Rgba8Unorm, true),
        (TextureFormat::Rgba8Snorm, true),
        (TextureFormat::Bgra8Unorm, false),
        (TextureFormat::Rgba16Unorm, false),
        (TextureFormat::Rgba16Snorm, false),
        (TextureFormat::Rgb10a2Unorm, false),
        (TextureFormat::Rg11b10Ufloat, false),
    ];
    let mut written = 0;
    for (format, always) in formats {
        match Afterimage::new(&plain, &bare.desc, format) {
            Ok(_) => assert!(always, "{format:?}"),
            Err(CreateError::OutputFormat { expected, .. }) => {
                assert!(!always && expected.contains("Features::"), "{format:?}: {expected}");
            }
            Err(other) => panic!("{format:?}: {other}"),
        }
        let usages = adapter.get_texture_format_features(format).allowed_usages;
        let made = Afterimage::new(&bare.device, &bare.desc, format);
        if !usages.contains(TextureUsages::STORAGE_BINDING) {
            println!("{format:?}: the adapter cannot store to it");
            continue;
        }
        let mut post = made.unwrap_or_else(|e| panic!("{format:?}: {e}"));
        let output = bare.output(format);
        bare.record(&mut post, &Frame::new(&color, &bare.views, 0), &output).unwrap();
        let texels = bare.read(&output);
        assert!(texels.iter().all(|&t| t != 0), "{format:?}: {:x?}", &texels[..4]);
        written += 1;
    }
    assert!(written >= 4, "{written} formats");
    for format in [TextureFormat::Rgba8UnormSrgb, TextureFormat::Bgra8UnormSrgb, TextureFormat::R16Float] {
        let error = Afterimage::new(&bare.device, &bare.desc, format).unwrap_err();
        assert!(error.to_string().contains("Rgba16Float"), "{error}");
    }
}

#[test]
fn resized_history_agrees() {
    for settings in all_settings() {
        let desc = ContextDesc { view_count: 2, ..ContextDesc::new(SIZE) };
        let Some(mut rig) = Rig::new(desc, settings) else { return };
        let mut index = 0;
        for size in [[70, 41], [64, 36], [96, 54], [35, 21], [131, 77]] {
            rig.resize_keeping_history(size);
            let [cpu, gpu] = rig.histories();
            // An adapter that rounds otherwise may store neighbours; what it shows is compared below.
            if settings.method != Method::None && afterimage_testing::gpu::rounds_as_the_cpu() {
                assert!(cpu == gpu, "{:?} at {size:?}", settings.method);
            }
            let desc = ContextDesc { size_px: size, ..desc };
            for _ in 0..2 {
                rig.both(index, Reset::None, &full_views(index, &desc, &settings));
                index += 1;
            }
        }
    }
}

#[test]
fn radiance_beyond_halves_is_shown_as_far_as_the_output_holds_it() {
    let settings = Settings { method: Method::None, ..Settings::default() };
    let Some(bare) = Bare::new(ContextDesc { settings, ..ContextDesc::new([16, 8]) }) else { return };
    let color = bare.filled(TextureFormat::Rgba32Float, &[[1e6_f32, 3.0, 1e30, 1.0]; 128]);
    let shown = |format| {
        let output = bare.output(format);
        let exposure = Exposure::Scene { exposure: 2.0_f32.powi(-12) };
        let frame = Frame { exposure, ..Frame::new(&color, &bare.views, 0) };
        bare.record(&mut bare.context(format), &frame, &output).unwrap();
        bare.read(&output)
    };
    let floats = shown(TextureFormat::Rgba32Float);
    let largest = 65504.0 * 4096.0;
    assert_eq!(floats[..4], [1e6, 3.0, largest, 1.0].map(f32::to_bits));
    // Halves, two in a word: 65504 and 3, 65504 and 1.
    assert_eq!(shown(TextureFormat::Rgba16Float)[..2], [0x4200_7bff, 0x3c00_7bff]);
}

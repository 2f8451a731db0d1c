//! What engines bring: regions, jitter, depth conventions that change, alpha, formats, prewarmed pipelines, debug views
//! beside the frame, resolutions that change.

use super::rig::{Rig, View, make_texture, noise, noise_view};
use afterimage::gpu::{Afterimage, Frame, Region, Target, Textures, Variant};
use afterimage::wgpu::{self, Features, TextureFormat, TextureUsages};
use afterimage::{
    ContextDesc, CreateError, DebugView, DepthConvention, Exposure, Method, MethodKind, MotionConvention, Reset,
    Settings, ViewFrame,
};

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
    let Some((device, _queue)) = afterimage_testing::gpu::device() else { return };
    let desc = ContextDesc::new(SIZE);
    let mut post = Afterimage::new(&device, &desc, TextureFormat::Rgba16Float).unwrap();
    let large = ContextDesc { view_count: 2, ..ContextDesc::new([100, 50]) };
    let color = make_texture(&device, &large, TextureFormat::Rgba16Float, Afterimage::INPUT_USAGE);
    let output = make_texture(&device, &desc, TextureFormat::Rgba16Float, Afterimage::OUTPUT_USAGE);
    let view = View::still(noise(SIZE, "facts"), [3.0, 4.0]);
    let views = [view.facts];
    let mut try_regions = |regions: &[Region<'_>]| {
        let mut encoder = device.create_command_encoder(&Default::default());
        let frame = Frame::new(Textures::Regions(regions), &views, 0);
        post.record(&device, &mut encoder, &frame, &output).map(|_| ()).map_err(|e| e.to_string())
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
        let mut seen = std::collections::HashSet::new();
        for (index, view) in (0..).zip(in_turn.by_ref().take(3)) {
            let views = full_views(index, &desc, &settings);
            rig.scattered = index % 2 == 1;
            let alone = rig.decisions(index, Reset::None, &views, view);
            rig.beside = Some(view);
            rig.both(index, Reset::None, &views);
            rig.beside = None;
            // Halves, two in a word: red and green, blue and alpha. Devices may round them differently.
            let beside = rig.beside();
            let half = |bits: u32| afterimage::kernel::pack::half_value(bits & 0xffff);
            let drawn = beside.chunks_exact(2).map(|w| [half(w[0]), half(w[0] >> 16), half(w[1])]);
            for (drawn, alone) in drawn.zip(alone) {
                let near =
                    |i: usize| (drawn[i] - f32::from_bits(alone[i])).abs() <= f32::from_bits(alone[i]) / 1024.0 + 1e-7;
                assert!((0..3).all(near), "{:?}, {view:?}: {drawn:?}, {alone:?}", settings.method);
            }
            seen.insert(beside);
        }
        assert!(seen.len() > 1 || settings.method == Method::None, "views differ from each other");
    }
}

#[test]
fn a_view_beside_the_frame_needs_a_limit() {
    // WebGPU's default limit is 4.
    let Some((device, _queue)) = afterimage_testing::gpu::device() else { return };
    let desc = ContextDesc::new(SIZE);
    let mut post = Afterimage::new(&device, &desc, TextureFormat::Rgba16Float).unwrap();
    let texture = |usage| make_texture(&device, &desc, TextureFormat::Rgba16Float, usage);
    let (color, output) = (texture(Afterimage::INPUT_USAGE), texture(Afterimage::OUTPUT_USAGE));
    let views = [View::still(noise(SIZE, "facts"), [3.0, 4.0]).facts];
    let debug = afterimage::gpu::DebugTarget { view: DebugView::Gate, output: (&output).into() };
    let target = Target { debug: Some(debug), ..Target::new(&output) };
    let mut encoder = device.create_command_encoder(&Default::default());
    let error = post.record(&device, &mut encoder, &Frame::new(&color, &views, 0), target).unwrap_err();
    assert!(error.to_string().ends_with("expected a limit of 5; or Afterimage::record_view"), "{error}");
}

#[test]
fn record_compiles_nothing_after_prewarm() {
    let required_limits = wgpu::Limits { max_storage_textures_per_shader_stage: 5, ..wgpu::Limits::default() };
    let desc = wgpu::DeviceDescriptor { required_limits, ..Default::default() };
    let Some((device, queue)) = afterimage_testing::gpu::device_with(&desc) else { return };
    for settings in all_settings() {
        let desc = ContextDesc { settings, ..ContextDesc::new([16, 16]) };
        let texture = |format, usage| make_texture(&device, &desc, format, usage);
        let output = texture(TextureFormat::Rgba16Float, Afterimage::OUTPUT_USAGE);
        let [color, one, two] = [TextureFormat::Rgba16Float, TextureFormat::R32Float, TextureFormat::Rg32Float]
            .map(|format| texture(format, Afterimage::INPUT_USAGE));
        let counters = device.create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size: afterimage::FrameStats::COUNTERS_BYTES,
            usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let mut post = Afterimage::new(&device, &desc, output.format()).unwrap();
        let beside = Variant { depth: true, debug: Some(DebugView::Gate), regions: true, ..Variant::default() };
        let usual = Variant { depth: true, motion: true, ..Variant::default() };
        let rest = Variant { trust: true, lod: true, counters: true, ..usual };
        let exposed = Variant { exposure: true, ..usual };
        let mut variants = vec![Variant::default(), usual, rest, beside, exposed];
        if settings.method == Method::None {
            // All of them only for the method that compiles fastest.
            variants.extend(Variant::all());
        }
        let views = [View::still(noise([16, 16], "facts"), [3.0, 4.0]).facts];
        let region = [Region::new(&color, [0, 0])];
        let record = |post: &mut Afterimage, index: usize, variant: Variant| {
            let frame = Frame {
                depth: variant.depth.then_some((&one).into()),
                motion: variant.motion.then_some((&two).into()),
                trust: variant.trust.then_some((&one).into()),
                lod: variant.lod.then_some((&one).into()),
                noise: settings.noisy.then_some((&two).into()),
                exposure: match index {
                    _ if variant.exposure => Exposure::Scene { exposure: 0.5 },
                    i if i.is_multiple_of(3) => Exposure::Changed { ratio: 2.0 },
                    _ => Exposure::Same,
                },
                reset: if index.is_multiple_of(5) { Reset::All } else { Reset::None },
                ..Frame::new(
                    if variant.regions { Textures::Regions(&region) } else { (&color).into() },
                    &views,
                    index as u64,
                )
            };
            let debug = variant.debug.map(|view| afterimage::gpu::DebugTarget { view, output: (&output).into() });
            // The debug view and the frame are never the same texture.
            let shown = texture(TextureFormat::Rgba16Float, Afterimage::OUTPUT_USAGE);
            let counters = variant.counters.then_some(&counters);
            let target = Target { debug, counters, ..Target::new(&shown) };
            assert_eq!(Variant::of(&frame, &target), variant);
            let mut encoder = device.create_command_encoder(&Default::default());
            post.record(&device, &mut encoder, &frame, target).unwrap();
            queue.submit([encoder.finish()]);
        };
        // The counter counts: without prewarming, a frame compiles.
        record(&mut post, 1, variants[2]);
        assert!(!post.pipelines().is_empty());
        post.prewarm(&device, variants.iter().copied());
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
        let (Some(mut rig), Some(mut other)) = (Rig::new(desc, settings), Rig::new(plain, settings)) else {
            return;
        };
        let mut before = [0.0; 2];
        for (index, jitter_px) in (0..).zip(jitters) {
            let views = full_views(index, &plain, &settings);
            let scale = motion.to_internal(plain.size_px);
            // Previous minus current position, both jittered.
            let added = [0, 1].map(|i| (before[i] - jitter_px[i]) / scale[i]);
            let jittered = |view: &View| View {
                facts: ViewFrame { jitter_px, ..view.facts },
                motion: view.motion.as_ref().map(|m| m.map(|v| [v[0] + added[0], v[1] + added[1]])),
                ..view.clone()
            };
            let aware = |view: &View| View { facts: ViewFrame { jitter_px, ..view.facts }, ..view.clone() };
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
    let Some((device, queue)) = afterimage_testing::gpu::device() else { return };
    let size = [16, 8];
    for (settings, keep_alpha) in all_settings().flat_map(|s| [(s, true), (s, false)]) {
        let desc = ContextDesc { settings, keep_alpha, ..ContextDesc::new(size) };
        let texture = |format, usage| make_texture(&device, &desc, format, usage | TextureUsages::COPY_DST);
        let color = texture(TextureFormat::Rgba32Float, Afterimage::INPUT_USAGE);
        let noisy = texture(TextureFormat::Rg32Float, Afterimage::INPUT_USAGE);
        let output = texture(TextureFormat::Rgba32Float, Afterimage::OUTPUT_USAGE | TextureUsages::COPY_SRC);
        let alphas = |i: u32| if i.is_multiple_of(7) { f32::NAN } else { i as f32 / 128.0 };
        let pixels: Vec<[f32; 4]> = (0..128).map(|i| [0.5, 0.25, 0.125, alphas(i)]).collect();
        afterimage_testing::gpu::write_layer(&queue, &color, 0, bytemuck::cast_slice(&pixels));
        afterimage_testing::gpu::write_layer(&queue, &noisy, 0, bytemuck::cast_slice(&vec![[0.1_f32, 4.0]; 128]));
        let mut post = Afterimage::new(&device, &desc, output.format()).unwrap();
        let views = [View::still(noise(size, "facts"), [3.0, 4.0]).facts];
        for index in 0..2 {
            let mut encoder = device.create_command_encoder(&Default::default());
            let noise = settings.noisy.then_some((&noisy).into());
            let frame = Frame { noise, ..Frame::new(&color, &views, index) };
            post.record(&device, &mut encoder, &frame, &output).unwrap();
            queue.submit([encoder.finish()]);
            let shown = afterimage_testing::gpu::read_texture(&device, &queue, &output);
            for (i, alpha) in (0_u32..).zip(shown.iter().skip(3).step_by(4)) {
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
    let (device, queue) = pollster::block_on(adapter.request_device(&desc)).unwrap();
    let (plain, _) = afterimage_testing::gpu::device().unwrap();
    let desc = ContextDesc::new([16, 8]);
    let color =
        make_texture(&device, &desc, TextureFormat::Rgba16Float, Afterimage::INPUT_USAGE | TextureUsages::COPY_DST);
    let halves = [0x3800_u16, 0x3400, 0x3000, 0x3c00].repeat(128);
    afterimage_testing::gpu::write_layer(&queue, &color, 0, bytemuck::cast_slice(&halves));
    let views = [View::still(noise([16, 8], "facts"), [3.0, 4.0]).facts];
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
        match Afterimage::new(&plain, &desc, format) {
            Ok(_) => assert!(always, "{format:?}"),
            Err(CreateError::OutputFormat { expected, .. }) => {
                assert!(!always && expected.contains("Features::"), "{format:?}: {expected}");
            }
            Err(other) => panic!("{format:?}: {other}"),
        }
        let usages = adapter.get_texture_format_features(format).allowed_usages;
        let made = Afterimage::new(&device, &desc, format);
        if !usages.contains(TextureUsages::STORAGE_BINDING) {
            println!("{format:?}: the adapter cannot store to it");
            continue;
        }
        let mut post = made.unwrap_or_else(|e| panic!("{format:?}: {e}"));
        let output = make_texture(&device, &desc, format, Afterimage::OUTPUT_USAGE | TextureUsages::COPY_SRC);
        afterimage_testing::gpu::validated(&device, "record", || {
            let mut encoder = device.create_command_encoder(&Default::default());
            post.record(&device, &mut encoder, &Frame::new(&color, &views, 0), &output).unwrap();
            queue.submit([encoder.finish()]);
        });
        let texels = afterimage_testing::gpu::read_texture(&device, &queue, &output);
        assert!(texels.iter().all(|&t| t != 0), "{format:?}: {:x?}", &texels[..4]);
        written += 1;
    }
    assert!(written >= 4, "{written} formats");
    for format in [TextureFormat::Rgba8UnormSrgb, TextureFormat::Bgra8UnormSrgb, TextureFormat::R16Float] {
        let error = Afterimage::new(&device, &desc, format).unwrap_err();
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
    let Some((device, queue)) = afterimage_testing::gpu::device() else { return };
    let desc =
        ContextDesc { settings: Settings { method: Method::None, ..Settings::default() }, ..ContextDesc::new([16, 8]) };
    let usage = Afterimage::INPUT_USAGE | TextureUsages::COPY_DST;
    let color = make_texture(&device, &desc, TextureFormat::Rgba32Float, usage);
    let radiance = [[1e6_f32, 3.0, 1e30, 1.0]; 128];
    afterimage_testing::gpu::write_layer(&queue, &color, 0, bytemuck::cast_slice(&radiance));
    let views = [View::still(noise([16, 8], "facts"), [3.0, 4.0]).facts];
    let shown = |format| {
        let mut post = Afterimage::new(&device, &desc, format).unwrap();
        let output = make_texture(&device, &desc, format, Afterimage::OUTPUT_USAGE | TextureUsages::COPY_SRC);
        let exposure = Exposure::Scene { exposure: 2.0_f32.powi(-12) };
        let mut encoder = device.create_command_encoder(&Default::default());
        post.record(&device, &mut encoder, &Frame { exposure, ..Frame::new(&color, &views, 0) }, &output).unwrap();
        queue.submit([encoder.finish()]);
        afterimage_testing::gpu::read_texture(&device, &queue, &output)
    };
    let floats = shown(TextureFormat::Rgba32Float);
    let largest = 65504.0 * 4096.0;
    assert_eq!(floats[..4], [1e6, 3.0, largest, 1.0].map(f32::to_bits));
    // Halves, two in a word: 65504 and 3, 65504 and 1.
    assert_eq!(shown(TextureFormat::Rgba16Float)[..2], [0x4200_7bff, 0x3c00_7bff]);
}

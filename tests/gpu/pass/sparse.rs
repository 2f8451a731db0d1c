//! Sparse frames: filled for the methods that read whole frames, and read without filling by taau.

use super::*;
use crate::images::{pixel, pixels};

pub(super) const SIZE: [u32; 2] = [70, 41];
/// Passes of smr for sparse frames.
pub(super) const SAMPLES: [&str; 3] = ["sparse_observe_pass", "sparse_light_pass", "sparse_pass"];

pub(super) fn settings(method: MethodKind) -> Settings {
    let foveation = Foveation {
        filter: Filter::Sparse,
        fovea_deg: 12.0,
        mid_deg: 30.0,
        rate_mid: 2,
        rate_far: 8,
        ..Foveation::default()
    };
    Settings { method: method.into(), foveation, ..Settings::paper() }
}

pub(super) fn desc() -> ContextDesc {
    ContextDesc { view_count: 2, ..ContextDesc::new(SIZE) }
}

/// Two views with lattices; some samples are not finite.
fn sparse_views(index: u64, settings: &Settings) -> Vec<View> {
    let view = |v: u32| {
        let name = format!("sparse {index} {v}");
        let view = noise_view(&name, &desc());
        let mut draws = Draws::new(&name);
        let color = view.color.map(|c| if draws.uniform() < 0.1 { [f32::NAN, c[1], f32::INFINITY] } else { c });
        let gaze_px = [draws.range(-20.0, 90.0), draws.range(-20.0, 60.0)];
        View { color, ..view }.foveated(&settings.foveation, gaze_px, index + u64::from(v))
    };
    (0..2).map(view).collect()
}

/// A gliding view with noise; in the last frames it is all at full rate.
fn noisy_view(index: u64, v: u32, settings: &Settings) -> View {
    let mut draws = Draws::new(&format!("noisy {index} {v}"));
    let mut view = gliding_view(index, v, settings);
    view.noise = Some(Image::from_fn(SIZE, |[x, _]| {
        let error = [0.0, 0.02, 0.2][(x / 11) as usize % 3] * draws.uniform();
        [if draws.uniform() < 0.02 { f32::NAN } else { error }, 1.0 + (draws.bits() % 4) as f32]
    }));
    if index > 9 {
        view.facts.lattices = Some(full_rate());
    }
    view
}

/// One lattice of every pixel.
pub(super) fn full_rate() -> Lattices {
    Lattices::new(&[Lattice::covering(1, [0, 0], SIZE, [0, 0])]).unwrap()
}

fn traced() -> Settings {
    Settings { foveation: settings(MethodKind::Smr).foveation, ..Settings::traced() }
}

#[test]
fn noisy_sparse_frames_are_bit_equal_on_both_executors() {
    for method in MethodKind::ALL {
        let settings = Settings { method: method.into(), ..traced() };
        let Some(mut rig) = Rig::new(desc(), settings) else { return };
        for index in 0..12 {
            arrange(index, &mut rig);
            rig.both(index, Reset::None, &[0, 1].map(|v| noisy_view(index, v, &settings)));
        }
    }
}

/// Regions and exposures of frame `index`.
pub(super) fn arrange(index: u64, rig: &mut Rig) {
    rig.scattered = index % 4 == 3;
    rig.exposure = if index % 3 == 2 { Exposure::Changed { ratio: 1.25 } } else { Exposure::Same };
}

#[test]
fn wrong_noise_is_caught() {
    let settings = traced();
    let planted = [
        ("textureLoad(past_noise, at, view, 0)", "textureLoad(past_noise, at, 1u - view, 0)"),
        ("noise = mean_noise(noises);", ""),
        ("confidence = noisy_lod_confidence(", "confidence = 0.0 * noisy_lod_confidence("),
        ("noise = accumulated.noise;", ""),
    ];
    rig::all_caught_in(SAMPLES, desc(), settings, 12, &planted, |index, rig| {
        arrange(index, rig);
        (Reset::None, [0, 1].map(|v| noisy_view(index, v, &settings)).to_vec())
    });
}

#[test]
fn sparse_frames_are_bit_equal_on_both_executors_in_an_atlas_or_not() {
    let wrs = Wrs { sampler: Sampler::AEs, ..Wrs::default() };
    let keyed = Settings { method: Method::Wrs(wrs), ..settings(MethodKind::Wrs) };
    for settings in MethodKind::ALL.map(settings).into_iter().chain([keyed]) {
        let Some([mut full, mut atlas]) = Rig::each([(desc(), settings); 2]) else { return };
        let size = [80, 160];
        atlas.resize_color(size);
        for index in 0..6 {
            let views = sparse_views(index, &settings);
            full.scattered = index % 3 == 2;
            let (expected, _) = full.both(index, Reset::None, &views);
            atlas.scattered = index % 2 == 1;
            let (made, _) = atlas.both(index, Reset::None, &[0, 1].map(|v| views[v].in_atlas(size)));
            assert!(made.stats.nonfinite > 0);
            assert_eq!(made, expected, "{settings:?}, frame {index}");
        }
    }
}

#[test]
fn lattices_without_a_sample_in_the_frame_have_no_candidates() {
    let settings = settings(MethodKind::None);
    let Some(mut rig) = Rig::new(ContextDesc::new(SIZE), settings) else { return };
    // The last column of blocks of the finer lattice has its samples beyond the right edge.
    let fine = Lattice::covering(4, [68, 0], [70, 41], [3, 0]);
    let far = Lattice::covering(8, [0, 0], SIZE, [1, 2]);
    let view = |lattices: &[Lattice]| {
        View::still(noise(SIZE, "beyond"), [20.0, 20.0]).sparse(Lattices::new(lattices).unwrap())
    };
    let (made, _) = rig.both(0, Reset::None, &[view(&[fine, far])]);
    assert_eq!(made.stats.nonfinite, 2 * 41);
    assert!(made.shown.chunks(70).all(|row| row[68..] == [[0; 3]; 2] && row[..68].iter().all(|&c| c != [0; 3])));
    // No sample at all.
    let (made, _) = rig.both(1, Reset::None, &[view(&[Lattice::covering(128, [0, 0], SIZE, [100, 0])])]);
    assert_eq!(made.stats.nonfinite, 70 * 41);
}

/// A view of a texture that glides across two depths under a light that changes; some samples are not finite.
pub(super) fn gliding_view(index: u64, v: u32, settings: &Settings) -> View {
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
    view.foveated(&settings.foveation, [20.0 + 4.0 * t, 15.0], index + u64::from(v))
}

#[test]
fn a_wrong_reconstruction_is_caught() {
    let settings = settings(MethodKind::Smr);
    let planted = [
        ("vec2i(frame.size) - 1), view, 0)", "vec2i(frame.size) - 1), 1u - view, 0)"),
        ("found.highest = expose(found.highest, frame.exposure);", ""),
        ("point.y << lattice.level", "point.x << lattice.level"),
        ("sparse.views[view][frame.lattice]", "sparse.views[0u][frame.lattice]"),
        ("without += errors * near.weight;", ""),
        ("next.disparity = surface.stored_disparity;", ""),
    ];
    rig::all_caught_in(SAMPLES, desc(), settings, 8, &planted, |index, rig| {
        arrange(index, rig);
        (Reset::None, [0, 1].map(|v| gliding_view(index, v, &settings)).to_vec())
    });
}

#[test]
fn a_wrong_pass_beside_those_of_smr_is_caught() {
    type Views = fn(u64, &Settings) -> Vec<View>;
    let noisy = Settings { method: Method::Wrs(Wrs::default()), ..traced() };
    let noisy_views: Views = |index, settings| (0..2).map(|v| noisy_view(index, v, settings)).collect();
    let [none, taau, wrs, smr] = [MethodKind::None, MethodKind::Taau, MethodKind::Wrs, MethodKind::Smr].map(settings);
    let planted: [(Settings, Views, &str, (&str, &str)); 6] = [
        (none, sparse_views, "fill_pass", ("bitcast<f32>(sparse.missing)", "0.0")),
        (none, sparse_views, "fill_pass", (", view, COLOR_IN)", ", 0u, COLOR_IN)")),
        (taau, sparse_views, "taau_pass", ("tail(confidence * source.previous.trust)", "tail(0.0)")),
        (wrs, sparse_views, "wrs_sparse_pass", ("place_weight(vec2f(x, y)))", "1.0)")),
        (noisy, noisy_views, "wrs_sparse_pass", ("noise_at(place.px, view)", "noise_at(px, view)")),
        (smr, at_samples, "fill_geometry_pass", ("near.y.points[below]", "near.y.points[right]")),
    ];
    for (settings, views, pass, error) in planted {
        rig::all_caught_in([pass], desc(), settings, 4, &[error], |index, rig| {
            rig.scattered = index > 1;
            (Reset::None, views(index, &settings))
        });
    }
}

#[test]
fn sparse_frames_without_lattices_and_lattices_of_other_frames_are_refused() {
    let Some(mut rig) = Rig::new(ContextDesc::new(SIZE), settings(MethodKind::Taa)) else { return };
    let mut view = View::still(noise(SIZE, "refused"), [20.0, 20.0]);
    let expected = "lattices of view 0 is None: expected where the samples are, because the filter of the foveation is \
                    Sparse";
    assert_eq!(rig.refusal(&view), expected);
    let foveation = settings(MethodKind::Taa).foveation;
    let lattices = foveation.lattices(&view.facts.geometry, [20.0, 20.0], 0);
    // An atlas that the texture does not hold.
    let far = Lattice { atlas_texel: Some([65, 3]), ..Lattice::covering(8, [0, 0], SIZE, [0, 0]) };
    view.facts.lattices = Some(Lattices::new(&[far]).unwrap());
    let expected = "lattices of view 0 is 9x6 samples from texel (65, 3) on in a color input of 70x41: expected an atlas \
                    inside the input";
    assert_eq!(rig.refusal(&view), expected);
    // A stack that leaves pixels uncovered.
    view.facts.lattices = Some(Lattices::new(&[Lattice::covering(8, [0, 0], [60, 41], [0, 0])]).unwrap());
    assert!(rig.refusal(&view).contains("leaves pixels uncovered"));
    view.facts.lattices = Some(lattices);
    let (made, _) = rig.both(0, Reset::None, &[view.clone()]);
    assert_eq!(made.stats.pixels, 70 * 41, "refused frames changed nothing");
    let Some(mut whole) = Rig::new(ContextDesc::new(SIZE), Settings::paper()) else { return };
    let expected = "lattices of view 0 is given: expected None; or set Filter::Sparse in Settings::foveation";
    assert_eq!(whole.refusal(&view), expected);
}

#[test]
fn color_of_another_size_is_refused_unless_it_is_an_atlas() {
    let desc = ContextDesc { settings: settings(MethodKind::None), ..ContextDesc::new(SIZE) };
    let Some(bare) = Bare::new(desc) else { return };
    let mut post = bare.context(TextureFormat::Rgba16Float);
    let larger = ContextDesc::new([80, 160]);
    let color = make_texture(&bare.device, &larger, TextureFormat::Rgba16Float, Afterimage::INPUT_USAGE);
    let output = bare.output(TextureFormat::Rgba16Float);
    let [mut view] = bare.views;
    let lattices = desc.settings.foveation.lattices(&view.geometry, [20.0, 20.0], 0);
    let mut try_color = |lattices, color: Textures<'_>| {
        view.lattices = Some(lattices);
        bare.record(&mut post, &Frame::new(color, &[view], 0), &output).map_err(|e| e.to_string())
    };
    assert!(try_color(lattices, (&color).into()).unwrap_err().contains("80x160: expected 70x41"));
    let atlas = lattices.in_atlas().0;
    assert_eq!(try_color(atlas, (&color).into()), Ok(()));
    assert_eq!(try_color(atlas, Textures::Regions(&[Region::new(&color, [1, 2])])), Ok(()));
    let beyond = try_color(atlas, Textures::Regions(&[Region::new(&color, [70, 0])])).unwrap_err();
    assert!(beyond.contains("from texel (70, 0) on in a color input of 80x160"), "{beyond}");
}

#[test]
fn filled_color_follows_size_and_settings() {
    let context = ContextDesc::new(SIZE);
    let Some(mut rig) = Rig::new(context, settings(MethodKind::Taa)) else { return };
    let pixels = u64::from(SIZE[0] * SIZE[1]);
    assert_eq!(rig.gpu.memory_bytes(), (16 + 16) * pixels);
    let view = |size: [u32; 2], index: u64, is_sparse: bool| {
        let view = View::still(noise(size, &format!("follows {index}")), [20.0, 20.0]);
        let foveation = settings(MethodKind::Taa).foveation;
        [if is_sparse { view.foveated(&foveation, [20.0, 20.0], index) } else { view }]
    };
    rig.both(0, Reset::None, &view(SIZE, 0, true));
    rig.resize([33, 50]);
    rig.both(1, Reset::None, &view([33, 50], 1, true));
    rig.resize_keeping_history([40, 20]);
    rig.both(2, Reset::None, &view([40, 20], 2, true));
    // Settings with and without sparse frames; history survives.
    let whole = Settings { method: Method::Taa, ..Settings::paper() };
    for (index, settings) in [(3, whole), (4, settings(MethodKind::Taa)), (5, settings(MethodKind::Wrs))] {
        rig.set_settings(settings);
        let is_sparse = settings.foveation.filter == Filter::Sparse;
        rig.both(index, Reset::None, &view([40, 20], index, is_sparse));
    }
}

#[test]
fn prewarmed_pipelines_suffice_for_sparse_frames() {
    let settings = settings(MethodKind::None);
    let Some(bare) = Bare::new(ContextDesc { settings, ..ContextDesc::new(SIZE) }) else { return };
    let mut post = bare.context(TextureFormat::Rgba32Float);
    let usual = Variant { counters: true, ..Default::default() };
    post.prewarm(&bare.device, [usual, Variant { regions: true, ..Default::default() }]);
    assert_eq!(post.pipelines().len(), 4);
    let [color, output] = [(); 2].map(|()| bare.texture(TextureFormat::Rgba32Float, super::limits::READ_AND_WRITE));
    let counters = rig::make_counters(&bare.device);
    let [mut view] = bare.views;
    view.lattices = Some(settings.foveation.lattices(&view.geometry, [20.0, 20.0], 0));
    let views = [view];
    let counted = Target { counters: Some(&counters), ..Target::new(&output) };
    bare.record(&mut post, &Frame::new(&color, &views, 0), counted).unwrap();
    // A region for the output alone.
    let region = [Region::new(&output, [0, 0])];
    bare.record(&mut post, &Frame::new(&color, &views, 1), Textures::Regions(&region)).unwrap();
    assert_eq!(post.pipelines().len(), 4);
    let counted = afterimage_testing::gpu::read_buffer(&bare.device, &bare.queue, &counters);
    assert_eq!(afterimage::FrameStats::from_counters(&counted).unwrap().pixels, 70 * 41);
}

#[test]
fn alpha_is_filled_as_color_is() {
    let format = TextureFormat::Rgba32Float;
    let desc = ContextDesc { settings: settings(MethodKind::None), ..ContextDesc::new(SIZE) };
    let Some(bare) = Bare::new(desc) else { return };
    // A ramp, which linear interpolation reproduces, with one alpha that is not finite.
    let texel = |i: u32| [0.5, 0.5, 0.5, if i == 0 { f32::NAN } else { (i % 70) as f32 / 64.0 }];
    let color = bare.filled(format, &(0..70 * 41).map(texel).collect::<Vec<_>>());
    let output = bare.output(format);
    let [mut view] = bare.views;
    view.lattices = Some(Lattices::new(&[Lattice::covering(8, [0, 0], SIZE, [0, 0])]).unwrap());
    bare.record(&mut bare.context(format), &Frame::new(&color, &[view], 0), &output).unwrap();
    let alpha: Vec<f32> = bare.read(&output).chunks(4).map(|c| f32::from_bits(c[3])).collect();
    assert_eq!(alpha[0], 1.0);
    for (i, alpha) in alpha.iter().enumerate().skip(70 * 8).filter(|(i, _)| i % 70 <= 64) {
        assert_eq!(*alpha, (i % 70) as f32 / 64.0, "pixel {i}");
    }
}

/// A stack of lattices of any steps, places and offsets that covers a view of `size`, in an atlas or not.
fn any_lattices(draws: &mut Draws, size: [u32; 2]) -> Lattices {
    let mut stack = vec![];
    let count = draws.bits() % 4;
    for level in 0..5 {
        let step = 1 << level;
        let offset = [0; 2].map(|_| draws.bits() % step);
        if level == 4 || stack.len() as u32 == count {
            stack.push(Lattice::covering(step, [0, 0], size, offset));
            break;
        }
        if draws.bits() & 1 == 0 {
            let low = size.map(|s| draws.bits() % s);
            let high = [0, 1].map(|i| low[i] + 1 + draws.bits() % size[i]);
            stack.push(Lattice::covering(step, low, high, offset));
        }
    }
    Lattices::new(&stack).unwrap()
}

#[test]
fn any_lattices_and_any_bits_agree_bit_for_bit_and_are_finite() {
    use crate::any_frame::{SIZE, any_frame};
    for method in MethodKind::ALL {
        let settings = settings(method);
        let Some(mut rig) = Rig::new(ContextDesc { view_count: 2, ..ContextDesc::new(SIZE) }, settings) else { return };
        let mut draws = Draws::new("any lattices");
        for index in 0..40 {
            rig.scattered = index % 5 == 4;
            let wild = [0.0, 0.02, 0.3, 1.0][index as usize % 4];
            let views = [0; 2].map(|_| {
                let frame = any_frame(&mut draws, wild).sparse(any_lattices(&mut draws, SIZE));
                View { lod: None, noise: None, ..frame }
            });
            let (made, _) = rig.both(index, if index % 6 == 0 { Reset::All } else { Reset::None }, &views);
            assert!(made.shown.iter().flatten().all(|&v| f32::from_bits(v).abs() <= 65504.0));
        }
    }
}

#[test]
fn sparse_history_follows_a_change_of_size() {
    let settings = settings(MethodKind::Smr);
    let Some(mut rig) = Rig::new(ContextDesc::new([64, 40]), settings) else { return };
    let view = |size: [u32; 2], index: u64| {
        let wave = |v: u32, n: u32| 0.5 + 0.4 * ((v as f32 + 0.5) / n as f32 * 40.0).sin();
        let color = Image::from_fn(size, |[x, y]| [wave(x, size[0]), wave(y, size[1]), 0.3]);
        let view = View::still(color, size.map(|side| side as f32 * 0.5));
        view.foveated(&settings.foveation, [20.0, 20.0], index)
    };
    for index in 0..64 {
        rig.both(index, Reset::None, &[view([64, 40], index)]);
    }
    for (index, size) in [(64, [64, 40]), (65, [80, 50]), (66, [64, 40]), (67, [33, 21])] {
        rig.resize_keeping_history(size);
        let now = view(size, index);
        let (made, _) = rig.both(index, Reset::None, std::slice::from_ref(&now));
        let pairs = made.shown.iter().flatten().zip(now.color.pixels().iter().flatten());
        let sum: f32 = pairs.map(|(&shown, full)| (f32::from_bits(shown) - full).powi(2)).sum();
        let rms = (sum / (3 * made.shown.len()) as f32).sqrt();
        println!("{size:?}: {rms:.4}");
        // Without history, what lies between samples of every eighth pixel is off by 0.2.
        assert!(rms < 0.1, "{size:?}: {rms}");
    }
}

#[test]
fn smr_on_sparse_frames_holds_less_than_24_bytes_a_pixel_and_8_more_for_noise() {
    let bytes = |size: [u32; 2], view_count, settings| {
        let desc = ContextDesc { settings, view_count, ..ContextDesc::new(size) };
        Afterimage::memory_bytes_of(&desc) as f64 / f64::from(size[0] * size[1] * view_count)
    };
    for (size, view_count) in [([1920, 1080], 1), ([480, 270], 2), ([3840, 2160], 1)] {
        let calm = bytes(size, view_count, settings(MethodKind::Smr));
        println!("{size:?}: {calm:.2} bytes a pixel and view");
        assert!((22.0..24.0).contains(&calm), "{calm}");
        let method = Method::Smr(Smr { antialias: true, ..Smr::default() });
        let antialiased = Settings { method, ..settings(MethodKind::Smr) };
        assert_eq!(bytes(size, view_count, antialiased), calm, "means take no memory");
        let [noisy, exact] = [true, false].map(|noisy| bytes(size, view_count, Settings { noisy, ..traced() }));
        assert!(exact <= 24.0 && (noisy - exact - 8.0).abs() < 1e-9, "{noisy}, {exact}");
    }
}

/// The gliding views of a frame with depth and motion at the samples only.
fn at_samples(index: u64, settings: &Settings) -> Vec<View> {
    let view = |v: u32| {
        let mut view = gliding_view(index, v, settings);
        view.facts.lattices = view.facts.lattices.map(Lattices::with_geometry_at_samples);
        if index % 4 == 1 {
            // What the renderer failed to write.
            let mut draws = Draws::new("holes");
            let mut hole = |z| match draws.uniform() < 0.1 {
                true => [f32::NAN, 0.0, f32::INFINITY][draws.bits() as usize % 3],
                false => z,
            };
            view.depth = view.depth.map(|depth| depth.map(&mut hole));
        }
        view
    };
    (0..2).map(view).collect()
}

/// With complete vectors, vectors that lack the camera's motion, and vectors of objects alone.
#[test]
fn geometry_at_samples_is_filled_bit_equal() {
    let moved =
        [[0.999, -0.02, 0.01, 0.05], [0.02, 0.999, -0.01, 0.0], [-0.01, 0.01, 0.999, 0.1], [0.0, 0.0, 0.0, 1.0]];
    let plain = desc().motion;
    let none = MotionConvention { no_vector: Some([0.0; 2]), ..plain };
    let excluded = MotionConvention { without_camera: true, ..plain };
    let in_turn = MethodKind::ALL.into_iter().zip([plain, none, excluded].into_iter().cycle());
    for (method, motion) in in_turn.chain([plain, none, excluded].map(|motion| (MethodKind::Smr, motion))) {
        let settings = settings(method);
        let Some(mut rig) = Rig::new(ContextDesc { motion, ..desc() }, settings) else { return };
        for index in 0..8 {
            rig.scattered = index % 4 == 3;
            let mut views = at_samples(index, &settings);
            for view in &mut views {
                view.facts.previous_from_current = (motion != plain).then_some(moved);
                if index % 3 == 2 {
                    view.motion = None;
                }
                if index == 6 && motion == plain {
                    view.depth = None;
                }
                if index % 2 == 1 && motion != plain {
                    view.facts.lattices = gliding_view(index, 0, &settings).facts.lattices;
                }
            }
            rig.both(index, Reset::None, &views);
        }
        assert_eq!(rig.gpu.memory_bytes() - Afterimage::memory_bytes_of(rig.gpu.desc()), 12 * 2 * 70 * 41);
    }
}

#[test]
fn filled_depth_is_that_of_the_samples_and_between_them() {
    let settings = settings(MethodKind::Smr);
    let Some(mut rig) = Rig::new(desc(), settings) else { return };
    assert!(rig.gpu.filled_depth().is_none());
    for index in [0, 2, 3] {
        let views = at_samples(index, &settings);
        rig.on_gpu(index, Reset::None, &views);
        let filled = rig.gpu.filled_depth().expect("a frame with geometry at samples");
        let filled = read_texture(&rig.device, &rig.queue, filled);
        let mut worst: [f32; 2] = [0.0; 2];
        for (view, filled) in views.iter().zip(filled.chunks((SIZE[0] * SIZE[1]) as usize)) {
            let (depth, lattices) = (view.depth.as_ref().unwrap(), view.facts.lattices.unwrap());
            for (px, z) in pixels(SIZE).zip(filled.iter().map(|&bits| f32::from_bits(bits))) {
                let (given, is_sample) = (pixel(depth, px), lattices.at(px).unwrap().samples(px));
                // Between samples, silhouettes may lie elsewhere; but each distance is one of the scene's.
                let error = if is_sample {
                    (z / given - 1.0).abs()
                } else {
                    (z / (2.0 + 0.01 * index as f32) - 1.0).abs().min((z / 6.5 - 1.0).abs())
                };
                worst[usize::from(is_sample)] = worst[usize::from(is_sample)].max(error);
            }
        }
        println!("frame {index}: largest relative error {:.1e} at samples, {:.1e} between them", worst[1], worst[0]);
        // A reciprocal there and back; a mean of reciprocals between.
        assert!(worst[1] < 1e-6 && worst[0] < 1e-6, "{worst:?}");
    }
}

#[test]
fn what_lies_between_samples_is_not_read() {
    let settings = settings(MethodKind::Smr);
    let Some([mut rig, mut other]) = Rig::each([(desc(), settings); 2]) else { return };
    for index in 0..4 {
        let views = at_samples(index, &settings);
        let changed = views.iter().cloned().map(|view| View {
            color: view.read_of(&view.color, [f32::NAN, -3.0, 1e30]),
            depth: view.depth.as_ref().map(|depth| view.read_of(depth, 0.1)),
            motion: view.motion.as_ref().map(|motion| view.read_of(motion, [f32::NAN; 2])),
            ..view
        });
        let changed: Vec<_> = changed.collect();
        assert_eq!(rig.on_gpu(index, Reset::None, &views), other.on_gpu(index, Reset::None, &changed));
    }
}

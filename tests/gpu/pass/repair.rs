//! Plans of repairs and repaired frames: both executors, the lists on the device, and planted errors.

use super::rig::{Rig, View};
use super::sparse::{SIZE, desc, gliding_view, settings};
use afterimage::gpu::{Afterimage, Frame};
use afterimage::internal::Sources;
use afterimage::shader::SHADERS;
use afterimage::wgpu::TextureFormat;
use afterimage::{ContextDesc, Foveation, Gaze, Image, Lattices, Method, MethodKind, Repair, Reset, Settings, Smr};

/// A budget that some frames use up and others do not.
const BUDGET: f32 = 0.5;
const FRAMES: u64 = 12;

fn repairing(antialias: bool, noisy: bool) -> Settings {
    let method = Method::Smr(Smr { repair: Some(Repair { budget: BUDGET }), antialias, ..Smr::default() });
    Settings { method, noisy, ..settings(MethodKind::Smr) }
}

/// Two views that glide, and colors of the pixels to repair, of which some are not numbers. In the second view surfaces
/// part, and its gaze is lost in every fifth frame.
fn views(index: u64, settings: &Settings) -> [View; 2] {
    [0, 1].map(|v| {
        let mut view = gliding_view(index, v, settings);
        let trust = view.trust.take().unwrap();
        let at = |x: u32, y: u32| trust.at(x as usize, y as usize);
        view.trust = Some(Image::from_fn(SIZE, |[x, y]| if y == 5 { 0.0 } else { at(x, y) }));
        let antialias = settings.method == repairing(true, false).method;
        view.facts.jitter_px = if antialias { Foveation::jitter_px(index) } else { [0.0; 2] };
        if v == 1 {
            view.motion = view.motion.map(|motion| motion.map(|[x, y]| [x, -y]));
            view.facts.gaze = if index % 5 == 4 { Gaze::Lost } else { view.facts.gaze };
        }
        if index % 4 == 2 {
            view.facts.lattices = view.facts.lattices.map(Lattices::with_geometry_at_samples);
        }
        view.noise =
            settings.noisy.then(|| Image::from_fn(SIZE, |[x, y]| [0.02 * (x % 3) as f32, 1.0 + (y % 4) as f32]));
        let whole = |[x, y]: [u32; 2]| {
            if (x + 3 * y).is_multiple_of(13) { f32::NAN } else { ((x * 7 + y * 3 + index as u32) % 32) as f32 / 32.0 }
        };
        view.repaired = Some(Image::from_fn(SIZE, |px| [whole(px), 0.25, 0.5]));
        view
    })
}

fn rig_of(index: u64, rig: &mut Rig) -> Reset {
    super::sparse::arrange(index, rig);
    if index == 7 { Reset::All } else { Reset::None }
}

#[test]
fn repaired_frames_are_bit_equal_on_both_executors() {
    for [antialias, noisy] in [[false, false], [true, false], [false, true]] {
        let settings = repairing(antialias, noisy);
        let Some(mut rig) = Rig::new(desc(), settings) else { return };
        let counts: Vec<u32> = (0..FRAMES)
            .map(|index| {
                let reset = rig_of(index, &mut rig);
                let (made, _) = rig.both(index, reset, &views(index, &settings));
                made.quads.iter().sum()
            })
            .collect();
        println!("antialias {antialias}, noisy {noisy}: quads chosen {counts:?}");
        let most = (BUDGET * (SIZE[0].div_ceil(2) * SIZE[1].div_ceil(2)) as f32) as u32 * 2;
        assert!(counts.iter().all(|&n| n <= most) && counts[0] > most - 40, "at most {most}");
        assert!(counts.iter().any(|&n| n > 0 && n < most - 40), "some plans do not use up their budget");
    }
}

/// An octagon that cuts off corners and edges, another one in each view.
fn lens_of(v: u32) -> [[f32; 4]; 2] {
    let [width, height] = SIZE.map(|side| side as f32);
    let inset = 3.0 + 2.0 * v as f32;
    let lowest = [inset, 2.0, 16.0, 14.0 - height];
    [lowest, [width - 4.0, height - 1.0 - inset, width + height - 20.0, width - 12.0]]
}

#[test]
fn what_a_lens_hides_is_black_without_history_and_never_repaired() {
    for [antialias, noisy] in [[false, false], [true, false], [false, true]] {
        let settings = repairing(antialias, noisy);
        let Some(mut rig) = Rig::new(desc(), settings) else { return };
        let hides = |v: u32, [x, y]: [u32; 2]| {
            let ([lowest, highest], [x, y]) = (lens_of(v), [x as f32, y as f32]);
            [x, y, x + y, x - y]
                .into_iter()
                .zip(lowest.into_iter().zip(highest))
                .any(|(at, (low, high))| at < low || at > high)
        };
        let (mut hidden, mut asked) = (0, 0);
        for index in 0..FRAMES {
            let reset = rig_of(index, &mut rig);
            let mut seen = views(index, &settings);
            seen.iter_mut().zip(0..).for_each(|(view, v)| view.facts.visible_px = Some(lens_of(v)));
            let (made, _) = rig.both(index, reset, &seen);
            let pixels = (SIZE[0] * SIZE[1]) as usize;
            for (i, shown) in made.shown.iter().enumerate() {
                let (v, i) = ((i / pixels) as u32, i % pixels);
                let px = [i as u32 % SIZE[0], i as u32 / SIZE[0]];
                if hides(v, px) {
                    hidden += 1;
                    assert_eq!(*shown, [0; 3], "{px:?}");
                    assert_eq!(made.words[v as usize * pixels + i][1] & 63, 0, "{px:?} has history");
                }
            }
            let columns = SIZE[0].div_ceil(2);
            let quads_a_view = (columns * SIZE[1].div_ceil(2)) as usize;
            for (i, _) in made.quads.iter().enumerate().filter(|(_, chosen)| **chosen == 1) {
                let (v, i) = ((i / quads_a_view) as u32, (i % quads_a_view) as u32);
                let px = [0, 1, 2, 3].map(|k| [2 * (i % columns) + k % 2, 2 * (i / columns) + k / 2]);
                assert!(px.iter().any(|px| !hides(v, *px)), "{px:?} is repaired");
                asked += 1;
            }
        }
        // What is seen is as it was, where no history can have come from beyond, and no budget is left over.
        let method = Method::Smr(Smr { antialias, ..Smr::default() });
        let Some(mut first) = Rig::new(desc(), Settings { method, ..settings }) else { return };
        let mut seen = views(0, &settings);
        seen.iter_mut().for_each(|view| view.repaired = None);
        let all = first.on_gpu(0, Reset::All, &seen);
        seen.iter_mut().zip(0..).for_each(|(view, v)| view.facts.visible_px = Some(lens_of(v)));
        let made = first.on_gpu(0, Reset::All, &seen);
        let differing = all.shown.iter().zip(&made.shown).enumerate().filter(|(_, (all, made))| all != made);
        for (i, _) in differing {
            let (v, i) = (i as u32 / (SIZE[0] * SIZE[1]), i as u32 % (SIZE[0] * SIZE[1]));
            assert!(hides(v, [i % SIZE[0], i / SIZE[0]]), "view {v}, pixel {i}");
        }
        println!("antialias {antialias}, noisy {noisy}: {hidden} hidden pixels, {asked} quads repaired");
        assert!(hidden > 1000 && asked > 100);
    }
}

#[test]
fn lists_have_the_quads_of_the_masks() {
    let settings = repairing(false, false);
    let Some(mut rig) = Rig::new(desc(), settings) else { return };
    for index in 0..FRAMES {
        let reset = rig_of(index, &mut rig);
        let made = rig.on_gpu(index, reset, &views(index, &settings));
        assert_lists_are_masks(&rig, &made.quads);
    }
}

/// Lists of the device, view by view, against a mask of all views.
fn assert_lists_are_masks(rig: &Rig, mask: &[u32]) {
    let [columns, rows] = SIZE.map(|side| side.div_ceil(2));
    for (view, mask) in mask.chunks((columns * rows) as usize).enumerate() {
        let words: Vec<u32> =
            afterimage_testing::gpu::read_buffer(&rig.device, &rig.queue, rig.gpu.repair_quads(view).unwrap());
        let count = mask.iter().sum::<u32>();
        assert_eq!(words[..8], [6, count, 0, 0, count.div_ceil(64), 1, 1, count], "view {view}");
        let mut listed = words[8..8 + count as usize].to_vec();
        listed.sort_unstable_by_key(|quad| (quad >> 16, quad & 0xffff));
        let chosen =
            (0..).zip(mask).filter(|(_, chosen)| **chosen == 1).map(|(i, _)| (i % columns) | ((i / columns) << 16));
        assert_eq!(listed, chosen.collect::<Vec<_>>(), "view {view}");
    }
}

/// A frame that is planned and then given without samples is as one that was not planned.
#[test]
fn a_plan_changes_nothing() {
    let settings = repairing(true, false);
    let (Some(mut planned), Some(mut plain)) = (Rig::new(desc(), settings), Rig::new(desc(), settings)) else { return };
    for index in 0..6 {
        let views = views(index, &settings);
        let unrepaired = views.clone().map(|view| View { repaired: None, ..view });
        let unshaded = views.map(|view| View { repaired: Some(Image::filled(SIZE, [f32::NAN; 3])), ..view });
        let (with, without) =
            (planned.on_gpu(index, Reset::None, &unshaded), plain.on_gpu(index, Reset::None, &unrepaired));
        assert!(with.shown == without.shown && with.words == without.words, "frame {index}");
    }
}

/// Sizes of a plan's textures and buffers, and that changes of settings replace them.
#[test]
fn plans_follow_size_and_settings() {
    let settings = repairing(false, false);
    let Some(mut rig) = Rig::new(desc(), settings) else { return };
    let without = Settings { method: MethodKind::Smr.into(), ..settings };
    let bytes = |settings| Afterimage::memory_bytes_of(&ContextDesc { settings, ..ContextDesc::new([1920, 1080]) });
    let (with, plain) = (bytes(settings), bytes(without));
    let pixels = 1920.0 * 1080.0;
    println!("{:.2} bytes a pixel, {:.2} without repair", with as f64 / pixels, plain as f64 / pixels);
    // Keys and mask, 4 bytes a quad each, and a word for each quad that the budget pays for.
    assert!((with - plain) as f64 <= (2.1 + f64::from(BUDGET)) * pixels);
    let size = |rig: &Rig| rig.gpu.repair_mask().map(|mask| [mask.width(), mask.height()]);
    assert_eq!(size(&rig), Some([35, 21]));
    rig.gpu.set_settings(&rig.device, without).unwrap();
    assert!(size(&rig).is_none() && rig.gpu.repair_quads(0).is_none());
    rig.gpu.set_settings(&rig.device, settings).unwrap();
    rig.gpu.resize(&rig.device, [64, 64]).unwrap();
    assert_eq!(size(&rig), Some([32, 32]));
    assert!(rig.gpu.repair_quads(1).is_some() && rig.gpu.repair_quads(2).is_none());
}

#[test]
fn what_was_not_planned_is_refused() {
    let settings = repairing(false, false);
    let Some(rig) = Rig::new(ContextDesc::new(SIZE), settings) else { return };
    let desc = ContextDesc { settings, ..ContextDesc::new(SIZE) };
    let mut post = Afterimage::new(&rig.device, &desc, TextureFormat::Rgba16Float).unwrap();
    let texture = |usage| super::rig::make_texture(&rig.device, &desc, TextureFormat::Rgba16Float, usage);
    let (color, output) = (texture(Afterimage::INPUT_USAGE), texture(Afterimage::OUTPUT_USAGE));
    let facts = [views(0, &settings)[0].facts];
    let mut encoder = rig.device.create_command_encoder(&Default::default());
    let frame = Frame::new(&color, &facts, 3);
    let repaired = Frame { repaired: Some((&color).into()), ..frame };
    let mut refused = |post: &mut Afterimage, frame: &Frame<'_>| {
        post.record(&rig.device, &mut encoder, frame, &output).map(|_| ()).map_err(|error| error.to_string())
    };
    let unplanned = "repaired of view 0 is given: expected None, or that plan was called with this frame";
    assert_eq!(refused(&mut post, &repaired), Err(unplanned.into()));
    let mut encoder = rig.device.create_command_encoder(&Default::default());
    post.plan(&rig.device, &mut encoder, &frame).unwrap();
    assert_eq!(refused(&mut post, &Frame { index: 4, ..repaired }), Err(unplanned.into()));
    assert_eq!(refused(&mut post, &repaired), Ok(()));
    assert_eq!(refused(&mut post, &repaired), Err(unplanned.into()));
    post.set_settings(&rig.device, Settings { method: MethodKind::Smr.into(), ..settings }).unwrap();
    let error = post.plan(&rig.device, &mut encoder, &frame).unwrap_err().to_string();
    assert!(error.starts_with("Smr::repair of view 0 is None: expected given"), "{error}");
}

#[test]
fn a_wrong_plan_is_caught() {
    let settings = repairing(true, false);
    let names = ["repair_key_pass", "repair_threshold_pass", "repair_mask_pass", "sparse_pass"];
    let right = names.map(|name| SHADERS.compose(name).source);
    let differs = |sources: &[String; 4]| {
        let texts = names.into_iter().zip(sources);
        let sources = texts.fold(Sources::default(), |all, (name, text)| all.with(name, text));
        let mut rig = Rig::with_sources(desc(), settings, sources)?;
        Some((0..FRAMES).any(|index| {
            let reset = rig_of(index, &mut rig);
            let views = views(index, &settings);
            rig.differs(index, reset, &views)
        }))
    };
    let planted = [
        ("priority(kept.found.lod, e_deg), 0u, is_sample)", "priority(kept.found.lod, e_deg), 0u, false)"),
        ("asked_px(firstTrailingBit(left),", "asked_px(0u,"),
        ("same = same_surface(expected, stored.disparity, frame.depth_relative, 0.0);", ""),
        ("at.verdict == VERDICT_VALID && lod >= 0.0 && lod < WANTED_LOD", "lod >= 0.0 && lod < WANTED_LOD"),
        ("has_history && lod < WANTED_LOD", "has_history"),
        ("bits(x, y, frame_low, ~key)", "bits(x, y, frame_low, key)"),
        ("of_run[first - 1u] <= budget - chosen", "of_run[first - 1u] <= budget"),
        (">= state.threshold", ">= state.threshold + 64u"),
        ("!= 0u && level > 0u;", "!= 0u;"),
        ("candidate.lod = 0.0;\n        candidate.is_own = true;", "candidate.is_own = true;"),
    ];
    afterimage_testing::planted::all_caught(&right, &planted, differs);
}

//! Frames shaded by quads: plans and pictures of both executors, the lists on the device, and planted errors.

use super::sparse::{SIZE, arrange, desc, gliding_view};
use super::*;
use crate::images::pixel;

const FRAMES: u64 = 12;

/// Of smr, in two regions and with a budget.
pub fn settings(antialias: bool) -> Settings {
    let foveation = Foveation { fovea_deg: 12.0, mid_deg: 30.0, rate_mid: 4, budget: 0.1, ..Foveation::quads() };
    let method = Method::Smr(Smr { antialias, ..Smr::default() });
    Settings { method, foveation, ..Settings::default() }
}

/// Two views that glide, with colors at every pixel, of which some are not numbers. In the second view surfaces part,
/// and its gaze is lost in every fifth frame.
pub fn views(index: u64, settings: &Settings) -> [View; 2] {
    [0, 1].map(|v| {
        let mut view = gliding_view(index, v);
        let trust = view.trust.take().unwrap();
        view.trust = Some(Image::from_fn(SIZE, |px| if px[1] == 5 { 0.0 } else { pixel(&trust, px) }));
        let antialias = matches!(settings.method, Method::Smr(Smr { antialias: true, .. }));
        view.facts.jitter_px = if antialias { Foveation::jitter_px(index) } else { [0.0; 2] };
        if antialias {
            // Bars that move with the surface behind them, and that some frames miss.
            let is_bar =
                |[x, y]: [u32; 2]| y > 24 && (x + 2 * index as u32).is_multiple_of(6) && !index.is_multiple_of(3);
            let depth = view.depth.take().unwrap();
            view.depth = Some(Image::from_fn(SIZE, |px| if is_bar(px) { 3.0 } else { pixel(&depth, px) }));
        }
        if v == 1 {
            view.motion = view.motion.map(|motion| motion.map(|[x, y]| [x, -y]));
            view.facts.gaze = if index % 5 == 4 { Gaze::Lost } else { view.facts.gaze };
        }
        if index > 8 {
            view.facts.visible_px = Some([[2.0, 1.0, 12.0, -30.0], [66.0, 39.0, 100.0, 60.0]]);
        }
        view.color = Image::from_fn(SIZE, |[x, y]| {
            let [r, g, b] = pixel(&view.color, [x, y]);
            [if (x + 3 * y).is_multiple_of(29) { f32::NAN } else { r }, g, b]
        });
        view
    })
}

pub fn reset_of(index: u64, rig: &mut Rig) -> Reset {
    arrange(index, rig);
    if index == 7 { Reset::All } else { Reset::None }
}

#[test]
fn frames_by_quads_are_bit_equal_on_both_executors() {
    let with = |method: MethodKind| Settings { method: method.into(), ..settings(false) };
    let others = [MethodKind::None, MethodKind::Taa, MethodKind::Taau, MethodKind::Wrs].map(with);
    for settings in [settings(false), settings(true)].into_iter().chain(others) {
        let Some(mut rig) = Rig::new(desc(), settings) else { return };
        let counts: Vec<u32> = (0..FRAMES)
            .map(|index| {
                let reset = reset_of(index, &mut rig);
                let (made, _) = rig.both(index, reset, &views(index, &settings));
                assert_lists_are_masks(&rig, &made.quads);
                made.quads.iter().map(|mask| mask.count_ones()).sum()
            })
            .collect();
        println!("{:?}: pixels shaded {counts:?}", settings.method);
        assert!(counts.iter().all(|&n| n > 400 && n < 3600));
    }
}

/// Bytes of a context, and that changes of size and settings replace mask and lists.
#[test]
fn plans_follow_size_and_settings() {
    let settings = settings(true);
    let Some(mut rig) = Rig::new(desc(), settings) else { return };
    let [bytes, with_alpha] = [false, true].map(|keep_alpha| {
        let desc = ContextDesc { settings, keep_alpha, ..ContextDesc::new([1920, 1080]) };
        Afterimage::memory_bytes_of(&desc) as f64 / (1920.0 * 1080.0)
    });
    println!("{bytes:.2} bytes a pixel, with alpha {with_alpha:.2}");
    assert!(bytes < 25.2 && with_alpha < 33.2);
    let size = |rig: &Rig| rig.gpu.quad_mask().map(|mask| [mask.width(), mask.height()]);
    assert_eq!(size(&rig), Some([35, 21]));
    rig.gpu.set_settings(&rig.device, Settings::default()).unwrap();
    assert!(size(&rig).is_none() && rig.gpu.quad_list(0).is_none());
    rig.gpu.set_settings(&rig.device, settings).unwrap();
    rig.gpu.resize(&rig.device, [64, 64]).unwrap();
    assert_eq!(size(&rig), Some([32, 32]));
    assert!(rig.gpu.quad_list(1).is_some() && rig.gpu.quad_list(2).is_none());
}

/// Single pixels, quads and single pixels again, in one context: what history and passes follow.
#[test]
fn filters_may_change_from_frame_to_frame() {
    for method in [MethodKind::Smr, MethodKind::Taa, MethodKind::Wrs] {
        let quads = Settings { method: method.into(), ..settings(false) };
        let single = super::sparse::settings(method);
        let Some(mut rig) = Rig::new(desc(), single) else { return };
        for (index, settings) in [single, single, quads, quads, single].into_iter().enumerate() {
            rig.set_settings(settings);
            rig.both(index as u64, Reset::None, &views(index as u64, &settings));
        }
    }
}

/// Lists of the device, view by view, against a mask of all views. Not in recordings: the order of a list differs from
/// run to run.
fn assert_lists_are_masks(rig: &Rig, mask: &[u32]) {
    if afterimage_testing::gpu::is_recorded() {
        return;
    }
    let [columns, rows] = SIZE.map(|side| side.div_ceil(2));
    for (view, mask) in mask.chunks((columns * rows) as usize).enumerate() {
        let words: Vec<u32> =
            afterimage_testing::gpu::read_buffer(&rig.device, &rig.queue, rig.gpu.quad_list(view).unwrap());
        let count = mask.iter().filter(|pixels| **pixels != 0).count() as u32;
        assert_eq!(words[..8], [6, count, 0, 0, count.div_ceil(64), 1, 1, count], "view {view}");
        let mut listed = words[8..8 + count as usize].to_vec();
        listed.sort_unstable_by_key(|quad| (quad >> 16, quad & 0xffff));
        let shaded =
            (0..).zip(mask).filter(|(_, pixels)| **pixels != 0).map(|(i, _)| (i % columns) | ((i / columns) << 16));
        assert_eq!(listed, shaded.collect::<Vec<_>>(), "view {view}");
    }
}

/// A counter that starts again from 0, and renderers that have no counter and give the last index.
#[test]
fn frames_may_have_the_last_index() {
    for settings in [settings(false), settings(true), super::sparse::settings(MethodKind::Smr)] {
        let Some(mut rig) = Rig::new(desc(), settings) else { return };
        for (i, index) in [u64::MAX - 1, u64::MAX, u64::MAX, 0].into_iter().enumerate() {
            rig.both(index, Reset::None, &views(i as u64, &settings));
        }
    }
}

#[test]
fn what_was_not_planned_is_refused() {
    let desc = ContextDesc { settings: settings(false), ..ContextDesc::new(SIZE) };
    let Some(bare) = Bare::new(desc) else { return };
    let mut post = bare.context(TextureFormat::Rgba16Float);
    let (color, output) = (bare.input(TextureFormat::Rgba16Float), bare.output(TextureFormat::Rgba16Float));
    let frame = Frame::new(&color, &bare.views, 3);
    let refused =
        |post: &mut Afterimage, frame: &Frame<'_>| bare.record(post, frame, &output).map_err(|error| error.to_string());
    let expected = "expected the plan of this frame: call plan before the frame is shaded, or give a mask";
    assert_eq!(refused(&mut post, &frame), Err(format!("plan of view 0 is missing: {expected}")));
    bare.plan(&mut post, &frame);
    let later = Frame { index: 4, ..frame };
    assert_eq!(refused(&mut post, &later), Err(format!("plan of view 0 is that of frame 3: {expected}")));
    assert_eq!(refused(&mut post, &frame), Ok(()));
    assert_eq!(refused(&mut post, &frame), Err(format!("plan of view 0 is missing: {expected}")));
}

#[test]
fn a_wrong_pass_is_caught() {
    let settings = settings(true);
    let passes = [
        "quad_key_pass",
        "quad_threshold_pass",
        "quad_mask_pass",
        "quad_around_pass",
        "quad_octants_pass",
        "quad_observe_pass",
        "quad_blocks_pass",
        "quad_rectify_pass",
        "quad_pass",
    ];
    let planted = [
        ("found.first * acuity(e_deg)", "found.first"),
        ("of_run[first - 1u] <= budget - chosen", "of_run[first - 1u] <= budget"),
        ("last_of(above, -8, -1, -rows)", "last_of(above, -7, -1, -rows)"),
        ("min(first_of(row, 0, limits.x, y), last_of(row, -limits.x, 0, y))", "first_of(row, 0, limits.x, y)"),
        ("source.previous.at -= frame.views[view].jitter_px;", ""),
        (".usable && !surface.is_silhouette;", ".usable;"),
        ("select(own, farthest_disparity, thin)", "own"),
        ("quad / BLOCK_QUADS", "quad / (2u * BLOCK_QUADS)"),
        ("4u * (invocation & 3u)", "4u * (invocation & 1u)"),
        ("candidate.fit = min(mean.fit, own_fit);", "candidate.fit = mean.fit;"),
        ("sampled.usable && is_shaded(mask_at(at, view), at)", "sampled.usable"),
    ];
    rig::all_caught_in(passes, desc(), settings, FRAMES, &planted, |index, rig| {
        (reset_of(index, rig), views(index, &settings).to_vec())
    });
}

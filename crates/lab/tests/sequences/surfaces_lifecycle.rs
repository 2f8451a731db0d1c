//! Lives of taa's and smr's histories: views, poison, resets, submissions, memory. Bit equality throughout.

use super::rig::noise_view;
use super::rig::{Rig, View};
use super::sequences::{SIZE, foveated};
use super::surfaces_variants::{all_methods, settings};
use afterimage::gpu::Afterimage;
use afterimage::wgpu::{self, TextureFormat};
use afterimage::{ContextDesc, Filter, Foveation, Gaze, MethodKind, Reset, Settings, ViewFrame};
use afterimage_lab::source::AnalyticSource;
use afterimage_testing::holds;

#[test]
fn h27_two_eyes_with_two_gazes_are_one_dispatch_without_a_leak() {
    for base in all_methods() {
        for view_count in [2, 4] {
            let desc = ContextDesc { view_count, ..ContextDesc::new(SIZE) };
            let Some(mut rig) = Rig::new(desc, base) else { return };
            let scenes = ["occluder", "lateral", "still", "light-step"];
            let mut sources: Vec<_> = scenes[..view_count as usize]
                .iter()
                .map(|scene| AnalyticSource::new(scene, SIZE, 70.0, 60.0).unwrap())
                .collect();
            for index in 0..12 {
                let views: Vec<View> = sources
                    .iter_mut()
                    .enumerate()
                    .map(|(eye, source)| {
                        let mut view = foveated(source, index, &base.foveation);
                        view.facts.gaze = Gaze::At { px: [20.0 + 35.0 * eye as f32, 70.0 - 20.0 * eye as f32] };
                        view
                    })
                    .collect();
                rig.both(index, Reset::None, &views);
            }
        }
    }
}

#[test]
fn h79_poisoned_fresh_history_is_never_visible() {
    for base in all_methods() {
        for filter in [Filter::Mip, Filter::Block] {
            let settings = Settings { foveation: Foveation { filter, ..base.foveation }, ..base };
            for size in [SIZE, [65, 33], [3, 2]] {
                let desc = ContextDesc::new(size);
                let Some(mut rig) = Rig::new(desc, settings) else { return };
                for index in 0..6 {
                    // What was never written, what a reset forgets, and what a resize makes.
                    if index == 5 {
                        rig.resize(size);
                    }
                    if [0, 3, 5].contains(&index) {
                        rig.poison();
                    }
                    let reset = if index == 3 { Reset::All } else { Reset::None };
                    let (made, _) = rig.both(index, reset, &[noise_view("poison", &desc)]);
                    assert!(made.shown.iter().flatten().all(|&c| f32::from_bits(c).is_finite()));
                }
            }
        }
        let Some(mut rig) = Rig::new(ContextDesc::new(SIZE), base) else { return };
        let views = [noise_view("poison", &rig.context)];
        rig.both(0, Reset::None, &views);
        rig.poison();
        let (cpu, _) = rig.on_cpu(1, Reset::None, &views);
        assert!(rig.on_gpu(1, Reset::None, &views) != cpu, "the planted error: no reset");
    }
    holds!("H79", Gpu, "smr and taa: NaN words and levels, fresh, after a reset and a resize: never seen, bit for bit");
}

#[test]
fn two_frames_in_one_submission_see_their_own_constants() {
    for base in all_methods() {
        let Some(mut rig) = Rig::new(ContextDesc::new(SIZE), base) else { return };
        let mut source = AnalyticSource::new("still", SIZE, 70.0, 60.0).unwrap();
        let mut view = foveated(&mut source, 0, &base.foveation);
        let (first, second) = (view.facts, ViewFrame { gaze: Gaze::At { px: [100.0, 20.0] }, ..view.facts });
        rig.on_cpu(0, Reset::None, &[view.clone()]);
        view.facts = second;
        let (expected, trace) = rig.on_cpu(1, Reset::None, &[view.clone()]);
        assert_eq!(rig.on_gpu_in_one_submission(&view, &[first, second]), expected);
        assert!(trace[0].pixels().iter().any(|t| !t.take), "the second frame has a past");
    }
}

#[test]
fn counting_changes_nothing() {
    for base in all_methods() {
        let Some(mut rig) = Rig::new(ContextDesc::new(SIZE), base) else { return };
        let Some(mut other) = Rig::new(ContextDesc::new(SIZE), base) else { return };
        let mut source = AnalyticSource::new("occluder", SIZE, 70.0, 60.0).unwrap();
        for index in 0..6 {
            let views = [foveated(&mut source, index, &base.foveation)];
            let (counted, plain) =
                (rig.on_gpu(index, Reset::None, &views), other.on_gpu_uncounted(index, Reset::None, &views));
            assert!(counted.shown == plain.shown && counted.words == plain.words);
        }
    }
}

#[test]
fn memory_bytes_is_what_is_made() {
    let Some((device, _)) = afterimage_testing::gpu::device() else { return };
    for (method, view_count, filter, size) in [
        (MethodKind::Taa, 1, Filter::Mip, SIZE),
        (MethodKind::Taau, 1, Filter::Mip, SIZE),
        (MethodKind::Smr, 1, Filter::Mip, SIZE),
        (MethodKind::Smr, 2, Filter::Block, SIZE),
        (MethodKind::Smr, 1, Filter::Mip, [1, 1]),
    ] {
        let base = settings(method);
        let settings = Settings { foveation: Foveation { filter, ..base.foveation }, ..base };
        let desc = ContextDesc { view_count, settings, ..ContextDesc::new(size) };
        let post = Afterimage::new(&device, &desc, TextureFormat::Rgba16Float).unwrap();
        // Two words a pixel, and four halves a texel of levels 1 to n, whose sides are padded so that halving never
        // rounds.
        let levels = if method != MethodKind::Smr { 0 } else { 5 + u64::from(filter == Filter::Block) };
        let padded = |len: u32| u64::from(len.div_ceil(2)).next_multiple_of(1 << (levels.max(1) - 1));
        let chain: u64 = (0..levels).map(|l| (padded(size[0]) >> l) * (padded(size[1]) >> l)).sum();
        let expected = 2 * 8 * u64::from(view_count) * (u64::from(size[0] * size[1]) + chain);
        assert_eq!(post.memory_bytes(), expected, "{method:?}, {filter:?}, {size:?}");
        let made: u64 = post.history_textures().iter().map(bytes).sum();
        assert_eq!(2 * made, expected, "two sets of textures");
    }
}

/// Of all levels and layers, by what the texture itself says.
fn bytes(texture: &wgpu::Texture) -> u64 {
    let texel = u64::from(texture.format().block_copy_size(None).unwrap());
    let texels = |l: u32| {
        let size = texture.size().mip_level_size(l, texture.dimension());
        u64::from(size.width) * u64::from(size.height) * u64::from(size.depth_or_array_layers)
    };
    (0..texture.mip_level_count()).map(|l| texel * texels(l)).sum()
}

//! Views, errors, several frames in one submission, corrupt history, resizing, device loss.

use super::*;
use crate::lifecycle_hard::*;
use crate::surfaces_hard;
use std::sync::{Arc, OnceLock};

lifecycle_laws!(Gpu, run_law);

const SIZE: [u32; 2] = [70, 40];

fn agree(desc: ContextDesc, settings: Settings, frames: u64) {
    let Some(mut rig) = Rig::new(desc, settings) else { return };
    let mut kept = 0;
    for index in 0..frames {
        let views: Vec<View> = (0..desc.view_count).map(|v| noise_view(&format!("{index} {v}"), &desc)).collect();
        let (cpu, trace) = rig.on_cpu(index, Reset::None, &views);
        assert_eq!(rig.on_gpu(index, Reset::None, &views).agrees(&cpu), Ok(()), "{desc:?}, frame {index}");
        kept += trace.iter().flat_map(|t| t.pixels()).filter(|t| !t.is_replaced).count();
    }
    assert!(kept > 100, "history must play a part");
}

#[test]
fn h27_stereo_is_one_dispatch_without_a_leak() {
    agree(ContextDesc { view_count: 2, ..ContextDesc::new(SIZE) }, Settings::paper(), 12);
    let settings = wrs(Wrs { sampler: Sampler::AEs, ..Wrs::default() });
    agree(ContextDesc { view_count: 4, ..ContextDesc::new([33, 17]) }, settings, 12);
    agree(ContextDesc { view_count: 2, ..ContextDesc::new(SIZE) }, Settings::weighted(), 12);
    // Planted error: the other eye's history. Swapped layers of history must make a difference.
    let desc = ContextDesc { view_count: 2, ..ContextDesc::new(SIZE) };
    let Some(mut rig) = Rig::new(desc, ungated()) else { return };
    let views = |index: u64| -> Vec<View> { (0..2).map(|v| noise_view(&format!("{index} {v}"), &desc)).collect() };
    rig.on_gpu(0, Reset::None, &views(0));
    rig.on_cpu(0, Reset::None, &views(0));
    rig.swap_past_layers();
    assert_ne!(rig.on_gpu(1, Reset::None, &views(1)), rig.on_cpu(1, Reset::None, &views(1)).0);
}

#[test]
fn h79_poisoned_fresh_history_is_never_visible() {
    for method in METHODS {
        for filter in [FoveationKind::Mip, FoveationKind::Block] {
            let base = surfaces_hard::settings(method);
            let settings = Settings { foveation: Foveation { kind: filter, ..base.foveation }, ..base };
            for size in [[65, 33], [3, 2]] {
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
        let Some(mut rig) = Rig::new(ContextDesc::new(SIZE), surfaces_hard::settings(method)) else { return };
        let views = [noise_view("poison", &rig.context)];
        rig.both(0, Reset::None, &views);
        rig.poison();
        assert!(rig.differs(1, Reset::None, &views), "the planted error: no reset");
    }
    holds!(
        "H79",
        Gpu,
        "wrs, smr, taa: NaN words and levels, fresh, after a reset and a resize: never seen, bit for bit"
    );
}

/// Frames `range`, on both.
fn run(rig: &mut Rig, range: std::ops::Range<u64>) -> Vec<Made> {
    let context = rig.context;
    range.map(|i| rig.both(i, Reset::None, &[noise_view(&format!("run {i}"), &context)]).0).collect()
}

#[test]
fn h76_a_minimised_window_is_refused_and_changes_nothing() {
    let Some([mut rig, mut other]) = Rig::each([(ContextDesc::new(SIZE), ungated()); 2]) else { return };
    run(&mut rig, 0..3);
    run(&mut other, 0..3);
    for size in [[0, 0], [0, 5], [5, 0], [1 << 20, 1]] {
        let error = rig.gpu.resize(&rig.device, size).unwrap_err();
        assert!(matches!(error, FrameError::Extent { .. }), "{error}");
    }
    assert_eq!(rig.gpu.desc().size_px, SIZE);
    assert!(run(&mut rig, 3..6) == run(&mut other, 3..6), "the history is still there");
    holds!("H76", Gpu, "0x0, 0x5, 5x0 and 2^20 x 1 are refused by a typed error; the history goes on, bit for bit");
}

#[test]
fn h77_a_lost_device_is_left_behind_for_a_new_one() {
    for method in [MethodKind::Wrs, MethodKind::Taa, MethodKind::Smr, MethodKind::Taau] {
        let fresh = || Rig::new(ContextDesc::new(SIZE), ungated_of(method));
        let Some(mut lost) = fresh() else { return };
        let reason = Arc::new(OnceLock::new());
        let lost_reason = reason.clone();
        lost.device.set_device_lost_callback(move |why, _| {
            let _ = lost_reason.set(why);
        });
        run(&mut lost, 0..4);
        let desc = wgpu::BufferDescriptor {
            label: None,
            size: 16,
            usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        };
        let buffer = lost.device.create_buffer(&desc);
        let textures = |rig: &Rig| {
            let texture = |usage| make_texture(&rig.device, &rig.context, TextureFormat::Rgba32Float, usage);
            (texture(TextureUsages::TEXTURE_BINDING), texture(TextureUsages::STORAGE_BINDING))
        };
        let record = |rig: &mut Rig, (color, output): (Texture, Texture)| {
            let facts = [noise_view("lost", &rig.context).facts];
            let mut encoder = rig.device.create_command_encoder(&Default::default());
            let frame = Frame::new(&color, &facts, 4);
            let viewed = rig.gpu.record_view(&rig.device, &mut encoder, &frame, &output, DebugView::Age);
            assert_eq!(viewed, Err(FrameError::DeviceLost));
            let recorded = rig.gpu.record(&rig.device, &mut encoder, &frame, &output);
            assert_eq!(recorded, Err(FrameError::DeviceLost));
            rig.queue.submit([encoder.finish()]);
        };
        let textures_before = textures(&lost);
        lost.lose();
        // A frame says it. Nothing panics, whatever the context has to create.
        record(&mut lost, textures_before);
        let textures_after = textures(&lost);
        record(&mut lost, textures_after);
        lost.gpu.resize(&lost.device, [33, 17]).unwrap();
        lost.gpu.forget();
        // The caller gets typed errors of wgpu: the reason, and a readback that does not map.
        let mapped = Arc::new(OnceLock::new());
        let result = mapped.clone();
        buffer.map_async(wgpu::MapMode::Read, .., move |r| {
            let _ = result.set(r);
        });
        let _ = lost.device.poll(wgpu::PollType::wait_indefinitely());
        assert!(matches!(mapped.get(), Some(Err(wgpu::BufferAsyncError))), "{mapped:?}");
        assert_eq!(reason.get(), Some(&wgpu::DeviceLostReason::Destroyed));
        drop(lost);
        // A new context on a new device has no history: it starts with the candidate.
        let mut again = fresh().unwrap();
        let made = run(&mut again, 4..8);
        let candidate = noise_view("run 4", &again.context).color;
        assert!(made[0].shown.iter().zip(candidate.pixels()).all(|(a, b)| *a == b.map(f32::to_bits)), "{method:?}");
        assert!(made == run(&mut fresh().unwrap(), 4..8));
    }
    holds!("H77", Gpu, "wrs, taa, smr: a lost device gives FrameError::DeviceLost, no panic; a new one starts afresh");
}

#[test]
fn good_bad_good_equals_good_good() {
    let desc = ContextDesc::new(SIZE);
    let Some([mut rig, mut other]) = Rig::each([(desc, Settings::paper()); 2]) else { return };
    let frames: Vec<View> = (0..2).map(|i| noise_view(&format!("good {i}"), &desc)).collect();
    rig.on_gpu(0, Reset::None, &frames[..1]);
    other.on_gpu(0, Reset::None, &frames[..1]);
    let texture = |format, usage, size| make_texture(&rig.device, &ContextDesc::new(size), format, usage);
    let read = TextureUsages::TEXTURE_BINDING;
    let write = TextureUsages::STORAGE_BINDING;
    let color = texture(TextureFormat::Rgba16Float, read, SIZE);
    let output = texture(TextureFormat::Rgba32Float, write, SIZE);
    let small = texture(TextureFormat::Rgba16Float, read, [8, 8]);
    let unbound = texture(TextureFormat::Rgba16Float, TextureUsages::COPY_DST, SIZE);
    let integer = texture(TextureFormat::Rgba16Uint, read, SIZE);
    let narrow = texture(TextureFormat::R32Float, read, SIZE);
    let wrong_output = texture(TextureFormat::Rgba16Float, write, SIZE);
    let facts = [frames[0].facts];
    let elsewhere = [ViewFrame { geometry: ViewGeometry::flat([9, 9], 70.0).unwrap(), ..facts[0] }];
    let good = Frame { reset: Reset::All, ..Frame::new(&color, &facts, 7) };
    let bad = [
        Frame { color: (&small).into(), ..good },
        Frame { color: (&unbound).into(), ..good },
        Frame { color: (&integer).into(), ..good },
        Frame { motion: Some((&narrow).into()), ..good },
        Frame { depth: Some((&integer).into()), ..good },
        Frame { trust: Some((&small).into()), ..good },
        Frame { lod: Some((&unbound).into()), ..good },
        Frame { exposure: Exposure::Changed { ratio: 0.0 }, ..good },
        Frame { exposure: Exposure::Scene { exposure: 2.0_f32.powi(41) }, ..good },
        Frame { views: &[], ..good },
        Frame { views: &elsewhere, ..good },
    ];
    let mut encoder = rig.device.create_command_encoder(&Default::default());
    let onto = |output| (good, output);
    for (frame, output) in bad.map(|frame| (frame, &output)).into_iter().chain([onto(&wrong_output), onto(&color)]) {
        let error: FrameError = rig.gpu.record(&rig.device, &mut encoder, &frame, output).unwrap_err();
        println!("{error}");
        assert!(error.to_string().contains("expected"));
    }
    rig.queue.submit([encoder.finish()]);
    assert_eq!(rig.on_gpu(1, Reset::None, &frames[1..]), other.on_gpu(1, Reset::None, &frames[1..]));
}

#[test]
fn memory_bytes_is_what_is_made() {
    let Some((device, _)) = afterimage_testing::gpu::device() else { return };
    let keyed = wrs(Wrs { sampler: Sampler::AEs, ..Wrs::default() });
    for (settings, view_count, bytes) in [(Settings::paper(), 1, 24), (keyed, 1, 32), (keyed, 2, 64)] {
        let desc = ContextDesc { settings, view_count, ..ContextDesc::new(SIZE) };
        let mut post = Afterimage::new(&device, &desc, TextureFormat::Rgba16Float).unwrap();
        assert_eq!(post.memory_bytes(), bytes * u64::from(SIZE[0] * SIZE[1]));
        post.resize(&device, [7, 5]).unwrap();
        assert_eq!(post.memory_bytes(), bytes * 35);
    }
}

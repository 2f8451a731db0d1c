//! Recorded frames that never run, or run late: what the device has of history decides, not what was recorded.

use super::*;
use crate::surfaces_hard;
use afterimage::wgpu::CommandBuffer;

const SIZE: [u32; 2] = [37, 23];
const METHODS: [MethodKind; 4] = [MethodKind::Wrs, MethodKind::Smr, MethodKind::Taa, MethodKind::Taau];
/// The check of the frame number, and what is there without it.
const CHECK: (&str, &str) = ("stored_frame == frame.past_frame", "frame.past_frame != NO_FRAME");

/// Every layout of history.
fn all_settings() -> Vec<Settings> {
    let keyed = wrs(Wrs { sampler: Sampler::AEs, ..Wrs::default() });
    let of_whole_frames = METHODS.map(ungated_of).into_iter().chain([keyed, Settings::weighted(), Settings::traced()]);
    let planned = [MethodKind::Smr, MethodKind::Taau].map(sparse::settings);
    let noisy = Settings { noisy: true, ..sparse::settings(MethodKind::Smr) };
    let planned = planned.into_iter().chain([noisy]).chain([false, true].map(super::quads::settings));
    // Of so many pixels that no plan takes a quarter: after a dropped frame the host believes in history that the
    // device does not have, and would plan another frame than a context without history.
    let planned = planned.map(|settings| {
        let foveation = Foveation { budget: 0.3, ..settings.foveation };
        Settings { foveation, ..settings }
    });
    of_whole_frames.chain(planned).collect()
}

/// A view of the rig's size that moves, over two depths.
fn view(rig: &Rig, index: u64) -> View {
    let (size, settings) = (rig.context.size_px, rig.context.settings);
    let gaze_px = [(index * 11 % 37) as f32, (index * 7 % 23) as f32];
    let mut view = noise_view(&format!("submission {index}"), &rig.context);
    view.facts.gaze = Gaze::At { px: gaze_px };
    view.motion = Some(Image::from_fn(size, |[x, _]| if x % 16 < 8 { [1.0, 0.0] } else { [0.5, -0.25] }));
    view.noise = settings.noisy.then(|| Image::filled(size, [0.05, 2.0]));
    view
}

/// Frames, resizes and cuts at random, of which the device gets some. The CPU gets these alone, and a reset where the
/// frame before was dropped. Returns the numbers of frames compared, of those after a dropped one, and of differences.
fn run(rig: &mut Rig, name: &str, frames: u64) -> [usize; 3] {
    let mut draws = Draws::new(name);
    let (mut is_broken, mut compared, mut after_drop, mut differences) = (false, 0, 0, 0);
    for index in 0..frames {
        rig.drops = draws.uniform() < 0.3;
        rig.exposure = Exposure::Scene { exposure: [1.0, 0.7, 3.0][index as usize % 3] };
        match draws.bits() % 12 {
            0 => rig.forget(),
            1 => rig.resize([SIZE, [18, 40]][draws.bits() as usize % 2]),
            2 => {
                rig.resize_keeping_history([SIZE, [40, 18]][draws.bits() as usize % 2]);
                is_broken |= rig.drops;
            }
            _ => {}
        }
        let reset = if draws.bits().is_multiple_of(10) { Reset::All } else { Reset::None };
        let view = view(rig, index);
        let gpu = rig.on_gpu(index, reset, std::slice::from_ref(&view));
        if rig.drops {
            is_broken = true;
            continue;
        }
        let (cpu, _) = rig.on_cpu(index, if is_broken { Reset::All } else { reset }, &[view]);
        compared += 1;
        after_drop += usize::from(is_broken);
        differences += usize::from(gpu.agrees(&cpu).is_err());
        rig.goes_on_from(index, &cpu);
        is_broken = false;
    }
    [compared, after_drop, differences]
}

#[test]
fn h103_a_frame_after_one_that_never_ran_has_no_history() {
    let (mut frames, mut alone) = (0, 0);
    for (i, settings) in all_settings().into_iter().enumerate() {
        let desc = ContextDesc::new(SIZE);
        let Some(mut rig) = Rig::new(desc, settings) else { return };
        let [compared, after_drop, differences] = run(&mut rig, &format!("dropped {i}"), 48);
        assert_eq!(differences, 0, "{settings:?}");
        assert!(after_drop > 5);
        (frames, alone) = (frames + compared, alone + after_drop);
        if i % 3 != 0 {
            continue;
        }
        // Planted error: history is read as the host believes it to be.
        let source = SHADERS.compose(method_pass(&settings)).source;
        assert!(source.contains(CHECK.0));
        let mut wrong = Rig::with_shader(desc, settings, &source.replace(CHECK.0, CHECK.1)).unwrap();
        assert!(run(&mut wrong, &format!("dropped {i}"), 48)[2] > 2, "{settings:?}: the planted error");
    }
    holds!(
        "H103",
        Gpu,
        "{frames} frames of twelve settings, {alone} of them after dropped frames, resizes and cuts: as if only what ran had been recorded, with a reset, bit for bit"
    );
}

/// Without the check, too: where nothing was ever written, nothing is stored.
#[test]
fn zeroed_history_is_empty() {
    for settings in all_settings() {
        let sources = Sources::new(|name| SHADERS.compose(name).source.replace(CHECK.0, CHECK.1).into());
        let Some(mut rig) = Rig::with_sources(ContextDesc::new(SIZE), settings, |_| sources) else { return };
        rig.drops = true;
        let views = [view(&rig, 0)];
        rig.on_gpu(0, Reset::None, &views);
        rig.drops = false;
        let first = rig.on_gpu(1, Reset::None, &views);
        let (expected, _) = rig.on_cpu(1, Reset::None, &views);
        agree::colors(&first.shown, &expected.shown).unwrap_or_else(|error| panic!("{settings:?}: {error}"));
        assert!(first.words == expected.words || !afterimage_testing::gpu::rounds_as_the_cpu(), "{settings:?}");
        assert_ne!(first.stats, expected.stats, "history was looked at: it was empty, not reset");
    }
}

/// A recorded frame that was not submitted yet.
fn recorded(rig: &mut Rig, index: u64, [color, output]: &[Texture; 2]) -> CommandBuffer {
    let views = [view(rig, index)];
    let texels: Vec<f32> = views[0].color.pixels().iter().flat_map(|c| [c[0], c[1], c[2], 1.0]).collect();
    afterimage_testing::gpu::write_layer(&rig.queue, color, 0, bytemuck::cast_slice(&texels));
    let facts = [views[0].facts];
    let mut encoder = rig.device.create_command_encoder(&Default::default());
    rig.gpu.record(&rig.device, &mut encoder, &Frame::new(color, &facts, index), output).unwrap();
    encoder.finish()
}

/// What `order` of six recorded frames shows, and the CPU for the frames `expected`, each with or without history.
#[track_caller]
fn ordered(method: MethodKind, order: &[&[usize]], expected: &[(u64, Reset)]) {
    let Some(mut rig) = Rig::new(ContextDesc::new(SIZE), surfaces_hard::settings(method)) else { return };
    let texture = |usage| make_texture(&rig.device, &rig.context, TextureFormat::Rgba32Float, usage);
    let textures = [0; 6].map(|_| {
        let read = TextureUsages::TEXTURE_BINDING | TextureUsages::COPY_DST;
        [texture(read), texture(TextureUsages::STORAGE_BINDING | TextureUsages::COPY_SRC)]
    });
    let mut buffers: Vec<_> = (0..).zip(&textures).map(|(i, t)| Some(recorded(&mut rig, i, t))).collect();
    for submission in order {
        let submission: Vec<_> = submission.iter().map(|&i| buffers[i].take().unwrap()).collect();
        rig.queue.submit(submission);
    }
    for &(index, reset) in expected {
        let view = view(&rig, index).with(|view| (view.depth, view.motion) = (None, None));
        let (cpu, _) = rig.on_cpu(index, reset, &[view]);
        let shown = read_texture(&rig.device, &rig.queue, &textures[index as usize][1]);
        let shown: Vec<[u32; 3]> = shown.chunks_exact(4).map(|c| [c[0], c[1], c[2]]).collect();
        let same = agree::colors(&shown, &cpu.shown);
        same.unwrap_or_else(|error| panic!("{method:?}, frame {index} of {order:?}: {error}"));
    }
}

#[test]
fn frames_that_run_out_of_order_have_no_history() {
    use Reset::{All, None};
    for method in METHODS {
        // In order: in one submission, in three, and in one of several command buffers.
        let all = [0, 1, 2, 3, 4, 5].map(|i| (i, None));
        ordered(method, &[&[0, 1, 2, 3, 4, 5]], &all);
        ordered(method, &[&[0, 1], &[2], &[3, 4, 5]], &all);
        // The third before the second: both are without history, and the fourth continues the third.
        ordered(method, &[&[0, 2], &[1, 3, 4]], &[(0, None), (2, All), (3, None), (4, None)]);
        ordered(method, &[&[0], &[2, 1, 3, 4]], &[(1, All)]);
        // The second a whole turn late, over what the fourth stored.
        ordered(method, &[&[0], &[2, 3], &[1], &[4, 5]], &[(2, All), (3, None), (4, All), (5, None)]);
        // Two and three in a row that never run.
        ordered(method, &[&[0], &[3], &[4, 5]], &[(0, None), (3, All), (4, None), (5, None)]);
        ordered(method, &[&[0, 4, 5]], &[(0, None), (4, All), (5, None)]);
    }
}

//! What is known of decisions: counters, debug views, warnings. They agree with the CPU's, cost no state, and can be
//! left out.

use super::rig::{Rig, View, make_texture, same_counts};
use super::sequences::{SIZE, reset, surfaces, trust, view};
use afterimage::gpu::{Frame, Recorded};
use afterimage::internal::{ContextDesc, Method, Reset, Sampler, Settings, ViewFrame, Wrs};
use afterimage::kernel::debug_view::view_color;
use afterimage::wgpu::{TextureFormat, TextureUsages};
use afterimage::{DebugView, Exposure, FrameStats, Gaze, Verdict, Warning};
use afterimage_lab::source::AnalyticSource;
use afterimage_testing::agree;

fn source(scene: &str) -> AnalyticSource {
    AnalyticSource::new(scene, SIZE, 70.0, 60.0).unwrap()
}

/// With broken numbers and a mask, so that every verdict occurs.
fn masked(source: &mut AnalyticSource, index: u64) -> View {
    View { trust: Some(trust(index)), ..view(source, index) }
}

#[test]
fn debug_views_draw_what_record_decides_next_and_move_nothing() {
    let base = Settings::paper();
    let of = |method| Settings { method, ..base };
    let keyed = Wrs { sampler: Sampler::AEs, gate: None, ..Wrs::default() };
    // Each view of each method compiles a pipeline: but for the first method, they take turns.
    let mut in_turn = DebugView::ALL.into_iter().cycle();
    for settings in
        [base, of(Method::Wrs(keyed)), of(Method::None), of(Method::Taa), of(Method::Taau), Settings::steady()]
    {
        let drawn: Vec<_> = in_turn.by_ref().take(if settings == base { DebugView::ALL.len() } else { 2 }).collect();
        let Some(mut rig) = Rig::new(ContextDesc::new(SIZE), settings) else { return };
        let Some(mut undisturbed) = Rig::new(ContextDesc::new(SIZE), settings) else { return };
        let mut source = source("occluder");
        let mut seen = [0; Verdict::COUNT];
        for index in 0..14 {
            rig.exposure = if index == 10 { Exposure::Changed { ratio: 2.0 } } else { Exposure::Same };
            undisturbed.exposure = rig.exposure;
            let views = [masked(&mut source, index)];
            let pictures: Vec<_> = drawn.iter().map(|&v| rig.decisions(index, reset(index), &views, v)).collect();
            let counted = rig.read().stats;
            let (cpu, trace) = rig.on_cpu(index, reset(index), &views);
            same_counts(&counted, &cpu.stats).expect("a view counts, too");
            for (&view, picture) in drawn.iter().zip(&pictures) {
                let bits = |t| view_color(view, t).to_array().map(f32::to_bits);
                let same = agree::colors(picture, &trace[0].pixels().iter().map(bits).collect::<Vec<_>>());
                same.unwrap_or_else(|error| panic!("{settings:?}, {view:?}, frame {index}: {error}"));
            }
            let after = rig.on_gpu(index, reset(index), &views);
            assert!(after == undisturbed.on_gpu(index, reset(index), &views), "frame {index}");
            after.agrees(&cpu).unwrap_or_else(|error| panic!("frame {index}: {error}"));
            rig.goes_on_from(index, &cpu);
            undisturbed.goes_on_from(index, &cpu);
            for (sum, n) in seen.iter_mut().zip(cpu.stats.verdicts) {
                *sum += n;
            }
        }
        println!("verdicts {seen:?}");
        assert!(settings.method == Method::None || seen.iter().all(|&n| n > 0), "every verdict is shown: {seen:?}");
    }
}

#[test]
fn counting_changes_nothing_and_may_be_left_out() {
    for settings in [Settings::paper()].into_iter().chain(surfaces()) {
        let Some(mut counted) = Rig::new(ContextDesc::new(SIZE), settings) else { return };
        let Some(mut uncounted) = Rig::new(ContextDesc::new(SIZE), settings) else { return };
        let mut source = source("occluder");
        for index in 0..4 {
            let views = [masked(&mut source, index)];
            let with = counted.on_gpu(index, Reset::None, &views);
            let without = uncounted.on_gpu_uncounted(index, Reset::None, &views);
            assert_eq!((with.shown, with.words), (without.shown, without.words));
            assert_eq!(with.stats.pixels, u64::from(SIZE[0] * SIZE[1]));
            assert_eq!(without.stats, FrameStats::default(), "not counted, not cleared");
            let said: Vec<_> = with.stats.warnings().collect();
            assert!(said.iter().any(|w| matches!(w, Warning::NonfiniteColor { pixels: 1.. })), "{said:?}");
            assert!(said.iter().any(|w| matches!(w, Warning::BadTrust { pixels: 1.. })), "{said:?}");
        }
    }
}

#[test]
fn h63_what_is_odd_about_the_gaze_is_said_at_once() {
    let desc = ContextDesc { view_count: 2, ..ContextDesc::new(SIZE) };
    let Some(mut rig) = Rig::new(desc, Settings::paper()) else { return };
    let texture = |usage| make_texture(&rig.device, &desc, TextureFormat::Rgba32Float, usage);
    let (color, output) = (texture(TextureUsages::TEXTURE_BINDING), texture(TextureUsages::STORAGE_BINDING));
    let mut source = source("still");
    let facts = view(&mut source, 0).facts;
    let mut index = 0;
    let mut record = |gazes: [Gaze; 2]| -> Recorded {
        let views = gazes.map(|gaze| ViewFrame { gaze, ..facts });
        let mut encoder = rig.device.create_command_encoder(&Default::default());
        index += 1;
        let frame = Frame::new(&color, &views, index);
        let seen = rig.gpu.record_view(&rig.device, &mut encoder, &frame, &output, DebugView::Agreement).unwrap();
        let recorded = rig.gpu.record(&rig.device, &mut encoder, &frame, &output).unwrap();
        assert_eq!(seen, recorded, "a view moves no state");
        rig.queue.submit([encoder.finish()]);
        recorded
    };
    let at = |x, y| Gaze::At { px: [x, y] };
    let expect = |recorded: Recorded, list: &[Warning]| assert_eq!(recorded.warnings().collect::<Vec<_>>(), list);
    let [right, bottom] = [SIZE[0] as f32 - 0.5, SIZE[1] as f32 - 0.5];
    expect(record([at(3.0, 3.0), Gaze::Lost]), &[Warning::GazeUnknown { view: 1 }]);
    // The middle that was taken is held from then on, like any gaze.
    expect(record([Gaze::Lost, Gaze::Lost]), &[Warning::GazeHeld { view: 0 }, Warning::GazeHeld { view: 1 }]);
    expect(record([at(f32::NAN, 1.0), at(-0.5, -0.5)]), &[Warning::GazeHeld { view: 0 }]);
    expect(record([at(right, 5.0), at(5.0, bottom)]), &[0, 1].map(|view| Warning::GazeOffScreen { view }));
    expect(record([at(right.next_down(), 5.0), at(5.0, bottom.next_down())]), &[]);
    for warning in record([Gaze::Lost, at(1e9, 0.0)]).warnings() {
        println!("{warning}");
    }
}

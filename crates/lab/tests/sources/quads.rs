//! Frames of which methods choose the quads that they read, simulated on whole frames.

use afterimage::cpu::{CpuAfterimage, Frame};
use afterimage::{ContextDesc, Foveation, Gaze, Image, Method, MethodKind, Settings, Smr, ViewFrame, ViewGeometry};
use afterimage_lab::device::Backend;
use afterimage_lab::pipeline::{Pipeline, RunKind};
use afterimage_lab::source::{AnalyticSource, FrameSource};

const SIZE: [u32; 2] = [161, 91];
const GAZE: [f32; 2] = [60.0, 50.0];
const METHODS: [MethodKind; 5] =
    [MethodKind::None, MethodKind::Taa, MethodKind::Taau, MethodKind::Wrs, MethodKind::Smr];

fn settings(method: MethodKind, budget: f32) -> Settings {
    let method = match method {
        MethodKind::Smr => Method::Smr(Smr { antialias: true, ..Smr::default() }),
        other => other.into(),
    };
    Settings { method, foveation: Foveation { budget, ..Foveation::quads() }, ..Settings::default() }
}

fn pipeline(source: &AnalyticSource, budget: f32) -> Pipeline {
    let geometry = ViewGeometry::flat(SIZE, source.info().hfov_deg.unwrap()).unwrap();
    let kinds = METHODS.map(|method| RunKind::PostProcess(settings(method, budget)));
    let foveation = Foveation { budget, ..Foveation::quads() };
    Pipeline::new(geometry, foveation, &kinds, false, &[], &Backend::Cpu).unwrap().with_jitter()
}

/// Shares of the pixels that each method chooses, frame by frame.
fn shares(clip: &str, budget: f32, frames: u64) -> Vec<Vec<f64>> {
    let mut source = AnalyticSource::new(clip, SIZE, 70.0, 60.0).unwrap();
    let mut pipeline = pipeline(&source, budget);
    let mut frame = |index| {
        let frame = source.render(&pipeline.request(index, Some(GAZE))).unwrap();
        pipeline.step(&frame).unwrap().outputs.iter().map(|output| output.chosen.unwrap().share).collect()
    };
    (0..frames).map(&mut frame).collect()
}

/// The even pattern is the same for all methods. None exceeds the budget, and smr spends most of it.
fn keeps_to(budget: f64, even: &[Vec<f64>], shares: &[Vec<f64>]) -> bool {
    even.iter().zip(shares).all(|(even, shares)| {
        // A part of the quads at the right and lower edges lies beyond them: a share of quads is one of pixels within
        // a few hundredths.
        let spent: Vec<f64> = shares.iter().map(|share| share - even[0]).collect();
        even.iter().all(|share| *share == even[0])
            && spent.iter().all(|&spent| (0.0..=1.02 * budget).contains(&spent))
            && spent[METHODS.len() - 1] > 0.6 * budget
    })
}

#[test]
fn methods_shade_the_even_pattern_and_smr_spends_the_budget() {
    for clip in ["lateral", "occluder", "turn"] {
        let even = shares(clip, 0.0, 6);
        println!("{clip}: even pattern {:?}", even[5]);
        assert!(even.iter().all(|even| even[0] > 0.02 && even[0] < 0.15), "{even:?}");
        for budget in [0.01, 0.04] {
            let chosen = shares(clip, budget, 6);
            println!("{clip}, budget {budget}: {:?}", chosen[5]);
            assert!(keeps_to(f64::from(budget), &even, &chosen), "{clip}, {budget}: {chosen:?}, {even:?}");
            assert!(!keeps_to(f64::from(budget) / 2.0, &even, &chosen), "a planted error: twice the budget");
        }
    }
}

/// Whether pixels of chosen quads, and no others but by chance, are those of a frame.
fn shows_chosen(shown: &Image<[f32; 3]>, full: &Image<[f32; 3]>, chosen: &Image<bool>) -> bool {
    let all = shown.pixels().iter().zip(full.pixels()).zip(chosen.pixels());
    let (mut is_right, mut unshaded, mut different) = (true, 0, 0);
    for ((shown, full), chosen) in all {
        is_right &= !chosen || shown == full;
        unshaded += u32::from(!chosen);
        different += u32::from(!chosen && shown != full);
    }
    is_right && 2 * different > unshaded
}

#[test]
fn the_first_picture_differs_from_full_rate_where_nothing_was_shaded() {
    let mut source = AnalyticSource::new("lateral", SIZE, 70.0, 60.0).unwrap();
    let mut pipeline = pipeline(&source, 0.025);
    let frame = source.render(&pipeline.request(0, Some(GAZE))).unwrap();
    let step = pipeline.step(&frame).unwrap();
    let given = frame.given();
    for (method, output) in METHODS.into_iter().zip(&step.outputs) {
        // The same plan from a context of its own.
        let desc = ContextDesc { settings: settings(method, 0.025), ..ContextDesc::new(SIZE) };
        let geometry = ViewGeometry::flat(SIZE, source.info().hfov_deg.unwrap()).unwrap();
        let view = ViewFrame { jitter_px: frame.jitter_px, ..ViewFrame::new(geometry, Gaze::At { px: GAZE }) };
        let (depth, motion) = ([given.depth.as_ref().unwrap()], [given.motion.as_ref().unwrap()]);
        let planned =
            Frame { depth: Some(&depth), motion: Some(&motion), ..Frame::new(&[], std::slice::from_ref(&view), 0) };
        let chosen = CpuAfterimage::new(&desc).unwrap().plan(&planned).unwrap()[0].clone();
        let count = chosen.pixels().iter().filter(|&&chosen| chosen).count();
        assert_eq!(output.chosen.unwrap().share, count as f64 / chosen.pixels().len() as f64, "{}", method.name());
        // taau and antialiased history move samples to the pixels' centres.
        if matches!(method, MethodKind::None | MethodKind::Taa | MethodKind::Wrs) {
            assert!(shows_chosen(&output.image, &given.color, &chosen), "{}", method.name());
            let moved = Image::from_fn(SIZE, |[x, y]| chosen.at((x as usize + 2) % SIZE[0] as usize, y as usize));
            assert!(!shows_chosen(&output.image, &given.color, &moved), "a planted error: the mask a quad aside");
        }
    }
}

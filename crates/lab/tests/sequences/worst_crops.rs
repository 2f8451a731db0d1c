//! The law of smr: no crop of 64x64 pixels is visibly worse than in the foveated frame (H85).

use afterimage::internal::{Foveation, FoveationKind, Method, Settings, Smr};
use afterimage_lab::device::Backend;
use afterimage_lab::metric::{Crops, WorstCrop, encode};
use afterimage_lab::pipeline::{Pipeline, RunKind};
use afterimage_lab::source::{AnalyticSource, FrameSource};
use afterimage_testing::holds;

const SIZE: [u32; 2] = [320, 180];
const FRAMES: u64 = 56;

/// Fixations of eight frames each, over the middle of the view.
fn gaze(index: u64) -> [f32; 2] {
    let spots = [[160.0, 90.0], [110.0, 70.0], [200.0, 110.0], [160.0, 50.0], [140.0, 130.0], [225.0, 75.0]];
    spots[(index / 8) as usize % spots.len()]
}

/// The worst crop on a scene of each run of smr: its foveation's filter and rates, and its settings.
fn worst<const N: usize>(scene: &str, runs: [(FoveationKind, [u32; 2], Smr); N]) -> [WorstCrop; N] {
    let mut source = AnalyticSource::new(scene, SIZE, 70.0, 60.0).unwrap();
    let of = |method| RunKind::PostProcess(Settings { method, ..Settings::default() });
    let mut pipelines = runs.map(|(filter, [rate_mid, rate_far], smr)| {
        let foveation = Foveation { kind: filter, rate_mid, rate_far, ..Foveation::default() };
        let kinds = [of(Method::None), of(Method::Smr(smr))];
        Pipeline::new(*source.view(), foveation, &kinds, false, &[], &Backend::Cpu).unwrap()
    });
    let mut crops = [Crops::default(); N];
    for index in 0..FRAMES {
        // Rendering takes most of the time: all runs are given one frame.
        let frame = source.render(&pipelines[0].request(index, Some(gaze(index)))).unwrap();
        let full = encode(&frame.reference.color, 0.0);
        for (crops, pipeline) in crops.iter_mut().zip(&mut pipelines) {
            let step = pipeline.step(&frame).unwrap();
            let [foveated, shown] = [0, 1].map(|i| encode(&step.outputs[i].image, 0.0));
            crops.push(&full, &shown, &foveated);
        }
    }
    crops.map(|crops| crops.worst().unwrap())
}

#[test]
fn h85_no_crop_of_smr_is_visibly_worse_than_the_foveated_frame() {
    let mut least = f64::INFINITY;
    let mut holds = |scene: &str, mips: &[WorstCrop]| {
        for smr in mips {
            println!("{scene}: {smr:?}");
            assert!(smr.delta_db > -0.3, "{scene}: {smr:?}");
            least = least.min(smr.delta_db);
        }
    };
    let [a, b, c] = [[2, 4], [4, 8], [8, 16]].map(|rates| (FoveationKind::Mip, rates, Smr::default()));
    for scene in ["still", "lateral", "turn", "walk", "light-step"] {
        holds(scene, &worst(scene, [a, b, c]));
    }
    // Point-sampled blocks: a sample of another surface, or of a highlight, is accumulated. Measured: see the row.
    let blocks = (FoveationKind::Block, [4, 8], Smr::default());
    // The planted error: a gate that hardly ever closes.
    let open = (FoveationKind::Mip, [4, 8], Smr { tolerance: 10.0, ..Smr::default() });
    let [mips @ .., blocks, open] = worst("spin", [a, b, c, blocks, open]);
    holds("spin", &mips);
    println!("spin, blocks: {blocks:?}; open gate: {open:?}");
    assert!(blocks.delta_db > -4.0, "{blocks:?}");
    assert!(open.delta_db < -1.0, "{open:?}");
    let (scenes, [blocks, open]) = ("6 scenes at rates 2/4, 4/8, 8/16", [blocks, open].map(|crop| crop.delta_db));
    holds!(
        "H85",
        Cpu,
        "{scenes}: least {least:.2} dB; spin with point samples {blocks:.1}, with an open gate {open:.1}"
    );
}

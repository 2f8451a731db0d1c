//! Sparse frames in the pipeline: lattices that move, geometry at samples, and both executors alike.

use afterimage::kernel::lattice::offset_px;
use afterimage::{Filter, Foveation, MethodKind, Settings};
use afterimage_lab::device::Backend;
use afterimage_lab::lattices::{Geometry, SampleOrder};
use afterimage_lab::pipeline::{Pipeline, RunKind, Step};
use afterimage_lab::source::{AnalyticSource, FrameSource};
use std::collections::HashSet;

const SIZE: [u32; 2] = [160, 90];
const METHODS: [MethodKind; 4] = [MethodKind::None, MethodKind::Taa, MethodKind::Wrs, MethodKind::Taau];

fn foveation() -> Foveation {
    Foveation { filter: Filter::Sparse, rate_mid: 2, rate_far: 8, ..Foveation::default() }
}

fn kinds() -> Vec<RunKind> {
    METHODS.map(|method| RunKind::PostProcess(Settings { method: method.into(), ..Settings::paper() })).to_vec()
}

fn source(scene: &str) -> AnalyticSource {
    AnalyticSource::new(scene, SIZE, 70.0, 60.0).unwrap()
}

fn gaze(index: u64) -> [f32; 2] {
    [60.0 + 7.0 * index as f32, 45.0 - 3.0 * index as f32]
}

/// Frames of a scene through a pipeline.
fn steps(scene: &str, geometry: Geometry, order: SampleOrder, backend: &Backend) -> Vec<Step> {
    let mut source = source(scene);
    let pipeline = Pipeline::new(*source.view(), foveation(), &kinds(), source.info().still, &[], backend).unwrap();
    let mut pipeline = pipeline.with_sparse(geometry, order);
    let step = |i| {
        let frame = source.render(&pipeline.request(i, Some(gaze(i)))).unwrap();
        pipeline.step(&frame).unwrap()
    };
    (0..6).map(step).collect()
}

#[test]
fn foveated_frames_have_the_samples_of_the_full_ones() {
    let mut source = source("lateral");
    let view = *source.view();
    let steps = steps("lateral", Geometry::Full, SampleOrder::Bayer, &Backend::Cpu);
    let mut seen = HashSet::new();
    for (index, step) in steps.iter().enumerate() {
        let full = source.frame(index as u64).unwrap().color;
        let lattices = foveation().lattices(&view, step.gaze_px, index as u64);
        let mut samples = 0;
        for [x, y] in (0..SIZE[1]).flat_map(|y| (0..SIZE[0]).map(move |x| [x, y])) {
            let (lattice, i, j) = (lattices.at([x, y]).unwrap(), x as usize, y as usize);
            assert_eq!(step.lods.at(i, j), lattice.step.ilog2() as f32);
            if lattice.samples([x, y]) {
                assert_eq!(step.outputs[0].image.at(i, j), full.at(i, j));
                samples += 1;
            }
        }
        assert!(samples < SIZE[0] * SIZE[1] / 3, "{samples} samples");
        seen.insert(lattices.as_slice().last().unwrap().offset_px());
        println!("frame {index}: {samples} samples of {}", SIZE[0] * SIZE[1]);
    }
    assert_eq!(seen.len(), steps.len(), "samples move every frame");
}

#[test]
fn geometry_at_samples_matters() {
    let of = |geometry| steps("occluder", geometry, SampleOrder::Bayer, &Backend::Cpu);
    let rejected = |steps: Vec<Step>| steps.iter().map(|s| s.outputs[2].stats.rejected()).sum::<u64>();
    assert_ne!(rejected(of(Geometry::Full)), rejected(of(Geometry::Samples)));
}

#[test]
fn every_order_samples_each_pixel_of_a_block_once() {
    for order in SampleOrder::ALL {
        for step in [1, 2, 4, 8, 16, 256] {
            let turn = u64::from(step * step);
            let offsets: HashSet<_> = (0..turn).map(|index| order.offset_px(index, step)).collect();
            assert_eq!(offsets.len() as u64, turn, "{order:?}, step {step}");
            assert!(offsets.iter().flatten().all(|&v| v < step));
            assert_eq!(order.offset_px(turn + 3, step), order.offset_px(3, step));
        }
    }
    assert_eq!(SampleOrder::Bayer.offset_px(5, 8), offset_px(5, 8));
    // As many samples in all columns, rows and quarters of a block after as many frames.
    let of = |index| SampleOrder::Sobol.offset_px(index, 8);
    for first in [0, 8, 16, 24] {
        let columns: HashSet<_> = (first..first + 8).map(|i| of(i)[0]).collect();
        let rows: HashSet<_> = (first..first + 8).map(|i| of(i)[1]).collect();
        assert_eq!((columns.len(), rows.len()), (8, 8));
    }
    let quarters: HashSet<_> = (0..4).map(|i| of(i).map(|v| v / 4)).collect();
    assert_eq!(quarters.len(), 4);
}

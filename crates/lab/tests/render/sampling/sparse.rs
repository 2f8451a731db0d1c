//! Samples of moving lattices: they lie where the post-process reads them, have the color that was traced there, and
//! nothing else is traced.

use super::fills::Yard;
use afterimage::{Image, Lattices, ViewGeometry};
use afterimage_lab::lattices::SampleOrder;
use afterimage_lab::trace::film::Film;
use afterimage_lab::trace::sampling::{Lattice, Layers, Regions, Sampling};
use afterimage_lab::trace::settings::TraceSettings;
use afterimage_lab::trace::work::Spans;
use std::collections::{HashMap, HashSet};

const SIZE: [u32; 2] = [160, 90];

fn patterns() -> [Sampling; 2] {
    let regions = Regions { samples: [3, 2, 1], diameters_deg: [8.0, 25.0], ..Regions::default() };
    let layers = Layers { radii_deg: [3.0, 7.0, 15.0], steps: [1, 2, 4, 8], lens_deg: None };
    [Sampling::Regions(regions), Sampling::Layers(layers)]
}

/// Pixels whose samples the post-process reads for a pixel: the four of its lattice around it.
fn read_for(lattices: &Lattices, [x, y]: [u32; 2]) -> Vec<[u32; 2]> {
    let lattice = lattices.at([x, y]).unwrap();
    let along = |i: usize, px: u32| {
        let (first, step) = (i64::from(lattice.first_px[i]), i64::from(lattice.step));
        let last = i64::from(lattice.points[i] - 1).min((i64::from(SIZE[i]) - 1 - first) / step);
        let low = (i64::from(px) - first).div_euclid(step);
        // A sample beyond a pixel on the lattice has no weight.
        let high = if (i64::from(px) - first).rem_euclid(step) == 0 { low } else { low + 1 };
        [low, high].map(|point| (first + point.clamp(0, last) * step) as u32)
    };
    let (xs, ys) = (along(0, x), along(1, y));
    ys.into_iter().flat_map(|y| xs.map(|x| [x, y])).collect()
}

#[test]
fn what_the_post_process_reads_is_traced_and_little_else() {
    let yard = Yard::new(SIZE, TraceSettings::default());
    for sampling in patterns() {
        let mut offsets = HashSet::new();
        for (frame, gaze) in [(0, [80.0, 45.0]), (5, [10.0, 80.0]), (11, [150.3, 2.0]), (14, [-400.0, 45.0])] {
            let plan = sampling.sparse_plan(yard.geometry(), gaze, 2, frame, SampleOrder::Bayer).unwrap();
            let traced: HashMap<[u32; 2], u32> = plan.pixels().collect();
            assert_eq!(traced.len(), plan.pixels().count(), "no pixel is traced twice");
            let read = (0..SIZE[1]).flat_map(|y| (0..SIZE[0]).flat_map(move |x| [[x, y]]));
            let read: HashSet<_> = read.flat_map(|px| read_for(plan.lattices(), px)).collect();
            for px in &read {
                assert!(traced.contains_key(px), "{sampling:?}, frame {frame}: {px:?} is read");
            }
            let spare = traced.keys().filter(|px| !read.contains(*px)).count();
            println!("{}, {spare} of them spare", traced.len());
            assert!(spare * 20 < traced.len(), "{spare} samples of {} are not read", traced.len());
            offsets.insert(plan.lattices().as_slice().last().unwrap().offset_px());
            assert_eq!(plan.samples().iter().sum::<u64>(), traced.values().map(|&n| u64::from(n)).sum::<u64>());
        }
        assert_eq!(offsets.len(), 4, "lattices move");
    }
}

#[test]
fn samples_have_the_colors_traced_at_their_places() {
    let yard = Yard::new(SIZE, TraceSettings::default());
    for sampling in patterns() {
        let plan = sampling.sparse_plan(yard.geometry(), [60.0, 50.0], 2, 7, SampleOrder::Bayer).unwrap();
        let made = plan.trace(&yard.tracer, &yard.world, &yard.view, 7);
        assert_eq!(made.lattices, Some(*plan.lattices()));
        let level = |px| plan.lattices().at(px).map_or(0.0, |lattice| lattice.step.ilog2() as f32);
        assert_eq!(made.lod, Image::from_fn(SIZE, level));
        let traced: HashMap<[u32; 2], u32> = plan.pixels().collect();
        for (i, color) in made.color.pixels().iter().enumerate() {
            let px = [i as u32 % SIZE[0], i as u32 / SIZE[0]];
            assert_eq!(traced.contains_key(&px), color.iter().all(|v| v.is_finite()), "{sampling:?} at {px:?}");
        }
        // Each point of each lattice again, by itself, in a view whose pixel (x, y) is the lattice's point.
        let mut seen = 0;
        for lattice in plan.lattices().as_slice() {
            let first_px = lattice.first_px.map(|v| v as f32);
            let grid = Lattice { step: lattice.step, first_px, points: lattice.points, footprint_px: 1.0 };
            for (x, y) in (0..lattice.points[1]).flat_map(|y| (0..lattice.points[0]).map(move |x| (x, y))) {
                let px = [lattice.first_px[0] + x * lattice.step, lattice.first_px[1] + y * lattice.step];
                if px[0] >= SIZE[0] || px[1] >= SIZE[1] || plan.lattices().at(px) != Some(lattice) {
                    continue;
                }
                let work = Spans::new([[x, y]], 0..traced[&px]);
                let mut film = Film::window([x, y], [1, 1]);
                yard.tracer.trace(&yard.world, &yard.view.on_lattice(&grid), 7, &work, &mut film);
                assert_eq!(made.color.at(px[0] as usize, px[1] as usize), film.at([x, y]).mean.to_array(), "{px:?}");
                assert_eq!(made.noise.as_ref().unwrap().at(px[0] as usize, px[1] as usize)[1], traced[&px] as f32);
                seen += 1;
            }
        }
        assert!(seen * 10 > traced.len() * 9, "{seen} of {}", traced.len());
    }
}

#[test]
fn regions_of_one_step_are_one_lattice() {
    let geometry = ViewGeometry::flat([64, 36], 40.0).unwrap();
    let regions = Regions { blocks: [4, 4], samples: [3, 2, 1], ..Regions::default() };
    let plan = Sampling::Regions(regions).sparse_plan(&geometry, [30.0, 20.0], 9, 5, SampleOrder::Bayer).unwrap();
    assert_eq!(plan.lattices().as_slice().iter().map(|l| l.step).collect::<Vec<_>>(), [1, 4]);
    let samples: HashSet<u32> = plan.pixels().map(|(_, samples)| samples).collect();
    assert_eq!(samples, HashSet::from([3, 1]), "of the fovea, and of the outer region");
}

//! Analytic scenes: depth and motion against independent closed forms in f64, invariance over time, threads and size,
//! and the fixture of a page of text.

use afterimage::Image;
use afterimage_lab::frame::SourceFrame;
use afterimage_lab::source::FrameSource;
use afterimage_lab::source::analytic::{AnalyticSource, LIGHT_STEP};

mod oracle;
mod page;

const SIZE: [u32; 2] = [640, 360];
const FPS: f64 = 60.0;

fn source(name: &str, size: [u32; 2]) -> AnalyticSource {
    AnalyticSource::new(name, size, 70.0, FPS as f32).unwrap()
}

fn frames(name: &str, indices: [u64; 2]) -> [SourceFrame; 2] {
    let mut source = source(name, SIZE);
    indices.map(|index| source.frame(index).unwrap())
}

/// Depth and motion of a frame; analytic scenes always have both.
fn geometry(frame: &SourceFrame) -> (&Image<f32>, &Image<[f32; 2]>) {
    (frame.depth.as_ref().unwrap(), frame.motion.as_ref().unwrap())
}

fn pixels(size: [u32; 2]) -> impl Iterator<Item = (usize, usize)> {
    (0..size[1] as usize).flat_map(move |y| (0..size[0] as usize).map(move |x| (x, y)))
}

fn bits(frame: &SourceFrame) -> Vec<u32> {
    let (depth, motion) = geometry(frame);
    let numbers = frame.color.pixels().iter().flatten().chain(depth.pixels()).chain(motion.pixels().iter().flatten());
    numbers.chain(frame.previous_from_current.iter().flatten().flatten()).map(|v| v.to_bits()).collect()
}

fn all_zero(motion: &Image<[f32; 2]>) -> bool {
    motion.pixels().iter().all(|m| *m == [0.0; 2])
}

#[test]
fn still_stays() {
    let mut source = source("still", SIZE);
    assert!(source.info().still && source.info().frames.is_none());
    let first = source.frame(0).unwrap();
    assert!(first.cut && all_zero(geometry(&first).1));
    for index in [1, 59, 1 << 40] {
        let later = source.frame(index).unwrap();
        assert!(!later.cut);
        assert!(bits(&later) == bits(&first), "frame {index}");
    }
    let identity = std::array::from_fn(|i| std::array::from_fn(|k| f32::from(u8::from(i == k))));
    assert_eq!(first.previous_from_current, Some(identity));
}

#[test]
fn light_step_scales_the_color_and_nothing_else() {
    let mut source = source("light-step", SIZE);
    assert!(!source.info().still);
    let bright = source.frame(0).unwrap();
    for (index, factor) in [(29, 1.0), (30, LIGHT_STEP), (74, LIGHT_STEP), (75, 1.0)] {
        let frame = source.frame(index).unwrap();
        let scaled = bright.color.map(|c| c.map(|v| v * factor));
        assert!(frame.color == scaled, "frame {index}");
        assert_eq!(geometry(&frame), geometry(&bright));
    }
    assert_eq!(LIGHT_STEP, 0.45);
}

#[test]
fn scroll_changes_the_panel_only_and_does_not_say_so() {
    let mut source = source("scroll", SIZE);
    assert!(self::source("still", [8, 8]).panel_mask(0).is_none());
    let mask = source.panel_mask(40).unwrap();
    let [before, now] = [39, 40].map(|index| source.frame(index).unwrap());
    assert!(all_zero(geometry(&now).1));
    assert_eq!(geometry(&before), geometry(&now));
    let (mut panel, mut changed) = (0, 0);
    for (x, y) in pixels(SIZE) {
        let differs = before.color.at(x, y) != now.color.at(x, y);
        assert!(mask.at(x, y) || !differs, "({x}, {y}) is beside the panel");
        panel += u32::from(mask.at(x, y));
        changed += u32::from(differs);
    }
    println!("panel: {panel} pixels, {changed} change");
    assert!(panel > 20_000 && f64::from(changed) > 0.3 * f64::from(panel));
}

#[test]
fn frames_do_not_depend_on_threads_or_order() {
    for name in AnalyticSource::names() {
        let on = |threads: usize, indices: &[u64]| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| {
                let mut source = source(name, [203, 117]);
                indices.iter().map(|&index| bits(&source.frame(index).unwrap())).last()
            })
        };
        assert!(on(1, &[33]) == on(2, &[50, 0, 33]), "{name}");
    }
}

#[test]
fn any_size_gives_finite_frames() {
    for name in AnalyticSource::names() {
        for size in [[1, 1], [17, 1], [1, 33], [96, 54]] {
            let mut source = source(name, size);
            for index in [0, 1, 45, 1_000_000] {
                let frame = source.frame(index).unwrap();
                let (depth, motion) = geometry(&frame);
                assert_eq!(frame.color.size(), size);
                assert!(frame.color.pixels().iter().flatten().all(|c| (0.0..1.6).contains(c)), "{name} {size:?}");
                assert!(depth.pixels().iter().all(|&z| z > 0.0));
                assert!(motion.pixels().iter().flatten().all(|m| m.is_finite()));
                assert_eq!((frame.cut, frame.nonfinite), (index == 0, 0));
            }
        }
    }
}

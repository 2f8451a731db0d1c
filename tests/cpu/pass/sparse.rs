//! Sparse frames, filled for the methods that read whole frames.

use super::*;
use afterimage::{Filter, Foveation, Lattice, Lattices};

const METHODS: [MethodKind; 5] =
    [MethodKind::None, MethodKind::Taa, MethodKind::Wrs, MethodKind::Smr, MethodKind::Taau];

fn settings(method: MethodKind) -> Settings {
    let foveation = Foveation { filter: Filter::Sparse, rate_mid: 2, rate_far: 8, ..Foveation::default() };
    Settings { method: method.into(), foveation, ..Settings::paper() }
}

/// First frame of a context with this color and these lattices.
fn first(method: MethodKind, color: &Color, lattices: Lattices) -> (Color, FrameStats) {
    let made = context(settings(method)).step(0, &still(color.clone()).sparse(lattices));
    (made.shown, made.stats)
}

fn stack(offset: [u32; 2]) -> Lattices {
    let fine = Lattice::covering(2, [16, 8], [40, 30], offset.map(|v| v % 2));
    Lattices::new(&[fine, Lattice::covering(8, [0, 0], SIZE, offset)]).unwrap()
}

#[test]
fn samples_are_shown_unchanged_and_nothing_else_is_read() {
    let full = noise(SIZE, "samples");
    for method in METHODS {
        for offset in [[0, 0], [3, 6], [7, 7]] {
            let lattices = stack(offset);
            let is_sample = |px: [u32; 2]| lattices.at(px).unwrap().samples(px);
            let holed = still(full.clone()).sparse(lattices).read_of(&full, [f32::NAN; 3]);
            let (out, stats) = first(method, &holed, lattices);
            assert_eq!((stats.nonfinite, stats.pixels), (0, 64 * 48), "{method:?}");
            assert_eq!(out, first(method, &full, lattices).0, "{method:?}");
            assert!(pixels(SIZE).filter(|&px| is_sample(px)).all(|px| pixel(&out, px) == pixel(&full, px)));
        }
    }
}

#[test]
fn a_ramp_is_reproduced_between_samples_and_a_constant_everywhere() {
    let ramp = Image::from_fn(SIZE, |[x, y]| [x as f32 / 64.0, y as f32 / 64.0, (x + y) as f32 / 128.0]);
    let lattices = stack([0, 0]);
    let (out, _) = first(MethodKind::None, &ramp, lattices);
    let error = |px| {
        let (a, b) = (pixel(&ramp, px), pixel(&out, px));
        (0..3).map(|i| (a[i] - b[i]).abs()).fold(0.0, f32::max)
    };
    // Up to the last samples of the coarse lattice, and of the fine one.
    let worst = pixels([57, 41]).filter(|&px| lattices.at(px).unwrap().step != 2 || px[0] <= 38 && px[1] <= 28);
    assert!(worst.map(error).fold(0.0, f32::max) < 1e-6);
    let (out, _) = first(MethodKind::None, &Image::filled(SIZE, [0.25, 0.5, 0.75]), stack([5, 2]));
    assert!(out.pixels().iter().all(|&c| c == [0.25, 0.5, 0.75]));
}

#[test]
fn samples_that_are_not_finite_are_left_out() {
    let far = Lattices::new(&[Lattice::covering(8, [0, 0], SIZE, [4, 4])]).unwrap();
    let bad = Image::from_fn(SIZE, |px| if px == [20, 20] { [0.5, f32::INFINITY, 0.5] } else { [0.5; 3] });
    let (out, stats) = first(MethodKind::None, &bad, far);
    // Its neighbours have three samples more; its own pixel has none.
    assert_eq!(stats.nonfinite, 1);
    let black = |c: &[f32; 3]| *c == [0.0; 3];
    assert_eq!(out.pixels().iter().position(black), Some(20 * 64 + 20));
    assert!(out.pixels().iter().filter(|c| !black(c)).all(|c| (c[0] - 0.5).abs() < 1e-6));
    let (_, stats) = first(MethodKind::None, &Image::filled(SIZE, [f32::NAN; 3]), far);
    assert_eq!(stats.nonfinite, 64 * 48);
}

#[test]
fn the_doctor_refuses_lattices() {
    let desc = ContextDesc { settings: settings(MethodKind::Wrs), ..ContextDesc::new(SIZE) };
    let error = afterimage::cpu::Doctor::new(&desc, 0).unwrap_err().to_string();
    assert!(error.contains("the doctor does not know lattices yet"), "{error}");
}

#[test]
fn levels_of_detail_beside_lattices_are_refused() {
    let mut post = context(settings(MethodKind::Wrs));
    let view = View { lod: Some(Image::filled(SIZE, 1.0)), ..still(noise(SIZE, "lod")).sparse(stack([0, 0])) };
    let images = Images::of([&view]);
    let error = post.process(&images.frame(0), &mut [Image::filled(SIZE, [0.0; 3])]).unwrap_err().to_string();
    assert_eq!(error, "lod of view 0 is given: expected None: the places of the samples say how coarse the frame is");
    assert!(!post.history().is_filled());
}

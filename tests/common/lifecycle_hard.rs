//! Hard cases of a context's life, H76 to H78: laws that hold on either executor. What remains equals a fresh context,
//! bit for bit.

use crate::depth_hard::{Made, Make, SIZE, Steps, desc};
use crate::images::{View, noise, pixel, times};
use crate::surfaces_hard::settings;
use afterimage::internal::{ContextDesc, MethodKind, Reset};
use afterimage::{Exposure, Image};

/// The laws as tests of an executor. `$run_law` runs one, and returns what it measured.
macro_rules! lifecycle_laws {
    ($side:ident, $run_law:ident) => {
        crate::laws::laws! { $side, $run_law,
            h76_other_sizes_and_back_equal_a_fresh_context: "H76", other_sizes;
            h77_a_cut_shows_the_candidate_and_equals_a_fresh_context: "H77", cut;
            h78_resets_equal_a_fresh_context: "H78", resets;
        }
    };
}
pub(crate) use lifecycle_laws;

pub const METHODS: [MethodKind; 4] = [MethodKind::Wrs, MethodKind::Smr, MethodKind::Taa, MethodKind::Taau];

fn of(method: MethodKind) -> ContextDesc {
    match method {
        MethodKind::Wrs => desc(crate::settings::ungated()),
        method => desc(settings(method)),
    }
}

/// Frames so that all output depends on earlier ones: noise for wrs, for others a picture that fades, half of it
/// coarse. Every third frame moves, over two depths.
fn frame(method: MethodKind, index: u64) -> View {
    let coarse = |x: u32| (u64::from(x) + 5 * index) % 26 < 13;
    let picture = match method {
        MethodKind::Wrs => noise(SIZE, &format!("run {index}")),
        _ => times(&noise(SIZE, "run"), 1.0 + 0.02 * index as f32),
    };
    let is_fine = |x: u32| method == MethodKind::Wrs || !coarse(x);
    let color = Image::from_fn(SIZE, |px| pixel(&picture, if is_fine(px[0]) { px } else { px.map(|v| v & !1) }));
    let motion = |[x, y]: [u32; 2]| if (x / 8 + y / 8) % 2 == 0 { [16.0, -1.0] } else { [-0.5, 2.5] };
    View {
        lod: (method != MethodKind::Wrs).then(|| Image::from_fn(SIZE, |[x, _]| if coarse(x) { 1.5 } else { 0.0 })),
        depth: Some(Image::from_fn(SIZE, |[x, _]| if x % 32 < 16 { 2.0 } else { 30.0 })),
        motion: (index % 3 == 2).then(|| Image::from_fn(SIZE, motion)),
        ..View::still(color, [20.0, 20.0])
    }
}

fn run(post: &mut Box<dyn Steps>, method: MethodKind, frames: std::ops::Range<u64>) -> Vec<Made> {
    frames.map(|index| post.step(index, &frame(method, index))).collect()
}

/// Output of a fresh context for frames 8 to 13, and a context after its first 8 frames.
fn fresh_and_used(make: Make<'_>, method: MethodKind) -> Option<(Vec<Made>, Box<dyn Steps>)> {
    let (mut fresh, mut used) = (make(of(method))?, make(of(method))?);
    run(&mut used, method, 0..8);
    Some((run(&mut fresh, method, 8..14), used))
}

/// Odd, even, a single pixel, and back, with frames between: another pixel density is another size.
pub fn other_sizes(make: Make<'_>) -> Option<String> {
    for method in METHODS {
        let (fresh, mut resized) = fresh_and_used(make, method)?;
        for size in [[3, 5], [64, 64], [1, 1], [65, 47], [53, 41]] {
            resized.resize(size);
            let lod = (method != MethodKind::Wrs).then(|| Image::filled(size, 0.0));
            let view = View { lod, ..View::still(noise(size, "resized"), [20.0, 20.0]) };
            let made = resized.step(0, &view);
            assert_eq!(made.shown, view.color, "{method:?}: the first frame of a size is the candidate");
            resized.step(1, &view);
        }
        resized.resize(SIZE);
        assert!(run(&mut resized, method, 8..14) == fresh, "{method:?}");
    }
    Some("wrs, smr, taa: 5 sizes, odd, even and 1x1, then back: 6 frames as of a fresh context, bit for bit".into())
}

/// A cut, or a pause, said twice.
pub fn cut(make: Make<'_>) -> Option<String> {
    for method in METHODS {
        let (fresh, mut cut) = fresh_and_used(make, method)?;
        let view = frame(method, 8);
        for _ in 0..2 {
            let made = cut.make(8, &view, Exposure::Same, Reset::All);
            assert_eq!(made.shown, view.color, "{method:?}: the cut shows what came");
            assert!(made == fresh[0], "{method:?}");
        }
        assert!(run(&mut cut, method, 9..14) == fresh[1..], "{method:?}");
    }
    Some(
        "wrs, smr, taa: the first frame after a cut is the candidate, 5 more as of a fresh context, bit for bit".into(),
    )
}

/// A reset at frame 0, a reset in two successive frames, and a context whose history is discarded.
pub fn resets(make: Make<'_>) -> Option<String> {
    for method in METHODS {
        let (fresh, mut twice) = fresh_and_used(make, method)?;
        for index in 6..8 {
            twice.make(index, &frame(method, index), Exposure::Same, Reset::All);
        }
        let mut stale = make(of(method))?;
        run(&mut stale, method, 7..8);
        let expected = run(&mut stale, method, 8..14);
        assert!(run(&mut twice, method, 8..14) == expected, "{method:?}: two frames running");
        assert!(expected[0].shown != fresh[0].shown, "{method:?}, the planted error: no reset");
        stale.forget();
        assert!(run(&mut stale, method, 8..14) == fresh, "{method:?}: forgotten");
        let [mut with_reset, mut without] = [make(of(method))?, make(of(method))?];
        let first = with_reset.make(0, &frame(method, 0), Exposure::Same, Reset::All);
        assert!(run(&mut without, method, 0..1) == [first], "{method:?}: a reset at frame 0");
        assert!(run(&mut with_reset, method, 1..5) == run(&mut without, method, 1..5), "{method:?}");
    }
    Some(
        "wrs, smr, taa: reset twice running, and at frame 0: 5 frames and more as of a fresh context, bit for bit"
            .into(),
    )
}

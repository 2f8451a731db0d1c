//! Long streams of frames on both executors in lockstep: whatever the events, nothing leaks or shows NaN.
//!
//! The test suite runs a few hundred frames; `tests/soak.sh` runs 100,000 of each method, and a million planned ones.
//! Alone in its file, for a process of its own.

mod events;
#[path = "../common/images.rs"]
#[allow(dead_code, reason = "the passes' tests use all of it")]
mod images;
mod pictures;
mod planned;
#[path = "../gpu/pass/rig.rs"]
#[allow(dead_code, unused_imports, reason = "the passes' tests use all of it")]
mod rig;

use afterimage::internal::{ContextDesc, MethodKind, Reset, Settings};
use afterimage::{Exposure, Image};
use events::{Event, Stream};
use pictures::Pictures;
use rig::{Made, Rig, View};

const SIZE: [u32; 2] = [320, 180];

/// White of a scene whose colors are radiance.
const WHITE: f32 = 1.0 / 1024.0;

/// Findings of a soak test.
#[derive(Debug, Default)]
struct Found {
    frames: u64,
    events: u64,
    /// Shown components that are NaN or infinite.
    nonfinite: u64,
    /// Shown components above the brightest that was presented, by more than halves round.
    above: u64,
    /// Fovea pixels of smr that were not the candidate, bit for bit.
    not_candidate: u64,
    resident_mib: Vec<f64>,
}

/// Runs `frames` frames of `size` through both executors, which must agree in every bit. Colors are radiance, with the
/// exposure of each frame, or exposed.
fn soak(method: MethodKind, is_radiance: bool, size: [u32; 2], frames: u64) -> Option<Found> {
    let settings = Settings { method: method.into(), foveation: pictures::FOVEATION, ..Settings::default() };
    let mut rig = Rig::new(ContextDesc::new(size), settings)?;
    let mut stream = Stream::new(&format!("soak {method:?}"), size);
    let mut pictures = Pictures::default();
    let mut found = Found { frames, ..Found::default() };
    // Largest value that history may contain.
    let mut brightest = 0.0_f32;
    for index in 0..frames {
        let event = stream.next();
        found.events += u64::from(event != Event::default());
        if let Some(size) = event.size {
            rig.resize(size);
        }
        let exposure = stream.state().exposure;
        let factor = if is_radiance { WHITE } else { exposure };
        let view = pictures.view(rig.context.size_px, &event, stream.state(), factor);
        let reset = if event.reset { Reset::All } else { Reset::None };
        rig.exposure = match event.exposure {
            _ if is_radiance => Exposure::Scene { exposure: exposure / WHITE },
            Some(ratio) => Exposure::Changed { ratio },
            None => Exposure::Same,
        };
        let (made, _) = rig.both(index, reset, std::slice::from_ref(&view));
        brightest *= event.exposure.filter(|_| !is_radiance).unwrap_or(1.0);
        brightest = brightest_of(&view).max(if event.reset || event.size.is_some() { 0.0 } else { brightest });
        check(&mut found, method, &event, &view, &made, brightest);
        if frames >= 10 && index % (frames / 10) == frames / 20 {
            found.resident_mib.extend(afterimage_testing::resident::resident_mib());
            if frames > 5000 {
                println!("{method:?}, radiance: {is_radiance}: frame {index}, {found:?}");
            }
        }
    }
    Some(found)
}

/// The brightest finite component of the color.
fn brightest_of(view: &View) -> f32 {
    view.color.pixels().iter().flatten().filter(|v| v.is_finite()).fold(0.0, |a, &b| a.max(b))
}

fn check(found: &mut Found, method: MethodKind, event: &Event, view: &View, made: &Made, brightest: f32) {
    let color: &Image<[f32; 3]> = &view.color;
    for value in made.shown.iter().flatten().map(|&bits| f32::from_bits(bits)) {
        found.nonfinite += u64::from(!value.is_finite());
        // Halves round by 2^-11; an exposure step rounds once more. Relighting of smr may brighten history to the
        // candidate's level.
        found.above += u64::from(method == MethodKind::Wrs && value > brightest * 1.002 + 1e-6);
    }
    if method == MethodKind::Smr && !event.is_broken {
        let (width, lods) = (color.width(), view.lod.as_ref());
        for (i, (shown, given)) in made.shown.iter().zip(color.pixels()).enumerate() {
            if lods.is_some_and(|l| l.at(i % width, i / width) == 0.0) {
                found.not_candidate += u64::from(shown.map(f32::from_bits) != *given);
            }
        }
    }
}

fn assert_sound(method: MethodKind, found: &Found) {
    println!("{method:?}: {found:?}");
    assert!(found.events * 20 > found.frames, "too little happened");
    assert_eq!([found.nonfinite, found.above, found.not_candidate], [0; 3], "{found:?}");
    // A leak of a kilobyte a frame would be 1 MiB each time; late allocations of the driver happen once.
    let late = &found.resident_mib[found.resident_mib.len().min(2)..];
    if found.frames >= 10_000 && late.len() > 2 {
        let growth = afterimage_testing::resident::least_growth_mib(late);
        assert!(growth < 0.5, "{growth} MiB in {} frames: {:?}", found.frames / 10, found.resident_mib);
    }
}

fn frames(default: u64) -> u64 {
    std::env::var("SOAK_FRAMES").map_or(default, |n| n.parse().expect("SOAK_FRAMES is a number of frames"))
}

#[test]
fn a_short_stream_is_sound() {
    for method in [MethodKind::Wrs, MethodKind::Smr] {
        for is_radiance in [false, true] {
            let Some(found) = soak(method, is_radiance, [64, 36], 400) else { return };
            assert_sound(method, &found);
        }
    }
}

/// The checks find planted errors.
#[test]
fn damage_is_noticed() {
    let view = View::still(Image::filled([4, 3], [0.5; 3]), [1.0, 1.0]);
    let view = View { lod: Some(Image::filled([4, 3], 0.0)), ..view };
    let good = Made {
        shown: vec![[0.5_f32.to_bits(); 3]; 12],
        words: vec![],
        quads: vec![],
        paths: vec![],
        alpha: vec![],
        albedo: vec![],
        stats: Default::default(),
    };
    let checked = |method, value: f32| {
        let (mut found, mut made) = (Found::default(), good.clone());
        made.shown[5][1] = value.to_bits();
        check(&mut found, method, &Event::default(), &view, &made, 0.5);
        [found.nonfinite, found.above, found.not_candidate]
    };
    assert_eq!(checked(MethodKind::Wrs, 0.5), [0, 0, 0]);
    assert_eq!(checked(MethodKind::Wrs, f32::NAN), [1, 0, 0]);
    assert_eq!(checked(MethodKind::Wrs, 0.6), [0, 1, 0]);
    assert_eq!(checked(MethodKind::Smr, 0.5_f32.next_up()), [0, 0, 1]);
}

#[test]
#[ignore = "hours: tests/soak.sh"]
fn wrs_for_100_000_frames() {
    for is_radiance in [false, true] {
        let Some(found) = soak(MethodKind::Wrs, is_radiance, SIZE, frames(50_000)) else { return };
        assert_sound(MethodKind::Wrs, &found);
    }
}

#[test]
#[ignore = "hours: tests/soak.sh"]
fn smr_for_100_000_frames() {
    for is_radiance in [false, true] {
        let Some(found) = soak(MethodKind::Smr, is_radiance, SIZE, frames(50_000)) else { return };
        assert_sound(MethodKind::Smr, &found);
    }
}

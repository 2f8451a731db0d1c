//! Errors planted in an executor, each of which the laws of hard cases must catch.

use crate::reactive::reactive_is_the_inverse_of_trust;
use crate::sparse_hard::*;
use afterimage::{ContextDesc, Exposure, Gaze, Image, Method, Reset, Settings};
use std::cell::Cell;
use std::panic::{AssertUnwindSafe, catch_unwind, set_hook, take_hook};
use std::sync::Once;

#[derive(Clone, Copy, Debug, PartialEq)]
enum Planted {
    /// History is not used.
    Foveated,
    /// Resets are ignored.
    NoReset,
    /// Motion vectors are ignored.
    NoMotion,
    /// Depth is ignored.
    NoDepth,
    /// Ratios of exposures are ignored.
    NoExposure,
    /// Trust masks are ignored.
    NoTrust,
    /// Reactive masks are ignored.
    NoReactive,
    /// Reactive masks are read as trust masks.
    ReactiveAsTrust,
    /// The first view is shown for all.
    FirstView,
    /// The gaze changes what is shown.
    Gaze,
    /// Samples that are not finite are shown.
    Unsanitized,
    /// A pixel is NaN in frame 3.
    Nan,
    /// The image is moved by a pixel.
    Beside,
    /// The periphery is brighter by 5 %.
    Seam,
    /// Nothing gets darker by more than a tenth a frame.
    Lingering,
}

struct Executor {
    inner: Box<dyn Shows>,
    planted: Planted,
    last: Option<Color>,
}

impl Executor {
    /// Frame that the executor gets instead of the given one.
    fn changed(&self, shot: &Shot) -> Shot {
        let mut shot = shot.clone();
        match self.planted {
            Planted::NoReset => shot.reset = Reset::None,
            Planted::NoMotion => shot.motion = None,
            Planted::NoDepth => shot.depth = None,
            Planted::NoExposure => shot.exposure = Exposure::Same,
            Planted::NoTrust => shot.trust = None,
            Planted::NoReactive => shot.reactive = None,
            Planted::ReactiveAsTrust => shot.trust = shot.trust.take().or(shot.reactive.take()),
            _ => (),
        }
        shot
    }

    fn change(&mut self, index: u64, shot: &Shot, shown: &Color) -> Color {
        let at = |px| pixel(shown, px);
        let step = |px| shot.lattices().at(px).map_or(0, |lattice| lattice.step);
        let last = self.last.as_ref();
        let changed = |px: [u32; 2]| match self.planted {
            Planted::Nan if index == 3 && px == [0, 0] => [f32::NAN; 3],
            Planted::Unsanitized if !pixel(&shot.color, px)[0].is_finite() => [f32::NAN; 3],
            Planted::Beside => at([px[0].saturating_sub(1), px[1]]),
            Planted::Seam if step(px) == 4 => at(px).map(|v| v * 1.05),
            Planted::Lingering => {
                let last = last.map_or([0.0; 3], |last| pixel(last, px));
                [0, 1, 2].map(|c| at(px)[c].max(0.9 * last[c]))
            }
            Planted::Gaze => match shot.facts.gaze {
                Gaze::Uv { .. } => at(px).map(|v| v * 1.001),
                _ => at(px),
            },
            _ => at(px),
        };
        Image::from_fn(shown.size(), changed)
    }
}

impl Shows for Executor {
    fn show(&mut self, index: u64, shots: &[Shot]) -> Vec<Color> {
        let shots: Vec<_> = shots.iter().map(|shot| self.changed(shot)).collect();
        let shown = self.inner.show(index, &shots);
        let mut shown: Vec<_> = shots.iter().zip(&shown).map(|(shot, shown)| self.change(index, shot, shown)).collect();
        if self.planted == Planted::FirstView {
            shown = vec![shown[0].clone(); shown.len()];
        }
        self.last = Some(shown[0].clone());
        shown
    }

    fn set_settings(&mut self, settings: Settings) {
        self.inner.set_settings(settings);
    }
}

thread_local! {
    static EXPECTED: Cell<bool> = const { Cell::new(false) };
}

/// Whether a law holds with an error planted. Its message is not printed.
fn holds_with(law: fn(Make) -> Option<String>, planted: Planted) -> bool {
    static ONCE: Once = Once::new();
    ONCE.call_once(|| {
        let report = take_hook();
        set_hook(Box::new(move |panic| {
            if !EXPECTED.get() {
                report(panic);
            }
        }));
    });
    EXPECTED.set(true);
    let make = |desc: ContextDesc| {
        let method = match (planted, desc.settings.method) {
            (Planted::Foveated, _) => Method::None,
            (_, method) => method,
        };
        let inner = on_cpu(ContextDesc { settings: Settings { method, ..desc.settings }, ..desc })?;
        Some(Box::new(Executor { inner, planted, last: None }) as Box<dyn Shows>)
    };
    let held = catch_unwind(AssertUnwindSafe(|| law(&make))).is_ok();
    EXPECTED.set(false);
    held
}

#[test]
fn planted_errors_are_caught_by_the_laws_of_sparse_frames() {
    type Law = fn(Make) -> Option<String>;
    use Planted::*;
    let laws: [(&str, Law, &[Planted]); 14] = [
        ("H86", starved_positions, &[Foveated, Nan, Beside]),
        ("H87", degenerate_lattices, &[Beside, Foveated]),
        ("H88", restarts_of_the_order, &[NoReset, Foveated]),
        ("H89", borders, &[Foveated, Seam, NoMotion]),
        ("H90", thin_lines, &[Foveated, NoMotion, Seam]),
        ("H91", sparkles, &[Lingering, Nan]),
        ("H92", fast_motion, &[NoMotion, Lingering, Nan]),
        ("H93", announced_and_unannounced_cuts, &[NoReset, NoDepth, Lingering]),
        ("H94", silhouettes, &[Foveated, NoMotion, Nan]),
        ("H95", invalid_samples, &[Unsanitized, Foveated]),
        ("H96", repeated_offsets, &[Foveated, NoMotion, Lingering]),
        ("H97", offsets_off_by_one, &[NoMotion, Nan]),
        ("H98", light_trust_views_gaze_and_foveation, &[NoExposure, NoTrust, FirstView, Gaze, Nan]),
        ("reactive masks", reactive_is_the_inverse_of_trust, &[NoReactive, ReactiveAsTrust]),
    ];
    let mut missed = vec![];
    for (row, law, errors) in laws {
        missed.extend(errors.iter().filter(|&&error| holds_with(law, error)).map(|error| format!("{row}: {error:?}")));
    }
    assert_eq!(missed, Vec::<String>::new());
}

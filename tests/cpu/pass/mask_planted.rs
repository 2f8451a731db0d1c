//! Errors planted in an executor, each of which the laws of hard cases must catch.

use crate::mask_hard::*;
use crate::reactive::reactive_is_the_inverse_of_trust;
use afterimage::internal::{ContextDesc, Method, Reset, Settings};
use afterimage::{Exposure, Image};
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
    /// Ratios of exposures are ignored.
    NoExposure,
    /// Reactive masks are read as trust masks.
    ReactiveAsTrust,
    /// The first view is shown for all.
    FirstView,
    /// Samples that are not finite are shown.
    Unsanitized,
    /// The image is moved by a pixel.
    Beside,
    /// All is brighter by 5 %.
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
            Planted::NoExposure => shot.exposure = Exposure::Same,
            Planted::ReactiveAsTrust => shot.trust = shot.trust.take().or(shot.reactive.take()),
            _ => (),
        }
        shot
    }

    fn change(&self, shot: &Shot, shown: &Color) -> Color {
        let at = |px| pixel(shown, px);
        let last = self.last.as_ref();
        let changed = |px: [u32; 2]| match self.planted {
            Planted::Unsanitized if !pixel(&shot.color, px)[0].is_finite() => [f32::NAN; 3],
            Planted::Beside => at([px[0].saturating_sub(1), px[1]]),
            Planted::Seam => at(px).map(|v| v * 1.05),
            Planted::Lingering => {
                let last = last.map_or([0.0; 3], |last| pixel(last, px));
                [0, 1, 2].map(|c| at(px)[c].max(0.9 * last[c]))
            }
            _ => at(px),
        };
        Image::from_fn(shown.size(), changed)
    }
}

impl Shows for Executor {
    fn show(&mut self, index: u64, shots: &[Shot]) -> Vec<Color> {
        let shots: Vec<_> = shots.iter().map(|shot| self.changed(shot)).collect();
        let shown = self.inner.show(index, &shots);
        let mut shown: Vec<_> = shots.iter().zip(&shown).map(|(shot, shown)| self.change(shot, shown)).collect();
        if self.planted == Planted::FirstView {
            shown = vec![shown[0].clone(); shown.len()];
        }
        self.last = Some(shown[0].clone());
        shown
    }

    fn plan(&self, index: u64, shot: &Shot) -> Mask {
        self.inner.plan(index, &self.changed(shot))
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
fn planted_errors_are_caught_by_the_laws_of_masks() {
    type Law = fn(Make) -> Option<String>;
    use Planted::*;
    let laws: [(&str, Law, Planted); 14] = [
        ("H86", starved_positions, Foveated),
        ("H87", degenerate_masks, Beside),
        ("H88", restarts_of_the_order, NoReset),
        ("H89", borders, Seam),
        ("H90", thin_lines, NoMotion),
        ("H91", sparkles, Lingering),
        ("H92", fast_motion, NoMotion),
        ("H93", announced_and_unannounced_cuts, NoReset),
        ("H95", invalid_samples, Unsanitized),
        ("H96", repeated_offsets, Foveated),
        ("H97", offsets_off_by_one, NoMotion),
        ("H98", light_trust_views_gaze_and_foveation, NoExposure),
        ("H98", light_trust_views_gaze_and_foveation, FirstView),
        ("reactive masks", reactive_is_the_inverse_of_trust, ReactiveAsTrust),
    ];
    let missed = laws.iter().filter(|(_, law, planted)| holds_with(*law, *planted));
    assert_eq!(missed.map(|(row, _, planted)| format!("{row}: {planted:?}")).collect::<Vec<_>>(), Vec::<String>::new());
}

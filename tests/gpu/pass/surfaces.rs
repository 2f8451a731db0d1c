//! Occlusion and disocclusion on the device: hard cases H41, H42, H44 to H47, H49 and H50.

use super::rig::with_w_sum;
use super::*;
use crate::depth_hard::{self, *};

pub fn still(name: &str) -> View {
    depth_hard::still(noise(SIZE, name))
}

pub fn with_motion(name: &str, motion: impl FnMut([u32; 2]) -> [f32; 2]) -> View {
    View { motion: Some(Image::from_fn(SIZE, motion)), ..still(name) }
}

impl Steps for Rig {
    fn make(&mut self, index: u64, view: &View, exposure: Exposure, reset: Reset) -> depth_hard::Made {
        self.exposure = exposure;
        let (made, mut trace) = self.both(index, reset, std::slice::from_ref(view));
        let shown = made.shown.iter().map(|c| c.map(f32::from_bits)).collect();
        let shown = Image::from_pixels(view.color.size(), shown).unwrap();
        depth_hard::Made { shown, words: made.words, trace: trace.remove(0), stats: made.stats }
    }

    fn set_settings(&mut self, settings: Settings) {
        Rig::set_settings(self, settings);
    }

    fn resize(&mut self, size: [u32; 2]) {
        Rig::resize(self, size);
        self.poison();
    }

    fn forget(&mut self) {
        Rig::forget(self);
    }

    fn stick(&mut self) {
        let words = self.read().words;
        self.restore(&with_w_sum(&words, 1e12));
    }
}

/// What a law measured; `None`, after a message, without an adapter.
pub fn run_law(law: fn(Make<'_>) -> Option<String>) -> Option<String> {
    law(&|desc| Some(Box::new(Rig::new(desc, desc.settings)?)))
}

depth_laws!(Gpu, run_law);

#[test]
fn h42_depth_beyond_its_ends_is_clamped() {
    let depth = DepthConvention::Reversed { near: 0.1, far: 1000.0 };
    for method in METHODS {
        let desc = ContextDesc { depth, ..ContextDesc::new(SIZE) };
        let Some(mut rig) = Rig::new(desc, ungated_of(method)) else { return };
        let ends = |by: f32| move |[x, _]: [u32; 2]| if x < 32 { 1.0 + by } else { -by };
        for (index, by) in (0..).zip([0.0, f32::EPSILON, 1e-3, 1e30, f32::INFINITY, 0.0]) {
            let view = View { depth: Some(Image::from_fn(SIZE, ends(by))), ..still("ends") };
            let stats = rig.step(index, &view).stats;
            assert_eq!((stats.rejected(), stats.bad_depth), (0, 0), "{method:?}, by {by}");
        }
    }
    holds!("H42", Gpu, "wrs and smr: 1 ulp to infinity beyond either end is the same surface as the end, 3072 pixels");
}

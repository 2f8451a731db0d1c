//! Hard cases of sparse frames on the GPU, H86 and up: each frame is equal on both executors, bit for bit, and the laws
//! are those of the CPU.

use super::rig::{Rig, View};
use crate::sparse_hard::*;
use afterimage::{ContextDesc, Image, Settings};
use afterimage_testing::holds;
use std::cell::RefCell;
use std::rc::Rc;

/// Both executors. Returns to the pool when it is dropped, because a device and its pipelines take long to make.
struct Both {
    rig: Option<Rig>,
    pool: Rc<RefCell<Vec<Rig>>>,
}

impl Shows for Both {
    fn show(&mut self, index: u64, shots: &[Shot]) -> Vec<Color> {
        let rig = self.rig.as_mut().unwrap();
        rig.exposure = shots[0].exposure;
        let view = |s: &Shot| View {
            facts: s.facts,
            color: s.color.clone(),
            depth: s.depth.clone(),
            motion: s.motion.clone(),
            trust: s.trust.clone(),
            lod: None,
            noise: None,
            repaired: s.repaired.clone(),
        };
        let views: Vec<_> = shots.iter().map(view).collect();
        let (made, _) = rig.both(index, shots[0].reset, &views);
        let size = rig.context.size_px;
        let pixels = made.shown.chunks(made.shown.len() / shots.len());
        pixels.map(|p| Image::from_pixels(size, p.iter().map(|c| c.map(f32::from_bits)).collect()).unwrap()).collect()
    }

    /// The CPU's, which that of the frame on the GPU must equal.
    fn plan(&mut self, index: u64, shot: &Shot) -> Mask {
        Shows::plan(&mut self.rig.as_mut().unwrap().cpu, index, shot)
    }

    fn set_settings(&mut self, settings: Settings) {
        let rig = self.rig.as_mut().unwrap();
        rig.cpu.set_settings(settings).unwrap();
        rig.gpu.set_settings(&rig.device, settings).unwrap();
    }
}

impl Drop for Both {
    fn drop(&mut self) {
        self.pool.borrow_mut().extend(self.rig.take());
    }
}

/// What a law measured; `None`, after a message, without an adapter.
fn held(law: fn(Make) -> Option<String>) -> Option<String> {
    let pool: Rc<RefCell<Vec<Rig>>> = Rc::default();
    law(&|desc: ContextDesc| {
        let fits = |rig: &Rig| (rig.context.size_px, rig.context.view_count) == (desc.size_px, desc.view_count);
        let used = pool.borrow().iter().position(fits);
        let rig = match used {
            Some(i) => {
                let mut rig = pool.borrow_mut().swap_remove(i);
                rig.cpu.set_settings(desc.settings).unwrap();
                rig.gpu.set_settings(&rig.device, desc.settings).unwrap();
                rig.cpu.forget();
                rig.gpu.forget();
                rig
            }
            None => Rig::new(desc, desc.settings)?,
        };
        Some(Box::new(Both { rig: Some(rig), pool: pool.clone() }))
    })
}

#[test]
fn h86_positions_that_are_never_sampled_are_no_worse_than_foveated() {
    let Some(figure) = held(starved_positions) else { return };
    holds!("H86", Gpu, "{figure}");
}

#[test]
fn h87_degenerate_lattices_are_finite_and_show_their_samples() {
    let Some(figure) = held(degenerate_lattices) else { return };
    holds!("H87", Gpu, "{figure}");
}

#[test]
fn h88_a_reset_in_the_middle_of_the_order_equals_a_fresh_context() {
    let Some(figure) = held(restarts_of_the_order) else { return };
    holds!("H88", Gpu, "{figure}");
}

#[test]
fn h89_the_fovea_is_the_candidate_and_borders_have_no_seam() {
    let Some(figure) = held(borders) else { return };
    holds!("H89", Gpu, "{figure}");
}

#[test]
fn h90_a_line_of_one_pixel_is_rebuilt() {
    let Some(figure) = held(thin_lines) else { return };
    holds!("H90", Gpu, "{figure}");
}

#[test]
fn h91_a_sparkle_is_gone_after_a_turn() {
    let Some(figure) = held(sparkles) else { return };
    holds!("H91", Gpu, "{figure}");
}

#[test]
fn h92_fast_motion_is_no_worse_than_foveated() {
    let Some(figure) = held(fast_motion) else { return };
    holds!("H92", Gpu, "{figure}");
}

#[test]
fn h93_cuts_leave_no_ghost() {
    let Some(figure) = held(announced_and_unannounced_cuts) else { return };
    holds!("H93", Gpu, "{figure}");
}

#[test]
fn h94_geometry_at_samples_holds_at_silhouettes() {
    let Some(figure) = held(silhouettes) else { return };
    holds!("H94", Gpu, "{figure}");
}

#[test]
fn h95_an_invalid_sample_stays_in_its_block() {
    let Some(figure) = held(invalid_samples) else { return };
    holds!("H95", Gpu, "{figure}");
}

#[test]
fn h96_repeated_offsets_do_no_harm() {
    let Some(figure) = held(repeated_offsets) else { return };
    holds!("H96", Gpu, "{figure}");
}

#[test]
fn h97_offsets_off_by_one_cost_little() {
    let Some(figure) = held(offsets_off_by_one) else { return };
    holds!("H97", Gpu, "{figure}");
}

#[test]
fn h98_light_trust_views_gaze_and_foveation() {
    let Some(figure) = held(light_trust_views_gaze_and_foveation) else { return };
    holds!("H98", Gpu, "{figure}");
}

#[test]
fn h99_half_a_screen_uncovered_is_repaired_from_the_gaze_outwards() {
    let Some(figure) = held(half_uncovered) else { return };
    holds!("H99", Gpu, "{figure}");
}

#[test]
fn h100_the_order_of_a_budget_does_not_flicker() {
    let Some(figure) = held(order_without_flicker) else { return };
    holds!("H100", Gpu, "{figure}");
}

#[test]
fn h101_trails_of_thin_occluders_are_no_ghosts() {
    let Some(figure) = held(thin_occluders) else { return };
    holds!("H101", Gpu, "{figure}");
}

#[test]
fn h102_a_step_of_light_is_followed_while_much_is_repaired() {
    let Some(figure) = held(light_and_contradictions) else { return };
    holds!("H102", Gpu, "{figure}");
}

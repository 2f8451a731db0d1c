//! Hard cases of sparse frames on the CPU, H86 and up.

use crate::sparse_hard::*;
use afterimage::{Filter, Foveation};
use afterimage_testing::{Draws, holds};

/// What a law measured.
fn held(law: fn(Make) -> Option<String>) -> String {
    law(&on_cpu).expect("the CPU is always there")
}

#[test]
fn h86_positions_that_are_never_sampled_are_no_worse_than_foveated() {
    let figure = held(starved_positions);
    holds!("H86", Cpu, "{figure}");
}

#[test]
fn h87_degenerate_lattices_are_finite_and_show_their_samples() {
    let figure = held(degenerate_lattices);
    holds!("H87", Cpu, "{figure}");
}

#[test]
fn h87_every_lattice_of_a_foveation_has_a_sample_in_the_view() {
    let mut draws = Draws::new("lattices with samples");
    let mut stacks = 0;
    for size in [[1, 1], [3, 200], [70, 41], [94, 70], [320, 180]] {
        for rates in [[1, 2], [2, 8], [4, 8], [8, 64], [128, 256]] {
            let foveation = Foveation { filter: Filter::Sparse, rate_mid: rates[0], rate_far: rates[1], ..foveation() };
            for index in 0..200 {
                let gaze = [0, 1].map(|i| draws.range(-0.5, 1.5) * size[i] as f32);
                let lattices = foveation.lattices(&geometry(size), gaze, index);
                for lattice in lattices.as_slice() {
                    let first = lattice.first_px;
                    assert!(first[0] < size[0] && first[1] < size[1], "{size:?}, frame {index}: {lattice:?}");
                }
                stacks += 1;
            }
        }
    }
    holds!("H87", Cpu, "every lattice of {stacks} stacks of Foveation::lattices has a sample inside the view");
}

#[test]
fn h88_a_reset_in_the_middle_of_the_order_equals_a_fresh_context() {
    let figure = held(restarts_of_the_order);
    holds!("H88", Cpu, "{figure}");
}

#[test]
fn h89_the_fovea_is_the_candidate_and_borders_have_no_seam() {
    let figure = held(borders);
    holds!("H89", Cpu, "{figure}");
}

#[test]
fn h90_a_line_of_one_pixel_is_rebuilt() {
    let figure = held(thin_lines);
    holds!("H90", Cpu, "{figure}");
}

#[test]
fn h91_a_sparkle_is_gone_after_a_turn() {
    let figure = held(sparkles);
    holds!("H91", Cpu, "{figure}");
}

#[test]
fn h92_fast_motion_is_no_worse_than_foveated() {
    let figure = held(fast_motion);
    holds!("H92", Cpu, "{figure}");
}

#[test]
fn h93_cuts_leave_no_ghost() {
    let figure = held(announced_and_unannounced_cuts);
    holds!("H93", Cpu, "{figure}");
}

#[test]
fn h94_geometry_at_samples_holds_at_silhouettes() {
    let figure = held(silhouettes);
    holds!("H94", Cpu, "{figure}");
}

#[test]
fn h95_an_invalid_sample_stays_in_its_block() {
    let figure = held(invalid_samples);
    holds!("H95", Cpu, "{figure}");
}

#[test]
fn h96_repeated_offsets_do_no_harm() {
    let figure = held(repeated_offsets);
    holds!("H96", Cpu, "{figure}");
}

#[test]
fn h97_offsets_off_by_one_cost_little() {
    let figure = held(offsets_off_by_one);
    holds!("H97", Cpu, "{figure}");
}

#[test]
fn h98_light_trust_views_gaze_and_foveation() {
    let figure = held(light_trust_views_gaze_and_foveation);
    holds!("H98", Cpu, "{figure}");
}

#[test]
fn h99_half_a_screen_uncovered_is_repaired_from_the_gaze_outwards() {
    let figure = held(half_uncovered);
    holds!("H99", Cpu, "{figure}");
}

#[test]
fn h100_the_order_of_a_budget_does_not_flicker() {
    let figure = held(order_without_flicker);
    holds!("H100", Cpu, "{figure}");
}

#[test]
fn h101_trails_of_thin_occluders_are_no_ghosts() {
    let figure = held(thin_occluders);
    holds!("H101", Cpu, "{figure}");
}

#[test]
fn h102_a_step_of_light_is_followed_while_much_is_repaired() {
    let figure = held(light_and_contradictions);
    holds!("H102", Cpu, "{figure}");
}

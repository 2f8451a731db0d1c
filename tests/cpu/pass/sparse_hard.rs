//! Hard cases of sparse frames on the CPU, H86 and up.

use crate::sparse_hard::*;
use afterimage::{Filter, Foveation};
use afterimage_testing::{Draws, holds};

/// What a law measured.
fn run_law(law: fn(Make) -> Option<String>) -> Option<String> {
    Some(law(&on_cpu).expect("the CPU is always there"))
}

sparse_laws!(Cpu, run_law);

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

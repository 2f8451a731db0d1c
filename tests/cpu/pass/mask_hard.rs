//! Hard cases of masks on the CPU, H86 and up.

use crate::mask_hard::*;

/// What a law measured.
fn run_law(law: fn(Make) -> Option<String>) -> Option<String> {
    Some(law(&on_cpu).expect("the CPU is always there"))
}

mask_laws!(Cpu, run_law);

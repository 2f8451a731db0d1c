//! Light on frames shaded by quads, on the device: hard cases H109 to H114.

use super::run_law;
use crate::planned_hard::old_light::{contrasted_floor, old_light};
use crate::planned_hard::other_surfaces::lamps_and_signs;
use crate::planned_hard::sliding::sliding;
use crate::planned_hard::still::{moire, still_wall};
use crate::planned_hard::turning::turning;
use crate::planned_hard::*;

mod inputs {
    use super::run_law;
    use crate::planned_hard::inputs::*;

    crate::planned_hard::planned_input_laws!(Gpu, run_law);
}

planned_laws!(Gpu, run_law);

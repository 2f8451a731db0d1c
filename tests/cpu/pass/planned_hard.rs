//! Light on frames shaded by quads: hard cases H109 to H114.

use super::depth::run_law;
use crate::planned_hard::inputs::nan_depth_antialiased;
use crate::planned_hard::old_light::*;
use crate::planned_hard::other_surfaces::*;
use crate::planned_hard::sliding::*;
use crate::planned_hard::still::*;
use crate::planned_hard::turning::*;
use crate::planned_hard::*;

mod inputs {
    use super::run_law;
    use crate::planned_hard::inputs::*;

    crate::planned_hard::planned_input_laws!(Cpu, run_law);
}

planned_laws!(Cpu, run_law);
planned_tables!(Cpu, run_law);

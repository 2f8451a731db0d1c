//! Changing light on the device: hard cases H72 to H75.

use super::surfaces::run_law;
use crate::laws::laws;
use crate::light_hard::*;
use afterimage_testing::holds;

light_laws!(Gpu, run_law);

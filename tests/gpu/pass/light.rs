//! Changing light on the device: hard cases H72 to H75.

use super::run_law;
use crate::light_hard::*;

light_laws!(Gpu, run_law);

//! Changing light on the device: hard cases H72 to H75.

use super::surfaces::held;
use crate::light_hard::*;
use crate::sparse_hard::laws;
use afterimage_testing::holds;

light_laws!(Gpu, held);

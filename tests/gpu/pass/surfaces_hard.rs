//! smr, taa and taau on the device in the hard cases that wrs has in `surfaces`, `motion` and `light`.

use super::run_law;
use crate::surfaces_hard::*;

surfaces_laws!(Gpu, run_law);

mod feedback {
    use super::run_law;
    use crate::feedback_hard::*;

    feedback_laws!(Gpu, run_law);
}

mod scale {
    use super::run_law;
    use crate::scale_hard::*;

    scale_laws!(Gpu, run_law);
}

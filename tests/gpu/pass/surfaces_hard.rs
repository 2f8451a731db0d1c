//! smr, taa and taau on the device in the hard cases that wrs has in `surfaces`, `motion` and `light`.

use super::surfaces::run_law;
use crate::laws::laws;
use crate::surfaces_hard::*;
use afterimage_testing::holds;

surfaces_laws!(Gpu, run_law);

mod feedback {
    use super::super::surfaces::run_law;
    use crate::feedback_hard::*;
    use crate::laws::laws;
    use afterimage_testing::holds;

    feedback_laws!(Gpu, run_law);
}

mod scale {
    use super::super::surfaces::run_law;
    use crate::laws::laws;
    use crate::scale_hard::*;
    use afterimage_testing::holds;

    scale_laws!(Gpu, run_law);
}

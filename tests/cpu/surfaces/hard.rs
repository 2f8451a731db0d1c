//! Hard cases for the methods that store surfaces: the laws that hold on either executor.

use crate::pass::run_law;
use crate::surfaces_hard::*;

surfaces_laws!(Cpu, run_law);

mod feedback {
    use super::run_law;
    use crate::feedback_hard::*;

    feedback_laws!(Cpu, run_law);
}

mod scale {
    use super::run_law;
    use crate::scale_hard::*;

    scale_laws!(Cpu, run_law);
}

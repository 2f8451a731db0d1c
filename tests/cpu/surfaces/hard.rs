//! Hard cases for the methods that store surfaces: the laws that hold on either executor.

use crate::laws::laws;
use crate::pass::run_law;
use crate::surfaces_hard::*;
use afterimage_testing::holds;

surfaces_laws!(Cpu, run_law);

mod feedback {
    use crate::feedback_hard::*;
    use crate::laws::laws;
    use crate::pass::run_law;
    use afterimage_testing::holds;

    feedback_laws!(Cpu, run_law);
}

mod scale {
    use crate::laws::laws;
    use crate::pass::run_law;
    use crate::scale_hard::*;
    use afterimage_testing::holds;

    scale_laws!(Cpu, run_law);
}

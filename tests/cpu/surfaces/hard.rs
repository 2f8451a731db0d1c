//! Hard cases for the methods that store surfaces: the laws that hold on either executor.

use crate::laws::laws;
use crate::pass::held;
use crate::surfaces_hard::*;
use afterimage_testing::holds;

surfaces_laws!(Cpu, held);

mod feedback {
    use crate::feedback_hard::*;
    use crate::laws::laws;
    use crate::pass::held;
    use afterimage_testing::holds;

    feedback_laws!(Cpu, held);
}

mod scale {
    use crate::laws::laws;
    use crate::pass::held;
    use crate::scale_hard::*;
    use afterimage_testing::holds;

    scale_laws!(Cpu, held);
}

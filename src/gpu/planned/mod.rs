//! Passes of planned frames: the plan, the depth that draws it, and the comparison of its samples with history.

pub(super) mod prime;
pub(super) mod quad_plan;
pub(super) mod quad_samples;

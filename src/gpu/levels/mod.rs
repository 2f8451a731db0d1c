//! Passes for methods that read whole frames: colors between the samples of planned frames, and mip chains.

pub(super) mod fill;
pub(super) mod mip_chain;

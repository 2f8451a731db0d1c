//! The wgpu executor: the post-process as WGSL passes, recorded into the caller's command encoder.

pub mod shader;
pub mod types;

//! For this workspace's other crates and for tests; not part of the stable API.

#[cfg(feature = "cpu")]
pub use crate::cpu::history::History;
#[cfg(feature = "gpu")]
pub use crate::gpu::binding::{Binding, INPUTS, used_by};
#[cfg(feature = "gpu")]
pub use crate::gpu::buffer::filled;
#[cfg(feature = "gpu")]
pub use crate::gpu::compute::{ComputeShader, Sources, declared, method_pass};
#[cfg(feature = "gpu")]
pub use crate::gpu::plane::array_view;
pub use crate::notes::{Note, NoteStage, NoteValues, PixelNotes};

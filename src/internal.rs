//! For this workspace's other crates and for tests; not part of the stable API: the description of a context for frames
//! of either door, with any method, which both doors narrow down.

pub use crate::context::ContextDesc;

#[cfg(feature = "cpu")]
pub use crate::cpu::history::History;
pub use crate::foveation::{Foveation, FoveationKind};
pub use crate::frame::{FrameInputs, Reset};
#[cfg(feature = "gpu")]
pub use crate::gpu::binding::{Binding, INPUTS, used_by};
#[cfg(feature = "gpu")]
pub use crate::gpu::buffer::filled;
#[cfg(feature = "gpu")]
pub use crate::gpu::compute::{ComputeShader, Sources, declared, method_pass};
#[cfg(feature = "gpu")]
pub use crate::gpu::frame::Frame;
#[cfg(feature = "gpu")]
pub use crate::gpu::plane::array_view;
pub use crate::notes::{Note, NoteStage, NoteValues, PixelNotes};
pub use crate::settings::{
    Bias, DepthTest, Gate, GateMetric, GateScale, Method, MethodKind, Sampler, Settings, Smr, Wrs,
};
#[cfg(feature = "cpu")]
pub use crate::simulator::Pyramid;
#[cfg(feature = "gpu")]
pub use crate::simulator::{GpuSimulator, SimulatorFrame};
pub use crate::view::ViewFrame;

//! Pipeline of a clip on any [`Backend`](crate::device::Backend): foveates each frame for a gaze, runs each method on
//! it, and tracks surfaces for the metrics.

mod device;

pub use afterimage_eval::pipeline::{MethodOutput, Pipeline, Processor, ProcessorInfo, RunKind, Step};
pub use device::{DeviceFormats, DeviceInputs, DeviceRun};

//! Processor of a pipeline's methods: the CPU, or a device.

use super::cpu::CpuExecutor;
use super::executor::Executor;
use afterimage::CreateError;
use afterimage::internal::ContextDesc;
use serde::Serialize;
use std::fmt::Debug;

/// A processor that runs methods.
pub trait Processor: Debug + Send + Sync {
    /// An executor of frames with `desc`'s size and foveation. `is_still`: all frames are equal.
    ///
    /// # Errors
    /// [`CreateError`] if a setting is out of range or the processor does not support it.
    fn executor(&self, desc: &ContextDesc, is_still: bool) -> Result<Box<dyn Executor>, CreateError>;

    /// Its description.
    fn info(&self) -> ProcessorInfo;
}

/// A processor in reports.
#[derive(Clone, Debug, Serialize)]
pub struct ProcessorInfo {
    /// `cpu` or `gpu`.
    pub kind: &'static str,
    /// Name of the adapter, or number of threads.
    pub name: String,
    /// Driver and version; `none` on the CPU.
    pub driver: String,
}

/// The CPU.
#[derive(Clone, Copy, Debug)]
pub struct Cpu;

impl Processor for Cpu {
    fn executor(&self, _: &ContextDesc, _: bool) -> Result<Box<dyn Executor>, CreateError> {
        Ok(Box::new(CpuExecutor::default()))
    }

    fn info(&self) -> ProcessorInfo {
        ProcessorInfo { kind: "cpu", name: format!("{} threads", rayon::current_num_threads()), driver: "none".into() }
    }
}

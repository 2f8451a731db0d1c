//! Backends as processors of methods.

use super::executor::DeviceExecutor;
use crate::device::Backend;
use afterimage::CreateError;
use afterimage::internal::ContextDesc;
use afterimage_eval::pipeline::{Cpu, Executor, Processor, ProcessorInfo};

impl Processor for Backend {
    fn executor(&self, desc: &ContextDesc, is_still: bool) -> Result<Box<dyn Executor>, CreateError> {
        match self {
            Self::Cpu => Cpu.executor(desc, is_still),
            Self::Gpu(gpu) => Ok(Box::new(DeviceExecutor::new(gpu, desc, is_still)?)),
        }
    }

    fn info(&self) -> ProcessorInfo {
        match self {
            Self::Cpu => Cpu.info(),
            Self::Gpu(gpu) => ProcessorInfo {
                kind: "gpu",
                name: gpu.info.name.clone(),
                driver: format!("{} {}", gpu.info.driver, gpu.info.driver_info),
            },
        }
    }
}

//! The foveation simulator on a GPU.

use super::Desc;
use crate::error::{CreateError, FrameError};
use crate::simulator::{GpuSimulator, SimulatorFrame};
use wgpu::{CommandEncoder, Device};

/// A foveation simulator on a GPU: turns a full-rate frame into the frame that a foveating renderer would have
/// delivered, for renderers that do not foveate, and for tests.
///
/// The caller owns queue, encoder, submission, and every input and output texture, as with
/// [`Afterimage`](super::Afterimage). The simulator holds mip levels, 5.4 bytes a pixel for
/// [`Filter::Mip`](super::Filter::Mip) and 5 for [`Filter::Block`](super::Filter::Block), or an intermediate texture,
/// 16 bytes a pixel for [`Filter::Gauss`](super::Filter::Gauss).
///
/// ```no_run
/// # use afterimage::wgpu;
/// # fn example(device: &wgpu::Device, encoder: &mut wgpu::CommandEncoder, full: &wgpu::Texture, foveated: &wgpu::Texture,
/// #     views: &[afterimage::levels::ViewFrame]) -> Result<(), Box<dyn std::error::Error>> {
/// use afterimage::levels::{Desc, Simulator, SimulatorFrame};
///
/// let mut simulator = Simulator::new(device, &Desc::new([full.width(), full.height()], foveated.format()))?;
/// simulator.record(encoder, &SimulatorFrame::new(full, foveated, views))?;
/// # Ok(())
/// # }
/// ```
#[derive(Debug)]
pub struct Simulator {
    device: Device,
    passes: GpuSimulator,
}

impl Simulator {
    /// A simulator of the foveation `desc.settings.foveation`, for frames of the size and number of views of `desc`,
    /// and outputs of its format. Creates shader modules; pipelines are compiled at the first frame that needs them.
    ///
    /// # Errors
    /// [`CreateError`] if the description is out of range, the output format is not supported, or a limit of the device
    /// is too low.
    pub fn new(device: &Device, desc: &Desc) -> Result<Self, CreateError> {
        let passes = GpuSimulator::new(device, &desc.passes(), desc.output)?;
        Ok(Self { device: device.clone(), passes })
    }

    /// Records one frame into `encoder`.
    ///
    /// # Errors
    /// [`FrameError`] if a texture or value does not fit the simulator. Then nothing was recorded.
    pub fn record(&mut self, encoder: &mut CommandEncoder, frame: &SimulatorFrame<'_>) -> Result<(), FrameError> {
        self.passes.record(&self.device, encoder, frame)
    }
}

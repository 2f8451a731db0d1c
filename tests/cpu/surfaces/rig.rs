//! Frames of one view for the methods that store surfaces, and their results.

pub use crate::depth_hard::{Color, Made, Steps};
pub use crate::images::{View, noise, off, peak, pixel, pixels, times};
pub use crate::low_pass::LowPass;
pub use crate::surfaces_hard::{METHODS, SIZE, at_lod, settings, sharp};
pub use afterimage::cpu::CpuAfterimage;
pub use afterimage::internal::{ContextDesc, MethodKind, Reset, Settings};
pub use afterimage::kernel::surface::{Surface, unpack_surface};
pub use afterimage::{Exposure, Image, ViewGeometry};
pub use afterimage_testing::Draws;

pub fn context(method: MethodKind) -> CpuAfterimage {
    context_of(SIZE, settings(method))
}

pub fn context_of(size: [u32; 2], settings: Settings) -> CpuAfterimage {
    CpuAfterimage::new(&ContextDesc { settings, ..ContextDesc::new(size) }).unwrap()
}

pub fn bits(color: [f32; 3]) -> [u32; 3] {
    color.map(f32::to_bits)
}

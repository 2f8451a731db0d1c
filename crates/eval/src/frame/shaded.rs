//! Pixels that a method chooses while a frame is processed, and that its source shades.

use super::DeviceHandle;
use crate::clock::Elapsed;
use afterimage::Image;

/// Pixels that a method chose, and that the source should shade.
#[derive(Clone, Debug)]
pub struct QuadRequest {
    /// Whether the pixels of each quad of 2x2 pixels are requested.
    pub quads: Image<bool>,
    /// The same as a list on the method's device, in the form of `gpu::Afterimage::quad_list`; `None` for methods on
    /// the CPU.
    pub on_device: Option<DeviceHandle>,
}

impl QuadRequest {
    /// The pixels, of a frame of `size_px`, ordered by row.
    pub fn pixels(&self, [width, height]: [u32; 2]) -> impl Iterator<Item = [u32; 2]> + '_ {
        let pixels = (0..height).flat_map(move |y| (0..width).map(move |x| [x, y]));
        pixels.filter(|&[x, y]| self.quads.at(x as usize / 2, y as usize / 2))
    }

    /// Share of the pixels of a frame of `size_px`. Half of a quad may lie beyond the edge.
    pub fn share(&self, size_px: [u32; 2]) -> f64 {
        self.pixels(size_px).count() as f64 / size_px.iter().map(|&side| f64::from(side)).product::<f64>()
    }
}

/// The pixels of a [`QuadRequest`], in an image of the frame's size. Other pixels are not defined.
#[derive(Clone, Debug)]
pub struct Shaded {
    /// Linear color.
    pub color: ShadedColor,
    /// Time of shading.
    pub took: Elapsed,
}

/// Where shaded pixels are.
#[derive(Clone, Debug)]
pub enum ShadedColor {
    /// In memory, for methods on the CPU.
    InMemory(Image<[f32; 3]>),
    /// In a texture on the methods' device.
    OnDevice(DeviceHandle),
}

//! Pixels that a method chooses while a frame is processed, and that its source shades.

use super::DeviceHandle;
use crate::clock::Elapsed;
use afterimage::Image;

/// Pixels that a method chose, and that the source should shade.
#[derive(Clone, Debug)]
pub struct ShadingRequest {
    /// Whether a pixel is requested.
    pub mask: Image<bool>,
    /// Place in its quad of 2x2 pixels of the only requested pixel of each quad, if one of each is requested. The
    /// source may then answer with a color of half the width and height.
    pub half_place_px: Option<[u32; 2]>,
    /// Number of paths to trace at each requested pixel, for noisy methods; `None`: the source's own number.
    pub paths: Option<Image<u8>>,
    /// Quads with a requested pixel, as a list on the method's device, in the form of `gpu::Afterimage::quad_list`;
    /// `None` for methods on the CPU.
    pub on_device: Option<DeviceHandle>,
}

impl ShadingRequest {
    /// A request of the pixels of a mask.
    pub fn new(mask: Image<bool>, on_device: Option<DeviceHandle>) -> Self {
        let half_place_px = only_place_px(&mask);
        Self { mask, half_place_px, paths: None, on_device }
    }

    /// With a number of paths at each requested pixel.
    #[must_use]
    pub fn with_paths(self, paths: Option<Image<u8>>) -> Self {
        Self { paths, ..self }
    }

    /// The pixels, ordered by row.
    pub fn pixels(&self) -> impl Iterator<Item = [u32; 2]> + '_ {
        let [width, height] = self.mask.size();
        let pixels = (0..height).flat_map(move |y| (0..width).map(move |x| [x, y]));
        pixels.filter(|&[x, y]| self.mask.at(x as usize, y as usize))
    }

    /// Whether any pixel of each quad of 2x2 pixels is requested.
    pub fn quads(&self) -> Image<bool> {
        let [width, height] = self.mask.size().map(|side| side as usize);
        let is_chosen = |x: usize, y: usize| x < width && y < height && self.mask.at(x, y);
        Image::from_fn(self.mask.size().map(|side| side.div_ceil(2)), |quad| {
            let [x, y] = quad.map(|v| 2 * v as usize);
            (0..4).any(|i| is_chosen(x + i % 2, y + i / 2))
        })
    }

    /// Share of the pixels of the frame.
    pub fn share(&self) -> f64 {
        self.pixels().count() as f64 / self.mask.pixels().len() as f64
    }
}

/// Place in its quad of the only chosen pixel of each quad, if each quad has one there. Quads at the edge may have none.
fn only_place_px(mask: &Image<bool>) -> Option<[u32; 2]> {
    let chosen = |[x, y]: [u32; 2]| mask.at(x as usize, y as usize);
    let [width, height] = mask.size();
    let place =
        [[0, 0], [1, 0], [0, 1], [1, 1]].into_iter().find(|&[x, y]| x < width && y < height && chosen([x, y]))?;
    let mut pixels = (0..height).flat_map(|y| (0..width).map(move |x| [x, y]));
    pixels.all(|px| chosen(px) == (0..2).all(|i| px[i] % 2 == place[i])).then_some(place)
}

/// The pixels of a [`ShadingRequest`], in an image of the frame's size, or of half of it. Other pixels are not defined.
#[derive(Clone, Debug)]
pub struct Shaded {
    /// Linear color.
    pub color: ShadedColor,
    /// Whether the color has one texel for each quad of 2x2 pixels.
    pub is_half: bool,
    /// Noise of the color, as in [`FoveatedFrame::noise`](super::FoveatedFrame::noise), in an image of the frame's size;
    /// `None` without noise.
    pub noise: Option<Image<[f32; 2]>>,
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

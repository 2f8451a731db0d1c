//! Pixels that a method chooses while a frame is processed, and that its source shades.

use super::DeviceHandle;
use crate::clock::Elapsed;
use afterimage::Image;

/// Pixels that a method chose, and that the source should shade.
#[derive(Clone, Debug)]
pub struct ShadingRequest {
    /// Whether a pixel is requested.
    pub mask: Image<bool>,
    /// Place in its quad of 2x2 pixels of the only requested pixel of each quad, if each is requested whole or there.
    /// The source may then answer with a color of half the width and height beside that of whole quads.
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
        quads_of(&self.mask, |chosen| chosen > 0)
    }

    /// Whether more than one pixel of each quad is requested.
    pub fn whole_quads(&self) -> Image<bool> {
        quads_of(&self.mask, |chosen| chosen > 1)
    }

    /// Share of the pixels of the frame.
    pub fn share(&self) -> f64 {
        self.pixels().count() as f64 / self.mask.pixels().len() as f64
    }
}

/// A property of each quad by the number of its chosen pixels.
fn quads_of(mask: &Image<bool>, property: impl Fn(usize) -> bool) -> Image<bool> {
    Image::from_fn(mask.size().map(|side| side.div_ceil(2)), |quad| property(chosen_of(mask, quad).count()))
}

/// Places of the chosen pixels of a quad.
fn chosen_of(mask: &Image<bool>, quad: [u32; 2]) -> impl Iterator<Item = [u32; 2]> + '_ {
    let [width, height] = mask.size();
    let places = [[0, 0], [1, 0], [0, 1], [1, 1]].into_iter();
    places.filter(move |place| {
        let [x, y] = [0, 1].map(|i| 2 * quad[i] + place[i]);
        x < width && y < height && mask.at(x as usize, y as usize)
    })
}

/// Place of the only chosen pixel of each quad that is not chosen whole, if it is the same in all of them, and if there
/// are such quads. Quads at the edge may have none.
fn only_place_px(mask: &Image<bool>) -> Option<[u32; 2]> {
    let [columns, rows] = mask.size().map(|side| side.div_ceil(2));
    let mut found = None;
    for quad in (0..rows).flat_map(|y| (0..columns).map(move |x| [x, y])) {
        let inside: u32 = [0, 1].map(|i| (mask.size()[i] - 2 * quad[i]).min(2)).iter().product();
        let mut chosen = chosen_of(mask, quad);
        match (chosen.next(), 1 + chosen.count() as u32) {
            (Some(place), 1) if inside > 1 && *found.get_or_insert(place) != place => return None,
            (Some(_), 1) => {}
            (Some(_), count) if count == inside => {}
            (None, _) if inside < 4 => {}
            _ => return None,
        }
    }
    found
}

/// The pixels of a [`ShadingRequest`], in an image of the frame's size. Other pixels are not defined.
#[derive(Clone, Debug)]
pub struct Shaded {
    /// Linear color.
    pub color: ShadedColor,
    /// Color of the quads that are requested in part, one texel for each quad of 2x2 pixels; `None` if `color` has all.
    pub half: Option<ShadedColor>,
    /// Noise of the color, as in [`FoveatedFrame::noise`](super::FoveatedFrame::noise), in an image of the frame's
    /// size; `None` without noise.
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

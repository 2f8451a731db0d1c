//! Where the views of an input or output are.

use super::groups::Resource;
use std::ops::Range;
use wgpu::Texture;

/// Textures of an input or output: where its views are.
///
/// A texture with one layer a view converts by `into()`. Regions are for viewports, split screens, dynamic resolution
/// (a view in the corner of a larger texture), atlases and double-wide stereo, and for one texture an eye:
///
/// ```
/// # use afterimage::wgpu;
/// # fn example(color: &wgpu::Texture, depth: &wgpu::Texture, left: &wgpu::Texture, right: &wgpu::Texture) {
/// use afterimage::gpu::{Region, Textures};
///
/// let layers = Textures::from(color);
/// let side_by_side = [Region::new(depth, [0, 0]), Region::new(depth, [1440, 0])];
/// let eyes = [Region::new(left, [0, 0]), Region::new(right, [0, 0])];
/// let inputs = [layers, Textures::Regions(&side_by_side), Textures::Regions(&eyes)];
/// # let _ = inputs;
/// # }
/// ```
///
/// The views of a frame with regions are processed one after the other. Such a frame has pipelines of its own.
#[derive(Clone, Copy, Debug)]
pub enum Textures<'a> {
    /// A texture of the context's size with one array layer for each view; a plain 2D texture for one view.
    Layers(&'a Texture),
    /// One region for each view.
    Regions(&'a [Region<'a>]),
}

/// Rectangle of the context's size in a texture. Example: [`Textures`].
#[derive(Clone, Copy, Debug)]
pub struct Region<'a> {
    /// A 2D texture, with or without layers.
    pub texture: &'a Texture,
    /// Texel of the rectangle's top-left corner.
    pub origin_px: [u32; 2],
    /// Array layer. Default 0.
    pub layer: u32,
}

impl<'a> Region<'a> {
    /// A rectangle in a texture's first layer.
    pub fn new(texture: &'a Texture, origin_px: [u32; 2]) -> Self {
        Self { texture, origin_px, layer: 0 }
    }
}

impl<'a> From<&'a Texture> for Textures<'a> {
    fn from(texture: &'a Texture) -> Self {
        Self::Layers(texture)
    }
}

impl<'a> Textures<'a> {
    /// Textures of all views, and the layer of each; `None`: all layers.
    pub(super) fn parts(self) -> impl Iterator<Item = (&'a Texture, Option<u32>)> {
        let (layers, regions) = match self {
            Self::Layers(texture) => (Some((texture, None)), &[][..]),
            Self::Regions(regions) => (None, regions),
        };
        layers.into_iter().chain(regions.iter().map(|r| (r.texture, Some(r.layer))))
    }

    /// Textures of all views.
    pub(super) fn iter(self) -> impl Iterator<Item = &'a Texture> {
        self.parts().map(|(texture, _)| texture)
    }

    /// Whether the views are regions.
    pub(super) fn is_regions(&self) -> bool {
        matches!(self, Self::Regions(_))
    }

    /// What to bind for a batch of views.
    pub(super) fn bind(&self, batch: &Batch) -> Resource {
        let view = batch.views.start;
        match self {
            Self::Layers(texture) => Resource::Texture((*texture).clone(), batch.regions.then_some(view)),
            Self::Regions(regions) => {
                let Region { texture, layer, .. } = regions[view as usize];
                Resource::Texture(texture.clone(), Some(layer))
            }
        }
    }

    /// First pixel of a view as the shaders read it: x in the low half, y in the high half.
    pub(super) fn packed_origin(&self, view: usize) -> u32 {
        match self {
            Self::Layers(_) => 0,
            Self::Regions(regions) => {
                let [x, y] = regions[view].origin_px;
                x | y << 16
            }
        }
    }
}

/// Views that are processed in one dispatch.
#[derive(Clone, Debug)]
pub(super) struct Batch {
    pub views: Range<u32>,
    /// Whether the batch is a single view, whose inputs and outputs may be regions. Otherwise it is all views, as
    /// layers.
    pub regions: bool,
}

/// Batches of a frame of `count` views. `regions`: whether an input or output consists of regions.
pub(super) fn batches(count: usize, regions: bool) -> impl Iterator<Item = Batch> {
    let count = count as u32;
    let (batches, len) = if regions { (count, 1) } else { (1, count) };
    (0..batches).map(move |i| Batch { views: i * len..(i + 1) * len, regions })
}

//! Textures of a context, and views of textures.

use wgpu::{
    Device, Extent3d, Texture, TextureAspect, TextureDescriptor, TextureDimension, TextureFormat, TextureUsages,
    TextureView, TextureViewDescriptor, TextureViewDimension,
};

#[derive(Clone, Copy, Debug)]
pub struct PlaneDesc {
    pub label: &'static str,
    pub format: TextureFormat,
    pub size_px: [u32; 2],
    pub layers: u32,
    pub levels: u32,
    /// Usages in addition to those that passes need.
    pub usage: TextureUsages,
}

impl PlaneDesc {
    /// A plane with one level, for passes alone.
    pub const fn new(label: &'static str, format: TextureFormat, size_px: [u32; 2], layers: u32) -> Self {
        Self { label, format, size_px, layers, levels: 1, usage: TextureUsages::empty() }
    }

    pub fn bytes(&self) -> u64 {
        let texel = u64::from(self.format.block_copy_size(None).unwrap_or(0));
        let texels = |level: u32| self.size_px.map(|s| u64::from(s >> level)).iter().product::<u64>();
        texel * (0..self.levels).map(texels).sum::<u64>() * u64::from(self.layers)
    }

    pub fn create(&self, device: &Device) -> Plane {
        let [width, height] = self.size_px;
        let texture = device.create_texture(&TextureDescriptor {
            label: Some(self.label),
            size: Extent3d { width, height, depth_or_array_layers: self.layers },
            mip_level_count: self.levels,
            sample_count: 1,
            dimension: TextureDimension::D2,
            format: self.format,
            usage: TextureUsages::TEXTURE_BINDING | TextureUsages::STORAGE_BINDING | self.usage,
            view_formats: &[],
        });
        let whole = view(&texture, 0, None, None);
        let levels = (0..self.levels).map(|level| view(&texture, level, Some(1), None)).collect();
        Plane { desc: *self, texture, whole, levels }
    }
}

/// A texture that passes read and write, with an array layer for each view.
#[derive(Clone, Debug)]
pub struct Plane {
    pub desc: PlaneDesc,
    pub texture: Texture,
    /// View of all levels, to read.
    pub whole: TextureView,
    /// View of each level, to write or to read alone.
    pub levels: Vec<TextureView>,
}

/// View of all layers of a texture's first level as a 2D array. Textures with one layer also get a 2D array view,
/// because the shaders bind arrays.
pub fn array_view(texture: &Texture) -> TextureView {
    view(texture, 0, Some(1), None)
}

/// View of one layer, or of all, of a texture's first level as a 2D array.
pub(super) fn layer_view(texture: &Texture, layer: Option<u32>) -> TextureView {
    view(texture, 0, Some(1), layer)
}

/// View of one layer, or of all, as a 2D array, of `count` levels from `first` on; `None`: of all levels from `first`
/// on.
fn view(texture: &Texture, first: u32, count: Option<u32>, layer: Option<u32>) -> TextureView {
    let aspect = if texture.format().has_depth_aspect() { TextureAspect::DepthOnly } else { TextureAspect::All };
    texture.create_view(&TextureViewDescriptor {
        label: Some("afterimage"),
        dimension: Some(TextureViewDimension::D2Array),
        aspect,
        base_mip_level: first,
        mip_level_count: count,
        base_array_layer: layer.unwrap_or(0),
        array_layer_count: layer.map(|_| 1),
        ..TextureViewDescriptor::default()
    })
}

//! Materials and textures on the device.

use super::mipmaps::levels;
use super::pipelines::{Layouts, SAMPLERS, SLOTS};
use super::vertices::AlphaKind;
use crate::device::{bind_group, empty_buffer, texture_desc};
use crate::scene::shading_records::MaterialRecord;
use crate::scene::{Coordinates, Material, Scene, Texture, TextureRef, Wrap};
use afterimage::Image;
use std::collections::HashMap;
use wgpu::{
    AddressMode, BindGroup, BindingResource, Device, FilterMode, Queue, TextureFormat, TextureUsages, TextureView,
};

/// Bind groups of a scene's materials; at least one.
pub(super) fn bind_groups(
    device: &Device,
    queue: &Queue,
    layouts: &Layouts,
    scene: &Scene,
    anisotropy: u16,
) -> Vec<BindGroup> {
    let fallback = [Material::default()];
    let materials = if scene.materials.is_empty() { &fallback } else { &scene.materials[..] };
    let white = upload(device, queue, "white", &[Image::filled([1, 1], [255; 4])], false);
    let max_side = device.limits().max_texture_dimension_2d;
    let (mut textures, mut samplers) = (HashMap::new(), HashMap::new());
    // Upload only textures in use. One that serves as color and as data is uploaded in both formats.
    let of = |slot: Option<TextureRef>| slot.and_then(|r| scene.textures.get(r.texture as usize));
    for (slot, is_color) in materials.iter().flat_map(slots) {
        if let (Some(r), Some(t)) = (slot, of(slot)) {
            let upload = || upload(device, queue, "texture", &levels(t, is_color, max_side), is_color);
            textures.entry((r.texture, is_color)).or_insert_with(upload);
        }
        let (key, description) = addressing(of(slot), anisotropy);
        samplers.entry(key).or_insert_with(|| device.create_sampler(&description));
    }
    let bytes = (size_of::<MaterialRecord>() + size_of::<SlotCoordinates>()) as u64;
    let stride = bytes.next_multiple_of(256.max(u64::from(device.limits().min_storage_buffer_offset_alignment)));
    let usage = wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_DST;
    let buffer = empty_buffer(device, "materials", stride * materials.len() as u64, usage);
    let groups = materials.iter().enumerate().map(|(i, m)| {
        let record = MaterialRecord { unused: [i as f32, 0.0], ..MaterialRecord::new(m) };
        queue.write_buffer(&buffer, stride * i as u64, bytemuck::bytes_of(&record));
        let slots = slots(m);
        let coordinates: SlotCoordinates =
            slots.map(|(slot, _)| rows(of(slot).map(|t| t.coordinates).unwrap_or_default()));
        let after = stride * i as u64 + size_of::<MaterialRecord>() as u64;
        queue.write_buffer(&buffer, after, bytemuck::bytes_of(&coordinates));
        let mut resources = vec![BindingResource::Buffer(wgpu::BufferBinding {
            buffer: &buffer,
            offset: stride * i as u64,
            size: wgpu::BufferSize::new(bytes),
        })];
        for (k, (slot, is_color)) in slots.into_iter().enumerate() {
            let view = slot.and_then(|r| textures.get(&(r.texture, is_color))).unwrap_or(&white);
            resources.push(BindingResource::TextureView(view));
            if k < SAMPLERS {
                resources.push(BindingResource::Sampler(&samplers[&addressing(of(slot), anisotropy).0]));
            }
        }
        bind_group(device, &m.name, &layouts.material, resources)
    });
    groups.collect()
}

/// Whether the G-buffer has all that lighting needs of opaque surfaces of these materials: it has neither tangents nor
/// textures of layers, and 16 bits for the material.
pub(super) fn are_deferrable(materials: &[Material], device: &Device) -> bool {
    let is_opaque = |m: &&Material| AlphaKind::of(m) != AlphaKind::Blend;
    let has_layer_texture = |m: &Material| slots(m)[SAMPLERS..].iter().any(|(slot, _)| slot.is_some());
    let fits = materials.len() <= device.limits().max_texture_dimension_2d.min(1 << 16) as usize;
    fits && !materials.iter().filter(is_opaque).any(|m| m.anisotropy > 0.0 || has_layer_texture(m))
}

/// What lighting needs of materials besides the G-buffer: a row each, at least one. Twin of `surface_of` in
/// `shaders/raster/lighting_pass.wgsl`.
pub(super) fn texels(device: &Device, queue: &Queue, materials: &[Material]) -> TextureView {
    let rows = materials.iter().flat_map(|m| {
        let MaterialRecord { specular_color: [r, g, b], specular, ior, specular_tint, .. } = MaterialRecord::new(m);
        let [sheen_r, sheen_g, sheen_b] = m.sheen_color;
        [
            [r, g, b, specular],
            [ior, specular_tint, m.clearcoat, m.clearcoat_roughness],
            [sheen_r, sheen_g, sheen_b, m.sheen_roughness],
            [m.sheen_tint, 0.0, 0.0, 0.0],
        ]
    });
    let mut texels: Vec<[f32; 4]> = rows.collect();
    texels.resize(texels.len().max(4), [0.0; 4]);
    let size = [4, texels.len() as u32 / 4];
    let image = Image::from_pixels(size, texels).expect("whole rows");
    upload_levels(device, queue, "materials", &[image], TextureFormat::Rgba32Float)
}

/// Rows of the coordinates of all textures of a material, as `raster_material.wgsl` has them.
type SlotCoordinates = [[[f32; 4]; 2]; SLOTS];

fn rows(coordinates: Coordinates) -> [[f32; 4]; 2] {
    let [[a, b, c], [d, e, f]] = coordinates.rows;
    [[a, b, c, f32::from(u8::from(coordinates.second))], [d, e, f, 0.0]]
}

/// Textures in the order of their bindings, and whether each holds colors.
fn slots(m: &Material) -> [(Option<TextureRef>, bool); SLOTS] {
    [
        (m.base_color_texture, true),
        (m.metallic_roughness_texture, false),
        (m.normal_texture, false),
        (m.emissive_texture, true),
        (m.specular_texture, false),
        (m.specular_color_texture, true),
        (m.clearcoat_texture, false),
        (m.clearcoat_roughness_texture, false),
        (m.sheen_color_texture, true),
        (m.sheen_roughness_texture, false),
        (m.transmission_texture, false),
    ]
}

/// Sampler description of a texture, and a key to share samplers.
fn addressing(texture: Option<&Texture>, anisotropy: u16) -> ([u8; 3], wgpu::SamplerDescriptor<'static>) {
    let (wrap, nearest) = texture.map_or(([Wrap::Repeat; 2], false), |t| (t.wrap, t.nearest));
    let mode = |wrap| match wrap {
        Wrap::Repeat => AddressMode::Repeat,
        Wrap::Mirror => AddressMode::MirrorRepeat,
        Wrap::Clamp => AddressMode::ClampToEdge,
    };
    let filter = if nearest { FilterMode::Nearest } else { FilterMode::Linear };
    let description = wgpu::SamplerDescriptor {
        label: Some("texture"),
        address_mode_u: mode(wrap[0]),
        address_mode_v: mode(wrap[1]),
        mag_filter: filter,
        min_filter: filter,
        mipmap_filter: if nearest { wgpu::MipmapFilterMode::Nearest } else { wgpu::MipmapFilterMode::Linear },
        anisotropy_clamp: if nearest { 1 } else { anisotropy },
        ..Default::default()
    };
    ([wrap[0] as u8, wrap[1] as u8, u8::from(nearest)], description)
}

/// Uploads an 8-bit texture with all its mip levels.
fn upload(device: &Device, queue: &Queue, label: &str, levels: &[Image<[u8; 4]>], is_color: bool) -> TextureView {
    let format = if is_color { TextureFormat::Rgba8UnormSrgb } else { TextureFormat::Rgba8Unorm };
    upload_levels(device, queue, label, levels, format)
}

/// Uploads mip levels of four-channel texels, largest first.
pub(super) fn upload_levels<T: bytemuck::NoUninit>(
    device: &Device,
    queue: &Queue,
    label: &str,
    levels: &[Image<T>],
    format: TextureFormat,
) -> TextureView {
    let usage = TextureUsages::TEXTURE_BINDING | TextureUsages::COPY_DST;
    let desc = |image: &Image<T>| texture_desc(label, image.size(), format, usage);
    let mip_level_count = levels.len() as u32;
    let texture = device.create_texture(&wgpu::TextureDescriptor { mip_level_count, ..desc(&levels[0]) });
    for (level, image) in levels.iter().enumerate() {
        let to = wgpu::TexelCopyTextureInfo { mip_level: level as u32, ..texture.as_image_copy() };
        let layout = wgpu::TexelCopyBufferLayout {
            offset: 0,
            bytes_per_row: Some(image.size()[0] * size_of::<T>() as u32),
            rows_per_image: None,
        };
        queue.write_texture(to, bytemuck::cast_slice(image.pixels()), layout, desc(image).size);
    }
    texture.create_view(&Default::default())
}

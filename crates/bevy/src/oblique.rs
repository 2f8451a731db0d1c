//! Depth that is not that of a distance. Mirrors and portals have oblique projections: their near plane
//! (`near_clip_plane`) is that of the mirror. The post-process gets depth of a plain projection instead; of
//! orthographic ones, too.

use crate::orthographic::is_orthographic;
use afterimage::wgpu;
use bevy::math::{Mat4, UVec2, Vec2, Vec4};
use bevy::prelude::Resource;
use wgpu::util::DeviceExt;
use wgpu::{BindingResource, CommandEncoder, Device, Texture};

/// Near plane of the plain projection, which is reversed and has no far plane.
pub(crate) const NEAR: f32 = 0.1;

/// Whether a projection's depth is not that of a distance.
pub(crate) fn is_oblique(clip_from_view: Mat4) -> bool {
    clip_from_view.x_axis.z != 0.0 || clip_from_view.y_axis.z != 0.0
}

/// A projection from view or world with plain depth.
pub(crate) fn plain(clip_from: Mat4) -> Mat4 {
    let mut rows = clip_from.transpose();
    rows.z_axis = Vec4::W * NEAR;
    rows.transpose()
}

/// Depth of what is infinitely far: a factor on pixels to the right, on pixels down, and a constant; and a factor on
/// what lies above it.
fn plane(clip_from_view: Mat4, size: UVec2, jitter_px: Vec2) -> Vec4 {
    let [x, y, z, w] = [clip_from_view.x_axis, clip_from_view.y_axis, clip_from_view.z_axis, clip_from_view.w_axis];
    let size = size.as_vec2();
    // Rays through pixels, one away from the camera: u = (ndc + offset) / focal length.
    let offset = Vec2::new(z.x, z.y) + Vec2::new(-2.0, 2.0) * jitter_px / size;
    let by = Vec2::new(x.z / x.x, y.z / y.y);
    let constant = by.dot(offset + Vec2::new(-1.0, 1.0)) - z.z;
    Vec4::new(2.0 * by.x / size.x, -2.0 * by.y / size.y, constant, NEAR / w.z)
}

/// Compiled for the first camera that needs it.
#[derive(Resource, Debug, Default)]
pub(crate) struct ObliquePass(Option<wgpu::ComputePipeline>);

fn pipeline(device: &Device) -> wgpu::ComputePipeline {
    let source = wgpu::ShaderSource::Wgsl(include_str!("oblique.wgsl").into());
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor { label: Some("oblique"), source });
    device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
        label: Some("afterimage oblique"),
        layout: None,
        module: &module,
        entry_point: None,
        compilation_options: Default::default(),
        cache: None,
    })
}

impl ObliquePass {
    /// Writes the plain depth of a viewport, from the pixel `origin_px` on, to `plain`.
    pub fn record(
        &mut self,
        device: &Device,
        encoder: &mut CommandEncoder,
        (depth, origin_px): (&Texture, [u32; 2]),
        plain: &Texture,
        (clip_from_view, jitter_px): (Mat4, [f32; 2]),
    ) {
        let pipeline = self.0.get_or_insert_with(|| pipeline(device));
        let size = UVec2::new(plain.width(), plain.height());
        let plane = plane(clip_from_view, size, jitter_px.into()).to_array().map(f32::to_ne_bytes);
        let is_flat = is_orthographic(clip_from_view).into();
        let origin = [origin_px[0], origin_px[1], is_flat, 0].map(u32::to_ne_bytes);
        let uniforms = device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
            label: Some("afterimage oblique"),
            contents: &[plane, origin].concat().concat(),
            usage: wgpu::BufferUsages::UNIFORM,
        });
        let [depth, output] = [depth, plain].map(|texture| texture.create_view(&Default::default()));
        let entries =
            [BindingResource::TextureView(&depth), BindingResource::TextureView(&output), uniforms.as_entire_binding()];
        let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: None,
            layout: &pipeline.get_bind_group_layout(0),
            entries: &[0, 1, 2].map(|i| wgpu::BindGroupEntry { binding: i, resource: entries[i as usize].clone() }),
        });
        let mut pass = encoder.begin_compute_pass(&Default::default());
        pass.set_pipeline(pipeline);
        pass.set_bind_group(0, &group, &[]);
        pass.dispatch_workgroups(size.x.div_ceil(8), size.y.div_ceil(8), 1);
    }
}

#[cfg(test)]
#[path = "../tests/unit/oblique.rs"]
mod tests;

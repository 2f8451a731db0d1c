//! Jitter of the camera's projection: in its prepasses, so that depth and motion are those of the samples, and not in
//! what it draws later over the antialiased frame.

use crate::frame::ExtractedAfterimage;
use afterimage::wgpu;
use bevy::core_pipeline::Core3dSystems;
use bevy::core_pipeline::schedule::Core3d;
use bevy::prelude::*;
use bevy::render::RenderApp;
use bevy::render::camera::TemporalJitter;
use bevy::render::renderer::{RenderContext, ViewQuery};
use bevy::render::view::{ExtractedView, ViewUniformOffset, ViewUniforms};
use wgpu::util::DeviceExt;

pub(crate) struct JitterPlugin;

impl Plugin for JitterPlugin {
    fn build(&self, app: &mut App) {
        if let Some(render_app) = app.get_sub_app_mut(RenderApp) {
            render_app.add_systems(Core3d, remove.after(Core3dSystems::Prepass).before(Core3dSystems::MainPass));
        }
    }
}

/// Bevy's component for a jitter. Bevy adds the offset to the projection's z column, whose factor is negative.
pub(crate) fn temporal_jitter(jitter_px: [f32; 2]) -> TemporalJitter {
    TemporalJitter { offset: -Vec2::from(jitter_px) }
}

/// Jitter in pixels of a camera with or without this component.
pub(crate) fn jitter_px(jitter: Option<&TemporalJitter>) -> [f32; 2] {
    jitter.map_or([0.0; 2], |jitter| (-jitter.offset).to_array())
}

/// Removes the jitter from the matrices of a camera after its prepasses: gizmos would tremble.
fn remove(
    view: ViewQuery<(&ExtractedAfterimage, &ExtractedView, &ViewUniformOffset)>,
    uniforms: Res<ViewUniforms>,
    mut ctx: RenderContext,
) {
    let (frame, view, uniform) = view.into_inner();
    let Some(buffer) = uniforms.uniforms.buffer().filter(|_| frame.antialiases) else { return };
    let bytes: Vec<u8> = matrices(view).iter().flat_map(Mat4::to_cols_array).flat_map(f32::to_ne_bytes).collect();
    let matrices = ctx.render_device().wgpu_device().create_buffer_init(&wgpu::util::BufferInitDescriptor {
        label: Some("afterimage matrices without jitter"),
        contents: &bytes,
        usage: wgpu::BufferUsages::COPY_SRC,
    });
    let encoder = ctx.command_encoder();
    encoder.copy_buffer_to_buffer(&matrices, 0, buffer, uniform.offset.into(), matrices.size());
}

/// The matrices with which `ViewUniform` begins, in its order.
fn matrices(view: &ExtractedView) -> [Mat4; 7] {
    let world_from_view = view.world_from_view.to_matrix();
    let view_from_world = world_from_view.inverse();
    let (clip_from_view, view_from_clip) = (view.clip_from_view, view.clip_from_view.inverse());
    let clip_from_world = clip_from_view * view_from_world;
    [
        clip_from_world,
        clip_from_world,
        world_from_view * view_from_clip,
        world_from_view,
        view_from_world,
        clip_from_view,
        view_from_clip,
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use bevy::camera::CameraProjection;

    #[test]
    fn a_jitter_moves_what_is_drawn_by_its_pixels() {
        let (size, jitter) = (Vec2::new(640.0, 360.0), [0.375, -0.25]);
        let mut jittered = PerspectiveProjection::default().get_clip_from_view();
        let seen = |clip: Mat4| {
            let ndc = clip.project_point3(Vec3::new(0.3, -0.2, -3.0));
            (Vec2::new(ndc.x, -ndc.y) * 0.5 + 0.5) * size
        };
        let without = seen(jittered);
        temporal_jitter(jitter).jitter_projection(&mut jittered, size);
        let moved = seen(jittered) - without;
        assert!((moved - Vec2::from(jitter)).abs().max_element() < 1e-3, "{moved}");
        assert_eq!(jitter_px(Some(&temporal_jitter(jitter))), jitter);
    }
}

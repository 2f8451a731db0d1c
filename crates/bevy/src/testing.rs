//! Errors to plant, and what a frame was made of: for this crate's tests, not part of the stable API.

pub use crate::auto::Auto;
use crate::frame::ExtractedAfterimage;
pub use crate::frame::Planted;
use crate::pass::Contexts;
use afterimage::internal::{ContextDesc, ViewFrame};
use afterimage::wgpu;
use bevy::core_pipeline::prepass::ViewPrepassTextures;
use bevy::prelude::*;
use bevy::render::view::ViewTarget;

/// What the post-process of a camera was given in the last frame, and its output.
#[derive(Clone, Debug)]
pub struct Recorded {
    /// Render entity of the camera.
    pub camera: Entity,
    /// Description of the context.
    pub desc: ContextDesc,
    /// Description of the view.
    pub view: ViewFrame,
    /// Frame counter.
    pub index: u64,
    /// Color input, of which the quads of the mask are read, if no effect of the camera has overwritten it.
    pub color: wgpu::Texture,
    /// Quads that were shaded: a texel each, of which bit 0 says it.
    pub mask: wgpu::Texture,
    /// Depth input, of which the camera's viewport is read.
    pub depth: wgpu::Texture,
    /// Copy of it that can be read.
    pub open: Option<wgpu::Texture>,
    /// What is given in its place where it is not that of a distance, of the viewport alone.
    pub plain: Option<wgpu::Texture>,
    /// Albedo of the viewport, if the camera is deferred.
    pub albedo: Option<wgpu::Texture>,
    /// Motion vectors, likewise.
    pub motion: wgpu::Texture,
    /// The camera's main texture.
    pub output: wgpu::Texture,
}

/// What the post-processes of the last frame were given.
pub fn recorded(render_world: &mut World) -> Vec<Recorded> {
    type Camera<'a> = (Entity, &'a ExtractedAfterimage, &'a ViewTarget, &'a ViewPrepassTextures);
    let mut cameras = render_world.query::<Camera<'_>>();
    let contexts = &render_world.resource::<Contexts>().0;
    cameras
        .iter(render_world)
        .filter_map(|(camera, frame, target, prepass)| {
            let context = contexts.get(&camera)?;
            let mask = context.mask()?.clone();
            // Without effects after the post-process the camera's textures were swapped once.
            let color = (**target.main_texture_other()).clone();
            let depth = (*prepass.depth.as_ref()?.texture.texture).clone();
            let motion = (*prepass.motion_vectors.as_ref()?.texture.texture).clone();
            let (open, plain, albedo) = (context.depth.clone(), context.plain.clone(), context.albedo.clone());
            let output = (**target.main_texture()).clone();
            let ExtractedAfterimage { desc, view, index, .. } = *frame;
            Some(Recorded { camera, desc, view, index, color, mask, depth, open, plain, albedo, motion, output })
        })
        .collect()
}

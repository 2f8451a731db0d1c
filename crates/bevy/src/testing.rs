//! Errors to plant, and what a frame was made of: for this crate's tests, not part of the stable API.

use crate::frame::ExtractedAfterimage;
pub use crate::frame::Planted;
use crate::pass::Contexts;
use afterimage::{ContextDesc, ViewFrame, wgpu};
use bevy::core_pipeline::prepass::ViewPrepassTextures;
use bevy::diagnostic::FrameCount;
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
    /// Color input.
    pub color: wgpu::Texture,
    /// Depth input, of which the camera's viewport is read.
    pub depth: wgpu::Texture,
    /// Motion vectors, likewise.
    pub motion: wgpu::Texture,
    /// The camera's main texture.
    pub output: wgpu::Texture,
}

/// What the post-processes of the last frame were given.
pub fn recorded(render_world: &mut World) -> Vec<Recorded> {
    let mut cameras = render_world.query::<(Entity, &ExtractedAfterimage, &ViewTarget, &ViewPrepassTextures)>();
    let index = render_world.resource::<FrameCount>().0.into();
    let contexts = &render_world.resource::<Contexts>().by_camera;
    cameras
        .iter(render_world)
        .filter_map(|(camera, frame, target, prepass)| {
            let context = contexts.get(&camera)?;
            let color = context.color.clone()?;
            let depth = (*prepass.depth.as_ref()?.texture.texture).clone();
            let motion = (*prepass.motion_vectors.as_ref()?.texture.texture).clone();
            let output = (**target.main_texture()).clone();
            Some(Recorded { camera, desc: frame.desc, view: frame.view, index, color, depth, motion, output })
        })
        .collect()
}

//! Foveated rendering with memory for Bevy, in one plugin.
//!
//! A camera with [`Afterimage`] shades few of its pixels in a frame: those around the gaze, an even pattern that moves,
//! and those where history lacks something. A temporal post-process, the crate [`afterimage`], fills the rest from
//! what was shaded before. Without an eye tracker, [`Foveated::uniform`] spreads them evenly.
//!
//! ```no_run
//! use bevy::prelude::*;
//! use bevy_afterimage::{Afterimage, AfterimagePlugin, CursorGazePlugin, Foveated};
//!
//! App::new()
//!     .add_plugins((DefaultPlugins, AfterimagePlugin, CursorGazePlugin))
//!     .add_systems(Startup, |mut commands: Commands| {
//!         commands.spawn((Camera3d::default(), Afterimage::default(), Foveated::default()));
//!     })
//!     .run();
//! ```
//!
//! # How a frame is made
//!
//! 1. Bevy draws depth and motion vectors of every pixel, in its prepasses, and what is deferred.
//! 2. The post-process chooses quads of 2x2 pixels, and closes the depth buffer elsewhere.
//! 3. Bevy lights what is deferred, and draws opaque and alpha-masked meshes and the sky as always; the depth test
//!    skips what is closed.
//! 4. The post-process makes the frame, and opens the depth buffer again.
//! 5. Bevy draws what has no prepass, what transmits light, what is transparent, particles and gizmos at every pixel,
//!    and its effects.

mod albedo;
mod auto;
mod blit;
mod camera;
mod components;
mod context;
mod counters;
mod diagnostics;
mod frame;
mod gaze;
mod late;
mod layers;
mod oblique;
mod orthographic;
mod pass;
mod scanpath;
#[doc(hidden)]
pub mod testing;
mod warnings;

pub use afterimage;
pub use camera::AfterimageSupported;
pub use components::{Afterimage, AfterimageDebug, Foveated, FoveationKind};
pub use counters::AfterimageStats;
pub use gaze::{CameraGaze, CursorGazePlugin, Gaze};
pub use pass::ShowQuads;
pub use scanpath::{Scanpath, ScanpathError, ScanpathPlugin};

use bevy::prelude::*;
use bevy::render::RenderApp;
use bevy::render::renderer::RenderAdapter;

/// Runs the post-process for cameras with [`Afterimage`]. Needs Bevy's `PbrPlugin`, which is among `DefaultPlugins`;
/// add it after those.
#[derive(Clone, Copy, Debug, Default)]
pub struct AfterimagePlugin;

impl Plugin for AfterimagePlugin {
    fn build(&self, app: &mut App) {
        app.init_resource::<Gaze>()
            .register_type::<(Afterimage, AfterimageDebug, AfterimageStats, CameraGaze, Foveated, Gaze)>();
        if app.get_sub_app(RenderApp).is_none() {
            return;
        }
        app.init_resource::<AfterimageSupported>().add_plugins((
            auto::AutoPlugin,
            camera::CameraPlugin,
            layers::LayersPlugin,
            late::LatePlugin,
            frame::FramePlugin,
            pass::PassPlugin,
            albedo::AlbedoPlugin,
            diagnostics::DiagnosticsPlugin,
            warnings::WarningsPlugin,
        ));
    }

    fn finish(&self, app: &mut App) {
        let Some(render_app) = app.get_sub_app(RenderApp) else { return };
        if !app.world().contains_resource::<AfterimageSupported>() {
            error!(
                "AfterimagePlugin does nothing: no renderer was there when it was added. Add it after DefaultPlugins"
            );
            return;
        }
        let adapter = render_app.world().get_resource::<RenderAdapter>();
        let flags = adapter.map(|adapter| adapter.get_downlevel_capabilities().flags);
        if flags.is_some_and(|flags| !flags.contains(afterimage::wgpu::DownlevelFlags::COMPUTE_SHADERS)) {
            app.world_mut().remove_resource::<AfterimageSupported>();
            error!("AfterimagePlugin does nothing: the device has no compute shaders");
        }
    }
}

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;

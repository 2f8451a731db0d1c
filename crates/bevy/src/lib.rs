#![doc = include_str!("../README.md")]

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
            auto::plugin,
            camera::plugin,
            layers::plugin,
            late::plugin,
            frame::plugin,
            pass::plugin,
            albedo::plugin,
            diagnostics::plugin,
            warnings::plugin,
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

//! Foveated rendering with memory for Bevy, in one plugin.
//!
//! A camera with [`Afterimage`] shades every pixel only around the gaze. Elsewhere it shades one pixel of each block,
//! and another one in the next frame. A temporal post-process, the crate [`afterimage`], fills the rest from what was
//! shaded before.
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
//! [`FoveationKind::Sparse`], the default: the plugin gives the camera up to three children, the [lattice
//! cameras](LatticeCamera). Each draws the samples of a rectangle as a small view: a crop of the camera's projection,
//! shifted so that the middles of its texels are those of the samples. The camera itself draws depth and motion vectors
//! of every pixel, and shades no mesh. Before what else it draws, as gizmos, the post-process writes the frame into its
//! main texture, so that those stay at full rate. Post-processing effects and UI follow as usual.
//!
//! An application's queries for its camera find that alone: lattice cameras are hidden from systems in `First` to
//! `Update`, and in `PostUpdate` before `TransformSystems::Propagate`. Later ones, as in `Last`, need
//! `Without<LatticeCamera>`.

mod blit;
mod camera;
mod context;
mod counters;
mod diagnostics;
mod frame;
mod gaze;
mod hide;
mod lattice;
mod mirror;
mod pass;
mod scanpath;
mod shadow;
#[doc(hidden)]
pub mod testing;
mod warnings;

pub use afterimage;
pub use camera::{Afterimage, AfterimageDebug, AfterimageSupported, Foveated, FoveationKind, Preset};
pub use counters::AfterimageStats;
pub use gaze::{CameraGaze, CursorGazePlugin, Gaze};
pub use lattice::LatticeCamera;
pub use mirror::MirrorPlugin;
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
        app.init_resource::<Gaze>().init_resource::<testing::Planted>().register_type::<(
            Afterimage,
            AfterimageDebug,
            AfterimageStats,
            CameraGaze,
            Foveated,
            Gaze,
        )>();
        if app.get_sub_app(RenderApp).is_none() {
            return;
        }
        app.init_resource::<AfterimageSupported>().add_plugins((
            camera::CameraPlugin,
            lattice::LatticePlugin,
            mirror::MirrorDefaultsPlugin,
            shadow::ShadowPlugin,
            hide::HidePlugin,
            frame::FramePlugin,
            pass::PassPlugin,
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

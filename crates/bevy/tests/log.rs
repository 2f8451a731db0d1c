//! Lines in the log, in a process of their own: those that are written once are written once in a process.

#[path = "../examples/common/mod.rs"]
mod common;

use bevy::camera::ClearColorConfig;
use bevy::core_pipeline::prepass::DeferredPrepass;
use bevy::light::VolumetricFog;
use bevy::log::tracing_subscriber;
use bevy::prelude::*;
use bevy::render::camera::TemporalJitter;
use bevy_afterimage::{Afterimage, AfterimagePlugin, AfterimageSupported, CameraGaze, Foveated};
use common::headless::{self, Headless};
use common::scene::{ScenePlugin, TONEMAPPING, stroll};
use std::io::Write;
use std::sync::Mutex;

static LOG: Mutex<Vec<u8>> = Mutex::new(vec![]);

struct Log;

impl Write for Log {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        LOG.lock().expect("the log").write(bytes)
    }

    fn flush(&mut self) -> std::io::Result<()> {
        Ok(())
    }
}

/// How many lines contain `word` after a few frames of a camera with `components`.
fn lines_about(word: &str, components: impl Bundle) -> usize {
    let mut headless = Headless::new(UVec2::new(64, 36), ScenePlugin { lamps: 0, moves: false });
    let target = headless.render_target();
    headless.app.world_mut().spawn((Camera3d::default(), target, TONEMAPPING, stroll(1.0), components));
    headless.frames(4);
    lines(word)
}

/// How many of the plugin's lines so far contain `word`.
fn lines(word: &str) -> usize {
    let log = LOG.lock().expect("the log");
    let log = String::from_utf8_lossy(&log);
    log.lines().filter(|line| line.contains("bevy_afterimage") && line.contains(word)).count()
}

/// A material that lets the light of what is behind it through.
fn glass(mut commands: Commands, mut meshes: ResMut<Assets<Mesh>>, mut materials: ResMut<Assets<StandardMaterial>>) {
    let material = StandardMaterial { specular_transmission: 0.9, ..default() };
    commands.spawn((Mesh3d(meshes.add(Cuboid::default())), MeshMaterial3d(materials.add(material))));
}

fn lines_of_glass() -> usize {
    let mut headless = Headless::new(UVec2::new(64, 36), ScenePlugin { lamps: 0, moves: false });
    headless.app.add_systems(Startup, glass);
    let target = headless.render_target();
    headless.app.world_mut().spawn((Camera3d::default(), Msaa::Off, target, TONEMAPPING, Afterimage::default()));
    headless.frames(4);
    lines("specular_transmission")
}

/// Adds the plugin before those that it needs.
fn lines_of_a_wrong_order() -> usize {
    let mut app = App::new();
    app.add_plugins(AfterimagePlugin);
    headless::add_default_plugins(&mut app);
    headless::start(&mut app);
    assert!(!app.world().contains_resource::<AfterimageSupported>());
    lines("Add it after DefaultPlugins")
}

// One test, because lines that are written once are written once in a process.
#[test]
fn what_is_not_drawn_as_it_should_is_said_once() {
    tracing_subscriber::fmt().with_writer(|| Log).init();
    let msaa = |msaa: Msaa| lines_about("Msaa", (msaa, Afterimage::default()));
    assert_eq!([Msaa::Off, Msaa::Sample4, Msaa::Sample2].map(msaa), [0, 1, 1]);
    let jitter = |antialias| {
        let afterimage = Afterimage { antialias, ..default() };
        lines_about("TemporalJitter", (Msaa::Off, TemporalJitter::default(), afterimage))
    };
    assert_eq!([false, false, true, true].map(jitter), [1, 1, 2, 2]);

    assert_eq!([lines_about("Add Afterimage", Msaa::Off), lines_about("Add Afterimage", Foveated::default())], [0, 1]);
    assert_eq!(lines_about("Use DistanceFog", (Msaa::Off, Afterimage::default(), VolumetricFog::default())), 1);
    let uncleared = Camera { clear_color: ClearColorConfig::None, ..default() };
    assert_eq!(lines_about("ClearColorConfig::None", (Msaa::Off, Afterimage::default(), uncleared)), 1);
    let deferred = (Msaa::Off, Afterimage::default(), DeferredPrepass);
    assert_eq!(lines_about("DeferredPrepass", deferred), 1);
    let flat = Projection::from(OrthographicProjection { scale: 0.03, ..OrthographicProjection::default_3d() });
    assert_eq!(lines_about("projection is orthographic", (Msaa::Off, Afterimage::default(), flat)), 1);
    assert_eq!([lines_of_glass(), lines_of_glass()], [1, 2]);
    assert_eq!(lines_of_a_wrong_order(), 1);
    // What is right is not complained about.
    let before = lines("");
    lines_about("", (Msaa::Off, Afterimage::default(), CameraGaze::default()));
    assert_eq!(lines(""), before);
}

//! A courtyard in a window. The mouse is the gaze.
//!
//! Keys: 1 full rate; 2 foveated by the mouse; 3 one pixel in 4 everywhere, without a gaze; A antialiasing; D debug
//! views; S stats; R resets history.
//!
//! `cargo run --release --features window --example window`

mod common;

use bevy::diagnostic::{DiagnosticsStore, FrameTimeDiagnosticsPlugin};
use bevy::prelude::*;
use bevy_afterimage::afterimage::DebugView;
use bevy_afterimage::{
    Afterimage, AfterimageDebug, AfterimagePlugin, AfterimageStats, CursorGazePlugin, Foveated, FoveationKind,
};
use common::scene::{ScenePlugin, TONEMAPPING, stroll};

fn main() {
    let mut app = App::new();
    // (1) to (3): what Afterimage adds to an application.
    app.add_plugins((DefaultPlugins, AfterimagePlugin, CursorGazePlugin))
        .add_plugins((FrameTimeDiagnosticsPlugin::default(), ScenePlugin { lamps: 16, moves: true }))
        .add_systems(Startup, |mut commands: Commands| {
            commands.spawn((Camera3d::default(), Afterimage::default(), Foveated::default(), TONEMAPPING, stroll(1.5)));
        })
        .add_systems(Update, (keys, title, sway));
    app.run();
}

/// Moves the camera to and fro.
fn sway(time: Res<Time>, mut camera: Single<&mut Transform, With<Afterimage>>) {
    **camera = stroll(1.5 + (0.5 * time.elapsed_secs()).sin());
}

type Switched<'a> = (Entity, &'a mut Foveated, &'a mut Afterimage, Option<&'a AfterimageDebug>, Has<AfterimageStats>);

fn keys(mut commands: Commands, keys: Res<ButtonInput<KeyCode>>, camera: Single<Switched<'_>>) {
    let (entity, mut foveated, mut afterimage, debug, counts) = camera.into_inner();
    for (key, chosen) in [
        (KeyCode::Digit1, Foveated { kind: FoveationKind::Off, ..default() }),
        (KeyCode::Digit2, Foveated::default()),
        (KeyCode::Digit3, Foveated::uniform(0.25)),
    ] {
        if keys.just_pressed(key) {
            *foveated = chosen;
        }
    }
    if keys.just_pressed(KeyCode::KeyR) {
        afterimage.reset = true;
    }
    if keys.just_pressed(KeyCode::KeyA) {
        afterimage.antialias = !afterimage.antialias;
    }
    if keys.just_pressed(KeyCode::KeyD) {
        let views = [DebugView::Quality, DebugView::Age, DebugView::Rejection, DebugView::Motion];
        let next = debug.map_or(0, |debug| views.iter().position(|view| *view == debug.0).map_or(0, |i| i + 1));
        match views.get(next) {
            Some(&view) => commands.entity(entity).insert(AfterimageDebug(view)),
            None => commands.entity(entity).remove::<AfterimageDebug>(),
        };
    }
    if keys.just_pressed(KeyCode::KeyS) {
        match counts {
            true => commands.entity(entity).remove::<AfterimageStats>(),
            false => commands.entity(entity).insert(AfterimageStats::default()),
        };
    }
}

fn title(
    diagnostics: Res<DiagnosticsStore>,
    camera: Single<(&Foveated, Option<&AfterimageStats>)>,
    mut window: Single<&mut Window>,
) {
    let (foveated, stats) = *camera;
    let frame_ms =
        diagnostics.get(&FrameTimeDiagnosticsPlugin::FRAME_TIME).and_then(|d| d.smoothed()).unwrap_or_default();
    let kept =
        stats.map_or(String::new(), |s| format!(", kept {:.0} %", 100.0 * s.kept as f64 / s.pixels.max(1) as f64));
    let name = match (foveated.kind, foveated.fovea_deg) {
        (FoveationKind::Off, _) => "full rate",
        (FoveationKind::Quads, 0.0) => "uniform",
        _ => "foveated",
    };
    window.title = format!("{name}: {frame_ms:.1} ms{kept} (1-3, A, D, S, R)");
}

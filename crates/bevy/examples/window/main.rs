//! A courtyard in a window, with what foveation finds hard: a walking figure, a flashlight, sparks, glass, and a view
//! model on top. The title tells the time of a frame for each mode that was chosen.
//!
//! Keys: 1 full rate with MSAA; 2 full rate with TAA; 3 one pixel in 4 everywhere; 4 as many as make 60 frames a
//! second; 5 around the mouse, which is the gaze; A antialiasing; D debug views; S stats; R resets history.
//!
//! `cargo run --release --features window --example window`

#[path = "../common/mod.rs"]
mod common;
mod props;

use bevy::anti_alias::taa::TemporalAntiAliasing;
use bevy::diagnostic::{DiagnosticsStore, FrameTimeDiagnosticsPlugin};
use bevy::pbr::ScreenSpaceTransmission;
use bevy::prelude::*;
use bevy::render::RenderPlugin;
use bevy::render::camera::TemporalJitter;
use bevy::render::diagnostic::RenderDiagnosticsPlugin;
use bevy_afterimage::afterimage::DebugView;
use bevy_afterimage::{
    Afterimage, AfterimageDebug, AfterimagePlugin, AfterimageStats, CursorGazePlugin, Foveated, FoveationKind,
};
use common::scene::{ScenePlugin, TONEMAPPING, stroll};
use props::{Held, PropsPlugin};

fn main() {
    let mut app = App::new();
    // (1) to (3): what Afterimage adds to an application. `Foveated::auto` has the device's time by
    // `RenderDiagnosticsPlugin`.
    // Otherwise the world is missing while the pipelines of another mode are compiled.
    let render = RenderPlugin { synchronous_pipeline_compilation: true, ..default() };
    app.add_plugins((DefaultPlugins.set(render), RenderDiagnosticsPlugin, AfterimagePlugin, CursorGazePlugin))
        .add_plugins((FrameTimeDiagnosticsPlugin::default(), ScenePlugin { lamps: 16, moves: true }, PropsPlugin))
        .add_systems(Startup, |mut commands: Commands| {
            let foveated = (Afterimage::default(), Foveated::uniform(0.25));
            let camera = (Camera3d::default(), ScreenSpaceTransmission::default(), TONEMAPPING, stroll(1.5));
            let camera = commands.spawn(camera).insert(foveated).id();
            commands.insert_resource(Held { by: camera });
        })
        .init_resource::<Mode>()
        .add_systems(Update, (choose, keys, title, sway));
    app.run();
}

/// Moves the camera to and fro.
fn sway(time: Res<Time>, mut camera: Single<&mut Transform, With<Afterimage>>) {
    **camera = stroll(1.5 + (0.5 * time.elapsed_secs()).sin());
}

/// How pixels are shaded.
#[derive(Resource, Clone, Copy, Default, PartialEq, Eq)]
enum Mode {
    Full,
    Taa,
    #[default]
    Uniform,
    Auto,
    Gaze,
}

impl Mode {
    const ALL: [(Self, KeyCode, &str); 5] = [
        (Self::Full, KeyCode::Digit1, "full rate"),
        (Self::Taa, KeyCode::Digit2, "TAA"),
        (Self::Uniform, KeyCode::Digit3, "uniform"),
        (Self::Auto, KeyCode::Digit4, "auto"),
        (Self::Gaze, KeyCode::Digit5, "gaze"),
    ];

    fn foveated(self) -> Foveated {
        match self {
            Self::Full | Self::Taa => Foveated { kind: FoveationKind::Off, ..default() },
            Self::Uniform => Foveated::uniform(0.25),
            Self::Auto => Foveated::auto(60.0),
            Self::Gaze => Foveated::screen(),
        }
    }
}

fn choose(
    mut commands: Commands,
    keys: Res<ButtonInput<KeyCode>>,
    mut mode: ResMut<Mode>,
    world_camera: Single<Entity, With<Afterimage>>,
    cameras: Query<Entity, With<Camera3d>>,
) {
    let Some(&(chosen, ..)) = Mode::ALL.iter().find(|(_, key, _)| keys.just_pressed(*key)) else { return };
    *mode = chosen;
    // Cameras of one target share its samples.
    let msaa = if chosen == Mode::Taa { Msaa::Off } else { Msaa::Sample4 };
    for camera in &cameras {
        commands.entity(camera).insert(msaa);
    }
    let mut camera = commands.entity(*world_camera);
    camera.insert(chosen.foveated());
    match chosen {
        Mode::Taa => camera.insert(TemporalAntiAliasing::default()),
        _ => camera.remove::<(TemporalAntiAliasing, TemporalJitter)>(),
    };
}

type Switched<'a> = (Entity, &'a mut Afterimage, Option<&'a AfterimageDebug>, Has<AfterimageStats>);

fn keys(mut commands: Commands, keys: Res<ButtonInput<KeyCode>>, camera: Single<Switched<'_>>) {
    let (entity, mut afterimage, debug, counts) = camera.into_inner();
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

/// Time of a frame in each mode, when it was last chosen.
fn title(
    diagnostics: Res<DiagnosticsStore>,
    mode: Res<Mode>,
    stats: Query<&AfterimageStats>,
    mut window: Single<&mut Window>,
    mut measured: Local<[Option<f64>; 5]>,
) {
    let frame_ms = diagnostics.get(&FrameTimeDiagnosticsPlugin::FRAME_TIME).and_then(|d| d.smoothed());
    measured[*mode as usize] = frame_ms;
    let times = Mode::ALL.iter().zip(*measured).enumerate().map(|(i, ((own, _, name), ms))| {
        let mark = if *own == *mode { "*" } else { "" };
        ms.map_or_else(|| format!("{} {name}", i + 1), |ms| format!("{} {name}{mark} {ms:.1} ms", i + 1))
    });
    let share = |part: u64, all: u64| 100.0 * part as f64 / all.max(1) as f64;
    let counted = stats
        .iter()
        .map(|s| format!("shaded {:.0} %, kept {:.0} %", share(s.shaded, s.pixels), share(s.kept, s.pixels)));
    window.title = times.chain(counted).collect::<Vec<_>>().join(" | ");
}

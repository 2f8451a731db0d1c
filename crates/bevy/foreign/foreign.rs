//! What run.py adds to an example of Bevy: the post-process on every `Camera3d`, time in fixed steps, pictures.
//!
//! Time stands still until models and shaders are there, so that all runs show the same frames.

use bevy::anti_alias::taa::TemporalAntiAliasing;
use bevy::diagnostic::FrameCount;
use bevy::prelude::*;
use bevy::render::camera::{MipBias, TemporalJitter};
use bevy::render::render_resource::PipelineCache;
use bevy::render::view::screenshot::{Screenshot, save_to_disk};
use bevy::render::{ExtractSchedule, MainWorld, RenderApp};
use bevy::time::TimeUpdateStrategy;
use bevy::window::WindowResized;
use bevy::winit::WinitSettings;
use bevy_afterimage::{Afterimage, AfterimagePlugin, AfterimageStats, Foveated, Gaze};
use rustix::time::{ClockId, clock_gettime};
use std::path::PathBuf;
use std::time::{Duration, Instant};

const FRAME: Duration = Duration::from_nanos(16_666_667);
const SIZE: UVec2 = UVec2::new(640, 360);

/// Frames of which a picture is taken, counted from the first that moves.
const SHOTS: [u32; 3] = [20, 40, 60];

/// Frames whose CPU time is measured: no picture is under way.
const MEASURED: [u32; 2] = [45, 59];

/// Pictures are written, and pixels counted, a few frames later.
const LAST: u32 = 72;

/// Nothing new is loaded or compiled for this long, and this many frames.
const QUIET: (Duration, u32) = (Duration::from_millis(1500), 15);
const PATIENCE: Duration = Duration::from_secs(90);

/// A number of the first frame that moves, because patterns follow it.
const FIRST_FRAME: u32 = 1000;

/// What every camera gets.
#[derive(Resource, Clone, Copy, Debug, PartialEq)]
enum Mode {
    /// As the example is.
    Own,
    /// Every pixel, with the antialiasing of the example, less MSAA.
    Full,
    /// Every pixel, with temporal antialiasing.
    Taa,
    Quads {
        foveated: Foveated,
        antialias: bool,
    },
}

impl Mode {
    fn read() -> Self {
        let uniform = Foveated::uniform(0.25);
        match std::env::var("FOREIGN_MODE").as_deref() {
            Ok("own") => Self::Own,
            Ok("full" | "again") => Self::Full,
            Ok("taa") => Self::Taa,
            Ok("quads") => Self::Quads { foveated: uniform, antialias: false },
            Ok("gaze") => Self::Quads { foveated: Foveated::default(), antialias: false },
            Ok("antialias") => Self::Quads { foveated: uniform, antialias: true },
            mode => panic!("FOREIGN_MODE is {mode:?}: expected own, full, again, taa, quads, gaze or antialias"),
        }
    }
}

/// Where the run is.
#[derive(Resource)]
struct Run {
    folder: PathBuf,
    loaded: Loaded,
    began: Instant,
    quiet_since: Instant,
    quiet_frames: u32,
    /// Frames that have moved. `None`: time stands still.
    frame: Option<u32>,
    measured_ms: f64,
}

/// What is loaded and compiled.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Loaded {
    drawn: usize,
    meshes: usize,
    images: usize,
    pipelines: Pipelines,
}

#[derive(Resource, Clone, Copy, Debug, Default, PartialEq)]
struct Pipelines {
    known: usize,
    waiting: usize,
}

/// Added to an application when it has all of its own plugins.
pub struct ForeignPlugin;

impl Plugin for ForeignPlugin {
    fn build(&self, app: &mut App) {
        let mode = Mode::read();
        if matches!(mode, Mode::Quads { .. }) {
            app.add_plugins(AfterimagePlugin);
            app.world_mut().resource_mut::<Gaze>().set(Vec2::splat(0.5));
        }
        let now = Instant::now();
        app.insert_resource(TimeUpdateStrategy::ManualDuration(FRAME))
            // The window of a virtual display never has the focus.
            .insert_resource(WinitSettings::continuous())
            .insert_resource(mode)
            .init_resource::<Pipelines>()
            .insert_resource(Run {
                folder: std::env::var_os("FOREIGN_OUT").expect("FOREIGN_OUT, a folder").into(),
                loaded: Loaded::default(),
                began: now,
                quiet_since: now,
                quiet_frames: 0,
                frame: None,
                measured_ms: 0.0,
            })
            .add_observer(change_camera)
            .add_systems(PreStartup, tell_sizes)
            .add_systems(PostUpdate, step);
        app.world_mut().resource_mut::<Time<Virtual>>().pause();
        let mut windows = app.world_mut().query::<&mut Window>();
        for mut window in windows.iter_mut(app.world_mut()) {
            window.resolution.set_scale_factor_override(Some(1.0));
            window.resolution.set_physical_resolution(SIZE.x, SIZE.y);
        }
        app.sub_app_mut(RenderApp).add_systems(ExtractSchedule, count_pipelines);
    }
}

/// Some examples wait for it to set their viewports. A virtual display has no window manager that would say it.
fn tell_sizes(windows: Query<(Entity, &Window)>, mut resized: MessageWriter<WindowResized>) {
    for (window, shown) in &windows {
        resized.write(WindowResized { window, width: shown.width(), height: shown.height() });
    }
}

fn change_camera(added: On<Add<Camera3d>>, mode: Res<Mode>, mut commands: Commands) {
    let mut camera = commands.entity(added.entity);
    match *mode {
        Mode::Own => &mut camera,
        Mode::Full => camera.insert(Msaa::Off),
        Mode::Taa => camera.insert((Msaa::Off, TemporalAntiAliasing::default())),
        Mode::Quads { foveated, antialias } => {
            if antialias {
                // In its place.
                camera.remove::<(TemporalAntiAliasing, TemporalJitter, MipBias)>();
            }
            camera.insert((Afterimage { antialias, ..default() }, foveated))
        }
    };
}

fn count_pipelines(mut world: ResMut<MainWorld>, cache: Res<PipelineCache>) {
    *world.resource_mut::<Pipelines>() =
        Pipelines { known: cache.pipelines().count(), waiting: cache.waiting_pipelines().count() };
}

fn step(world: &mut World) {
    let Some(frame) = world.resource::<Run>().frame else {
        if is_settled(world) {
            world.resource_mut::<Time<Virtual>>().unpause();
            world.resource_mut::<FrameCount>().0 = FIRST_FRAME;
            world.resource_mut::<Run>().frame = Some(0);
        }
        return;
    };
    let frame = frame + 1;
    world.resource_mut::<Run>().frame = Some(frame);
    if SHOTS.contains(&frame) {
        let path = world.resource::<Run>().folder.join(format!("{frame:03}.png"));
        world.spawn(Screenshot::primary_window()).observe(save_to_disk(path));
    }
    if frame == MEASURED[0] {
        world.resource_mut::<Run>().measured_ms = cpu_ms();
    }
    if frame == MEASURED[1] {
        let spent_ms = cpu_ms() - world.resource::<Run>().measured_ms;
        println!("foreign: cpu_ms {:.1}", spent_ms / f64::from(MEASURED[1] - MEASURED[0]));
        count_shaded(world);
    }
    if frame == LAST {
        print_shaded(world);
        world.write_message(AppExit::Success);
    }
}

/// Whether nothing has been loaded or compiled for a while.
fn is_settled(world: &mut World) -> bool {
    let loaded = Loaded {
        drawn: world.query::<&Mesh3d>().iter(world).count(),
        meshes: world.resource::<Assets<Mesh>>().len(),
        images: world.resource::<Assets<Image>>().len(),
        pipelines: *world.resource::<Pipelines>(),
    };
    let mut run = world.resource_mut::<Run>();
    if run.loaded != loaded || loaded.pipelines.waiting > 0 {
        (run.loaded, run.quiet_since, run.quiet_frames) = (loaded, Instant::now(), 0);
    }
    run.quiet_frames += 1;
    if run.began.elapsed() > PATIENCE {
        println!("foreign: still loading after {} s: {loaded:?}", PATIENCE.as_secs());
        return true;
    }
    run.quiet_frames > QUIET.1 && run.quiet_since.elapsed() > QUIET.0
}

fn count_shaded(world: &mut World) {
    let cameras: Vec<Entity> = world.query_filtered::<Entity, With<Afterimage>>().iter(world).collect();
    for camera in cameras {
        world.entity_mut(camera).insert(AfterimageStats::default());
    }
}

fn print_shaded(world: &mut World) {
    let mut cameras = world.query::<&AfterimageStats>();
    for stats in cameras.iter(world) {
        match stats.pixels {
            0 => println!("foreign: shaded all"),
            pixels => println!("foreign: shaded {:.1} %", 100.0 * stats.shaded as f64 / pixels as f64),
        }
    }
}

/// CPU time of the process so far, with that of the software driver.
fn cpu_ms() -> f64 {
    let time = clock_gettime(ClockId::ProcessCPUTime);
    1e3 * time.tv_sec as f64 + 1e-6 * time.tv_nsec as f64
}

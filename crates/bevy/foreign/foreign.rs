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
use bevy::window::{PresentMode, WindowResized};
use bevy::winit::WinitSettings;
use bevy_afterimage::{Afterimage, AfterimagePlugin, AfterimageStats, Foveated, FoveationKind, Gaze};
use rustix::time::{ClockId, clock_gettime};
use std::path::PathBuf;
use std::time::{Duration, Instant};

const FRAME: Duration = Duration::from_nanos(16_666_667);
const SIZE: UVec2 = UVec2::new(640, 360);

/// Frames of which a picture is taken, counted from the first that moves.
const SHOTS: [u32; 3] = [20, 40, 60];

/// First frame whose CPU time is measured, and how many are: no picture is under way.
const MEASURED: [u32; 2] = [45, 14];

/// Pictures are written, and pixels counted, this many frames later.
const MORE: u32 = 13;

/// Nothing new is loaded or compiled for this long, and this many frames.
const QUIET: (Duration, u32) = (Duration::from_millis(1500), 15);
const PATIENCE: Duration = Duration::from_secs(90);

/// Frames in which `Foveated::auto` settles before anything moves, after all is loaded.
const SETTLING: u32 = 150;

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

/// What is measured alone, without pictures.
#[derive(Resource, Clone, Copy, Debug)]
struct Timed {
    size: UVec2,
    frames: u32,
}

impl Timed {
    /// FOREIGN_TIMED is `WIDTHxHEIGHTxFRAMES`.
    fn read() -> Option<Self> {
        let text = std::env::var("FOREIGN_TIMED").ok()?;
        let numbers: Vec<u32> = text.split('x').flat_map(str::parse).collect();
        let [width, height, frames] = numbers[..] else { panic!("FOREIGN_TIMED is {text}") };
        Some(Self { size: UVec2::new(width, height), frames })
    }
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
            Ok("auto") => {
                let target_fps = std::env::var("FOREIGN_FPS").expect("FOREIGN_FPS").parse().expect("a number");
                Self::Quads { foveated: Foveated::auto(target_fps), antialias: true }
            }
            mode => panic!("FOREIGN_MODE is {mode:?}: expected own, full, again, taa, quads, gaze, antialias or auto"),
        }
    }

    fn is_auto(self) -> bool {
        matches!(self, Self::Quads { foveated: Foveated { target_fps: Some(_), .. }, .. })
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
    /// Clock and CPU time when the measurement began.
    measured: [f64; 2],
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
                measured: [0.0; 2],
            })
            .add_observer(change_camera)
            .add_systems(PreStartup, tell_sizes)
            .add_systems(PostUpdate, step)
            .add_systems(Last, tell_choice);
        app.world_mut().resource_mut::<Time<Virtual>>().pause();
        let timed = Timed::read();
        let size = timed.map_or(SIZE, |timed| timed.size);
        let mut windows = app.world_mut().query::<&mut Window>();
        for mut window in windows.iter_mut(app.world_mut()) {
            window.resolution.set_scale_factor_override(Some(1.0));
            window.resolution.set_physical_resolution(size.x, size.y);
            if timed.is_some() {
                window.present_mode = PresentMode::AutoNoVsync;
            }
        }
        if let Some(timed) = timed {
            app.insert_resource(timed);
        }
        if mode.is_auto() {
            // It measures the clock's time; what moves does so in steps of at most a frame.
            app.insert_resource(TimeUpdateStrategy::Automatic);
            app.world_mut().resource_mut::<Time<Virtual>>().set_max_delta(FRAME);
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
    let timed = world.get_resource::<Timed>().copied();
    if timed.is_none() && SHOTS.contains(&frame) {
        let path = world.resource::<Run>().folder.join(format!("{frame:03}.png"));
        world.spawn(Screenshot::primary_window()).observe(save_to_disk(path));
    }
    let [first, count] = [MEASURED[0], timed.map_or(MEASURED[1], |timed| timed.frames)];
    let now = |run: &Run| [1e3 * run.began.elapsed().as_secs_f64(), cpu_ms()];
    if frame == first {
        let mut run = world.resource_mut::<Run>();
        run.measured = now(&run);
    }
    if frame == first + count {
        let run = world.resource::<Run>();
        let [clock_ms, spent_ms] = [0, 1].map(|i| (now(run)[i] - run.measured[i]) / f64::from(count));
        println!("foreign: cpu_ms {spent_ms:.1}\nforeign: clock_ms {clock_ms:.1}");
        count_shaded(world);
    }
    if frame == first + count + MORE {
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
    let quiet_frames = QUIET.1 + if world.resource::<Mode>().is_auto() { SETTLING } else { 0 };
    let mut run = world.resource_mut::<Run>();
    // What auto switches compiles pipelines, but does not make it start again.
    let is_settling = run.quiet_frames > QUIET.1 && run.loaded.images == loaded.images;
    if !is_settling && (run.loaded != loaded || loaded.pipelines.waiting > 0) {
        (run.loaded, run.quiet_since, run.quiet_frames) = (loaded, Instant::now(), 0);
    }
    run.quiet_frames += 1;
    if !is_settling && run.began.elapsed() > PATIENCE {
        println!("foreign: still loading after {} s: {loaded:?}", PATIENCE.as_secs());
        return true;
    }
    run.quiet_frames > quiet_frames && run.quiet_since.elapsed() > QUIET.0
}

/// Prints what `Foveated::auto` chooses, when it switches foveation off or on.
fn tell_choice(cameras: Query<&Foveated>, run: Res<Run>, mut last: Local<Option<FoveationKind>>) {
    let kind = cameras.iter().find(|foveated| foveated.target_fps.is_some()).map(|foveated| foveated.kind);
    if kind.is_some() && *last != kind {
        println!("foreign: auto {kind:?} at {:?} after {} quiet frames", run.frame, run.quiet_frames);
        *last = kind;
    }
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

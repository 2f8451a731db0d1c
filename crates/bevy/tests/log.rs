//! Lines in the log, in a process of their own: those that are written once are written once in a process.

mod captured;
#[path = "../examples/common/mod.rs"]
mod common;

use bevy::asset::RenderAssetUsages;
use bevy::asset::uuid::Uuid;
use bevy::camera::{ClearColorConfig, RenderTarget};
use bevy::core_pipeline::core_3d::{main_opaque_pass_3d, main_transparent_pass_3d};
use bevy::core_pipeline::prepass::DeferredPrepass;
use bevy::core_pipeline::schedule::Core3d;
use bevy::log::tracing_subscriber;
use bevy::mesh::MeshVertexBufferLayoutRef;
use bevy::pbr::{MaterialPipeline, MaterialPipelineKey, ScreenSpaceReflections};
use bevy::prelude::*;
use bevy::reflect::TypePath;
use bevy::render::RenderApp;
use bevy::render::camera::TemporalJitter;
use bevy::render::render_resource::{
    AsBindGroup, CompareFunction, RenderPipelineDescriptor, SpecializedMeshPipelineError,
};
use bevy::render::renderer::{RenderContext, ViewQuery};
use bevy::render::storage::ShaderBuffer;
use bevy::render::view::ViewTarget;
use bevy::shader::{Shader, ShaderRef};
use bevy_afterimage::{
    Afterimage, AfterimagePlugin, AfterimageStats, AfterimageSupported, CameraGaze, Foveated, ShowQuads,
};
use captured::{LOG, Log};
use common::headless::{self, Headless};
use common::scene::{ScenePlugin, TONEMAPPING, stroll};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

/// A pass of an application that reads the frame, between the opaque meshes and those that blend.
fn blur(_: ViewQuery<&ViewTarget>, mut context: RenderContext) {
    context.command_encoder().insert_debug_marker("blur");
}

/// The same, where it belongs.
fn late_blur(_: ViewQuery<&ViewTarget>, mut context: RenderContext) {
    context.command_encoder().insert_debug_marker("late blur");
}

fn add_passes(app: &mut App) {
    let passes = (blur.before(ShowQuads), late_blur.after(ShowQuads));
    let passes = passes.after(main_opaque_pass_3d).before(main_transparent_pass_3d);
    app.sub_app_mut(RenderApp).add_systems(Core3d, passes);
}

/// How many lines contain `word` after a few frames of a camera with `components`.
fn lines_about(headless: &mut Headless, word: &str, components: impl Bundle) -> usize {
    let camera = (Camera3d::default(), headless.render_target(), TONEMAPPING, stroll(1.0), components);
    let camera = headless.app.world_mut().spawn(camera).id();
    headless.frames(4);
    headless.app.world_mut().despawn(camera);
    headless.frames(1);
    lines(word)
}

/// How many of the plugin's lines so far contain `word`.
fn lines(word: &str) -> usize {
    let log = LOG.lock().expect("the log");
    let log = String::from_utf8_lossy(&log);
    log.lines().filter(|line| line.contains("bevy_afterimage") && line.contains(word)).count()
}

/// Materials that the depth test does not spare, or that have no prepass.
#[derive(Asset, TypePath, AsBindGroup, Clone)]
#[bind_group_data(Kind)]
struct Special {
    #[storage(0)]
    written: Handle<ShaderBuffer>,
    #[storage(1, read_only)]
    read: Handle<ShaderBuffer>,
    kind: Kind,
}

/// What a material does, in words.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
struct Kind(&'static str);

impl Kind {
    const ALL: [&str; 6] = ["plain", "depth", "always", "storage", "storage forced", "bare"];

    fn is(self, word: &str) -> bool {
        self.0.split(' ').any(|own| own == word)
    }

    fn shader(self) -> Handle<Shader> {
        let number = Self::ALL.iter().position(|kind| *kind == self.0).expect("a kind");
        Uuid::from_u128(SHADER + number as u128).into()
    }

    /// In WGSL, without imports: Bevy's WESL has no forced tests.
    fn text(self) -> String {
        let forced = if self.is("forced") { "@early_depth_test(force)" } else { "" };
        let write = if self.is("storage") { "counts[0] = 1u;" } else { "" };
        let (binding, access) = if self.is("storage") { (0, "read_write") } else { (1, "read") };
        let (output, depth) = match self.is("depth") {
            true => ("@builtin(frag_depth) depth: f32,", "out.depth = position.z;"),
            false => ("", ""),
        };
        format!(
            "// A comment on frag_depth and read_write is none of it.
            @group(3) @binding({binding}) var<storage, {access}> counts: array<u32, 4>;
            struct Out {{ @location(0) color: vec4f, {output} }}
            @fragment {forced}
            fn fragment(@builtin(position) position: vec4f, @location(2) uv: vec2f) -> Out {{
                var out: Out;
                {write}
                {depth}
                out.color = vec4(uv, f32(counts[1]), 1.0);
                return out;
            }}"
        )
    }
}

impl From<&Special> for Kind {
    fn from(material: &Special) -> Self {
        material.kind
    }
}

/// The first shader; others follow it.
const SHADER: u128 = 0x9d1c8d2e_5a2f_4a8e_9a4f_0b6a3a1f2c66;

/// Whether the material that is made now has no prepass.
static IS_BARE: AtomicBool = AtomicBool::new(false);

impl Material for Special {
    fn fragment_shader() -> ShaderRef {
        Kind(Kind::ALL[0]).shader().into()
    }

    fn enable_prepass() -> bool {
        !IS_BARE.load(Ordering::Relaxed)
    }

    fn specialize(
        _: &MaterialPipeline,
        descriptor: &mut RenderPipelineDescriptor,
        _: &MeshVertexBufferLayoutRef,
        key: MaterialPipelineKey<Self>,
    ) -> Result<(), SpecializedMeshPipelineError> {
        let kind = key.bind_group_data;
        // Prepasses have shaders of their own.
        if let Some(fragment) = descriptor.fragment.as_mut().filter(|own| own.shader == Kind(Kind::ALL[0]).shader()) {
            fragment.shader = kind.shader();
        }
        if kind.is("always")
            && let Some(depth) = &mut descriptor.depth_stencil
        {
            depth.depth_compare = Some(CompareFunction::Always);
        }
        Ok(())
    }
}

fn add_shaders(mut shaders: ResMut<Assets<Shader>>) {
    for kind in Kind::ALL.map(Kind) {
        shaders.insert(kind.shader().id(), Shader::from_wgsl(kind.text(), "special.wgsl")).expect("inserted");
    }
}

/// How many lines contain `word` after frames that show a mesh with a material of `kind`.
fn lines_of_material(headless: &mut Headless, kind: &'static str, word: &str) -> usize {
    let before = lines("");
    IS_BARE.store(kind == "bare", Ordering::Relaxed);
    let [written, read] =
        [(), ()].map(|()| headless.asset(ShaderBuffer::new(vec![0_u32; 4], RenderAssetUsages::default())));
    let material = MeshMaterial3d(headless.asset(Special { written, read, kind: Kind(kind) }));
    show_mesh(headless, Rectangle::new(4.0, 3.0), material);
    let log = LOG.lock().expect("the log");
    let log = String::from_utf8_lossy(&log);
    let ours = log.lines().filter(|line| line.contains("bevy_afterimage")).skip(before);
    let (about, others): (Vec<_>, Vec<_>) = ours.partition(|line| line.contains(word));
    assert!(others.is_empty(), "{kind}: {others:?}");
    about.len()
}

/// Shows a mesh for a few frames, without errors.
fn show_mesh(headless: &mut Headless, mesh: impl Into<Mesh>, material: impl Bundle) {
    let mesh = Mesh3d(headless.asset(mesh.into()));
    let mesh = headless.app.world_mut().spawn((mesh, material, Transform::from_xyz(0.0, 1.5, 0.0))).id();
    lines_about(headless, "", (Msaa::Off, Afterimage::default()));
    headless.app.world_mut().despawn(mesh);
    assert_eq!(headless.problems(), &[] as &[String]);
}

/// A material that lets the light of what is behind it through.
fn lines_of_glass(headless: &mut Headless) -> usize {
    let material = StandardMaterial { specular_transmission: 0.9, ..default() };
    let material = MeshMaterial3d(headless.asset(material));
    show_mesh(headless, Cuboid::default(), material);
    lines("specular_transmission")
}

/// What is said of frames of `size`, before each of which the application takes some times as long as the device, and
/// what was counted last.
fn lines_of_pace(headless: &mut Headless, size: UVec2, times: u64, frames: usize) -> (usize, AfterimageStats) {
    let target = RenderTarget::from(headless.add_target(size));
    let camera = (Camera3d::default(), Msaa::Off, target, TONEMAPPING, stroll(1.0), Afterimage::default());
    let camera = headless.app.world_mut().spawn((camera, AfterimageStats::default())).id();
    let mut stats = AfterimageStats::default();
    for _ in 0..frames {
        std::thread::sleep(Duration::from_micros(times * stats.device_us));
        headless.frames(1);
        stats = *headless.app.world().get(camera).expect("stats");
    }
    headless.app.world_mut().despawn(camera);
    headless.frames(1);
    (lines("does not make frames faster"), stats)
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
    let headless = &mut Headless::new(
        UVec2::new(64, 36),
        (ScenePlugin { lamps: 0, moves: false }, MaterialPlugin::<Special>::default(), |app: &mut App| {
            app.add_systems(Startup, add_shaders);
            add_passes(app);
        }),
    );
    let msaa = [Msaa::Off, Msaa::default(), Msaa::Sample2];
    let msaa = msaa.map(|msaa| lines_about(headless, "Msaa", (msaa, Afterimage::default())));
    assert_eq!(msaa, [0, 1, 1]);
    let jitter = [false, false, true, true].map(|antialias| {
        let afterimage = Afterimage { antialias, ..default() };
        lines_about(headless, "TemporalJitter", (Msaa::Off, TemporalJitter::default(), afterimage))
    });
    assert_eq!(jitter, [1, 1, 2, 2]);

    assert_eq!(lines_about(headless, "Add Afterimage", Msaa::Off), 0);
    assert_eq!(lines_about(headless, "Add Afterimage", Foveated::default()), 1);
    let uncleared = Camera { clear_color: ClearColorConfig::None, ..default() };
    assert_eq!(lines_about(headless, "ClearColorConfig::None", (Msaa::Off, Afterimage::default(), uncleared)), 1);
    let reflecting = (Msaa::Off, Afterimage::default(), ScreenSpaceReflections::default());
    assert_eq!(lines_about(headless, "ScreenSpaceReflections", reflecting), 1);
    let of_deferred = [true, false, false].map(|antialias| {
        let afterimage = Afterimage { antialias, ..default() };
        lines_about(headless, "albedo needs", (Msaa::Off, DeferredPrepass, afterimage))
    });
    assert_eq!(of_deferred, [0, 1, 1]);
    let said = lines("renders every pixel");
    let flat = Projection::from(OrthographicProjection { scale: 0.03, ..OrthographicProjection::default_3d() });
    assert_eq!(lines_about(headless, "renders every pixel", (Msaa::Off, Afterimage::default(), flat)), said);
    // Drawn at every pixel, over the whole frame.
    assert_eq!(lines_of_glass(headless), 0);
    assert_eq!(lines_of_material(headless, "plain", "special"), 0);
    assert_eq!(lines_of_material(headless, "depth", "special.wgsl: it writes frag_depth"), 1);
    assert_eq!(lines_of_material(headless, "always", "special.wgsl: its pipeline compares no depth"), 1);
    assert_eq!(lines_of_material(headless, "storage", "special.wgsl: it writes to storage"), 1);
    assert_eq!(lines_of_material(headless, "storage forced", "special"), 0);
    assert_eq!(lines_of_material(headless, "bare", "has no prepass"), 1);
    let (lines_of_pixels, stats) = lines_of_pace(headless, UVec2::new(960, 540), 0, 8);
    println!("many pixels: {} us of {} us a frame", stats.device_us, stats.frame_us);
    assert!(2 * stats.device_us > stats.frame_us, "{stats:?}");
    let (lines_of_a_busy_app, stats) = lines_of_pace(headless, UVec2::new(64, 36), 3, 140);
    println!("a busy application: {} us of {} us a frame", stats.device_us, stats.frame_us);
    assert_eq!((lines_of_pixels, lines_of_a_busy_app), (0, 1));
    assert_eq!(lines_of_a_wrong_order(), 1);
    assert_eq!((lines("system log::blur draws"), lines("late_blur")), (1, 0));
    // What is right is not complained about.
    let before = lines("");
    lines_about(headless, "", (Msaa::Off, Afterimage::default(), CameraGaze::default()));
    assert_eq!(lines(""), before);
}

//! Lines in the log, in a process of their own: those that are written once are written once in a process.

#[path = "../examples/common/mod.rs"]
mod common;

use bevy::asset::RenderAssetUsages;
use bevy::camera::ClearColorConfig;
use bevy::core_pipeline::prepass::DeferredPrepass;
use bevy::log::tracing_subscriber;
use bevy::mesh::MeshVertexBufferLayoutRef;
use bevy::pbr::{MaterialPipeline, MaterialPipelineKey};
use bevy::prelude::*;
use bevy::reflect::TypePath;
use bevy::render::camera::TemporalJitter;
use bevy::render::render_resource::{
    AsBindGroup, CompareFunction, RenderPipelineDescriptor, SpecializedMeshPipelineError,
};
use bevy::render::storage::ShaderBuffer;
use bevy::shader::{Shader, ShaderRef};
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

/// Materials that the depth test does not spare, or that have no prepass.
#[derive(Asset, TypePath, AsBindGroup, Clone)]
struct Special {
    #[storage(0)]
    buffer: Handle<ShaderBuffer>,
}

const SHADER: Handle<Shader> = bevy::asset::uuid_handle!("9d1c8d2e-5a2f-4a8e-9a4f-0b6a3a1f2c66");

/// Which of them is shown now.
static KIND: Mutex<&str> = Mutex::new("");

fn is(kind: &str) -> bool {
    KIND.lock().expect("the kind").split(' ').any(|word| word == kind)
}

impl Material for Special {
    fn fragment_shader() -> ShaderRef {
        SHADER.into()
    }

    fn enable_prepass() -> bool {
        !is("bare")
    }

    fn specialize(
        _: &MaterialPipeline,
        descriptor: &mut RenderPipelineDescriptor,
        _: &MeshVertexBufferLayoutRef,
        _: MaterialPipelineKey<Self>,
    ) -> Result<(), SpecializedMeshPipelineError> {
        if is("always")
            && let Some(depth) = &mut descriptor.depth_stencil
        {
            depth.depth_compare = Some(CompareFunction::Always);
        }
        Ok(())
    }
}

fn special(
    mut commands: Commands,
    mut shaders: ResMut<Assets<Shader>>,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<Special>>,
    mut buffers: ResMut<Assets<ShaderBuffer>>,
) {
    let forced = if is("forced") { "@early_depth_test(force)" } else { "" };
    let write = if is("storage") { "counts[0] = 1u;" } else { "" };
    let access = if is("storage") { "read_write" } else { "read" };
    let (output, depth) = match is("depth") {
        true => ("@builtin(frag_depth) depth: f32,", "out.depth = in.position.z;"),
        false => ("", ""),
    };
    let text = format!(
        "#import bevy_pbr::forward_io::VertexOutput
        // A comment on frag_depth and read_write is none of it.
        @group(#{{MATERIAL_BIND_GROUP}}) @binding(0) var<storage, {access}> counts: array<u32, 4>;
        struct Out {{ @location(0) color: vec4<f32>, {output} }}
        @fragment {forced}
        fn fragment(in: VertexOutput) -> Out {{
            var out: Out;
            {write}
            {depth}
            out.color = vec4(in.uv, f32(counts[1]), 1.0);
            return out;
        }}"
    );
    shaders.insert(SHADER.id(), Shader::from_wgsl(text, "special.wgsl")).expect("inserted");
    let buffer = buffers.add(ShaderBuffer::new(vec![0_u32; 4], RenderAssetUsages::default()));
    let mesh = Mesh3d(meshes.add(Rectangle::new(4.0, 3.0)));
    commands.spawn((mesh, MeshMaterial3d(materials.add(Special { buffer })), Transform::from_xyz(0.0, 1.5, 0.0)));
}

/// How many lines contain `word` after frames of a material of `kind`, in an application of its own.
fn lines_of_material(kind: &'static str, word: &str) -> usize {
    *KIND.lock().expect("the kind") = kind;
    let before = lines("");
    let mut headless = Headless::new(
        UVec2::new(64, 36),
        (MaterialPlugin::<Special>::default(), |app: &mut App| {
            app.add_systems(Startup, special);
        }),
    );
    let target = headless.render_target();
    headless.app.world_mut().spawn((Camera3d::default(), target, TONEMAPPING, stroll(1.0), Afterimage::default()));
    headless.frames(6);
    assert_eq!(headless.problems(), &[] as &[String], "{kind}");
    let log = LOG.lock().expect("the log");
    let log = String::from_utf8_lossy(&log);
    let ours = log.lines().filter(|line| line.contains("bevy_afterimage")).skip(before);
    let (about, others): (Vec<_>, Vec<_>) = ours.partition(|line| line.contains(word));
    assert!(others.is_empty(), "{kind}: {others:?}");
    about.len()
}

/// A material that lets the light of what is behind it through.
fn glass(mut commands: Commands, mut meshes: ResMut<Assets<Mesh>>, mut materials: ResMut<Assets<StandardMaterial>>) {
    let material = StandardMaterial { specular_transmission: 0.9, ..default() };
    commands.spawn((Mesh3d(meshes.add(Cuboid::default())), MeshMaterial3d(materials.add(material))));
}

fn lines_of_glass() -> usize {
    let mut headless = Headless::new(UVec2::new(64, 36), |app: &mut App| {
        app.add_plugins(ScenePlugin { lamps: 0, moves: false }).add_systems(Startup, glass);
    });
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
    assert_eq!([Msaa::Off, Msaa::default(), Msaa::Sample2].map(msaa), [0, 0, 1]);
    let jitter = |antialias| {
        let afterimage = Afterimage { antialias, ..default() };
        lines_about("TemporalJitter", (Msaa::Off, TemporalJitter::default(), afterimage))
    };
    assert_eq!([false, false, true, true].map(jitter), [1, 1, 2, 2]);

    assert_eq!([lines_about("Add Afterimage", Msaa::Off), lines_about("Add Afterimage", Foveated::default())], [0, 1]);
    let uncleared = Camera { clear_color: ClearColorConfig::None, ..default() };
    assert_eq!(lines_about("ClearColorConfig::None", (Msaa::Off, Afterimage::default(), uncleared)), 1);
    let deferred = (Msaa::Off, Afterimage::default(), DeferredPrepass);
    assert_eq!(lines_about("DeferredPrepass", deferred), 1);
    let flat = Projection::from(OrthographicProjection { scale: 0.03, ..OrthographicProjection::default_3d() });
    assert_eq!(lines_about("projection is orthographic", (Msaa::Off, Afterimage::default(), flat)), 1);
    // Drawn at every pixel, over the whole frame.
    assert_eq!(lines_of_glass(), 0);
    assert_eq!(lines_of_material("plain", "special"), 0);
    assert_eq!(lines_of_material("depth", "special.wgsl: it writes frag_depth"), 1);
    assert_eq!(lines_of_material("always", "special.wgsl: its pipeline compares no depth"), 1);
    assert_eq!(lines_of_material("storage", "special.wgsl: it writes to storage"), 1);
    assert_eq!(lines_of_material("storage forced", "special"), 0);
    assert_eq!(lines_of_material("bare", "has no prepass"), 1);
    assert_eq!(lines_of_a_wrong_order(), 1);
    // What is right is not complained about.
    let before = lines("");
    lines_about("", (Msaa::Off, Afterimage::default(), CameraGaze::default()));
    assert_eq!(lines(""), before);
}

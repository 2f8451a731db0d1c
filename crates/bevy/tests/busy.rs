//! A busy application on several threads, Bevy's default: nothing panics, wgpu finds no error, and nobody warns.

mod captured;
#[path = "../examples/common/mod.rs"]
mod common;

use bevy::camera::visibility::RenderLayers;
use bevy::camera::{ClearColorConfig, Hdr, RenderTarget, ShadowLodOrigin};
use bevy::core_pipeline::tonemapping::{DebandDither, Tonemapping};
use bevy::gltf::GltfAssetLabel;
use bevy::log::tracing_subscriber;
use bevy::math::ops;
use bevy::post_process::bloom::Bloom;
use bevy::prelude::*;
use bevy::reflect::TypePath;
use bevy::render::gpu_readback::{Readback, ReadbackComplete};
use bevy::render::render_resource::{
    AsBindGroup, Extent3d, TextureDescriptor, TextureDimension, TextureFormat, TextureUsages,
};
use bevy::render::renderer::RenderDevice;
use bevy::shader::{Shader, ShaderRef};
use bevy_afterimage::{Afterimage, AfterimagePlugin, AfterimageStats, Foveated, Gaze};
use captured::{LOG, Log};
use common::headless::{self, Problems};
use common::scene::{Mover, ScenePlugin, TONEMAPPING, stroll};
use std::path::Path;
use std::time::Duration;

/// A row of it is a multiple of 256 bytes, as copies need.
const SIZE: UVec2 = UVec2::new(320, 180);

/// Warnings and errors since the last call, of whomever.
fn complaints() -> Vec<String> {
    let log = std::mem::take(&mut *LOG.lock().expect("the log"));
    // What the machine lacks is none of it.
    let counts = |line: &&str| !line.is_empty() && !line.contains("only supports software rendering");
    String::from_utf8_lossy(&log).lines().filter(counts).map(str::to_owned).collect()
}

/// A material of the application: waves that move with time.
#[derive(Asset, TypePath, AsBindGroup, Clone)]
struct Waves {
    #[uniform(0)]
    color: LinearRgba,
    alpha_mode: AlphaMode,
}

const SHADER: Handle<Shader> = bevy::asset::uuid_handle!("7be1c7ab-3d8e-4bd8-8a53-0c4c6c1c7f10");

const TEXT: &str = "import bevy_pbr::render::{forward_io::VertexOutput, mesh_view_bindings::globals};
@group(constants::MATERIAL_BIND_GROUP) @binding(0) var<uniform> color: vec4f;
@fragment
fn fragment(in: VertexOutput) -> @location(0) vec4f {
    return vec4(color.rgb * (0.6 + 0.4 * sin(20.0 * in.uv.x + 3.0 * globals.time)), color.a);
}";

impl Material for Waves {
    fn fragment_shader() -> ShaderRef {
        SHADER.into()
    }

    fn alpha_mode(&self) -> AlphaMode {
        self.alpha_mode
    }
}

/// A model with two octahedra, one of them of glass.
fn glb() -> Vec<u8> {
    let (mut places, mut normals) = (vec![], vec![]);
    for i in 0..8 {
        let [x, y, z] = [0, 1, 2].map(|axis| if i >> axis & 1 == 0 { -1.0_f32 } else { 1.0 });
        let mut corners = [Vec3::X * x, Vec3::Y * y, Vec3::Z * z];
        if x * y * z < 0.0 {
            corners.swap(1, 2);
        }
        places.extend(corners);
        normals.extend([Vec3::new(x, y, z).normalize(); 3]);
    }
    let binary: Vec<u8> = places.iter().chain(&normals).flat_map(|v| v.to_array()).flat_map(f32::to_le_bytes).collect();
    let mut json = r#"{"asset": {"version": "2.0"}, "extensionsUsed": ["KHR_materials_transmission"], "scene": 0,
        "scenes": [{"nodes": [0, 1]}],
        "nodes": [{"mesh": 0, "translation": [-1.2, 1, 1]}, {"mesh": 1, "translation": [1.2, 1.4, 3]}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "NORMAL": 1}, "material": 0}]},
                   {"primitives": [{"attributes": {"POSITION": 0, "NORMAL": 1}, "material": 1}]}],
        "materials": [{"pbrMetallicRoughness": {"baseColorFactor": [0.9, 0.4, 0.1, 1], "metallicFactor": 0}},
                      {"pbrMetallicRoughness": {"metallicFactor": 0, "roughnessFactor": 0.1},
                       "extensions": {"KHR_materials_transmission": {"transmissionFactor": 0.9}}}],
        "buffers": [{"byteLength": 576}],
        "bufferViews": [{"buffer": 0, "byteLength": 288}, {"buffer": 0, "byteOffset": 288, "byteLength": 288}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 24, "type": "VEC3", "min": [-1, -1, -1],
                       "max": [1, 1, 1]}, {"bufferView": 1, "componentType": 5126, "count": 24, "type": "VEC3"}]}"#
        .to_owned();
    json.extend(std::iter::repeat_n(' ', json.len().next_multiple_of(4) - json.len()));
    let [json_bytes, binary_bytes] = [json.len(), binary.len()].map(|length| length as u32);
    let mut file = b"glTF".to_vec();
    file.extend([2, 28 + json_bytes + binary_bytes, json_bytes].into_iter().flat_map(u32::to_le_bytes));
    file.extend(b"JSON");
    file.extend(json.as_bytes());
    file.extend(binary_bytes.to_le_bytes());
    file.extend(b"BIN\0");
    file.extend(binary);
    file
}

/// Particles that rise, and what a head-up display shows.
#[derive(Component)]
enum Moving {
    Particle(f32),
    Needle,
}

fn animate(time: Res<Time>, mut moving: Query<(&mut Transform, &Moving)>, mut gizmos: Gizmos<'_, '_>) {
    let t = time.elapsed_secs();
    for (mut transform, moving) in &mut moving {
        transform.translation = match moving {
            Moving::Particle(phase) => {
                let height = (0.3 * t + phase).fract();
                Vec3::new(2.0 * ops::sin(7.0 * phase) + height, 3.0 * height, 2.0 + ops::cos(11.0 * phase))
            }
            Moving::Needle => Vec3::new(0.5 * ops::sin(6.0 * t), 0.9, -4.0),
        };
    }
    gizmos.line(Vec3::new(-3.0, 0.5, 3.0), Vec3::new(3.0, 0.8, 3.0), Color::WHITE);
}

/// Color of the needle, which nothing else has.
const MAGENTA: Color = Color::srgb(1.0, 0.0, 1.0);

fn build(
    mut commands: Commands,
    mut shaders: ResMut<Assets<Shader>>,
    mut meshes: ResMut<Assets<Mesh>>,
    mut waves: ResMut<Assets<Waves>>,
    mut standard: ResMut<Assets<StandardMaterial>>,
) {
    shaders.insert(SHADER.id(), Shader::from_wesl(TEXT, "waves.wesl")).expect("inserted");
    let cube = meshes.add(Cuboid::from_length(0.8));
    for (i, alpha_mode) in [AlphaMode::Opaque, AlphaMode::Mask(0.5), AlphaMode::Blend].into_iter().enumerate() {
        let color = LinearRgba::new(0.2, 0.5, 0.9, 0.8);
        let material = MeshMaterial3d(waves.add(Waves { color, alpha_mode }));
        commands.spawn((Mesh3d(cube.clone()), material, Transform::from_xyz(1.5 * i as f32 - 1.5, 0.4, 2.0)));
    }
    let glow = StandardMaterial { emissive: LinearRgba::rgb(20.0, 5.0, 1.0), ..default() };
    commands.spawn((Mesh3d(cube), MeshMaterial3d(standard.add(glow)), Transform::from_xyz(3.0, 0.4, 1.0)));
    let glass = StandardMaterial { specular_transmission: 0.9, thickness: 0.4, ior: 1.4, ..default() };
    let ball = Mesh3d(meshes.add(Sphere::new(0.6)));
    commands.spawn((ball, MeshMaterial3d(standard.add(glass)), Transform::from_xyz(-0.4, 1.2, 3.5)));
    let spark = StandardMaterial {
        base_color: Color::srgba(1.0, 0.7, 0.3, 0.4),
        alpha_mode: AlphaMode::Add,
        unlit: true,
        ..default()
    };
    let (quad, spark) = (meshes.add(Rectangle::from_length(0.08)), standard.add(spark));
    for i in 0..200 {
        let moving = Moving::Particle(i as f32 / 200.0);
        commands.spawn((Mesh3d(quad.clone()), MeshMaterial3d(spark.clone()), Transform::default(), moving));
    }
    let needle = StandardMaterial { base_color: MAGENTA, unlit: true, ..default() };
    let needle = (Mesh3d(meshes.add(Rectangle::new(0.2, 0.6))), MeshMaterial3d(standard.add(needle)));
    commands.spawn((needle, Transform::default(), Moving::Needle, RenderLayers::layer(1)));
}

/// An application whose renderer has a thread of its own, and the last frame that was read from it.
struct Busy {
    app: App,
    camera: Entity,
    hud: Entity,
}

#[derive(Resource, Default)]
struct Shown(Vec<u8>);

impl Busy {
    fn new() -> Self {
        let mut app = App::new();
        app.add_plugins((
            headless::default_plugins(),
            AfterimagePlugin,
            ScenePlugin { lamps: 3, moves: true },
            MaterialPlugin::<Waves>::default(),
        ));
        app.init_resource::<Shown>().add_systems(Startup, build).add_systems(Update, animate);
        headless::note_problems(&mut app);
        headless::start(&mut app);
        let image = app.world_mut().resource_mut::<Assets<Image>>().add(headless::target_image(SIZE));
        let target = RenderTarget::from(image.clone());
        let keep = |event: On<ReadbackComplete>, mut shown: ResMut<Shown>| shown.0.clone_from(&event.data);
        app.world_mut().spawn(Readback::texture(image)).observe(keep);
        let fog = DistanceFog { falloff: FogFalloff::from_visibility(60.0), ..default() };
        let camera = (Camera3d::default(), target.clone(), TONEMAPPING, stroll(1.0), Mover::Stroll);
        let camera = app.world_mut().spawn((camera, Hdr, Bloom::NATURAL, fog, ShadowLodOrigin)).id();
        let over = Camera { order: 1, clear_color: ClearColorConfig::None, ..default() };
        let hud =
            (Camera3d::default(), target, over, Tonemapping::None, DebandDither::Disabled, RenderLayers::layer(1));
        let hud = app.world_mut().spawn((hud, Hdr)).id();
        let panel = Node { width: px(60), height: px(20), position_type: PositionType::Absolute, ..default() };
        let panel = (panel, BackgroundColor(Color::srgb(0.0, 1.0, 0.0)), UiTargetCamera(hud));
        app.world_mut().spawn((panel, children![(Text::new("12 of 30"), TextFont::from_font_size(12.0))]));
        Self { app, camera, hud }
    }

    /// Loads a model and shows it.
    fn add_model(&mut self, path: &Path, transform: Transform) {
        let server = self.app.world().resource::<AssetServer>().clone();
        let scene = server.load(GltfAssetLabel::Scene(0).from_asset(path.to_path_buf()));
        while !server.is_loaded_with_dependencies(&scene) {
            assert!(!server.load_state(&scene).is_failed(), "{}", path.display());
            self.frames(1);
            std::thread::sleep(Duration::from_millis(20));
        }
        self.app.world_mut().spawn((WorldAssetRoot(scene), transform));
    }

    fn frames(&mut self, count: usize) {
        (0..count).for_each(|_| self.app.update());
    }

    fn problems(&self) -> &[String] {
        &self.app.world().resource::<Problems>().0
    }

    /// How many pixels of a late frame have a color.
    fn count(&self, color: Color) -> usize {
        let color = color.to_srgba().to_u8_array();
        let shown = &self.app.world().resource::<Shown>().0;
        shown.chunks(4).filter(|pixel| (0..3).all(|i| pixel[i].abs_diff(color[i]) < 40)).count()
    }
}

// One test, because the log is the process's.
#[test]
fn a_busy_application_runs_without_a_complaint() {
    let level = bevy::log::tracing::Level::WARN;
    tracing_subscriber::fmt().with_max_level(level).with_ansi(false).with_writer(|| Log).init();
    let mut busy = Busy::new();
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR"));
    std::fs::write(folder.join("octahedra.glb"), glb()).expect("a written file");
    busy.add_model(&folder.join("octahedra.glb"), Transform::default());
    let helmet = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data/scenes/flight_helmet");
    match helmet.join("FlightHelmet.gltf").canonicalize() {
        Ok(path) => busy.add_model(&path, Transform::from_xyz(0.0, 0.8, 4.5)),
        Err(_) => println!("SKIPPED: no model in {}", helmet.display()),
    }
    busy.frames(8);
    let [needle, panel] = [MAGENTA, Color::srgb(0.0, 1.0, 0.0)].map(|color| busy.count(color));
    println!("at full rate: {needle} pixels of the needle, {panel} of the panel");
    assert!(needle > 100 && panel > 800, "{needle} {panel}");

    for (foveated, antialias) in [(Foveated::default(), false), (Foveated::uniform(0.25), true)] {
        for msaa in [Msaa::default(), Msaa::Off] {
            let afterimage = Afterimage { antialias, reset: true, ..default() };
            let components = (afterimage, foveated, AfterimageStats::default(), msaa);
            busy.app.world_mut().entity_mut(busy.camera).insert(components);
            busy.app.world_mut().entity_mut(busy.hud).insert(msaa);
            for frame in 0..16 {
                let gaze = Vec2::new(0.3 + 0.02 * frame as f32, 0.5);
                busy.app.world_mut().resource_mut::<Gaze>().set(gaze);
                busy.frames(1);
            }
            let stats = *busy.app.world().get::<AfterimageStats>(busy.camera).expect("stats");
            assert!(stats.shaded > 0 && stats.shaded < stats.pixels / 2, "{stats:?}");
            let [now, beside] = [MAGENTA, Color::srgb(0.0, 1.0, 0.0)].map(|color| busy.count(color));
            println!("{stats:?}, {now} pixels of the needle, {beside} of the panel");
            // What moves over the frame leaves nothing behind.
            assert!(now.abs_diff(needle) < needle / 5, "{now} pixels of the needle, at full rate {needle}");
            assert!(beside.abs_diff(panel) < panel / 5, "{beside} pixels of the panel, at full rate {panel}");
        }
    }
    assert_eq!(busy.problems(), &[] as &[String]);
    assert_eq!(complaints(), &[] as &[String]);

    // The test notices an error.
    let usage = TextureUsages::STORAGE_BINDING;
    let (format, dimension) = (TextureFormat::Rgba8UnormSrgb, TextureDimension::D2);
    busy.app.world().resource::<RenderDevice>().create_texture(&TextureDescriptor {
        label: Some("planted"),
        size: Extent3d::default(),
        mip_level_count: 1,
        sample_count: 1,
        dimension,
        format,
        usage,
        view_formats: &[],
    });
    busy.frames(2);
    assert!(busy.problems().iter().any(|problem| problem.contains("planted")), "{:?}", busy.problems());
    assert!(complaints().iter().any(|line| line.contains("planted")));
}

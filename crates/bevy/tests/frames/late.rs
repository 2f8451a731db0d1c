//! Opaque things without a prepass: those of a material, and those that another plugin queues.

use crate::common::headless::Headless;
use crate::common::scene::{Mover, ScenePlugin, TONEMAPPING, stroll};
use crate::{SIZE, kind};
use bevy::asset::uuid_handle;
use bevy::camera::RenderTarget;
use bevy::core_pipeline::core_3d::{CORE_3D_DEPTH_FORMAT, Opaque3d, Opaque3dBatchSetKey, Opaque3dBinKey};
use bevy::prelude::*;
use bevy::reflect::TypePath;
use bevy::render::mesh::allocator::MeshSlabs;
use bevy::render::render_phase::{
    BinnedRenderPhaseType, Draw, DrawError, DrawFunctions, InputUniformIndex, TrackedRenderPass, ViewBinnedRenderPhases,
};
use bevy::render::render_resource::{
    AsBindGroup, CachedRenderPipelineId, CompareFunction, DepthStencilState, FragmentState, PipelineCache,
    RenderPipelineDescriptor, TextureFormat, VertexState,
};
use bevy::render::sync_world::MainEntity;
use bevy::render::{Render, RenderApp, RenderSystems};
use bevy::shader::{Shader, ShaderRef};
use bevy_afterimage::FoveationKind;

/// A material of an application without a prepass: stripes by the position in the target.
#[derive(Asset, TypePath, AsBindGroup, Clone)]
struct Bare {}

const SHADER: Handle<Shader> = uuid_handle!("5d1b5f6e-3c5a-4e0e-9b0c-1f2a7f0d8a41");

const TEXT: &str = "@fragment
fn fragment(@builtin(position) position: vec4f) -> @location(0) vec4f {
    return vec4f(0.9, 0.9 * f32((u32(position.x) / 3u) % 2u), 0.0, 1.0);
}";

impl Material for Bare {
    fn fragment_shader() -> ShaderRef {
        SHADER.into()
    }

    fn enable_prepass() -> bool {
        false
    }
}

/// A triangle that is not a mesh, near the camera.
const TRIANGLE: Handle<Shader> = uuid_handle!("5d1b5f6e-3c5a-4e0e-9b0c-1f2a7f0d8a42");

const TRIANGLE_TEXT: &str = "@vertex
fn vertex(@builtin(vertex_index) i: u32) -> @builtin(position) vec4f {
    return vec4f(vec2f(f32(i & 1u), f32(i >> 1u)) * 0.7 - 0.9, 0.5, 1.0);
}
@fragment
fn fragment() -> @location(0) vec4f {
    return vec4f(0.9, 0.0, 0.9, 1.0);
}";

#[derive(Resource)]
struct Triangle(CachedRenderPipelineId);

struct DrawTriangle;

impl Draw<Opaque3d> for DrawTriangle {
    fn draw<'w>(
        &mut self,
        world: &'w World,
        pass: &mut TrackedRenderPass<'w>,
        _: Entity,
        item: &Opaque3d,
    ) -> Result<(), DrawError> {
        let cache = world.resource::<PipelineCache>();
        if let Some(pipeline) = cache.get_render_pipeline(item.batch_set_key.pipeline) {
            pass.set_render_pipeline(pipeline);
            pass.draw(0..3, 0..1);
        }
        Ok(())
    }
}

fn queue_triangle(
    triangle: Res<Triangle>,
    functions: Res<DrawFunctions<Opaque3d>>,
    mut phases: ResMut<ViewBinnedRenderPhases<Opaque3d>>,
) {
    let draw_function = functions.read().id::<DrawTriangle>();
    for phase in phases.values_mut() {
        phase.add(
            Opaque3dBatchSetKey {
                draw_function,
                pipeline: triangle.0,
                material_bind_group_index: None,
                lightmap_slab: None,
                slabs: MeshSlabs::default(),
            },
            Opaque3dBinKey { asset_id: AssetId::<Mesh>::default().untyped() },
            (Entity::PLACEHOLDER, MainEntity::from(Entity::PLACEHOLDER)),
            InputUniformIndex::default(),
            BinnedRenderPhaseType::NonMesh,
        );
    }
}

/// Has a plugin queue the triangle.
fn add_triangle(app: &mut App) {
    let render_app = app.sub_app_mut(RenderApp);
    render_app.world().resource::<DrawFunctions<Opaque3d>>().write().add(DrawTriangle);
    let target = bevy::render::render_resource::ColorTargetState {
        format: TextureFormat::Rgba8UnormSrgb,
        blend: None,
        write_mask: Default::default(),
    };
    let descriptor = RenderPipelineDescriptor {
        label: Some("triangle".into()),
        vertex: VertexState { shader: TRIANGLE, ..default() },
        fragment: Some(FragmentState { shader: TRIANGLE, targets: vec![Some(target)], ..default() }),
        depth_stencil: Some(DepthStencilState {
            format: CORE_3D_DEPTH_FORMAT,
            depth_write_enabled: Some(true),
            depth_compare: Some(CompareFunction::GreaterEqual),
            stencil: default(),
            bias: default(),
        }),
        ..default()
    };
    render_app.add_systems(Render, queue_triangle.in_set(RenderSystems::Queue)).add_systems(
        bevy::render::RenderStartup,
        move |mut commands: Commands, cache: Res<PipelineCache>| {
            commands.insert_resource(Triangle(cache.queue_render_pipeline(descriptor.clone())));
        },
    );
}

fn build(
    mut commands: Commands,
    mut shaders: ResMut<Assets<Shader>>,
    mut meshes: ResMut<Assets<Mesh>>,
    mut bare: ResMut<Assets<Bare>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
) {
    for (handle, text) in [(SHADER, TEXT), (TRIANGLE, TRIANGLE_TEXT)] {
        shaders.insert(handle.id(), Shader::from_wgsl(text, "late.wgsl")).expect("inserted");
    }
    let ball = Mesh3d(meshes.add(Sphere::new(0.8)));
    let turn = Mover::Fly(1.5);
    commands.spawn((ball, MeshMaterial3d(bare.add(Bare {})), Transform::default(), turn));
    // Glass behind them, which they hide.
    let glass = StandardMaterial {
        base_color: Color::srgba(0.0, 1.0, 0.0, 0.4),
        alpha_mode: AlphaMode::Blend,
        unlit: true,
        ..default()
    };
    let pane = Mesh3d(meshes.add(Rectangle::new(14.0, 6.0)));
    commands.spawn((pane, MeshMaterial3d(materials.add(glass)), Transform::from_xyz(0.0, 2.0, -2.0)));
}

/// Whether a pixel is one of the ball, or of the triangle. Neither has blue and green alike.
fn is_late(pixel: &[u8]) -> [bool; 2] {
    let [r, g, b] = [pixel[0], pixel[1], pixel[2]];
    [r > 150 && b < 30 && !(30..=150).contains(&g), r > 150 && g < 30 && b > 150]
}

#[test]
fn what_has_no_prepass_is_that_of_full_rate_in_motion() {
    let scene = (ScenePlugin { lamps: 1, moves: true }, MaterialPlugin::<Bare>::default(), |app: &mut App| {
        add_triangle(app);
        app.add_systems(Startup, build);
    });
    let mut headless = Headless::new(SIZE, scene);
    let targets = [FoveationKind::Off, FoveationKind::Quads].map(|foveation| {
        let image = headless.add_target(SIZE);
        let target = RenderTarget::from(image.clone());
        let camera = (Camera3d::default(), target, TONEMAPPING, Msaa::Off, stroll(0.0), Mover::Stroll);
        headless.app.world_mut().spawn((camera, kind(foveation)));
        image
    });
    headless.frames(12);
    for frame in 0..4 {
        headless.frames(3);
        let [full, quads] = targets.each_ref().map(|target| headless.read_target(target));
        let mut counts = [0; 2];
        let mut wrong = [0; 2];
        for (a, b) in full.chunks(4).zip(quads.chunks(4)) {
            for (i, (is, shown)) in is_late(a).into_iter().zip(is_late(b)).enumerate() {
                counts[i] += usize::from(is);
                wrong[i] += usize::from(is != shown || is && a[..3].iter().zip(b).any(|(a, b)| a.abs_diff(*b) > 1));
            }
        }
        println!("frame {frame}: {counts:?} pixels of the ball and the triangle, {wrong:?} differ");
        assert!(counts.iter().all(|&count| count > 500), "{counts:?}");
        assert_eq!(wrong, [0, 0]);
    }
    assert_eq!(headless.problems(), &[] as &[String]);
}

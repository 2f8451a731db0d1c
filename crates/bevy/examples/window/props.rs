//! What foveation finds hard: limbs that swing, light that moves, what is transparent, and what is drawn on top.

use crate::common::scene::TONEMAPPING;
use bevy::camera::ClearColorConfig;
use bevy::camera::visibility::RenderLayers;
use bevy::light::NotShadowCaster;
use bevy::prelude::*;

/// The camera that holds the flashlight and the view model.
#[derive(Resource)]
pub struct Held {
    pub by: Entity,
}

/// Layer of the view model.
const HAND: RenderLayers = RenderLayers::layer(1);

/// Turns to and fro: by an angle in radians, and a phase.
#[derive(Component)]
struct Swing(f32, f32);

/// Walks around the courtyard.
#[derive(Component)]
struct Walk;

/// Rises and fades, from a time in a cycle on.
#[derive(Component)]
struct Spark(f32);

pub struct PropsPlugin;

impl Plugin for PropsPlugin {
    fn build(&self, app: &mut App) {
        // The camera is there after Startup.
        app.add_systems(PostStartup, (figure, glass, sparks, held)).add_systems(Update, (walk, swing, rise));
    }
}

type Meshes<'a> = ResMut<'a, Assets<Mesh>>;
type Materials<'a> = ResMut<'a, Assets<StandardMaterial>>;

/// A body with a head, whose arms and legs swing from their joints.
fn figure(mut commands: Commands, mut meshes: Meshes, mut materials: Materials) {
    let cloth = MeshMaterial3d(materials.add(Color::srgb(0.25, 0.3, 0.6)));
    let skin = MeshMaterial3d(materials.add(Color::srgb(0.85, 0.65, 0.5)));
    let body = Mesh3d(meshes.add(Capsule3d::new(0.22, 0.5)));
    let head = Mesh3d(meshes.add(Sphere::new(0.16)));
    let limb = Mesh3d(meshes.add(Capsule3d::new(0.08, 0.6)));
    commands.spawn((Walk, Transform::default(), Visibility::default())).with_children(|parts| {
        parts.spawn((body, cloth.clone(), Transform::from_xyz(0.0, 1.15, 0.0)));
        parts.spawn((head, skin.clone(), Transform::from_xyz(0.0, 1.75, 0.0)));
        for (joint, angle, phase, material) in [
            (Vec3::new(0.12, 0.8, 0.0), 0.6, 0.0, &cloth),
            (Vec3::new(-0.12, 0.8, 0.0), 0.6, 1.0, &cloth),
            (Vec3::new(0.32, 1.5, 0.0), 0.5, 1.0, &skin),
            (Vec3::new(-0.32, 1.5, 0.0), 0.5, 0.0, &skin),
        ] {
            let swing = (Swing(angle, phase), Transform::from_translation(joint), Visibility::default());
            let limb = (limb.clone(), material.clone(), Transform::from_xyz(0.0, -0.4, 0.0));
            parts.spawn(swing).with_child(limb);
        }
    });
}

/// A pane that blends, and a ball that refracts.
fn glass(mut commands: Commands, mut meshes: Meshes, mut materials: Materials) {
    let pane = StandardMaterial {
        base_color: Color::srgba(0.6, 0.9, 0.8, 0.3),
        alpha_mode: AlphaMode::Blend,
        perceptual_roughness: 0.1,
        ..default()
    };
    let ball = StandardMaterial {
        specular_transmission: 0.9,
        thickness: 0.8,
        ior: 1.5,
        perceptual_roughness: 0.1,
        ..default()
    };
    let pane = (Mesh3d(meshes.add(Cuboid::new(1.6, 1.6, 0.03))), MeshMaterial3d(materials.add(pane)));
    let ball = (Mesh3d(meshes.add(Sphere::new(0.45))), MeshMaterial3d(materials.add(ball)));
    commands.spawn((pane, Transform::from_xyz(1.2, 0.8, 3.2)));
    commands.spawn((ball, Transform::from_xyz(-0.9, 0.5, 3.4)));
}

fn sparks(mut commands: Commands, mut meshes: Meshes, mut materials: Materials) {
    let mesh = Mesh3d(meshes.add(Sphere::new(0.025).mesh().ico(1).expect("few triangles")));
    let material = StandardMaterial {
        base_color: Color::srgba(1.0, 0.7, 0.2, 0.7),
        emissive: LinearRgba::rgb(8.0, 4.0, 1.0),
        alpha_mode: AlphaMode::Add,
        unlit: true,
        ..default()
    };
    let material = MeshMaterial3d(materials.add(material));
    commands.spawn_batch((0..200).map(move |i| {
        (mesh.clone(), material.clone(), Spark(i as f32 / 200.0), Transform::default(), NotShadowCaster)
    }));
}

/// A flashlight, and a hand that a camera of its own shows on top.
fn held(mut commands: Commands, held: Res<Held>, mut meshes: Meshes, mut materials: Materials) {
    let light = SpotLight { intensity: 5e6, range: 30.0, shadow_maps_enabled: true, ..default() };
    let light = SpotLight { inner_angle: 0.25, outer_angle: 0.3, ..light };
    let ahead = Transform::default().looking_at(Vec3::new(0.0, -0.1, -1.0), Vec3::Y);
    let camera = Camera { order: 1, clear_color: ClearColorConfig::None, ..default() };
    let lens = Projection::from(PerspectiveProjection { fov: 1.2, ..default() });
    let hand =
        (Mesh3d(meshes.add(Cuboid::new(0.08, 0.08, 0.4))), MeshMaterial3d(materials.add(Color::srgb(0.2, 0.5, 0.5))));
    let lamp = (PointLight { intensity: 2e4, ..default() }, Transform::from_xyz(0.3, 0.4, 0.2), HAND);
    commands.entity(held.by).with_children(|parts| {
        parts.spawn((light, ahead));
        parts.spawn((Camera3d::default(), camera, lens, TONEMAPPING, HAND));
        parts.spawn((hand, Transform::from_xyz(0.25, -0.2, -0.5), HAND, NotShadowCaster));
        parts.spawn(lamp);
    });
}

fn walk(time: Res<Time>, mut walker: Single<&mut Transform, With<Walk>>) {
    let angle = 0.4 * time.elapsed_secs();
    **walker = Transform::from_xyz(2.6 * angle.sin(), 0.0, 1.2 + 1.6 * angle.cos())
        .with_rotation(Quat::from_rotation_y(angle + std::f32::consts::FRAC_PI_2));
}

fn swing(time: Res<Time>, mut limbs: Query<(&mut Transform, &Swing)>) {
    for (mut limb, Swing(angle, phase)) in &mut limbs {
        limb.rotation = Quat::from_rotation_x(angle * (5.0 * time.elapsed_secs() + phase * std::f32::consts::PI).sin());
    }
}

fn rise(time: Res<Time>, mut sparks: Query<(&mut Transform, &Spark)>) {
    for (mut spark, Spark(start)) in &mut sparks {
        let age = (0.5 * time.elapsed_secs() + start).fract();
        // The golden angle spreads them.
        let (angle, reach) = (480.0 * start, 0.1 + 0.7 * age * (31.0 * start).fract());
        spark.translation = Vec3::new(-3.4 + reach * angle.sin(), 2.4 * age, 1.0 + reach * angle.cos());
        spark.scale = Vec3::splat(1.0 - age);
    }
}

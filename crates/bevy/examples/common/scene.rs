//! A scene made of primitives: a courtyard with a colonnade, textured, lit by a sun with shadows and many lamps, in
//! which a camera moves sideways and objects turn and fly.

use bevy::asset::RenderAssetUsages;
use bevy::core_pipeline::tonemapping::Tonemapping;
use bevy::image::{ImageAddressMode, ImageFilterMode, ImageSampler, ImageSamplerDescriptor};
use bevy::light::CascadeShadowConfigBuilder;
use bevy::math::{Affine2, ops};
use bevy::mesh::VertexAttributeValues;
use bevy::prelude::*;
use bevy::render::render_resource::{Extent3d, TextureDimension, TextureFormat};

/// Adds the scene, without a camera.
pub struct ScenePlugin {
    /// Lamps without shadows: what makes pixels expensive.
    pub lamps: usize,
    /// Whether objects move.
    pub moves: bool,
}

/// Moves an entity by the application's time.
#[derive(Component, Clone, Copy)]
pub enum Mover {
    /// Turns in place, radians a second.
    Turn(f32),
    /// Flies around the courtyard, radians a second.
    Fly(f32),
    /// A camera that moves sideways and turns a little.
    Stroll,
    /// A camera that does so at a fifth of that speed.
    Amble,
    /// A camera that stands.
    Stand,
}

#[derive(Resource)]
struct Lamps(usize);

impl Plugin for ScenePlugin {
    fn build(&self, app: &mut App) {
        app.insert_resource(Lamps(self.lamps)).add_systems(Startup, build);
        if self.moves {
            app.add_systems(Update, animate);
        }
    }
}

/// Tone mapping that needs no table: the default one's is behind a feature of Bevy.
pub const TONEMAPPING: Tonemapping = Tonemapping::AcesFitted;

/// Transform of the camera at a time.
pub fn stroll(t_s: f32) -> Transform {
    let x = 1.2 * t_s - 1.6;
    Transform::from_xyz(x, 1.7 + 0.05 * ops::sin(5.0 * t_s), 7.0)
        .looking_at(Vec3::new(0.35 * x + 0.6 * ops::sin(0.7 * t_s), 1.4, 0.0), Vec3::Y)
}

fn animate(time: Res<Time>, mut movers: Query<(&mut Transform, &Mover)>) {
    let t = time.elapsed_secs();
    for (mut transform, mover) in &mut movers {
        match *mover {
            Mover::Turn(speed) => transform.rotation = Quat::from_rotation_y(speed * t),
            Mover::Fly(speed) => {
                let angle = speed * t;
                transform.translation =
                    Vec3::new(3.4 * ops::sin(angle), 2.1 + 0.5 * ops::sin(2.3 * angle), 2.0 + 1.5 * ops::cos(angle));
                transform.rotation = Quat::from_euler(EulerRot::YXZ, 2.0 * angle, angle, 0.0);
            }
            Mover::Stroll => *transform = stroll(t),
            Mover::Amble => *transform = stroll(0.2 * t),
            Mover::Stand => {}
        }
    }
}

fn build(
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
    mut images: ResMut<Assets<Image>>,
    lamps: Res<Lamps>,
) {
    let [brick, tiles, checks] = [brick, tile, check].map(|pattern| images.add(texture(512, pattern)));
    let mut material = |image: &Handle<Image>, color: Color, repeats: Vec2, rough: f32| {
        materials.add(StandardMaterial {
            base_color: color,
            base_color_texture: Some(image.clone()),
            uv_transform: Affine2::from_scale(repeats),
            perceptual_roughness: rough,
            ..default()
        })
    };
    let floor = material(&tiles, Color::srgb(0.85, 0.8, 0.7), Vec2::splat(8.0), 0.35);
    let wall = material(&brick, Color::srgb(0.9, 0.75, 0.65), Vec2::new(6.0, 2.0), 0.8);
    let stone = material(&tiles, Color::srgb(0.8, 0.8, 0.85), Vec2::new(2.0, 2.0), 0.6);
    let shiny = material(&checks, Color::srgb(0.9, 0.5, 0.2), Vec2::splat(3.0), 0.2);
    let painted = material(&checks, Color::srgb(0.3, 0.6, 0.9), Vec2::splat(2.0), 0.5);

    let mut put = |mesh: Mesh, material: &Handle<StandardMaterial>, transform: Transform| {
        commands.spawn((Mesh3d(meshes.add(mesh)), MeshMaterial3d(material.clone()), transform)).id()
    };
    put(Plane3d::default().mesh().size(24.0, 24.0).build(), &floor, Transform::default());
    put(Cuboid::new(24.0, 6.0, 0.4).into(), &wall, Transform::from_xyz(0.0, 3.0, -5.0));
    for side in [-1.0, 1.0] {
        put(Cuboid::new(0.4, 6.0, 24.0).into(), &wall, Transform::from_xyz(9.0 * side, 3.0, 0.0));
    }
    for i in 0..7 {
        let x = 2.2 * (i as f32 - 3.0);
        put(Cylinder::new(0.28, 3.4).mesh().resolution(32).build(), &stone, Transform::from_xyz(x, 1.7, -2.4));
        put(Cuboid::new(0.9, 0.25, 0.9).into(), &stone, Transform::from_xyz(x, 3.5, -2.4));
    }
    put(Cuboid::new(15.0, 0.5, 1.0).into(), &wall, Transform::from_xyz(0.0, 3.85, -2.4));
    let moving = [
        (put(sphere(0.75), &shiny, Transform::from_xyz(-2.2, 0.75, 0.6)), Mover::Turn(0.8)),
        (put(Torus::new(0.35, 0.8).into(), &painted, Transform::from_xyz(2.4, 1.2, 0.9)), Mover::Turn(-1.1)),
        (put(Cuboid::from_length(0.9).into(), &painted, Transform::from_xyz(0.0, 2.0, 2.0)), Mover::Fly(0.9)),
    ];
    for (entity, mover) in moving {
        commands.entity(entity).insert(mover);
    }

    commands.spawn((
        DirectionalLight { illuminance: 6_000.0, shadow_maps_enabled: true, ..default() },
        CascadeShadowConfigBuilder { num_cascades: 2, maximum_distance: 25.0, ..default() }.build(),
        Transform::from_xyz(3.0, 8.0, 5.0).looking_at(Vec3::ZERO, Vec3::Y),
    ));
    for i in 0..lamps.0 {
        let (column, row) = (i % 8, i / 8);
        let color = Color::hsl(47.0 * i as f32 % 360.0, 0.7, 0.6);
        commands.spawn((
            PointLight { color, intensity: 30_000.0, range: 14.0, shadow_maps_enabled: false, ..default() },
            Transform::from_xyz(2.0 * column as f32 - 7.0, 2.6 + 0.4 * (i % 3) as f32, 3.0 - 2.0 * row as f32),
        ));
    }
}

fn sphere(radius: f32) -> Mesh {
    let mut mesh = Sphere::new(radius).mesh().uv(48, 24);
    // Twice around, so that its texture is as fine as the others.
    if let Some(VertexAttributeValues::Float32x2(uvs)) = mesh.attribute_mut(Mesh::ATTRIBUTE_UV_0) {
        uvs.iter_mut().for_each(|uv| uv[0] *= 2.0);
    }
    mesh
}

/// A repeated texture with mip levels, from a pattern of gray levels over the unit square.
fn texture(side: u32, pattern: fn(Vec2, f32) -> f32) -> Image {
    let mut level: Vec<f32> = (0..side * side)
        .map(|i| {
            let at = UVec2::new(i % side, i / side);
            pattern((at.as_vec2() + 0.5) / side as f32, grain(at))
        })
        .collect();
    let (mut data, mut levels, mut n) = (vec![], 0, side as usize);
    loop {
        data.extend(level.iter().flat_map(|&gray| {
            let byte = (255.0 * gray.clamp(0.0, 1.0).powf(1.0 / 2.2)) as u8;
            [byte, byte, byte, 255]
        }));
        levels += 1;
        if n == 1 {
            break;
        }
        n /= 2;
        level = (0..n * n)
            .map(|i| {
                let (x, y) = (2 * (i % n), 2 * (i / n));
                let at = |x: usize, y: usize| level[y * 2 * n + x];
                0.25 * (at(x, y) + at(x + 1, y) + at(x, y + 1) + at(x + 1, y + 1))
            })
            .collect();
    }
    let size = Extent3d { width: side, height: side, depth_or_array_layers: 1 };
    let mut image =
        Image::new_uninit(size, TextureDimension::D2, TextureFormat::Rgba8UnormSrgb, RenderAssetUsages::default());
    image.texture_descriptor.mip_level_count = levels;
    image.data = Some(data);
    image.sampler = ImageSampler::Descriptor(ImageSamplerDescriptor {
        address_mode_u: ImageAddressMode::Repeat,
        address_mode_v: ImageAddressMode::Repeat,
        mag_filter: ImageFilterMode::Linear,
        min_filter: ImageFilterMode::Linear,
        mipmap_filter: ImageFilterMode::Linear,
        ..default()
    });
    image
}

/// A number from 0 to 1 for each texel.
fn grain(at: UVec2) -> f32 {
    let mut x = at.x.wrapping_mul(0x9e37_79b1) ^ at.y.wrapping_mul(0x85eb_ca77);
    x = (x ^ (x >> 15)).wrapping_mul(0x2c1b_3c6d);
    (x >> 8) as f32 / (1 << 24) as f32
}

fn brick(uv: Vec2, grain: f32) -> f32 {
    let rows = 8.0 * uv.y;
    let shift = 0.5 * (rows.floor() % 2.0);
    let at = Vec2::new((4.0 * uv.x + shift).fract(), rows.fract());
    let is_mortar = at.x < 0.04 || at.y < 0.08;
    if is_mortar {
        0.75 + 0.1 * grain
    } else {
        0.3 + 0.2 * grain + 0.1 * ((7.0 * (4.0 * uv.x + shift).floor() + 3.0 * rows.floor()) % 3.0)
    }
}

fn tile(uv: Vec2, grain: f32) -> f32 {
    let at = (4.0 * uv).fract();
    let is_joint = at.min_element() < 0.03;
    let vein = ops::sin(40.0 * uv.x + 9.0 * ops::sin(17.0 * uv.y)).powi(8);
    if is_joint { 0.15 } else { 0.6 + 0.15 * grain - 0.3 * vein }
}

fn check(uv: Vec2, grain: f32) -> f32 {
    let at = (8.0 * uv).floor();
    let bright = (at.x + at.y) % 2.0;
    0.15 + 0.65 * bright + 0.1 * grain
}

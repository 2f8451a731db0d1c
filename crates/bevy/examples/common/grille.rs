//! What aliases: thin bars, edges at slopes, bright and dark, before the courtyard.

use bevy::math::ops;
use bevy::prelude::*;

/// Adds a grille, a fan of beams and a railing to the courtyard.
pub struct GrillePlugin;

impl Plugin for GrillePlugin {
    fn build(&self, app: &mut App) {
        app.add_systems(Startup, build);
    }
}

fn build(mut commands: Commands, mut meshes: ResMut<Assets<Mesh>>, mut materials: ResMut<Assets<StandardMaterial>>) {
    let mut paint =
        |color: Color| materials.add(StandardMaterial { base_color: color, perceptual_roughness: 0.7, ..default() });
    let (dark, light) = (paint(Color::srgb(0.06, 0.06, 0.07)), paint(Color::srgb(0.95, 0.93, 0.88)));
    let mut beam = |material: &Handle<StandardMaterial>, from: Vec3, to: Vec3, width: f32| {
        let along = to - from;
        commands.spawn((
            Mesh3d(meshes.add(Cuboid::new(width, along.length(), width))),
            MeshMaterial3d(material.clone()),
            Transform::from_translation(0.5 * (from + to))
                .with_rotation(Quat::from_rotation_arc(Vec3::Y, along.normalize())),
        ));
    };
    // A grille of bars of 16 mm, at the left: about a pixel of a view of 640 x 360.
    for i in 0..22 {
        let x = -4.6 + 0.1 * i as f32;
        beam(&dark, Vec3::new(x, 0.2, 2.2), Vec3::new(x, 2.4, 2.2), 0.016);
    }
    for y in [0.2, 1.3, 2.4] {
        beam(&dark, Vec3::new(-4.7, y, 2.2), Vec3::new(-2.4, y, 2.2), 0.02);
    }
    // A fan of beams at slopes from level to steep, at the right.
    for i in 0..9 {
        let angle = 0.04 + 0.17 * i as f32;
        let end = Vec3::new(ops::cos(angle), ops::sin(angle), 0.0);
        let hub = Vec3::new(1.6, 0.3, 2.6);
        beam(if i % 2 == 0 { &light } else { &dark }, hub + 0.2 * end, hub + 2.2 * end, 0.03);
    }
    // A railing that leads away from the viewer.
    for height in [0.5, 0.9] {
        beam(&light, Vec3::new(-1.2, height, 4.5), Vec3::new(0.6, height, -2.0), 0.03);
    }
    for i in 0..14 {
        let at = Vec3::new(-1.2, 0.0, 4.5).lerp(Vec3::new(0.6, 0.0, -2.0), i as f32 / 13.0);
        beam(&light, at, at + 0.9 * Vec3::Y, 0.02);
    }
}

//! Dense shapes in the courtyard: a million triangles, and lamps with shadow maps.

use bevy::light::NotShadowCaster;
use bevy::prelude::*;

/// Adds a crowd of shapes of 4096 triangles each.
#[derive(Resource, Clone, Copy)]
pub struct CrowdPlugin {
    /// Shapes along each side of the floor.
    pub side: usize,
    /// Whether they cast shadows.
    pub casts_shadows: bool,
    /// Lamps with shadow maps: six views each.
    pub lamps: usize,
}

impl Plugin for CrowdPlugin {
    fn build(&self, app: &mut App) {
        app.insert_resource(*self).add_systems(Startup, build);
    }
}

/// Kinds of shapes, each with a mesh of its own.
const KINDS: usize = 8;

fn build(
    mut commands: Commands,
    crowd: Res<CrowdPlugin>,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
) {
    let kinds: Vec<_> = (0..KINDS)
        .map(|kind| {
            let mesh = Sphere::new(0.1 + 0.015 * kind as f32).mesh().uv(64, 32);
            let color = Color::hsl(360.0 * kind as f32 / KINDS as f32, 0.5, 0.5);
            let material = StandardMaterial { base_color: color, perceptual_roughness: 0.4, ..default() };
            (meshes.add(mesh), materials.add(material))
        })
        .collect();
    for i in 0..crowd.side * crowd.side {
        let at = UVec2::new((i % crowd.side) as u32, (i / crowd.side) as u32).as_vec2() / crowd.side as f32;
        let (mesh, material) = &kinds[(3 * i + i / crowd.side) % KINDS];
        let place = Transform::from_xyz(14.0 * at.x - 7.0, 0.25, 9.0 * at.y - 4.5);
        let mut shape = commands.spawn((Mesh3d(mesh.clone()), MeshMaterial3d(material.clone()), place));
        if !crowd.casts_shadows {
            shape.insert(NotShadowCaster);
        }
    }
    for i in 0..crowd.lamps {
        commands.spawn((
            PointLight { intensity: 60_000.0, range: 14.0, shadow_maps_enabled: true, ..default() },
            Transform::from_xyz(4.0 * i as f32 - 2.0, 3.0, 1.0),
        ));
    }
}

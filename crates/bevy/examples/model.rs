//! Shows a model of glTF with Afterimage, without a window, and writes the last frame as PNG.
//!
//! `cargo run --release --example model -- MODEL.glb [OUT.png]`: 48 frames of 1280x720, while the
//! camera moves around the model. Default of OUT.png: `out/model.png`.

mod common;

use bevy::asset::LoadState;
use bevy::camera::primitives::Aabb;
use bevy::gltf::GltfAssetLabel;
use bevy::math::{Vec3A, ops};
use bevy::prelude::*;
use bevy_afterimage::{Afterimage, AfterimageStats, Foveated, Gaze};
use common::headless::{Headless, write_png};
use common::scene::TONEMAPPING;
use std::error::Error;
use std::time::{Duration, Instant};

const SIZE: UVec2 = UVec2::new(1280, 720);
const FRAMES: u32 = 48;
const PATIENCE: Duration = Duration::from_secs(120);

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let model = arguments.next().ok_or("expected: MODEL.glb [OUT.png]")?;
    let out = arguments.next().unwrap_or_else(|| "out/model.png".into());
    let model = std::fs::canonicalize(&model).map_err(|error| format!("{model}: {error}"))?;

    let mut headless = Headless::new(SIZE, |app: &mut App| {
        app.add_systems(Startup, |mut commands: Commands| {
            let sun = DirectionalLight { illuminance: 8_000.0, shadow_maps_enabled: true, ..default() };
            commands.spawn((sun, Transform::from_xyz(2.0, 5.0, 4.0).looking_at(Vec3::ZERO, Vec3::Y)));
            commands.insert_resource(GlobalAmbientLight { brightness: 500.0, ..default() });
        });
    });
    let server = headless.app.world().resource::<AssetServer>().clone();
    let scene = server.load(GltfAssetLabel::Scene(0).from_asset(model));
    headless.app.world_mut().spawn(WorldAssetRoot(scene.clone()));
    let target = headless.render_target();
    let camera = (Camera3d::default(), Afterimage::default(), Foveated::default(), AfterimageStats::default());
    let camera = headless.app.world_mut().spawn((camera, target, TONEMAPPING)).id();

    let began = Instant::now();
    while !server.is_loaded_with_dependencies(&scene) {
        if let LoadState::Failed(error) = server.load_state(&scene) {
            return Err(error.to_string().into());
        }
        if began.elapsed() > PATIENCE {
            return Err(format!("the model is not loaded after {} s", PATIENCE.as_secs()).into());
        }
        headless.frames(1);
        std::thread::sleep(Duration::from_millis(20));
    }
    // Meshes are spawned, and have their bounds.
    headless.frames(2);
    let (low, high) = bounds(&mut headless).ok_or("the model has no meshes")?;
    let (middle, radius) = (0.5 * (low + high), 0.5 * (high - low).length());
    for frame in 0..FRAMES {
        let angle = 0.5 + 0.006 * frame as f32;
        let from = middle + 2.6 * radius * Vec3A::new(ops::sin(angle), 0.35, ops::cos(angle));
        let world = headless.app.world_mut();
        *world.entity_mut(camera).get_mut().ok_or("the camera is gone")? =
            Transform::from_translation(from.into()).looking_at(middle.into(), Vec3::Y);
        world.resource_mut::<Gaze>().set(Vec2::new(0.45 + 0.002 * frame as f32, 0.5));
        headless.frames(1);
    }
    write_png(out.as_ref(), SIZE, &headless.read())?;
    let stats = headless.app.world().entity(camera).get::<AfterimageStats>().copied().unwrap_or_default();
    println!("{out}: {:.1} % of the pixels shaded", 100.0 * stats.shaded as f64 / f64::from(SIZE.element_product()),);
    headless.problems().first().map_or(Ok(()), |problem| Err(problem.as_str().into()))
}

/// Corners of the box around all meshes.
fn bounds(headless: &mut Headless) -> Option<(Vec3A, Vec3A)> {
    let world = headless.app.world_mut();
    let mut meshes = world.query_filtered::<(&Aabb, &GlobalTransform), With<Mesh3d>>();
    let corners = meshes.iter(world).flat_map(|(bounds, transform)| {
        let corner = |i: u32| {
            let side = Vec3A::from([0, 1, 2].map(|axis| if i >> axis & 1 == 0 { -1.0 } else { 1.0 }));
            transform.affine().transform_point3a(bounds.center + side * bounds.half_extents)
        };
        (0..8).map(corner)
    });
    corners.fold(None, |all, corner| {
        let (low, high) = all.unwrap_or((corner, corner));
        Some((low.min(corner), high.max(corner)))
    })
}

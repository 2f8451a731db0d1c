//! What an application does with its camera: queries, components beside `Afterimage`, children, and taking it away.

use crate::common::headless::Headless;
use crate::common::scene::{ScenePlugin, TONEMAPPING, stroll};
use crate::{SIZE, kind, psnr_db};
use bevy::camera::{ClearColorConfig, Hdr};
use bevy::core_pipeline::prepass::{DeferredPrepass, DepthPrepass, MotionVectorPrepass};
use bevy::ecs::entity_disabling::Disabled;
use bevy::light::{EnvironmentMapLight, Skybox};
use bevy::pbr::{DistanceFog, FogFalloff};
use bevy::prelude::*;
use bevy::render::RenderApp;
use bevy::render::camera::ExtractedCamera;
use bevy_afterimage::{Afterimage, AfterimageStats, FoveationKind, LatticeCamera};

/// A still courtyard and a camera with `components`, which a few frames of full rate have seen.
fn still(components: impl Bundle) -> (Headless, Entity) {
    let mut headless = Headless::new(SIZE, ScenePlugin { lamps: 4, moves: false });
    let target = headless.render_target();
    let camera = (Camera3d::default(), target, TONEMAPPING, stroll(1.0));
    let camera = headless.app.world_mut().spawn(camera).insert(components).id();
    headless.frames(4);
    (headless, camera)
}

fn lattices(headless: &mut Headless) -> Vec<Entity> {
    let world = headless.app.world_mut();
    world.query_filtered::<Entity, With<LatticeCamera>>().iter(world).collect()
}

/// How many cameras the renderer knows.
fn rendered_cameras(headless: &mut Headless) -> usize {
    let world = headless.app.sub_app_mut(RenderApp).world_mut();
    world.query::<&ExtractedCamera>().iter(world).count()
}

#[test]
fn the_first_frame_has_the_cameras_sky_fog_and_light() {
    for is_hdr in [false, true] {
        let (mut headless, camera) = still(Msaa::Off);
        let world = headless.app.world_mut();
        let light = EnvironmentMapLight {
            intensity: 2000.0,
            ..EnvironmentMapLight::hemispherical_gradient(
                &mut world.resource_mut::<Assets<Image>>(),
                Color::srgb(0.3, 0.5, 0.9),
                Color::srgb(0.9, 0.8, 0.7),
                Color::srgb(0.2, 0.3, 0.1),
            )
        };
        let sky = Skybox { image: Some(light.diffuse_map.clone()), brightness: 3000.0, ..default() };
        let fog = DistanceFog {
            color: Color::srgb(0.7, 0.6, 0.9),
            falloff: FogFalloff::Linear { start: 4.0, end: 30.0 },
            ..default()
        };
        world.entity_mut(camera).insert((light, sky, fog));
        if is_hdr {
            world.entity_mut(camera).insert(Hdr);
        }
        headless.frames(4);
        // Without history, so that frames of a still view are equal.
        headless.app.world_mut().entity_mut(camera).insert(kind(FoveationKind::QuadViews));
        let first = headless.shot();
        headless.frames(6);
        let later = psnr_db(&first, &headless.read());
        println!("hdr {is_hdr}: first frame against a later one {later:.2} dB");
        assert!(later > 40.0, "hdr {is_hdr}: {later:.2} dB");
        // Neither when the format changes.
        let mut camera = headless.app.world_mut().entity_mut(camera);
        if is_hdr {
            camera.remove::<Hdr>()
        } else {
            camera.insert(Hdr)
        };
        headless.frames(1);
        let first = headless.shot();
        headless.frames(6);
        let later = psnr_db(&first, &headless.read());
        println!("hdr {is_hdr}, changed: second frame against a later one {later:.2} dB");
        assert!(later > 40.0, "hdr {is_hdr}, changed: {later:.2} dB");
        assert_eq!(headless.problems(), &[] as &[String]);
    }
}

/// How often a system ran.
#[derive(Resource, Default, Debug, PartialEq, Clone, Copy)]
struct Runs([u32; 4]);

#[test]
fn queries_for_the_camera_find_one() {
    let (mut headless, camera) = still(kind(FoveationKind::Sparse));
    headless.app.init_resource::<Runs>();
    headless.app.add_systems(First, |_: Single<&Transform, With<Camera3d>>, mut runs: ResMut<Runs>| runs.0[0] += 1);
    headless.app.add_systems(Update, |_: Single<&Camera>, mut runs: ResMut<Runs>| runs.0[1] += 1);
    headless.app.add_systems(Update, |_: Single<&GlobalTransform, With<Camera>>, mut runs: ResMut<Runs>| {
        runs.0[2] += 1;
    });
    headless.app.add_systems(
        PostUpdate,
        (|_: Single<&mut Transform, With<Camera3d>>, mut runs: ResMut<Runs>| runs.0[3] += 1)
            .before(TransformSystems::Propagate),
    );
    headless.frames(5);
    assert_eq!(*headless.app.world().resource::<Runs>(), Runs([5; 4]));
    assert_eq!((lattices(&mut headless).len(), rendered_cameras(&mut headless)), (3, 4));
    // Despawned by a system that cannot see the lattices: the renderer forgets them, too.
    headless.app.add_systems(Update, move |mut commands: Commands| commands.entity(camera).try_despawn());
    headless.frames(3);
    assert_eq!((lattices(&mut headless).len(), rendered_cameras(&mut headless)), (0, 0));
    let world = headless.app.world_mut();
    assert_eq!(world.query_filtered::<(), With<Disabled>>().iter(world).count(), 0);
    assert_eq!(headless.problems(), &[] as &[String]);
}

#[test]
fn lattices_whose_entities_are_gone_come_back() {
    let (mut headless, camera) = still(kind(FoveationKind::QuadViews));
    let before = headless.read();
    headless.app.world_mut().entity_mut(camera).despawn_children();
    headless.frames(2);
    let after = psnr_db(&headless.read(), &before);
    println!("after despawn_children: {after:.2} dB");
    assert!(after > 60.0, "{after:.2} dB");
    assert_eq!((lattices(&mut headless).len(), rendered_cameras(&mut headless)), (3, 4));
    assert_eq!(headless.problems(), &[] as &[String]);
}

/// Whether a camera with `components` shows what it shows without `Afterimage`.
fn shows_every_pixel(components: impl Bundle) -> bool {
    let (mut headless, camera) = still((components, Msaa::Off));
    let full = headless.read();
    headless.app.world_mut().entity_mut(camera).insert(kind(FoveationKind::QuadViews));
    headless.frames(4);
    assert_eq!(headless.problems(), &[] as &[String]);
    let psnr = psnr_db(&headless.read(), &full);
    println!("against full rate {psnr:.2} dB");
    psnr > 60.0
}

#[test]
fn what_lattices_cannot_draw_is_drawn_at_full_rate() {
    let clear_color = ClearColorConfig::None;
    assert!(shows_every_pixel((DeferredPrepass, DepthPrepass, MotionVectorPrepass)), "deferred");
    assert!(shows_every_pixel(Camera { clear_color, ..default() }), "a frame that is not cleared");
    assert!(!shows_every_pixel(()));
}

#[test]
fn a_sky_stands_in_for_a_clear_color() {
    let frame = |clear_color| {
        let (mut headless, camera) = still((Msaa::Off, Camera { clear_color, ..default() }));
        let world = headless.app.world_mut();
        let colors = [Color::WHITE, Color::BLACK, Color::WHITE];
        let [top, middle, bottom] = colors;
        let mut images = world.resource_mut::<Assets<Image>>();
        let light = EnvironmentMapLight::hemispherical_gradient(&mut images, top, middle, bottom);
        let sky = Skybox { image: Some(light.diffuse_map), brightness: 3000.0, ..default() };
        world.entity_mut(camera).insert((sky, kind(FoveationKind::QuadViews)));
        headless.frames(4);
        assert_eq!(lattices(&mut headless).len(), 3);
        headless.read()
    };
    assert!(frame(ClearColorConfig::None) == frame(ClearColorConfig::Default));
}

#[test]
fn msaa_comes_back() {
    let msaa = |headless: &Headless, camera: Entity| *headless.app.world().entity(camera).get::<Msaa>().unwrap();
    let (mut headless, camera) = still((Msaa::Sample4, kind(FoveationKind::Sparse)));
    assert_eq!(msaa(&headless, camera), Msaa::Off);
    headless.app.world_mut().entity_mut(camera).insert(kind(FoveationKind::Off));
    headless.frames(2);
    assert_eq!(msaa(&headless, camera), Msaa::Sample4);
    headless.app.world_mut().entity_mut(camera).insert(kind(FoveationKind::Sparse));
    headless.frames(2);
    assert_eq!(msaa(&headless, camera), Msaa::Off);
    headless.app.world_mut().entity_mut(camera).remove::<Afterimage>();
    headless.frames(2);
    assert_eq!(msaa(&headless, camera), Msaa::Sample4);
    assert_eq!(headless.problems(), &[] as &[String]);
}

#[test]
fn stats_say_what_is_shaded_and_what_is_drawn_more_than_once() {
    let (mut headless, camera) = still((kind(FoveationKind::Sparse), AfterimageStats::default()));
    headless.frames(4);
    let stats = *headless.app.world().entity(camera).get::<AfterimageStats>().unwrap();
    println!("{stats:?}");
    // A quarter of 25 degrees of 60, and one of 16 elsewhere.
    assert!(stats.shaded > stats.pixels / 16 && stats.shaded < stats.pixels / 4, "{stats:?}");
    assert!(stats.meshes > 10 && stats.drawn_meshes > stats.meshes, "{stats:?}");
    assert!(stats.drawn_meshes <= 4 * stats.meshes, "{stats:?}");
}

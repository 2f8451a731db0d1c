//! Deferred cameras: lighting is sparse, and so is what is drawn forward beside it.

use crate::common::headless::{Headless, psnr_db};
use crate::common::scene::{Mover, ScenePlugin, TONEMAPPING, stroll};
use crate::quads::{Shaded, shaded};
use crate::{SIZE, add_stroller, aliased, clip_psnr_db, clips, compared, kind, wander};
use bevy::asset::RenderAssetUsages;
use bevy::camera::visibility::RenderLayers;
use bevy::camera::{RenderTarget, Viewport};
use bevy::core_pipeline::prepass::{DeferredPrepass, DepthPrepass, MotionVectorPrepass};
use bevy::light::{EnvironmentMapLight, Skybox};
use bevy::material::OpaqueRendererMethod;
use bevy::pbr::{DefaultOpaqueRendererMethod, ScreenSpaceAmbientOcclusion};
use bevy::prelude::*;
use bevy::render::render_resource::{Extent3d, TextureDimension, TextureFormat};
use bevy_afterimage::{Afterimage, Foveated, FoveationKind};

/// What makes a camera deferred, with `Afterimage` or without.
pub fn deferred() -> impl Bundle {
    (DeferredPrepass, DepthPrepass, MotionVectorPrepass)
}

/// The courtyard, of which half of the materials are deferred; a cube with holes of either kind, and a pane of glass.
pub fn yard(moves: bool) -> Headless {
    Headless::new(
        SIZE,
        (ScenePlugin { lamps: 4, moves }, |app: &mut App| {
            app.insert_resource(DefaultOpaqueRendererMethod::deferred()).add_systems(PostStartup, mix);
        }),
    )
}

fn mix(
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
    mut images: ResMut<Assets<Image>>,
) {
    let methods = [OpaqueRendererMethod::Forward, OpaqueRendererMethod::Auto];
    for (i, (_, material)) in materials.iter_mut().enumerate() {
        material.opaque_render_method = methods[i % 2];
    }
    let texels: Vec<u8> = (0..64).flat_map(|i| [200, 220, 90, 255 * ((i + i / 8) % 2) as u8]).collect();
    let size = Extent3d { width: 8, height: 8, depth_or_array_layers: 1 };
    let (format, usage) = (TextureFormat::Rgba8UnormSrgb, RenderAssetUsages::default());
    let holes = images.add(Image::new(size, TextureDimension::D2, texels, format, usage));
    let cube = Mesh3d(meshes.add(Cuboid::from_length(1.2)));
    for (i, opaque_render_method) in methods.into_iter().enumerate() {
        let (base_color_texture, alpha_mode) = (Some(holes.clone()), AlphaMode::Mask(0.5));
        let material = StandardMaterial { base_color_texture, alpha_mode, opaque_render_method, ..default() };
        let place = Transform::from_xyz(2.4 * i as f32 - 1.2, 2.6, 1.5);
        commands.spawn((cube.clone(), MeshMaterial3d(materials.add(material)), place, Mover::Turn(0.7)));
    }
    let base_color = Color::srgba(0.1, 0.9, 0.3, 0.4);
    let glass = StandardMaterial { base_color, alpha_mode: AlphaMode::Blend, unlit: true, ..default() };
    let pane = Mesh3d(meshes.add(Rectangle::new(3.0, 1.0)));
    commands.spawn((pane, MeshMaterial3d(materials.add(glass)), Transform::from_xyz(0.0, 0.9, 3.0)));
}

/// An image that a deferred camera with `components` strolls for.
fn stroller(headless: &mut Headless, components: impl Bundle) -> Handle<Image> {
    let image = headless.add_target(SIZE);
    add_stroller(headless, RenderTarget::from(image.clone()), (deferred(), components));
    image
}

/// A sky, whose light is that of the scene, too.
fn sky(headless: &mut Headless) -> Skybox {
    let mut images = headless.app.world_mut().resource_mut::<Assets<Image>>();
    let light = EnvironmentMapLight::hemispherical_gradient(&mut images, Color::WHITE, Color::BLACK, Color::WHITE);
    Skybox { image: Some(light.diffuse_map), brightness: 3000.0, ..default() }
}

/// Takes the glass away, which is drawn on top of quads.
fn break_glass(headless: &mut Headless) {
    let world = headless.app.world_mut();
    let mut things = world.query::<(Entity, &MeshMaterial3d<StandardMaterial>)>();
    let materials = world.resource::<Assets<StandardMaterial>>();
    let is_glass = |id| materials.get(id).is_some_and(|material| material.alpha_mode == AlphaMode::Blend);
    let glass = things.iter(world).find(|(_, material)| is_glass(&material.0)).expect("glass").0;
    world.despawn(glass);
}

#[test]
fn lighting_is_that_of_full_rate_where_a_pixel_is_chosen_and_absent_elsewhere() {
    for has_effects in [false, true] {
        let mut headless = yard(true);
        break_glass(&mut headless);
        let sky = sky(&mut headless);
        let [full, _] = [FoveationKind::Off, FoveationKind::Quads].map(|foveation| match has_effects {
            true => stroller(&mut headless, (kind(foveation), sky.clone(), ScreenSpaceAmbientOcclusion::default())),
            false => stroller(&mut headless, kind(foveation)),
        });
        headless.frames(8);
        for frame in 0..4 {
            wander(&mut headless, frame);
            headless.frames(1);
            let expected = headless.read_target(&full);
            let Shaded { chosen, worst, beside } = shaded(&mut headless, &expected);
            println!("frame {frame}: {chosen} pixels chosen, worst difference {worst}/255, {beside} beside");
            assert!(chosen > 1000 && chosen < SIZE.element_product() as usize / 2, "{chosen}");
            assert!(worst <= 1, "{worst}/255");
            assert_eq!(beside, 0);
        }
        assert_eq!(headless.problems(), &[] as &[String]);
    }
}

#[test]
fn history_is_better_than_interpolation_in_motion() {
    let mut headless = yard(true);
    let targets = compared().map(|components| stroller(&mut headless, components));
    let shots = clips((headless, targets), 16, 8);
    let [blind, quads] = [&shots[1], &shots[2]].map(|of| clip_psnr_db(of, &shots[0]));
    println!("deferred: without history {blind:.2} dB, with {quads:.2} dB");
    assert!(quads > blind + 2.0, "without history {blind:.2} dB, with {quads:.2} dB");
}

#[test]
fn a_still_view_becomes_that_of_full_rate() {
    let mut headless = yard(false);
    let sky = sky(&mut headless);
    let kinds = [kind(FoveationKind::Off), kind(FoveationKind::Quads)];
    let [full, quads] = kinds.map(|kind| {
        let image = headless.add_target(SIZE);
        let camera = (Camera3d::default(), RenderTarget::from(image.clone()), TONEMAPPING, Msaa::Off, stroll(1.0));
        let effects = (sky.clone(), ScreenSpaceAmbientOcclusion::default());
        headless.app.world_mut().spawn((camera, deferred(), kind, effects));
        image
    });
    headless.frames(24);
    assert_eq!(headless.problems(), &[] as &[String]);
    let psnr = psnr_db(&headless.read_target(&quads), &headless.read_target(&full));
    println!("a still deferred view: {psnr:.2} dB");
    assert!(psnr > 38.0, "{psnr:.2} dB");
}

#[test]
fn deferred_cameras_share_a_target() {
    let [full, quads] = shared(|world, target, foveated| {
        // Side by side, with odd origins.
        for (order, (x, width)) in [(0, 161), (161, 159)].into_iter().enumerate() {
            let (physical_position, physical_size) = (UVec2::new(x, 1), UVec2::new(width, SIZE.y - 1));
            let viewport = Some(Viewport { physical_position, physical_size, ..default() });
            let camera = Camera { viewport, order: order as isize, ..default() };
            let view = (Camera3d::default(), target.clone(), TONEMAPPING, Msaa::Off, stroll(1.0 + order as f32));
            world.spawn((camera, view, deferred(), aliased(), foveated));
        }
    });
    let psnr = psnr_db(&quads, &full);
    println!("deferred cameras side by side: {psnr:.2} dB");
    assert!(psnr > 38.0, "{psnr:.2} dB");
}

#[test]
fn a_view_model_is_drawn_on_a_deferred_world() {
    let [full, quads] = shared(|world, target, foveated| {
        let view = (Camera3d::default(), TONEMAPPING, Msaa::Off, stroll(1.0));
        world.spawn((view.clone(), target.clone(), deferred(), aliased(), foveated));
        let camera = Camera { order: 1, clear_color: ClearColorConfig::None, ..default() };
        world.spawn((camera, view, target, ARM));
    });
    let arm = full.chunks(4).filter(|pixel| pixel[0] > 150 && pixel[1].max(pixel[2]) < 90).count();
    let psnr = psnr_db(&quads, &full);
    println!("{arm} pixels of a view model on a deferred world: {psnr:.2} dB");
    assert!(arm > 200, "{arm}");
    assert!(psnr > 38.0, "{psnr:.2} dB");
}

/// Layer of what only upper cameras show.
const ARM: RenderLayers = RenderLayers::layer(1);

/// The still yard, with an arm on its layer, after some frames: at full rate, and by quads. `spawn` adds cameras.
fn shared(spawn: impl Fn(&mut World, RenderTarget, Foveated)) -> [Vec<u8>; 2] {
    let mut headless = yard(false);
    let arm = Mesh3d(headless.asset(Cuboid::new(0.1, 0.1, 0.5).into()));
    let opaque_render_method = OpaqueRendererMethod::Forward;
    let red =
        StandardMaterial { base_color: Color::srgb(1.0, 0.0, 0.0), unlit: true, opaque_render_method, ..default() };
    let red = MeshMaterial3d(headless.asset(red));
    let place = stroll(1.0) * Transform::from_xyz(0.2, -0.1, -0.4);
    headless.app.world_mut().spawn((arm, red, place, ARM));
    let targets = [Foveated { kind: FoveationKind::Off, ..default() }, Foveated::default()].map(|foveated| {
        let image = headless.add_target(SIZE);
        spawn(headless.app.world_mut(), RenderTarget::from(image.clone()), foveated);
        image
    });
    headless.frames(24);
    assert_eq!(headless.problems(), &[] as &[String]);
    targets.map(|target| headless.read_target(&target))
}

#[test]
fn deferred_rendering_comes_and_goes_and_targets_change_their_size() {
    // Every material is drawn forward where a camera does not say otherwise.
    let mut headless = Headless::new(SIZE, ScenePlugin { lamps: 4, moves: false });
    let targets = [FoveationKind::Off, FoveationKind::Quads].map(|foveation| {
        let image = headless.add_target(SIZE);
        let camera = (Camera3d::default(), RenderTarget::from(image.clone()), TONEMAPPING, Msaa::Off, stroll(1.0));
        headless.app.world_mut().spawn((camera, kind(foveation)));
        image
    });
    let world = headless.app.world_mut();
    let cameras: Vec<_> = world.query_filtered::<Entity, With<Afterimage>>().iter(world).collect();
    for (is_deferred, size) in [(true, SIZE), (true, SIZE + 20), (false, SIZE + 20), (false, SIZE), (true, SIZE)] {
        for &camera in &cameras {
            let mut camera = headless.app.world_mut().entity_mut(camera);
            if is_deferred {
                camera.insert(deferred());
            } else {
                camera.remove::<DeferredPrepass>();
            }
        }
        targets.iter().for_each(|target| headless.resize(target, size));
        headless.frames(24);
        assert_eq!(headless.problems(), &[] as &[String], "deferred {is_deferred}, {size}");
        let [full, quads] = targets.each_ref().map(|target| headless.read_target(target));
        let psnr = psnr_db(&quads, &full);
        println!("deferred {is_deferred}, {size}: {psnr:.2} dB");
        // Equal pictures would be those of a camera that renders every pixel.
        assert!(psnr > 38.0 && psnr < 90.0, "{psnr:.2} dB");
    }
}

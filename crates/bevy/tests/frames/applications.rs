//! What an application does with its camera: components beside `Afterimage`, children, and taking it away.

use crate::common::headless::Headless;
use crate::common::scene::{ScenePlugin, TONEMAPPING, stroll};
use crate::{SIZE, kind, psnr_db, rendered_msaa};
use bevy::camera::ClearColorConfig;
use bevy::core_pipeline::prepass::MotionVectorPrepass;
use bevy::light::{EnvironmentMapLight, Skybox};
use bevy::pbr::ScreenSpaceReflections;
use bevy::prelude::*;
use bevy_afterimage::{Afterimage, AfterimageStats, Foveated, FoveationKind};

/// A still courtyard and a camera with `components`, which a few frames of full rate have seen.
fn still(components: impl Bundle) -> (Headless, Entity) {
    let mut headless = Headless::new(SIZE, ScenePlugin { lamps: 4, moves: false });
    let target = headless.render_target();
    let camera = (Camera3d::default(), target, TONEMAPPING, stroll(1.0));
    let camera = headless.app.world_mut().spawn(camera).insert(components).id();
    headless.frames(4);
    (headless, camera)
}

/// Whether a camera with `components` shows what it shows without `Afterimage`.
fn shows_every_pixel(components: impl Bundle) -> bool {
    let (mut headless, camera) = still((components, Msaa::Off));
    let full = headless.read();
    headless.app.world_mut().entity_mut(camera).insert(kind(FoveationKind::Quads));
    headless.frames(4);
    assert_eq!(headless.problems(), &[] as &[String]);
    let psnr = psnr_db(&headless.read(), &full);
    println!("against full rate {psnr:.2} dB");
    psnr > 60.0
}

#[test]
fn what_cannot_be_shaded_by_quads_is_drawn_at_full_rate() {
    let clear_color = ClearColorConfig::None;
    let reflecting = (ScreenSpaceReflections::default(), MotionVectorPrepass);
    assert!(shows_every_pixel(reflecting), "reflections in screen space");
    assert!(shows_every_pixel(Camera { clear_color, ..default() }), "a frame that is not cleared");
    assert!(!shows_every_pixel(()));
}

#[test]
fn a_sky_stands_in_for_a_clear_color() {
    let frame = |clear_color| {
        let (mut headless, camera) = still((Msaa::Off, Camera { clear_color, ..default() }));
        let world = headless.app.world_mut();
        let [top, middle, bottom] = [Color::WHITE, Color::BLACK, Color::WHITE];
        let mut images = world.resource_mut::<Assets<Image>>();
        let light = EnvironmentMapLight::hemispherical_gradient(&mut images, top, middle, bottom);
        let sky = Skybox { image: Some(light.diffuse_map), brightness: 3000.0, ..default() };
        world.entity_mut(camera).insert((sky, kind(FoveationKind::Quads), AfterimageStats::default()));
        headless.frames(4);
        headless.wait();
        headless.frames(2);
        let stats = headless.app.world().entity(camera).get::<AfterimageStats>().unwrap();
        assert!(stats.shaded > 0 && stats.shaded < stats.pixels / 4, "{stats:?}");
        headless.read()
    };
    assert!(frame(ClearColorConfig::None) == frame(ClearColorConfig::Default));
}

#[test]
fn msaa_comes_back() {
    let (mut headless, camera) = still((Msaa::Sample4, kind(FoveationKind::Quads)));
    assert_eq!(rendered_msaa(&mut headless), [Msaa::Off]);
    headless.app.world_mut().entity_mut(camera).insert(kind(FoveationKind::Off));
    headless.frames(2);
    assert_eq!(rendered_msaa(&mut headless), [Msaa::Sample4]);
    headless.app.world_mut().entity_mut(camera).insert(kind(FoveationKind::Quads));
    headless.frames(2);
    assert_eq!(rendered_msaa(&mut headless), [Msaa::Off]);
    // What the application has chosen is there all the time.
    assert_eq!(headless.app.world().entity(camera).get(), Some(&Msaa::Sample4));
    headless.app.world_mut().entity_mut(camera).remove::<Afterimage>();
    headless.frames(2);
    assert_eq!(rendered_msaa(&mut headless), [Msaa::Sample4]);
    // A camera that is refused keeps it.
    let mut refused = headless.app.world_mut().entity_mut(camera);
    refused.insert(kind(FoveationKind::Quads)).get_mut::<Camera>().expect("a camera").clear_color =
        ClearColorConfig::None;
    headless.frames(2);
    assert_eq!(rendered_msaa(&mut headless), [Msaa::Sample4]);
    assert_eq!(headless.problems(), &[] as &[String]);
}

#[test]
fn stats_say_what_is_shaded() {
    let (mut headless, camera) = still((Afterimage::default(), AfterimageStats::default()));
    let [gazed, uniform] = [Foveated::default(), Foveated::uniform(0.25)].map(|foveated| {
        headless.app.world_mut().entity_mut(camera).insert(foveated);
        headless.frames(8);
        headless.wait();
        headless.frames(2);
        let stats = *headless.app.world().entity(camera).get::<AfterimageStats>().unwrap();
        println!("{stats:?}");
        assert_eq!(stats.pixels, u64::from(SIZE.element_product()));
        stats.shaded as f64 / stats.pixels as f64
    });
    // A fovea of 0.6 %, 1/32 of the rest, and at most 5 % by need.
    assert!(gazed > 0.035 && gazed < 0.09, "{gazed}");
    assert!(uniform > 0.12 && uniform < 0.26, "{uniform}");
}

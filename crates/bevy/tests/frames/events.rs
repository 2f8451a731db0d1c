//! What happens to an application while it runs.

use crate::common::headless::Headless;
use crate::{SIZE, compared, courtyard, courtyards, kind, psnr_db, rendered_msaa, wander};
use bevy::prelude::*;
use bevy_afterimage::afterimage::DebugView;
use bevy_afterimage::afterimage::internal::{Method, Settings, Wrs};
use bevy_afterimage::{Afterimage, AfterimageDebug, Foveated, FoveationKind, Gaze};

#[test]
fn frames_of_another_size_are_good_again() {
    let (mut headless, targets) = courtyards(compared());
    headless.frames(4);
    for size in [UVec2::new(400, 200), UVec2::new(160, 220), SIZE * 3 / 2] {
        targets.iter().for_each(|target| headless.resize(target, size));
        headless.frames(8);
        assert_eq!(headless.problems(), &[] as &[String]);
        let shots = targets.each_ref().map(|target| headless.read_target(target));
        assert_eq!(shots[2].len(), 4 * size.element_product() as usize);
        let [blind, quads] = [&shots[1], &shots[2]].map(|shot| psnr_db(shot, &shots[0]));
        println!("{size}: without history {blind:.2} dB, with {quads:.2} dB");
        assert!(quads > blind, "{size}: without history {blind:.2} dB, with {quads:.2} dB");
    }
}

#[test]
fn msaa_is_switched_off() {
    let [without, with] = [Msaa::Off, Msaa::Sample4].map(|msaa| {
        let mut headless = courtyard((kind(FoveationKind::Quads), msaa));
        headless.frames(5);
        assert_eq!(headless.problems(), &[] as &[String]);
        assert_eq!(rendered_msaa(&mut headless), [Msaa::Off]);
        headless.read()
    });
    assert!(without == with);
}

#[test]
fn a_lost_gaze_stays_where_it_was() {
    let [held, lost, centred] = [Some(Vec2::new(0.2, 0.7)), None, Some(Vec2::splat(0.5))].map(|later| {
        let mut headless = courtyard(kind(FoveationKind::Quads));
        headless.app.world_mut().resource_mut::<Gaze>().set(Vec2::new(0.2, 0.7));
        headless.frames(3);
        headless.app.world_mut().resource_mut::<Gaze>().set(later);
        headless.frames(3);
        headless.read()
    });
    assert!(held == lost);
    assert!(held != centred);
}

#[test]
fn settings_and_kinds_change_while_it_runs() {
    let mut headless = courtyard(kind(FoveationKind::Quads));
    let mut cameras = headless.app.world_mut().query::<(Entity, &mut Afterimage, &mut Foveated)>();
    let mut frame = 0;
    let mut change = |headless: &mut Headless, to: &dyn Fn(&mut Afterimage, &mut Foveated)| {
        let (_, mut afterimage, mut foveated) = cameras.single_mut(headless.app.world_mut()).unwrap();
        to(&mut afterimage, &mut foveated);
        for _ in 0..3 {
            wander(headless, frame);
            frame += 1;
            headless.frames(1);
        }
        assert_eq!(headless.problems(), &[] as &[String]);
        let shot = headless.read();
        let mean = shot.iter().map(|&byte| u64::from(byte)).sum::<u64>() / shot.len() as u64;
        assert!(mean > 80, "a dark frame: {mean}");
        shot
    };
    change(&mut headless, &|_, _| {});
    for settings in [Some(Settings::responsive()), Some(Settings::weighted()), None] {
        change(&mut headless, &|afterimage, _| afterimage.settings = settings);
    }
    for foveated in [Foveated::headset(), Foveated::screen()] {
        change(&mut headless, &|_, own| *own = foveated);
    }
    change(&mut headless, &|_, foveated| (foveated.rate_mid, foveated.rate_far) = (2, 4));
    change(&mut headless, &|_, foveated| (foveated.rate_mid, foveated.rate_far) = (8, 8));
    change(&mut headless, &|_, foveated| foveated.budget = 1.0);
    for share in [0.0, 0.1, 0.25, 1.0] {
        change(&mut headless, &|_, foveated| *foveated = Foveated::uniform(share));
    }
    for kind in [FoveationKind::Off, FoveationKind::Quads] {
        change(&mut headless, &|_, foveated| foveated.kind = kind);
    }
    change(&mut headless, &|afterimage, _| afterimage.antialias = true);
    change(&mut headless, &|afterimage, _| afterimage.antialias = false);
    // Settings out of range: every pixel is rendered, until they are mended.
    let method = Method::Wrs(Wrs { weight_exponent: 99, ..Wrs::default() });
    let broken = Settings { method, ..Settings::default() };
    change(&mut headless, &|afterimage, _| afterimage.settings = Some(broken));
    change(&mut headless, &|afterimage, foveated| {
        afterimage.settings = None;
        foveated.rate_far = 3;
    });
    change(&mut headless, &|_, foveated| *foveated = Foveated::default());
}

#[test]
fn debug_views_are_shown_instead_of_the_frame() {
    let mut headless = courtyard(kind(FoveationKind::Quads));
    headless.frames(8);
    let camera =
        headless.app.world_mut().query_filtered::<Entity, With<Afterimage>>().single(headless.app.world()).unwrap();
    let frame = headless.read();
    let views = [DebugView::Quality, DebugView::Rejection, DebugView::Motion].map(|view| {
        headless.app.world_mut().entity_mut(camera).insert(AfterimageDebug(view));
        headless.shot()
    });
    for (i, view) in views.iter().enumerate() {
        assert!(psnr_db(view, &frame) < 25.0, "view {i} looks like the frame");
        assert!(views[..i].iter().all(|other| other != view), "view {i} looks like another one");
    }
    headless.app.world_mut().entity_mut(camera).remove::<AfterimageDebug>();
    assert!(psnr_db(&headless.shot(), &frame) > 15.0);
    assert_eq!(headless.problems(), &[] as &[String]);
}

#[test]
fn cameras_come_and_go() {
    let mut headless = courtyard(kind(FoveationKind::Quads));
    headless.frames(3);
    let world = headless.app.world_mut();
    let camera = world.query_filtered::<Entity, With<Afterimage>>().single(world).unwrap();
    world.entity_mut(camera).remove::<Afterimage>();
    headless.frames(3);
    assert!(headless.read().iter().any(|&byte| byte > 150), "the camera renders every pixel itself");
    headless.app.world_mut().entity_mut(camera).insert(Afterimage::default());
    headless.frames(3);
    headless.app.world_mut().entity_mut(camera).get_mut::<Camera>().unwrap().is_active = false;
    headless.frames(2);
    headless.app.world_mut().entity_mut(camera).get_mut::<Camera>().unwrap().is_active = true;
    headless.frames(2);
    headless.app.world_mut().entity_mut(camera).despawn();
    headless.frames(2);
    assert_eq!(headless.problems(), &[] as &[String]);
}

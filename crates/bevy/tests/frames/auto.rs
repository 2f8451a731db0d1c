//! `Foveated::auto` on scripted loads: measured milliseconds go in, shares come out. Only the last test needs a device.

use crate::common::headless::{Headless, psnr_db};
use crate::{aliased, courtyard, rendered_msaa};
use bevy::anti_alias::taa::TemporalAntiAliasing;
use bevy::prelude::*;
use bevy::render::camera::TemporalJitter;
use bevy_afterimage::testing::Auto;
use bevy_afterimage::{Afterimage, Foveated, FoveationKind};

/// Milliseconds of a frame at 60 Hz.
const TARGET: f32 = 1e3 / 60.0;
/// Frames from a decision to the measurement of a frame that has it.
const DELAY: usize = 3;
const LEAST: f32 = 0.1;

/// Milliseconds of a frame's parts.
#[derive(Clone, Copy, Debug)]
struct Load {
    fixed: f32,
    /// Of all pixels.
    pixels: f32,
    /// Of the post-process.
    post: f32,
}

impl Load {
    /// Time of a frame with a share of the pixels, or without foveation.
    fn ms(self, share: Option<f32>) -> f32 {
        self.fixed + share.map_or(self.pixels, |share| self.post + share * self.pixels)
    }

    fn best_ms(self) -> f32 {
        self.ms(None).min(self.ms(Some(LEAST)))
    }

    /// Whether a frame meets the target, or comes within 3 % of the better of both ways.
    fn is_met(self, ms: f32) -> bool {
        ms <= TARGET.max(1.03 * self.best_ms())
    }
}

/// Pseudo-random numbers from 0 to 1.
struct Draws(u32);

impl Draws {
    fn next(&mut self) -> f32 {
        self.0 = self.0.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (self.0 >> 8) as f32 / (1 << 24) as f32
    }

    fn load(&mut self) -> Load {
        Load { fixed: 25.0 * self.next(), pixels: 60.0 * self.next().powi(2), post: 8.0 * self.next() }
    }
}

/// Shares of frames, and their times without noise. A frame after one without foveation has no history, and shades
/// every pixel.
fn run(frames: usize, load: impl Fn(usize) -> Load, noise: f32) -> Vec<(Option<f32>, f32)> {
    let mut auto = Auto::new(TARGET).expect("a target");
    let mut draws = Draws(7);
    let mut asked = vec![Some(1.0); DELAY];
    let mut made: Vec<(Option<f32>, f32)> = vec![];
    for i in 0..frames {
        let is_cut = asked[i].is_some() && made.last().is_none_or(|(last, _)| last.is_none());
        let ms = load(i).ms(if is_cut { Some(1.0) } else { asked[i] });
        made.push((asked[i], ms));
        asked.push(auto.share_for(ms * (1.0 + noise * (2.0 * draws.next() - 1.0))));
    }
    made
}

/// Times that foveation comes or goes.
fn switches(made: &[(Option<f32>, f32)]) -> usize {
    made.windows(2).filter(|w| w[0].0.is_some() != w[1].0.is_some()).count()
}

/// Times that the share turns from growing to shrinking or back.
fn turns(made: &[(Option<f32>, f32)]) -> usize {
    let shares: Vec<f32> = made.iter().filter_map(|frame| frame.0).collect();
    let steps: Vec<f32> = shares.windows(2).map(|w| w[1] - w[0]).filter(|step| *step != 0.0).collect();
    steps.windows(2).filter(|w| w[0] * w[1] < 0.0).count()
}

fn mean_ms(made: &[(Option<f32>, f32)]) -> f32 {
    made.iter().map(|(_, ms)| ms).sum::<f32>() / made.len() as f32
}

#[test]
fn a_constant_load_is_met_without_oscillation() {
    let mut draws = Draws(1);
    let mut off = 0;
    for _ in 0..2000 {
        let load = draws.load();
        let made = run(3200, |_| load, 0.02);
        let late = &made[800..];
        let mean = mean_ms(late);
        assert!(mean <= 1.03 * TARGET.max(load.best_ms()), "{load:?}: {mean} ms, best {} ms", load.best_ms());
        // The other way is tried twice, and is left again.
        assert!(switches(late) <= 4, "{load:?}: {} switches", switches(late));
        assert!(turns(late) <= 1, "{load:?}: {:?}", turns(late));
        off += usize::from(made[3199].0.is_none());
    }
    println!("without foveation: {off} of 2000 loads");
    assert!((100..1900).contains(&off), "{off}");
}

#[test]
fn a_change_of_load_is_followed_within_30_frames() {
    let mut draws = Draws(2);
    let (mut longest, mut hidden) = (0, 0);
    for _ in 0..2000 {
        let (before, after) = (draws.load(), draws.load());
        let made = run(1600, |i| if i < 800 { before } else { after }, 0.0);
        // What changes nothing that is measured is found by the next try.
        let share = made[799].0;
        if (after.ms(share) / before.ms(share) - 1.0).abs() < 0.06 {
            hidden += 1;
            continue;
        }
        let followed = made[800..].iter().position(|(_, ms)| after.is_met(*ms)).expect("it is followed");
        assert!(followed <= 30, "{before:?} to {after:?}: {followed} frames");
        longest = longest.max(followed);
        let (settled, share) = (mean_ms(&made[1400..]), made[1599].0);
        assert!(settled <= 1.03 * TARGET.max(after.best_ms()), "{before:?} to {after:?}: {settled} ms, {share:?}");
        // Time to spare is spent.
        let is_spent = after.ms(Some(1.0)) > 0.84 * TARGET || share.is_none_or(|share| share == 1.0);
        assert!(is_spent, "{before:?} to {after:?}: {share:?}");
    }
    println!("followed within {longest} frames, {hidden} of 2000 changes not measured");
    assert!(hidden < 200);
}

/// Of two loads, foveation pays in one.
#[test]
fn loads_that_alternate_do_not_make_it_swing() {
    let pays = Load { fixed: 12.0, pixels: 30.0, post: 3.0 };
    let does_not = Load { fixed: 24.0, pixels: 2.0, post: 6.0 };
    for period in 1..200 {
        let load = |i: usize| if (i / period).is_multiple_of(2) { pays } else { does_not };
        let made = run(12_000, load, 0.05);
        // Two for a try that fails, with at most 720 frames between tries.
        assert!(switches(&made) <= 12_000 / 360 + 12, "period {period}: {} switches", switches(&made));
        let fixed = [None, Some(LEAST)].map(|share| (0..12_000).map(|i| load(i).ms(share)).sum::<f32>() / 12_000.0);
        let mean = mean_ms(&made);
        assert!(mean <= 1.03 * fixed[0].max(fixed[1]), "period {period}: {mean} ms of {fixed:?}");
    }
}

#[test]
fn noise_and_missing_times_change_little() {
    let load = Load { fixed: 14.0, pixels: 30.0, post: 2.0 };
    for (noise, most, within) in [(0.03, 8, 1.03), (0.1, 24, 1.03)] {
        let made = run(4000, |_| load, noise);
        let (switches, over) = (switches(&made), mean_ms(&made[800..]) / load.best_ms());
        println!("noise {noise}: {switches} switches, {over} of the better time");
        assert!(switches <= most && over <= within, "noise {noise}: {switches} switches, {over} of the better time");
    }
    let mut auto = Auto::new(TARGET).expect("a target");
    for ms in [0.0, -1.0, f32::NAN, f32::INFINITY] {
        assert!((0..100).all(|_| auto.share_for(ms) == Some(1.0)));
    }
    assert!([0.0, -60.0, f32::NAN, f32::INFINITY].iter().all(|ms| Auto::new(*ms).is_err()));
}

#[test]
fn a_camera_follows_its_target() {
    // A millionth of a frame a second is always made, a million never, with or without foveation.
    for (target_fps, grows) in [(1e-3, true), (1e6, false)] {
        let mut headless = courtyard((aliased(), Foveated::auto(target_fps)));
        headless.frames(40);
        let msaa = rendered_msaa(&mut headless);
        let mut cameras = headless.app.world_mut().query::<&Foveated>();
        let foveated = cameras.single(headless.app.world()).expect("a camera");
        println!("{target_fps} frames a second: {foveated:?}");
        assert_eq!((foveated.target_fps, msaa), (Some(target_fps), vec![Msaa::Off]));
        let is_all = foveated.kind == FoveationKind::Quads && foveated.budget > 0.8;
        assert_eq!(is_all, grows, "{foveated:?}");
        assert_eq!(headless.problems(), &[] as &[String]);
        assert!(headless.read().iter().any(|&byte| byte > 150), "a dark frame");
    }
}

/// Runs a camera whose target is always missed until foveation is left out, and for some frames more, if that lasts.
/// Its picture, and whether Bevy antialiases.
fn left_out(afterimage: Afterimage) -> (Vec<u8>, bool) {
    let mut headless = courtyard((afterimage, Foveated::auto(1e6)));
    let mut cameras = headless.app.world_mut().query::<(&Foveated, Has<TemporalAntiAliasing>)>();
    for _ in 0..120 {
        headless.frames(1);
        let (foveated, _) = cameras.single(headless.app.world()).expect("a camera");
        if foveated.kind == FoveationKind::Off {
            headless.frames(3);
            let (foveated, has_taa) = cameras.single(headless.app.world()).expect("a camera");
            assert_eq!(foveated.kind, FoveationKind::Off, "the try lasts for five measured frames");
            assert_eq!(headless.problems(), &[] as &[String]);
            return (headless.read(), has_taa);
        }
    }
    panic!("foveation is never left out");
}

#[test]
fn bevy_antialiases_while_foveation_is_left_out() {
    let [(picture, has_taa), (rough, has_none)] = [Afterimage::default(), aliased()].map(left_out);
    assert!(has_taa && !has_none);
    let psnr = psnr_db(&picture, &rough);
    println!("antialiased and not: {psnr:.1} dB");
    assert!((15.0..45.0).contains(&psnr), "{psnr} dB");
}

#[test]
fn what_stands_in_leaves_with_its_camera_settings() {
    let mut headless = courtyard((Afterimage::default(), Foveated::auto(1e6)));
    let mut cameras = headless.app.world_mut().query_filtered::<Entity, With<Foveated>>();
    let camera = cameras.single(headless.app.world()).expect("a camera");
    let out = Foveated { kind: FoveationKind::Off, ..Foveated::auto(1e6) };
    let stands_in = |headless: &mut Headless, foveated: Foveated| {
        // Without `Auto`, which would choose the kind itself, for one frame.
        headless.app.world_mut().entity_mut(camera).remove::<Auto>().insert(foveated);
        headless.frames(1);
        let camera = headless.app.world().entity(camera);
        [camera.contains::<TemporalAntiAliasing>(), camera.contains::<TemporalJitter>()]
    };
    assert_eq!(stands_in(&mut headless, out), [true; 2]);
    assert_eq!(stands_in(&mut headless, Foveated::auto(1e6)), [false; 2]);
    assert_eq!(stands_in(&mut headless, out), [true; 2]);
    assert_eq!(stands_in(&mut headless, Foveated::screen()), [false; 2]);
    // The application's own stays.
    headless.app.world_mut().entity_mut(camera).insert(TemporalAntiAliasing::default());
    assert_eq!(stands_in(&mut headless, out), [true; 2]);
    assert_eq!(stands_in(&mut headless, Foveated::uniform(0.25)), [true; 2]);
}

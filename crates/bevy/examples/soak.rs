//! Random events in a running application: resize, minimise, cameras that come and go, settings, gaze, cuts. Counts
//! validation errors and frames that are not finite in size.
//!
//! `cargo run --release --example soak -- SECONDS [SEED]`

mod common;

use bevy::camera::{Exposure, Hdr, Viewport};
use bevy::prelude::*;
use bevy_afterimage::afterimage::DebugView;
use bevy_afterimage::afterimage::internal::{MethodKind, Settings};
use bevy_afterimage::{Afterimage, AfterimageDebug, AfterimageStats, CameraGaze, Foveated, FoveationKind, Gaze};
use common::headless::Headless;
use common::scene::{Mover, ScenePlugin, TONEMAPPING};
use std::collections::BTreeMap;
use std::error::Error;
use std::time::{Duration, Instant};

/// SplitMix64.
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let x = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        x ^ (x >> 31)
    }

    /// Below `n`.
    fn below(&mut self, n: usize) -> usize {
        (self.next() % n as u64) as usize
    }

    fn of<T: Copy>(&mut self, choices: &[T]) -> T {
        choices[self.below(choices.len())]
    }

    /// From -0.5 to 1.5: gazes may lie outside.
    fn uv(&mut self) -> Vec2 {
        Vec2::new(self.next() as f32, self.next() as f32) / u64::MAX as f32 * 2.0 - 0.5
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let seconds = arguments.next().ok_or("expected: SECONDS [SEED]")?.parse()?;
    let mut random = Random(arguments.next().map_or(Ok(1), |seed| seed.parse())?);
    let mut size = UVec2::new(256, 144);
    let mut headless = Headless::new(size, ScenePlugin { lamps: 3, moves: true });
    println!("adapter: {}", headless.adapter());

    let began = Instant::now();
    let mut counts = BTreeMap::<&str, usize>::new();
    let mut frames = 0;
    while began.elapsed() < Duration::from_secs(seconds) {
        let event = event(&mut headless, &mut random, &mut size);
        *counts.entry(event).or_default() += 1;
        let count = 1 + random.below(4);
        headless.frames(count);
        frames += count;
        if let Some(problem) = headless.problems().first() {
            return Err(format!("frame {frames}, after {event}: {problem}").into());
        }
    }
    println!("{frames} frames in {seconds} s, no validation error; events: {counts:?}");
    Ok(())
}

/// Does something to the application, and says what.
fn event(headless: &mut Headless, random: &mut Random, size: &mut UVec2) -> &'static str {
    let target = headless.render_target();
    let world = headless.app.world_mut();
    let cameras: Vec<Entity> = world
        .query_filtered::<Entity, With<Mover>>()
        .iter(world)
        .filter(|&entity| world.get::<Camera>(entity).is_some())
        .collect();
    let camera = (!cameras.is_empty()).then(|| random.of(&cameras));
    let choice = random.below(16);
    let Some(camera) = camera.filter(|_| choice > 0 || cameras.len() >= 3) else {
        let order = world.query::<&Camera>().iter(world).map(|camera| camera.order).max().unwrap_or(0) + 1;
        let mut spawned =
            world.spawn((Camera3d::default(), target, Mover::Stroll, TONEMAPPING, Camera { order, ..default() }));
        spawned.insert((Afterimage::default(), random.of(&[Msaa::Off, Msaa::Sample4])));
        if random.below(2) == 0 {
            spawned.insert(Hdr);
        }
        return "camera spawned";
    };
    let mut entity = world.entity_mut(camera);
    match choice {
        1 => {
            entity.despawn();
            "camera despawned"
        }
        2 | 3 => {
            // Sides of 1 are as small as images can be.
            *size = UVec2::new(random.of(&[1, 7, 64, 255, 256, 401]), random.of(&[1, 9, 64, 143, 144, 250]));
            // Viewports that no longer fit would be errors of the application.
            let mut cameras = world.query::<&mut Camera>();
            cameras.iter_mut(world).for_each(|mut camera| {
                let end = camera.viewport.as_ref().map(|viewport| viewport.physical_position + viewport.physical_size);
                if end.is_some_and(|end| end.cmpgt(*size).any()) {
                    camera.viewport = None;
                }
            });
            let target = headless.target.clone();
            headless.resize(&target, *size);
            "resize"
        }
        4 => {
            let mut camera = entity.get_mut::<Camera>().expect("a camera");
            camera.is_active = !camera.is_active;
            "camera switched on or off"
        }
        5 => {
            entity.get_mut::<Camera>().expect("a camera").viewport = (random.below(3) > 0 && size.min_element() > 2)
                .then(|| Viewport {
                    physical_position: UVec2::new(random.below(size.x as usize / 2) as u32, 0),
                    physical_size: (*size / 2).max(UVec2::ONE),
                    ..default()
                });
            "viewport"
        }
        6 => {
            match entity.contains::<Afterimage>() {
                true => entity.remove::<Afterimage>(),
                false => entity.insert(Afterimage::default()),
            };
            "afterimage added or removed"
        }
        7 => {
            let uniform = Foveated::uniform(random.of(&[0.0, 0.1, 0.25, 1.0, f32::NAN]));
            let gazed = Foveated {
                kind: random.of(&[FoveationKind::Quads, FoveationKind::Quads, FoveationKind::Off]),
                fovea_deg: random.of(&[0.0, 5.0, 20.0, 200.0, f32::NAN]),
                mid_deg: random.of(&[0.0, 20.0, 60.0, 180.0]),
                rate_mid: random.of(&[1, 2, 4]),
                rate_far: random.of(&[2, 4, 8, 16, 5]),
                budget: random.of(&[0.0, 0.025, 1.0, 2.0]),
                target_fps: random.of(&[None, None, Some(1e-3), Some(20.0), Some(0.0), Some(f32::NAN)]),
            };
            entity.insert(random.of(&[uniform, gazed, gazed, Foveated::default()]));
            "foveation"
        }
        8 => {
            let method = random.of(&[MethodKind::None, MethodKind::Taa, MethodKind::Taau, MethodKind::Smr]);
            let settings = (random.below(2) == 0).then(|| Settings { method: method.into(), ..default() });
            let (antialias, reset) = (random.below(2) == 0, random.below(2) == 0);
            entity.insert(Afterimage { settings, antialias, reset });
            "settings"
        }
        9 => {
            if let Some(mut afterimage) = entity.get_mut::<Afterimage>() {
                afterimage.reset = true;
            }
            "cut"
        }
        10 => {
            match random.below(3) {
                0 => entity.remove::<CameraGaze>(),
                1 => entity.insert(CameraGaze { uv: None }),
                _ => entity.insert(CameraGaze { uv: Some(random.uv()) }),
            };
            "gaze of a camera"
        }
        11 => {
            match random.below(2) {
                0 => entity.remove::<AfterimageDebug>(),
                _ => entity.insert(AfterimageDebug(random.of(&DebugView::ALL))),
            };
            "debug view"
        }
        12 => {
            match random.below(2) {
                0 => entity.remove::<AfterimageStats>(),
                _ => entity.insert(AfterimageStats::default()),
            };
            "stats"
        }
        13 => {
            entity.insert(Exposure { ev100: random.of(&[9.0, 9.7, 11.0]) });
            match random.below(3) {
                0 => entity.insert(Hdr),
                _ => entity.remove::<Hdr>(),
            };
            "exposure and format"
        }
        14 => {
            entity.insert(match random.below(4) {
                0 => Projection::from(OrthographicProjection::default_3d()),
                _ => Projection::from(PerspectiveProjection { fov: random.of(&[0.3, 0.8, 2.0]), ..default() }),
            });
            "projection"
        }
        _ => {
            let uv = random.uv();
            let uv = random.of(&[None, Some(Vec2::NAN), Some(uv), Some(uv)]);
            world.resource_mut::<Gaze>().set(uv);
            "gaze"
        }
    }
}

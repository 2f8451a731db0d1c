//! Frames of quads with a jitter are those of a renderer with several samples a pixel.

use crate::common::headless::{Headless, psnr_db};
use crate::common::scene::{ScenePlugin, TONEMAPPING, stroll};
use crate::deferred::deferred;
use crate::orthographic::{above, flat};
use crate::{change, compared};
use bevy::pbr::DefaultOpaqueRendererMethod;
use bevy::prelude::*;
use bevy_afterimage::testing::Planted;
use bevy_afterimage::{Afterimage, Foveated};

pub const SIZE: UVec2 = UVec2::new(240, 136);

/// Samples a pixel along each side, of the reference.
pub const SAMPLES: u32 = 4;

/// A still camera. The courtyard is without thin bars, whose errors would hide those of a wrong jitter.
fn still(size: UVec2, (is_flat, is_deferred): (bool, bool), components: (Afterimage, Foveated)) -> Headless {
    let mut headless = Headless::new(
        size,
        (ScenePlugin { lamps: 4, moves: false }, move |app: &mut App| {
            if is_deferred {
                app.insert_resource(DefaultOpaqueRendererMethod::deferred());
            }
        }),
    );
    let target = headless.render_target();
    let (projection, place) = match is_flat {
        true => (Projection::from(flat(9.0)), above()),
        false => (Projection::default(), stroll(1.0)),
    };
    let camera = (Camera3d::default(), projection, Msaa::Off, target, TONEMAPPING, place, components);
    let mut camera = headless.app.world_mut().spawn(camera);
    if is_deferred {
        camera.insert(deferred());
    }
    headless
}

/// Its frame after `frames`.
fn shot(headless: &mut Headless, frames: usize) -> Vec<u8> {
    headless.frames(frames);
    assert_eq!(headless.problems(), &[] as &[String]);
    headless.read()
}

/// Mean of the samples of a pixel, in linear light.
pub fn averaged(rgba: &[u8]) -> Vec<u8> {
    let width = SIZE.x * SAMPLES;
    let pixel = |i: u32| {
        let corner = UVec2::new(i % SIZE.x, i / SIZE.x) * SAMPLES;
        let samples = (0..SAMPLES * SAMPLES).map(|k| {
            let at = 4 * ((corner.y + k / SAMPLES) * width + corner.x + k % SAMPLES) as usize;
            Color::srgb_u8(rgba[at], rgba[at + 1], rgba[at + 2]).to_linear().to_vec3()
        });
        let mean = samples.sum::<Vec3>() / (SAMPLES * SAMPLES) as f32;
        Color::from(LinearRgba::from_vec3(mean)).to_srgba().to_u8_array()
    };
    (0..SIZE.element_product()).flat_map(pixel).collect()
}

#[test]
fn a_still_view_becomes_that_of_many_samples_a_pixel() {
    becomes_that_of_many_samples((false, false));
}

#[test]
fn so_does_an_orthographic_one() {
    becomes_that_of_many_samples((true, false));
}

#[test]
fn so_do_deferred_ones() {
    [false, true].into_iter().for_each(|is_flat| becomes_that_of_many_samples((is_flat, true)));
}

fn becomes_that_of_many_samples(kind: (bool, bool)) {
    let [full, ..] = compared();
    let reference = averaged(&shot(&mut still(SIZE * SAMPLES, kind, full.clone()), 3));
    let mut headless = still(SIZE, kind, full);
    let one = psnr_db(&shot(&mut headless, 3), &reference);
    let [with, wrong] = [false, true].map(|jitter| {
        let camera = change(&mut headless, (Afterimage { antialias: true, ..default() }, Foveated::uniform(0.25)));
        headless.app.world_mut().entity_mut(camera).insert(Planted { jitter, ..default() });
        // Each pixel is sampled a dozen times.
        psnr_db(&shot(&mut headless, 64), &reference)
    });
    println!("one sample a pixel {one:.2} dB, antialiased {with:.2} dB, with the opposite jitter {wrong:.2} dB");
    assert!(with > one + 3.0, "one sample a pixel {one:.2} dB, antialiased {with:.2} dB");
    assert!(with > wrong + 1.0, "{with:.2} dB, with the opposite jitter {wrong:.2} dB");
}

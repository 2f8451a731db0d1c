//! Pixels that history lacks, shaded by the camera itself.

use crate::common::headless::{Headless, afterimage, psnr_db};
use crate::common::scene::{ScenePlugin, TONEMAPPING, stroll};
use crate::{SIZE, clip, clip_psnr_db, courtyard, kind, wander};
use afterimage::wgpu;
use bevy::prelude::*;
use bevy::render::RenderApp;
use bevy::render::renderer::{RenderDevice, RenderQueue};
use bevy_afterimage::testing::recorded;
use bevy_afterimage::{Afterimage, Foveated, FoveationKind, Gaze};

/// Panes before the courtyard: one that is blended, and one that is cut out.
fn panes(mut commands: Commands, mut meshes: ResMut<Assets<Mesh>>, mut materials: ResMut<Assets<StandardMaterial>>) {
    for (x, alpha_mode) in [(-1.0, AlphaMode::Blend), (1.0, AlphaMode::Mask(0.5))] {
        let material = StandardMaterial { base_color: Color::srgba(0.2, 0.9, 0.4, 0.6), alpha_mode, ..default() };
        commands.spawn((
            Mesh3d(meshes.add(Cuboid::new(1.2, 1.6, 0.1))),
            MeshMaterial3d(materials.add(material)),
            Transform::from_xyz(x, 1.5, 3.0),
        ));
    }
}

fn repairing(repair: f32) -> impl Bundle {
    (Afterimage { repair, ..default() }, Foveated::default())
}

/// Which pixels the last frame repaired.
fn chosen(headless: &mut Headless) -> Vec<bool> {
    let world = headless.app.sub_app_mut(RenderApp).world_mut();
    let mask = recorded(world).pop().expect("a camera").mask.expect("a mask");
    let (device, queue) = (world.resource::<RenderDevice>().wgpu_device(), world.resource::<RenderQueue>());
    let stride = (4 * mask.width()).next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
    let buffer = device.create_buffer(&wgpu::BufferDescriptor {
        label: None,
        size: u64::from(stride * mask.height()),
        usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
        mapped_at_creation: false,
    });
    let mut encoder = device.create_command_encoder(&Default::default());
    let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(stride), rows_per_image: None };
    let copy = wgpu::TexelCopyBufferInfo { buffer: &buffer, layout };
    encoder.copy_texture_to_buffer(mask.as_image_copy(), copy, mask.size());
    queue.submit([encoder.finish()]);
    buffer.map_async(wgpu::MapMode::Read, .., |result| result.expect("mapped"));
    device.poll(wgpu::PollType::wait_indefinitely()).expect("the device");
    let bytes = buffer.get_mapped_range(..);
    let at = |i: u32| bytes[(i / SIZE.x / 2 * stride + i % SIZE.x / 2 * 4) as usize] != 0;
    (0..SIZE.element_product()).map(at).collect()
}

/// Of two images, the pixels that `mask` has as `is`.
fn masked(images: [&[u8]; 2], mask: &[bool], is: bool) -> [Vec<u8>; 2] {
    images.map(|image| image.chunks(4).zip(mask).filter(|(_, m)| **m == is).flat_map(|(p, _)| p).copied().collect())
}

#[test]
fn chosen_pixels_are_those_of_a_full_rate_frame() {
    let share = 0.1;
    let [mut full, mut sparse] = [courtyard(kind(FoveationKind::Off)), courtyard(repairing(share))];
    for headless in [&mut full, &mut sparse] {
        headless.app.add_systems(Startup, panes);
    }
    for frame in 0..8 {
        let [expected, shown] = [&mut full, &mut sparse].map(|headless| {
            wander(headless, frame);
            let shot = headless.shot();
            assert_eq!(headless.problems(), &[] as &[String]);
            shot
        });
        if frame < 2 {
            // Meshes and textures are on their way.
            continue;
        }
        let mask = chosen(&mut sparse);
        let count = mask.iter().filter(|is_chosen| **is_chosen).count();
        let pixels = mask.len() as f32;
        assert!(count > 100 && count as f32 <= share * pixels, "frame {frame}: {count} pixels");
        let [chosen, others] = [true, false].map(|is| masked([&shown, &expected], &mask, is));
        let off = chosen[0].iter().zip(&chosen[1]).filter(|(a, b)| a.abs_diff(**b) > 1).count();
        let [chosen, others] = [chosen, others].map(|[shown, expected]| psnr_db(&shown, &expected));
        println!("frame {frame}: {count} pixels, {chosen:.2} dB, {off} values off; others {others:.2} dB");
        // Full-rate samples beside them are of a crop, which rounds otherwise.
        assert!(chosen > 50.0 && off * 200 < count, "frame {frame}: {chosen:.2} dB, {off} values off");
        assert!(others < 40.0, "frame {frame}: {others:.2} dB");
    }
}

#[test]
fn what_is_uncovered_is_better_repaired() {
    let reference = clip(&mut courtyard(kind(FoveationKind::Off)), 24, 12);
    let [without, with] =
        [0.0, 0.05].map(|share| clip_psnr_db(&clip(&mut courtyard(repairing(share)), 24, 12), &reference));
    println!("without repair {without:.2} dB, with {with:.2} dB");
    assert!(with > without + 0.3, "without repair {without:.2} dB, with {with:.2} dB");
}

#[test]
fn a_still_view_through_panes_becomes_that_of_full_rate() {
    let frame = |components: &dyn Fn(&mut EntityWorldMut<'_>)| {
        let mut headless = Headless::new(SIZE, ScenePlugin { lamps: 4, moves: false });
        headless.app.add_systems(Startup, panes);
        let target = headless.render_target();
        let camera = (Camera3d::default(), Msaa::Off, target, TONEMAPPING, stroll(1.0));
        components(&mut headless.app.world_mut().spawn(camera));
        headless.app.world_mut().resource_mut::<Gaze>().set(Vec2::new(0.3, 0.5));
        headless.frames(36);
        assert_eq!(headless.problems(), &[] as &[String]);
        headless.read()
    };
    let full = frame(&|_| {});
    let [without, with] = [0.0, 0.1].map(|share| {
        psnr_db(
            &frame(&|camera| {
                camera.insert(repairing(share));
            }),
            &full,
        )
    });
    println!("still: without repair {without:.2} dB, with {with:.2} dB");
    assert!(with > 38.0 && with > without - 0.5, "without repair {without:.2} dB, with {with:.2} dB");
}

#[test]
fn antialiasing_is_not_repaired() {
    let shot = |repair| {
        let mut headless = courtyard((Afterimage { antialias: true, repair, ..default() }, Foveated::default()));
        headless.frames(5);
        assert_eq!(headless.problems(), &[] as &[String]);
        headless.read()
    };
    assert!(shot(0.0) == shot(0.1));
}

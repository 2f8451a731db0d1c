//! Frames of an application without a window, on software Vulkan.

#[path = "../../examples/common/mod.rs"]
mod common;

mod albedo;
mod antialiasing;
mod applications;
mod auto;
mod conventions;
mod deferred;
mod events;
mod late;
mod layers;
mod mirrors;
mod orthographic;
mod pixels;
mod quads;
mod reflection;

use bevy::camera::{Hdr, RenderTarget};
use bevy::core_pipeline::tonemapping::Tonemapping;
use bevy::prelude::*;
use bevy::render::RenderApp;
use bevy::render::renderer::{RenderDevice, RenderQueue};
use bevy_afterimage::afterimage::internal::{Method, Settings};
use bevy_afterimage::afterimage::wgpu;
use bevy_afterimage::{Afterimage, Foveated, FoveationKind, Gaze};
use common::headless::{Headless, psnr_db};
use common::scene::{Mover, ScenePlugin, TONEMAPPING, stroll};

const SIZE: UVec2 = UVec2::new(320, 180);

/// Adds a camera with `components` that strolls through the courtyard.
fn add_stroller(headless: &mut Headless, target: RenderTarget, components: impl Bundle) {
    let camera = (Camera3d::default(), target, stroll(0.0), Mover::Stroll, TONEMAPPING, Msaa::Off);
    headless.app.world_mut().spawn(camera).insert(components);
}

/// The courtyard, and a camera with `components` that strolls through it.
fn courtyard(components: impl Bundle) -> Headless {
    let mut headless = Headless::new(SIZE, ScenePlugin { lamps: 4, moves: true });
    let target = headless.render_target();
    add_stroller(&mut headless, target, components);
    headless
}

/// The courtyard, and cameras that stroll through it on the same way, each with components and an image of its own.
fn courtyards<const N: usize>(cameras: [impl Bundle; N]) -> (Headless, [Handle<Image>; N]) {
    let mut headless = Headless::new(SIZE, ScenePlugin { lamps: 4, moves: true });
    let targets = cameras.map(|components| {
        let image = headless.add_target(SIZE);
        add_stroller(&mut headless, RenderTarget::from(image.clone()), components);
        image
    });
    (headless, targets)
}

/// Reads a texture of the device.
fn read(headless: &Headless, texture: &wgpu::Texture) -> Vec<u8> {
    let world = headless.app.sub_app(RenderApp).world();
    let (device, queue) = (world.resource::<RenderDevice>().wgpu_device(), world.resource::<RenderQueue>());
    let row_bytes = texture.format().block_copy_size(None).expect("a color format") * texture.width();
    let stride = row_bytes.next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
    let buffer = device.create_buffer(&wgpu::BufferDescriptor {
        label: None,
        size: u64::from(stride * texture.height()),
        usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
        mapped_at_creation: false,
    });
    let mut encoder = device.create_command_encoder(&Default::default());
    let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(stride), rows_per_image: None };
    let copy = wgpu::TexelCopyBufferInfo { buffer: &buffer, layout };
    encoder.copy_texture_to_buffer(texture.as_image_copy(), copy, texture.size());
    queue.submit([encoder.finish()]);
    buffer.map_async(wgpu::MapMode::Read, .., |result| result.expect("mapped"));
    device.poll(wgpu::PollType::wait_indefinitely()).expect("the device");
    let bytes = buffer.get_mapped_range(..).expect("mapped");
    bytes.chunks(stride as usize).flat_map(|row| &row[..row_bytes as usize]).copied().collect()
}

/// Not antialiased, as frames at every pixel are not that they are compared with.
fn aliased() -> Afterimage {
    Afterimage { antialias: false, ..default() }
}

/// At every pixel, by quads without history, and by quads.
fn compared() -> [(Afterimage, Foveated); 3] {
    let every = Foveated { kind: FoveationKind::Off, ..default() };
    let blind = Settings { method: Method::None, ..default() };
    let blind = Afterimage { settings: Some(blind), ..aliased() };
    [(aliased(), every), (blind, Foveated::default()), (aliased(), Foveated::default())]
}

/// Has the camera be shown otherwise from now on, without history.
fn change(headless: &mut Headless, (afterimage, foveated): (Afterimage, Foveated)) -> Entity {
    let world = headless.app.world_mut();
    let camera = world.query_filtered::<Entity, With<Camera3d>>().single(world).expect("a camera");
    world.entity_mut(camera).insert((Afterimage { reset: true, ..afterimage }, foveated)).id()
}

fn kind(kind: FoveationKind) -> impl Bundle {
    (aliased(), Foveated { kind, ..default() })
}

/// MSAA with which cameras are rendered.
fn rendered_msaa(headless: &mut Headless) -> Vec<Msaa> {
    let world = headless.app.sub_app_mut(RenderApp).world_mut();
    world.query::<&Msaa>().iter(world).copied().collect()
}

/// A gaze that wanders through the frame.
fn wander(headless: &mut Headless, frame: usize) {
    let t = frame as f32;
    let uv = Vec2::new(0.5 + 0.3 * (0.11 * t).sin(), 0.55 + 0.2 * (0.07 * t).cos());
    headless.app.world_mut().resource_mut::<Gaze>().set(uv);
}

/// Frames of the wandering gaze in each image, without the first `skipped`.
fn clips<const N: usize>(
    (mut headless, targets): (Headless, [Handle<Image>; N]),
    frames: usize,
    skipped: usize,
) -> [Vec<Vec<u8>>; N] {
    let mut shots = [const { vec![] }; N];
    for frame in 0..frames {
        wander(&mut headless, frame);
        headless.frames(1);
        if frame >= skipped {
            shots.iter_mut().zip(&targets).for_each(|(shots, target)| shots.push(headless.read_target(target)));
        }
    }
    assert_eq!(headless.problems(), &[] as &[String], "validation");
    shots
}

/// PSNR over the frames of a clip, in dB.
fn clip_psnr_db(a: &[Vec<u8>], b: &[Vec<u8>]) -> f64 {
    psnr_db(&a.concat(), &b.concat())
}

/// A camera with `Hdr` whose main texture is shown as it is.
fn linear() -> impl Bundle {
    (Hdr, Tonemapping::None)
}

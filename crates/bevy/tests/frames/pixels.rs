//! Pixels of frames: better than without history, and those of the drop-in.

use crate::common::headless::{Headless, afterimage};
use crate::common::scene::{Mover, ScenePlugin, TONEMAPPING, stroll};
use crate::{
    SIZE, aliased, change, clip_psnr_db, clips, compared, courtyard, courtyards, kind, linear, psnr_db, read, wander,
};
use afterimage::gpu::{Frame, Region, Textures};
use afterimage::internal::ViewFrame;
use afterimage::wgpu;
use bevy::camera::{CameraProjection, RenderTarget, SubCameraView, Viewport};
use bevy::math::Vec3A;
use bevy::prelude::*;
use bevy::render::RenderApp;
use bevy::render::renderer::{RenderDevice, RenderQueue};
use bevy_afterimage::testing::recorded;
use bevy_afterimage::{Afterimage, AfterimageStats, CameraGaze, Foveated, FoveationKind, Gaze};

#[test]
fn history_is_better_than_interpolation_in_motion() {
    let shots = clips(courtyards(compared()), 16, 8);
    let [blind, quads] = [&shots[1], &shots[2]].map(|of| clip_psnr_db(of, &shots[0]));
    println!("without history {blind:.2} dB, with {quads:.2} dB");
    assert!(quads > blind + 2.0, "without history {blind:.2} dB, with {quads:.2} dB");
}

/// A still courtyard.
fn still(is_hdr: bool) -> Headless {
    let mut headless = Headless::new(SIZE, ScenePlugin { lamps: 4, moves: false });
    let target = headless.render_target();
    let camera = (Camera3d::default(), Msaa::Off, target, TONEMAPPING, stroll(1.0));
    let mut camera = headless.app.world_mut().spawn(camera);
    if is_hdr {
        camera.insert(linear());
    }
    headless
}

/// A frame of the camera with `components`, after some.
fn settled(headless: &mut Headless, components: (Afterimage, Foveated), frames: usize, gaze: Vec2) -> Vec<u8> {
    change(headless, components);
    headless.app.world_mut().resource_mut::<Gaze>().set(gaze);
    headless.frames(frames);
    assert_eq!(headless.problems(), &[] as &[String]);
    headless.read()
}

#[test]
fn a_still_view_becomes_that_of_full_rate_with_and_without_hdr() {
    let at = Vec2::new(0.3, 0.5);
    for is_hdr in [false, true] {
        let mut headless = still(is_hdr);
        let [full, blind, quads] = compared();
        let full = settled(&mut headless, full, 3, at);
        let blind = psnr_db(&settled(&mut headless, blind, 8, at), &full);
        // 32 frames until each quad of the periphery was shaded, and a few more.
        let quads = psnr_db(&settled(&mut headless, quads, 40, at), &full);
        println!("hdr {is_hdr}: without history {blind:.2} dB, with {quads:.2} dB");
        assert!(quads > 38.0 && quads > blind + 8.0, "hdr {is_hdr}: without {blind:.2} dB, with {quads:.2} dB");
    }
}

#[test]
fn without_a_gaze_a_still_view_becomes_that_of_full_rate_wherever_one_looks() {
    let mut headless = still(false);
    let [full, ..] = compared();
    let full = settled(&mut headless, full, 3, Vec2::splat(0.5));
    let [left, right] = [0.1, 0.9].map(|x| {
        let uniform = (aliased(), Foveated::uniform(0.25));
        settled(&mut headless, uniform, 20, Vec2::new(x, 0.5))
    });
    let psnr = psnr_db(&left, &full);
    println!("uniform, 25 %: {psnr:.2} dB, {:.2} dB between gazes", psnr_db(&left, &right));
    assert!(psnr > 38.0, "{psnr:.2} dB");
    // Where history lacks nothing, the gaze decides nothing.
    assert!(psnr_db(&left, &right) > 45.0);
}

#[test]
fn frames_are_those_of_the_drop_in_fed_with_the_same_textures() {
    [false, true].into_iter().for_each(compare_with_the_drop_in);
}

fn compare_with_the_drop_in(antialias: bool) {
    let mut headless = courtyard((Afterimage { antialias, ..default() }, Foveated::default(), linear()));
    let mut alone = None;
    for frame in 0..6 {
        wander(&mut headless, frame);
        headless.frames(1);
        let render_world = headless.app.sub_app_mut(RenderApp).world_mut();
        let given = recorded(render_world).pop().expect("a camera");
        let device = render_world.resource::<RenderDevice>().wgpu_device().clone();
        let format = wgpu::TextureFormat::Rgba16Float;
        let post = alone.get_or_insert_with(|| afterimage::gpu::Afterimage::new(&device, &given.desc, format).unwrap());
        let output = device.create_texture(&wgpu::TextureDescriptor {
            label: None,
            size: given.output.size(),
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format,
            usage: wgpu::TextureUsages::STORAGE_BINDING | wgpu::TextureUsages::COPY_SRC,
            view_formats: &[],
        });
        let views = [given.view];
        let [depth, motion] = [&given.depth, &given.motion].map(|texture| [Region::new(texture, [0, 0])]);
        let described = Frame {
            depth: Some(Textures::Regions(&depth)),
            motion: Some(Textures::Regions(&motion)),
            ..Frame::new(&given.color, &views, given.index)
        };
        let mut show = |described: &Frame<'_>| {
            let mut encoder = device.create_command_encoder(&Default::default());
            post.plan(&device, &mut encoder, described).unwrap();
            post.record(&device, &mut encoder, described, &output).unwrap();
            headless.app.sub_app(RenderApp).world().resource::<RenderQueue>().submit([encoder.finish()]);
            read(&headless, &output)
        };
        let expected = show(&described);
        let shown = read(&headless, &given.output);
        assert!(shown.iter().any(|&byte| byte != 0), "frame {frame} is black");
        assert!(shown == expected, "frame {frame} differs");
        // The comparison notices a view that is described otherwise.
        if frame == 5 {
            let views = [ViewFrame { gaze: afterimage::Gaze::Uv { uv: [0.1, 0.1] }, ..given.view }];
            assert!(show(&Frame { views: &views, ..described }) != shown);
        }
    }
}

#[test]
fn gizmos_are_drawn_at_full_rate_and_hidden_by_meshes() {
    let mut headless = still(false);
    // One line before the meshes, and one behind the wall.
    headless.app.add_systems(Update, |mut gizmos: Gizmos<'_, '_>| {
        for (z, color) in [(3.0, Color::srgb(1.0, 0.0, 1.0)), (-9.0, Color::srgb(0.0, 1.0, 0.0))] {
            gizmos.line(Vec3::new(-2.0, 2.0, z), Vec3::new(2.0, 2.3, z), color);
        }
    });
    // The jitter of meshes does not move them.
    let antialias = Afterimage { antialias: true, ..default() };
    let [full, ..] = compared();
    let lines = [full, (antialias, Foveated::default())].map(|components| {
        let shot = settled(&mut headless, components, 8, Vec2::splat(0.5));
        let green = shot.chunks(4).filter(|pixel| pixel[1] > pixel[0].max(pixel[2]).saturating_add(100)).count();
        assert_eq!(green, 0, "pixels of the line behind the wall");
        shot.chunks(4).map(|pixel| pixel[0].min(pixel[2]) > pixel[1].saturating_add(100)).collect::<Vec<bool>>()
    });
    let counts = lines.each_ref().map(|shot| shot.iter().filter(|is_line| **is_line).count());
    println!("pixels of the line: {counts:?} at full rate and antialiased by history");
    assert!(counts[0] > 100);
    assert!(lines[0] == lines[1]);
}

#[test]
fn two_cameras_show_what_each_shows_alone() {
    let half = UVec2::new(SIZE.x / 2, SIZE.y);
    let camera = |headless: &mut Headless, side: u32| {
        let target = headless.render_target();
        let viewport = Viewport { physical_position: UVec2::new(side * half.x, 0), physical_size: half, ..default() };
        let clear_color = if side == 0 { ClearColorConfig::Default } else { ClearColorConfig::Custom(Color::BLACK) };
        headless.app.world_mut().spawn((
            Camera3d::default(),
            Camera { order: side as isize, viewport: Some(viewport), clear_color, ..default() },
            (target, TONEMAPPING, Afterimage::default()),
            (stroll(0.6 * side as f32), Mover::Stroll),
            CameraGaze { uv: Some(Vec2::new(0.3 + 0.4 * side as f32, 0.5)) },
        ));
    };
    let shots = [&[0][..], &[1], &[0, 1]].map(|sides| {
        let mut headless = Headless::new(SIZE, ScenePlugin { lamps: 4, moves: true });
        sides.iter().for_each(|&side| camera(&mut headless, side));
        headless.frames(10);
        assert_eq!(headless.problems(), &[] as &[String]);
        headless.read()
    });
    let side = |shot: &[u8], side: u32| -> Vec<u8> {
        let row = 4 * SIZE.x as usize;
        let from = 4 * (side * half.x) as usize;
        shot.chunks(row).flat_map(|line| &line[from..from + row / 2]).copied().collect()
    };
    for i in 0..2 {
        let [alone, both] = [&shots[i as usize], &shots[2]].map(|shot| side(shot, i));
        assert!(alone.iter().any(|&byte| byte > 100), "camera {i} shows nothing");
        let differing = alone.iter().zip(&both).filter(|(a, b)| a != b).count();
        assert_eq!(differing, 0, "camera {i} shows something else beside the other one");
    }
    assert_ne!(side(&shots[2], 0), side(&shots[2], 1), "the cameras show the same");
}

/// An eye of a headset: a frustum that is not symmetric.
#[derive(Clone, Copy, Debug)]
struct Eye {
    left: f32,
    right: f32,
    aspect: f32,
}

impl CameraProjection for Eye {
    fn get_clip_from_view(&self) -> Mat4 {
        let (near, half_height) = (0.1, 0.5 * (self.right - self.left) / self.aspect);
        let width = self.right - self.left;
        Mat4::from_cols(
            Vec4::X * (2.0 / width),
            Vec4::Y / half_height,
            Vec4::new((self.right + self.left) / width, 0.0, 0.0, -1.0),
            Vec4::new(0.0, 0.0, near, 0.0),
        )
    }

    fn get_clip_from_view_for_sub(&self, _: &SubCameraView) -> Mat4 {
        self.get_clip_from_view()
    }

    fn update(&mut self, width: f32, height: f32) {
        self.aspect = width / height;
    }

    fn far(&self) -> f32 {
        1000.0
    }

    fn get_frustum_corners(&self, z_near: f32, z_far: f32) -> [Vec3A; 8] {
        let half_height = 0.5 * (self.right - self.left) / self.aspect;
        let at = |z: f32, x: f32, y: f32| Vec3A::new(-z * x, -z * y, z);
        let mut all = [Vec3A::ZERO; 8];
        for (i, z) in [(0, z_near), (4, z_far)] {
            all[i] = at(z, self.right, -half_height);
            all[i + 1] = at(z, self.right, half_height);
            all[i + 2] = at(z, self.left, half_height);
            all[i + 3] = at(z, self.left, -half_height);
        }
        all
    }
}

#[test]
fn two_eyes_with_a_gaze_each() {
    let half = UVec2::new(SIZE.x / 2, SIZE.y);
    let mut headless = Headless::new(SIZE, ScenePlugin { lamps: 4, moves: true });
    let targets = compared().map(|components| {
        let image = headless.add_target(SIZE);
        for (side, [left, right]) in [(0_u32, [-0.8, 0.5]), (1, [-0.5, 0.8])] {
            let target = RenderTarget::from(image.clone());
            let viewport =
                Viewport { physical_position: UVec2::new(side * half.x, 0), physical_size: half, ..default() };
            let projection = Projection::custom(Eye { left, right, aspect: 1.0 });
            let head = Transform::from_xyz(0.0, 1.7, 6.0);
            let gaze = CameraGaze { uv: Some(Vec2::new(if side == 0 { 0.62 } else { 0.38 }, 0.5)) };
            headless.app.world_mut().spawn((
                Camera3d::default(),
                Camera { order: side as isize, viewport: Some(viewport), ..default() },
                (projection, target, TONEMAPPING, Msaa::Off, components.clone(), gaze),
                head.with_translation(head.translation + Vec3::X * 0.064 * (side as f32 - 0.5)),
            ));
        }
        image
    });
    headless.frames(16);
    assert_eq!(headless.problems(), &[] as &[String]);
    let shots = targets.map(|target| headless.read_target(&target));
    let [blind, quads] = [&shots[1], &shots[2]].map(|shot| psnr_db(shot, &shots[0]));
    println!("two eyes: without history {blind:.2} dB, with {quads:.2} dB");
    assert!(quads > blind + 2.0, "without history {blind:.2} dB, with {quads:.2} dB");
}

#[test]
fn a_reset_discards_history_and_is_done_once() {
    let mut headless = courtyard((kind(FoveationKind::Quads), AfterimageStats::default()));
    let stats = |headless: &mut Headless| {
        // Counts arrive a few frames later.
        headless.frames(3);
        *headless.app.world_mut().query::<&AfterimageStats>().single(headless.app.world()).unwrap()
    };
    headless.frames(6);
    let before = stats(&mut headless);
    println!("{before:?}");
    assert_eq!(before.pixels, u64::from(SIZE.element_product()));
    assert!(before.kept + before.replaced > before.pixels / 2);
    let mut cameras = headless.app.world_mut().query::<&mut Afterimage>();
    // In several frames, because not all are counted.
    for _ in 0..6 {
        cameras.single_mut(headless.app.world_mut()).unwrap().reset = true;
        headless.frames(1);
        headless.wait();
        assert!(!cameras.single(headless.app.world()).unwrap().reset);
    }
    let during = *headless.app.world_mut().query::<&AfterimageStats>().single(headless.app.world()).unwrap();
    assert_eq!((during.kept, during.replaced), (0, 0), "{during:?}");
    headless.frames(6);
    let after = stats(&mut headless);
    assert!(after.kept + after.replaced > after.pixels / 2);
}

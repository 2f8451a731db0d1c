//! The fixtures equal the output of the commands that write them, and the library can read them.

use afterimage::{Image, ViewGeometry};
use afterimage_lab::source::exr_file::{self, FrameToWrite};
use afterimage_lab::source::{self, AnalyticSource, FrameSource, ReadLimits, SceneOptions};
use glam::{Mat4, Vec3};
use std::path::PathBuf;

fn folder() -> PathBuf {
    afterimage_testing::workspace().join("fixtures/sequences/lateral_160x90")
}
const SIZE: [u32; 2] = [160, 90];
const FRAMES: u64 = 6;

fn scene() -> AnalyticSource {
    AnalyticSource::new("lateral", SIZE, 70.0, 60.0).unwrap()
}

/// Motion to the next frame, next minus current, of a scene in which only the camera moves.
fn to_next(view: &ViewGeometry, depth: &Image<f32>, next_from_current: Mat4) -> Image<[f32; 2]> {
    Image::from_fn(SIZE, |[x, y]| {
        let px = [x as f32, y as f32];
        let z = depth.at(x as usize, y as usize).min(1e6);
        let point: Vec3 = next_from_current.transform_point3(Vec3::from(view.ray(px)) * z);
        let there = view.project(point.into()).expect("in front of the camera");
        [there[0] - px[0], there[1] - px[1]]
    })
}

#[test]
#[ignore = "writes fixtures/sequences"]
fn write_sequences() {
    std::fs::create_dir_all(folder()).unwrap();
    let mut scene = scene();
    let view = *scene.view();
    for index in 0..FRAMES {
        let frame = scene.frame(index).unwrap();
        let rows = scene.frame(index + 1).unwrap().previous_from_current.unwrap();
        let next_from_current = Mat4::from_cols_array_2d(&rows).transpose().inverse();
        let depth = frame.depth.unwrap();
        let next = to_next(&view, &depth, next_from_current);
        let (depth, motion, motion_to_next) = (Some(&depth), frame.motion.as_ref(), Some(&next));
        let frame = FrameToWrite { depth, motion, motion_to_next, ..FrameToWrite::color(&frame.color) };
        exr_file::write(&folder().join(format!("frame_{index:04}.exr")), &frame).unwrap();
    }
    let cameras = "{ \"width\": 160, \"height\": 90, \"fps\": 60.0, \"horizontal_fov_deg\": 70.0 }\n";
    std::fs::write(folder().join("cameras.json"), cameras).unwrap();
}

#[test]
fn the_sequence_is_what_the_scene_gives() {
    let mut fixture =
        source::open(folder().to_str().unwrap(), &ReadLimits::default(), &SceneOptions::default()).unwrap();
    let info = fixture.info().clone();
    let expected = (SIZE, Some(FRAMES), Some(60.0), Some(70.0), false);
    assert_eq!((info.size, info.frames, info.fps, info.hfov_deg, info.still), expected);
    let mut scene = scene();
    for index in 0..FRAMES {
        let (read, made) = (fixture.frame(index).unwrap(), scene.frame(index).unwrap());
        for (a, b) in read.color.pixels().as_flattened().iter().zip(made.color.pixels().as_flattened()) {
            assert!((a - b).abs() <= b.abs() / 2048.0 + 1e-7);
        }
        assert_eq!(read.depth, made.depth);
        assert_eq!(read.motion, made.motion);
    }
    // Backwards, the vectors to the next frame take over: the fifth frame after the sixth.
    let (back, forth) = (fixture.frame(FRAMES).unwrap(), scene.frame(FRAMES - 1).unwrap());
    let (back, forth) = (back.motion.unwrap(), forth.motion.unwrap());
    let opposite = |x: usize, y: usize| {
        let m = back.at(x, y);
        let (qx, qy) = ((x as f32 + m[0]).round() as usize, (y as f32 + m[1]).round() as usize);
        let f = forth.at(qx.min(159), qy.min(89));
        (m[0] + f[0]).abs() < 0.1
    };
    let agree = (0..90).flat_map(|y| (0..160).map(move |x| (x, y))).filter(|&(x, y)| opposite(x, y)).count();
    println!("backward and forward vectors cancel at {agree} of 14400 pixels");
    assert!(agree > 13_500);
}

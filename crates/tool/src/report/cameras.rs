//! Cameras of frames as a `cameras.json`, which `run` reads with the frames and `--camera` accepts.

use glam::DMat4;
use serde::Serialize;

#[derive(Serialize)]
struct CamerasJson {
    width: u32,
    height: u32,
    fps: f32,
    horizontal_fov_deg: f32,
    frames: Vec<CameraJson>,
}

#[derive(Serialize)]
struct CameraJson {
    frame: usize,
    camera_to_world: [[f64; 4]; 4],
}

/// The file, with z up, from camera-to-world matrices in the scene's axes.
pub fn cameras_json(size: [u32; 2], fps: f32, hfov_deg: f32, poses: impl Iterator<Item = DMat4>) -> String {
    let frames = poses.enumerate().map(|(frame, pose)| {
        let m = pose.transpose().to_cols_array_2d();
        // The scene's (x, y, z) is the file's (x, -z, y).
        CameraJson { frame, camera_to_world: [m[0], m[2].map(|v| -v), m[1], m[3]] }
    });
    let cameras =
        CamerasJson { width: size[0], height: size[1], fps, horizontal_fov_deg: hfov_deg, frames: frames.collect() };
    serde_json::to_string_pretty(&cameras).expect("numbers and lists only") + "\n"
}

//! `afterimage info` of a camera file.

use afterimage_lab::error::InputError;
use afterimage_lab::scene::camera_file::CameraFile;
use std::path::Path;

/// Whether an input is a camera file, by its ending.
pub fn is_camera_file(input: &str) -> bool {
    input.to_lowercase().ends_with(".json") || CameraFile::is_colmap(Path::new(input))
}

/// Describes a camera file.
pub fn camera_info(input: &str) -> Result<(), InputError> {
    let file = CameraFile::open(Path::new(input))?;
    let known = |v: Option<f32>| v.map_or("not stated".to_owned(), |v| v.to_string());
    let first = file.world_from_camera(0, 0.0);
    let three = |v: [f64; 3]| v.map(|v| format!("{:.4}", v + 0.0)).join(", ");
    say!("camera file: {}", file.kind());
    match file.frames() {
        Some(n) => say!("frames: {n}{}", if file.is_still() { ", all alike" } else { "" }),
        None => say!("frames: any number, between keyframes"),
    }
    say!("frames per second: {}", known(file.fps));
    say!("horizontal field of view, degrees: {}", known(file.hfov_deg));
    say!("first camera, m, in the scene's axes (y up): {}", three(first.w_axis.truncate().to_array()));
    say!("it looks along: {}", three((-first.z_axis).truncate().to_array()));
    say!("use it with --camera {input}, and a scene");
    Ok(())
}

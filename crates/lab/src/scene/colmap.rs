//! COLMAP's `images.txt` and `cameras.txt` as poses in Blender's axes: its world, which comes with y down, is turned to
//! z up.

use super::camera_forms::{FileForm, FrameForm, angle_deg};
use glam::{DMat3, DMat4, DQuat, DVec3};

/// Reads the poses of `images`, in the order of the images' names, and the field of view of the first one's camera in
/// `cameras`, if this file is there.
///
/// # Errors
/// What is wrong with the first of them.
pub(super) fn read(images: &str, cameras: Option<&str>) -> Result<FileForm, String> {
    let mut poses = Vec::new();
    let mut lines = images.lines().enumerate().filter(|(_, line)| !line.trim_start().starts_with('#'));
    while let Some((number, line)) = lines.next() {
        if line.trim().is_empty() {
            continue;
        }
        let image = image(line).ok_or_else(|| {
            let line = number + 1;
            format!("has in line {line} no IMAGE_ID QW QX QY QZ TX TY TZ CAMERA_ID NAME, as COLMAP's images.txt has")
        })?;
        poses.push(image);
        // The points of the image, which may be none.
        lines.next();
    }
    poses.sort_by(|a, b| a.name.cmp(b.name));
    let of_first = poses.first().and_then(|first| {
        let cameras = cameras?.lines().map(|line| line.split_whitespace().collect::<Vec<_>>());
        cameras.into_iter().find(|words| words.first() == Some(&first.camera))
    });
    Ok(FileForm {
        kind: "images.txt of COLMAP",
        size: None,
        fps: None,
        hfov_deg: of_first.and_then(|words| hfov_deg(&words)),
        frames: poses.iter().map(|p| FrameForm { camera_to_world: Some(p.pose), ..FrameForm::default() }).collect(),
    })
}

struct ImagePose<'a> {
    camera: &'a str,
    name: &'a str,
    pose: DMat4,
}

fn image(line: &str) -> Option<ImagePose<'_>> {
    let words: Vec<&str> = line.split_whitespace().collect();
    let [_, qw, qx, qy, qz, tx, ty, tz, camera, name, ..] = words[..] else { return None };
    let number = |text: &str| text.parse::<f64>().ok().filter(|v| v.is_finite());
    let q = DQuat::from_xyzw(number(qx)?, number(qy)?, number(qz)?, number(qw)?);
    let t = DVec3::new(number(tx)?, number(ty)?, number(tz)?);
    if q.length() < 1e-6 {
        return None;
    }
    // World to camera; axes of the camera: x right, y down, z ahead.
    let to_world = DMat3::from_quat(q.normalize()).transpose();
    let up = DMat3::from_cols(DVec3::X, DVec3::NEG_Z, DVec3::Y);
    let axes = up * to_world * DMat3::from_diagonal(DVec3::new(1.0, -1.0, -1.0));
    let at = up * (to_world * -t);
    let pose =
        DMat4::from_cols(axes.x_axis.extend(0.0), axes.y_axis.extend(0.0), axes.z_axis.extend(0.0), at.extend(1.0));
    Some(ImagePose { camera, name, pose })
}

/// Of `CAMERA_ID MODEL WIDTH HEIGHT PARAMS...`; `None` for fisheyes. Focal lengths come first in all models.
fn hfov_deg(words: &[&str]) -> Option<f64> {
    let [_, model, width, _, focal, ..] = words[..] else { return None };
    let [width, focal] = [width, focal].map(|text| text.parse::<f64>().ok());
    Some(angle_deg(width? / (2.0 * focal?))).filter(|_| !model.contains("FISHEYE") && model != "FOV")
}

#[cfg(test)]
mod tests {
    use super::*;

    const CAMERAS: &str = "# CAMERA_ID, MODEL, WIDTH, HEIGHT, PARAMS[]\n2 PINHOLE 100 50 1 1 50 25\n\
        1 SIMPLE_RADIAL 100 50 86.60254037844387 50 25 0.1\n";
    /// A camera at (1, 2, 3) in COLMAP's world that looks along +x, with y down: its z is the world's x.
    const IMAGES: &str = "# IMAGE_ID, QW, QX, QY, QZ, TX, TY, TZ, CAMERA_ID, NAME\n\
        2 0.7071067811865476 0 -0.7071067811865476 0 3 -2 -1 1 b.jpg\n1.5 2.5 -1\n\
        7 1 0 0 0 0 0 0 1 a.jpg\n\n";

    #[test]
    fn cameras_look_ahead_with_y_down() {
        let file = read(IMAGES, Some(CAMERAS)).unwrap();
        assert!((file.hfov_deg.unwrap() - 60.0).abs() < 1e-9);
        let poses: Vec<DMat4> = file.frames.iter().map(|f| f.camera_to_world.unwrap()).collect();
        // By name: the identity looks along COLMAP's z, which is Blender's y, and its up is Blender's z.
        let columns = |m: &DMat4| [m.x_axis, m.y_axis, -m.z_axis, m.w_axis].map(|c| c.truncate());
        let near = |a: [DVec3; 4], b: [DVec3; 4]| a.iter().zip(b).all(|(a, b)| a.abs_diff_eq(b, 1e-9));
        assert!(near(columns(&poses[0]), [DVec3::X, DVec3::Z, DVec3::Y, DVec3::ZERO]), "{:?}", poses[0]);
        let at = DVec3::new(1.0, 3.0, -2.0);
        assert!(near(columns(&poses[1]), [DVec3::NEG_Y, DVec3::Z, DVec3::X, at]), "{:?}", poses[1]);
        // Planted: the quaternion as camera to world, and another camera.
        let turned = IMAGES.replace(" -0.7071067811865476", " 0.7071067811865476");
        assert!(!near(columns(&read(&turned, None).unwrap().frames[1].camera_to_world.unwrap()), columns(&poses[1])));
        let other = read(&IMAGES.replace("1 a.jpg", "2 a.jpg"), Some(CAMERAS)).unwrap();
        assert!(other.hfov_deg.unwrap() > 170.0);
        let fisheye = CAMERAS.replace("SIMPLE_RADIAL", "OPENCV_FISHEYE");
        assert_eq!(read(IMAGES, Some(&fisheye)).unwrap().hfov_deg, None);
    }

    #[test]
    fn lines_of_another_kind_are_refused_by_number() {
        for bad in ["1 PINHOLE 100 50 1 1 50 25\n", "1 0 0 0 0 0 0 0 1 a\n", "1 nan 0 0 0 0 0 0 1 a\n"] {
            assert!(read(bad, None).err().unwrap().contains("line 1"), "{bad}");
        }
    }
}

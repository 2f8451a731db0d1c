//! Camera files of this project and of others, in one form: poses in Blender's axes (z up), cameras that look along -z.
//!
//! `docs/cameras.md` states axes, layout and units of each.

use glam::{DMat4, DVec3, DVec4};
use serde::Deserialize;
use serde_json::Value;

/// A camera file.
pub(super) struct FileForm {
    /// What it is.
    pub kind: &'static str,
    pub size: Option<[u32; 2]>,
    pub fps: Option<f64>,
    /// Horizontal field of view in degrees, not checked.
    pub hfov_deg: Option<f64>,
    pub frames: Vec<FrameForm>,
}

/// A camera, not checked.
#[derive(Default)]
pub(super) struct FrameForm {
    pub frame: Option<i64>,
    pub camera_to_world: Option<DMat4>,
    pub world_to_camera: Option<DMat4>,
}

/// What a file may be, for errors.
pub(super) const EXPECTED: &str = "expected a cameras.json {fps, horizontal_fov_deg, width, height, frames: [{frame, \
    camera_to_world, world_to_camera}]}, all optional, a transforms.json of NeRF, a camera path of nerfstudio, or the \
    cameras.json of 3D Gaussian splatting";

#[derive(Deserialize)]
struct OwnForm {
    width: Option<u32>,
    height: Option<u32>,
    fps: Option<f64>,
    horizontal_fov_deg: Option<f64>,
    #[serde(default)]
    frames: Vec<OwnFrame>,
}

#[derive(Deserialize)]
struct OwnFrame {
    frame: Option<i64>,
    camera_to_world: Option<Value>,
    world_to_camera: Option<Value>,
}

/// NeRF, instant-ngp and nerfstudio. Intrinsics may stand at the top or at each frame.
#[derive(Deserialize)]
struct NerfForm {
    frames: Vec<NerfFrame>,
    #[serde(flatten)]
    lens: Lens,
}

#[derive(Deserialize)]
struct NerfFrame {
    transform_matrix: Value,
    #[serde(flatten)]
    lens: Lens,
}

#[derive(Deserialize)]
struct Lens {
    /// Radians.
    camera_angle_x: Option<f64>,
    /// Pixels.
    fl_x: Option<f64>,
    w: Option<f64>,
    camera_model: Option<String>,
}

impl Lens {
    fn hfov_deg(&self) -> Option<f64> {
        if self.camera_model.as_ref().is_some_and(|model| model.contains("FISHEYE") || model.contains("EQUIRECT")) {
            return None;
        }
        let of_focal_length = || Some(angle_deg(self.w? / (2.0 * self.fl_x?)));
        self.camera_angle_x.map(f64::to_degrees).or_else(of_focal_length)
    }
}

/// A rendered path of nerfstudio's viewer.
#[derive(Deserialize)]
struct PathForm {
    camera_type: Option<String>,
    render_width: Option<f64>,
    render_height: Option<f64>,
    fps: Option<f64>,
    camera_path: Vec<PathFrame>,
}

#[derive(Deserialize)]
struct PathFrame {
    camera_to_world: Value,
    /// Vertical, degrees.
    fov: Option<f64>,
    aspect: Option<f64>,
}

/// A camera of 3D Gaussian splatting: axes x right, y down, z ahead, in the columns of `rotation`.
#[derive(Deserialize)]
struct SplatCamera {
    id: Option<i64>,
    position: [f64; 3],
    rotation: [[f64; 3]; 3],
    width: Option<f64>,
    fx: Option<f64>,
}

/// Reads a file's JSON.
///
/// # Errors
/// What is wrong with it.
pub(super) fn read(value: Value) -> Result<FileForm, String> {
    let unexpected = |e: serde_json::Error| format!("is not the expected JSON ({e})");
    let has = |list: &str, key: &str| value.get(list).and_then(|frames| frames.get(0)?.get(key)).is_some();
    if value.is_array() {
        serde_json::from_value(value).map_err(unexpected).map(splat)
    } else if value.get("camera_path").is_some() {
        serde_json::from_value(value).map_err(unexpected).and_then(path)
    } else if has("frames", "transform_matrix") {
        serde_json::from_value(value).map_err(unexpected).and_then(nerf)
    } else {
        serde_json::from_value(value).map_err(unexpected).and_then(own)
    }
}

fn own(form: OwnForm) -> Result<FileForm, String> {
    let frame = |(i, frame): (usize, &OwnFrame)| {
        let number = frame.frame.unwrap_or(i as i64);
        let load = |name: &str, value: &Option<Value>| {
            value.as_ref().map(|value| matrix(value).ok_or_else(|| no_matrix(name, number))).transpose()
        };
        Ok(FrameForm {
            frame: frame.frame,
            camera_to_world: load("camera_to_world", &frame.camera_to_world)?,
            world_to_camera: load("world_to_camera", &frame.world_to_camera)?,
        })
    };
    Ok(FileForm {
        kind: "cameras.json",
        size: form.width.zip(form.height).map(|(w, h)| [w, h]),
        fps: form.fps,
        hfov_deg: form.horizontal_fov_deg,
        frames: form.frames.iter().enumerate().map(frame).collect::<Result<_, String>>()?,
    })
}

fn nerf(form: NerfForm) -> Result<FileForm, String> {
    let frames = form.frames.iter().map(|frame| &frame.transform_matrix);
    Ok(FileForm {
        kind: "transforms.json of NeRF",
        size: None,
        fps: None,
        hfov_deg: form.lens.hfov_deg().or_else(|| form.frames.first()?.lens.hfov_deg()),
        frames: posed("transform_matrix", frames)?,
    })
}

fn path(form: PathForm) -> Result<FileForm, String> {
    let hfov_deg = form.camera_path.first().and_then(|first| {
        let aspect = form.render_width.zip(form.render_height).map(|(w, h)| w / h).or(first.aspect)?;
        let is_flat = form.camera_type.as_ref().is_none_or(|kind| kind == "perspective");
        let half = (0.5 * first.fov.filter(|_| is_flat)?.to_radians()).tan();
        Some(angle_deg(half * aspect))
    });
    let frames = form.camera_path.iter().map(|frame| &frame.camera_to_world);
    Ok(FileForm {
        kind: "camera path of nerfstudio",
        size: None,
        fps: form.fps,
        hfov_deg,
        frames: posed("camera_to_world", frames)?,
    })
}

fn splat(cameras: Vec<SplatCamera>) -> FileForm {
    let hfov_deg = cameras.first().and_then(|first| Some(angle_deg(first.width? / (2.0 * first.fx?))));
    let frame = |camera: SplatCamera| {
        // The camera's y and z are ours, turned round.
        let column = |i: usize, sign: f64| (sign * DVec3::from(camera.rotation.map(|row| row[i]))).extend(0.0);
        let position = DVec3::from(camera.position).extend(1.0);
        let pose = DMat4::from_cols(column(0, 1.0), column(1, -1.0), column(2, -1.0), position);
        FrameForm { frame: camera.id, camera_to_world: Some(pose), world_to_camera: None }
    };
    FileForm {
        kind: "cameras.json of 3D Gaussian splatting",
        size: None,
        fps: None,
        hfov_deg,
        frames: cameras.into_iter().map(frame).collect(),
    }
}

fn posed<'a>(name: &str, matrices: impl Iterator<Item = &'a Value>) -> Result<Vec<FrameForm>, String> {
    let frame = |(i, value): (usize, &Value)| {
        let camera_to_world = Some(matrix(value).ok_or_else(|| no_matrix(name, i as i64))?);
        Ok(FrameForm { camera_to_world, ..FrameForm::default() })
    };
    matrices.enumerate().map(frame).collect()
}

fn no_matrix(name: &str, frame: i64) -> String {
    format!("has a {name} of frame {frame} that is not 4 or 3 rows of 4 numbers")
}

/// Twice the angle in degrees of a tangent.
pub(super) fn angle_deg(tangent: f64) -> f64 {
    2.0 * tangent.atan().to_degrees()
}

/// A matrix for column vectors, row by row: 3 or 4 rows of 4 numbers, or the same numbers in one list.
fn matrix(value: &Value) -> Option<DMat4> {
    let list = value.as_array()?;
    let numbers: Vec<f64> = if list.first()?.is_array() {
        let rows: Vec<&Vec<Value>> = list.iter().map(Value::as_array).collect::<Option<_>>()?;
        if rows.iter().any(|row| row.len() != 4) {
            return None;
        }
        rows.into_iter().flatten().map(Value::as_f64).collect::<Option<_>>()?
    } else {
        list.iter().map(Value::as_f64).collect::<Option<_>>()?
    };
    let row = |i: usize| DVec4::from_slice(&numbers[4 * i..4 * i + 4]);
    let last = match numbers.len() {
        12 => DVec4::W,
        16 => row(3),
        _ => return None,
    };
    Some(DMat4::from_cols(row(0), row(1), row(2), last).transpose())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::camera_file::CameraFile;

    /// The camera of all files: at (1, -4, 2) in Blender's axes, turned by 0.3 rad about z and looking down by a tenth.
    const ROWS: [[f64; 4]; 3] = [
        [0.955336489125606, -0.029404, 0.294047, 1.0],
        [0.295520206661340, 0.095058, -0.950570, -4.0],
        [0.0, 0.995037190209989, 0.099503719020999, 2.0],
    ];
    const HFOV_DEG: f64 = 60.0;

    /// The pose from [`ROWS`], exactly rigid.
    fn pose() -> DMat4 {
        let x = DVec3::new(ROWS[0][0], ROWS[1][0], 0.0).normalize();
        let z = DVec3::new(ROWS[0][2], ROWS[1][2], ROWS[2][2]);
        let z = (z - x * z.dot(x)).normalize();
        let at = DVec3::new(ROWS[0][3], ROWS[1][3], ROWS[2][3]);
        DMat4::from_cols(x.extend(0.0), z.cross(x).extend(0.0), z.extend(0.0), at.extend(1.0))
    }

    fn rows(m: DMat4, count: usize) -> String {
        let rows: Vec<_> = m.transpose().to_cols_array_2d()[..count].iter().map(|row| format!("{row:?}")).collect();
        format!("[{}]", rows.join(","))
    }

    fn flat(m: DMat4) -> String {
        format!("{:?}", m.transpose().to_cols_array())
    }

    /// A pose in the form of this project.
    fn own(matrix: &str) -> String {
        format!(r#"{{"horizontal_fov_deg":60,"frames":[{{"camera_to_world":{matrix}}}]}}"#)
    }

    /// A pose in NeRF's form, with `lens` at the top and at the frame.
    fn nerf(lens: [&str; 2], matrix: &str) -> String {
        let [top, frame] = lens;
        format!(r#"{{{top}"frames":[{{{frame}"file_path":"./r_0","transform_matrix":{matrix}}}]}}"#)
    }

    /// A pose in nerfstudio's form, with `fields` at the top.
    fn path(fields: &str, matrix: &str, aspect: f64) -> String {
        let vertical = 2.0 * ((0.5 * HFOV_DEG).to_radians().tan() * 180.0 / 320.0).atan().to_degrees();
        format!(r#"{{{fields}"camera_path":[{{"camera_to_world":{matrix},"fov":{vertical},"aspect":{aspect}}}]}}"#)
    }

    fn splat(focal: f64) -> String {
        let turned = (pose() * DMat4::from_scale(DVec3::new(1.0, -1.0, -1.0))).transpose().to_cols_array_2d();
        let rotation: Vec<_> = turned[..3].iter().map(|row| format!("{:?}", &row[..3])).collect();
        let rotation = rotation.join(",");
        format!(
            r#"[{{"id":0,"width":640,"height":360,"position":[1,-4,2],"rotation":[{rotation}],"fx":{focal},"fy":1}}]"#
        )
    }

    const RENDERED: &str = r#""camera_type":"perspective","render_height":180,"render_width":320,"fps":24,
        "keyframes":[{"matrix":"[1]","fov":9}],"#;

    /// The same camera in every form.
    fn files() -> Vec<(&'static str, String)> {
        const NERF: &str = "transforms.json of NeRF";
        const STUDIO: &str = "camera path of nerfstudio";
        let m = pose();
        let focal = 320.0 / (0.5 * HFOV_DEG).to_radians().tan();
        let scaled = m * DMat4::from_scale(DVec3::splat(2.0));
        let stretched = m * DMat4::from_scale(DVec3::new(1.0, 3.0, 0.5));
        let angle = format!(r#""camera_angle_x":{},"#, HFOV_DEG.to_radians());
        let pixels = format!(r#""fl_x":{focal},"fl_y":1,"w":640,"aabb_scale":4,"camera_model":"OPENCV","#);
        vec![
            ("cameras.json", own(&rows(m, 4))),
            ("cameras.json", own(&rows(m, 3))),
            ("cameras.json", own(&flat(m))),
            ("cameras.json", own(&rows(scaled, 4))),
            ("cameras.json", own(&rows(stretched, 4))),
            ("cameras.json", own(&rows(scaled.inverse(), 4)).replace("camera_to_world", "world_to_camera")),
            (NERF, nerf([&angle, ""], &rows(m, 4))),
            (NERF, nerf([&pixels, ""], &rows(m, 3))),
            (NERF, nerf(["", &pixels], &rows(scaled, 4))),
            (STUDIO, path(RENDERED, &flat(m), 1.5)),
            (STUDIO, path("", &rows(m, 4), 320.0 / 180.0)),
            ("cameras.json of 3D Gaussian splatting", splat(focal)),
        ]
    }

    /// Whether a file is the camera, in the scene's axes (x, z, -y).
    fn is_the_camera(text: &str) -> Result<bool, String> {
        let file = CameraFile::parse("c.json", text.as_bytes()).map_err(|e| e.to_string())?;
        let turn = DMat4::from_rotation_x(-std::f64::consts::FRAC_PI_2);
        let is_there = file.world_from_camera(0, 0.0).abs_diff_eq(turn * pose(), 1e-9);
        Ok(is_there && file.hfov_deg.is_some_and(|deg| (f64::from(deg) - HFOV_DEG).abs() < 1e-4))
    }

    #[test]
    fn every_form_is_the_same_camera() {
        for (kind, text) in files() {
            assert_eq!(is_the_camera(&text), Ok(true), "{text}");
            assert_eq!(CameraFile::parse("c.json", text.as_bytes()).unwrap().kind(), kind);
            assert_eq!(is_the_camera(&format!("\u{feff}{text}")), Ok(true), "a byte order mark");
        }
    }

    #[test]
    fn other_axes_layouts_and_units_are_another_camera() {
        let all = files();
        let of = |kind: &str| all.iter().find(|file| file.0 == kind).unwrap().1.clone();
        let splat = of("cameras.json of 3D Gaussian splatting");
        let path = of("camera path of nerfstudio");
        let turned = splat.split_once("\"rotation\":").unwrap().1.split_once(",\"fx\"").unwrap().0.to_owned();
        let rotation: Vec<_> =
            pose().transpose().to_cols_array_2d()[..3].iter().map(|row| format!("{:?}", &row[..3])).collect();
        for planted in [
            // The camera's axes are OpenGL's.
            splat.replace(&turned, &format!("[{}]", rotation.join(","))),
            of("transforms.json of NeRF").replace("camera_angle_x", "camera_angle_y"),
            path.replace("\"render_width\":320", "\"render_width\":180"),
            // Radians for degrees.
            of("cameras.json").replace("_deg\":60", "_deg\":1.0472"),
        ] {
            assert_eq!(is_the_camera(&planted), Ok(false), "{planted}");
        }
        // Column by column, as three.js has it, the last row is a translation.
        let columns = path.replace(&flat(pose()), &format!("{:?}", pose().to_cols_array()));
        assert!(is_the_camera(&columns).unwrap_err().contains("last row"));
    }

    #[test]
    fn files_without_cameras_say_what_is_missing() {
        for (text, word) in [
            ("[]", "has no camera"),
            ("[1]", "is not the expected JSON"),
            (r#"[{"position":[0,0],"rotation":[]}]"#, "is not the expected JSON"),
            (r#"{"camera_path":[]}"#, "has no camera"),
            (r#"{"keyframes":[{"matrix":"[1]","fov":50}]}"#, "camera_path"),
            (
                r#"{"frames":[{"transform_matrix":[[1,0],[0,1]]}]}"#,
                "transform_matrix of frame 0 that is not 4 or 3 rows",
            ),
            (r#"{"frames":[{"transform_matrix":[[1,0,0,0],[0,1,0,0],[0,0,"a",0]]}]}"#, "transform_matrix of frame 0"),
            (
                r#"{"camera_angle_x":4,"frames":[{"transform_matrix":[1,0,0,0,0,1,0,0,0,0,1,0]}]}"#,
                "horizontal field of view is 229",
            ),
            (r#"{"frames":[{"transform_matrix":[0,0,0,0,0,0,0,0,0,0,0,0]}]}"#, "no camera has"),
            (r#"{"path":[{"R":[0,0,0,1],"T":[0,0,0]}],"time":1}"#, "has no camera"),
            ("{}", "has no camera"),
            ("3", "is not the expected JSON"),
        ] {
            let error = CameraFile::parse("c.json", text.as_bytes()).unwrap_err().to_string();
            assert!(error.contains(word) && !error.contains('\n'), "{text}: {error}");
            assert!(["nerfstudio", "rotation", "correct"].iter().any(|w| error.contains(w)), "{error}");
        }
    }
}

//! `cameras.json`: frame rate, field of view and camera poses of a sequence.

use super::camera_forms::{self, EXPECTED, FileForm, FrameForm};
use crate::error::{Bound, Exceeded, InputError, io_error, one_line};
use glam::{DMat3, DMat4, DVec3};
use std::fs;
use std::path::Path;

/// Name of the file in the folder of the frames.
pub const FILE_NAME: &str = "cameras.json";

/// Largest file size in bytes: 100,000 frames with every field take less.
const MAX_BYTES: u64 = 256 << 20;

/// Tolerance for orthonormality of a rotation, and for a pair of matrices being inverse to each other. Rounding to
/// eight digits errs by 1e-8; a scaled or sheared camera by far more than this tolerance.
const RIGID_TOLERANCE: f64 = 1e-3;

#[derive(Clone, Copy, Debug)]
struct Pose {
    world_from_camera: DMat4,
    camera_from_world: DMat4,
}

/// Contents of a `cameras.json`. Absent fields are `None`.
#[derive(Clone, Debug)]
pub struct Cameras {
    /// Frames per second, above 0.
    pub fps: Option<f32>,
    /// Horizontal field of view in degrees, above 0 and below 180.
    pub hfov_deg: Option<f32>,
    /// What the file is.
    pub(crate) kind: &'static str,
    subject: String,
    size: Option<[u32; 2]>,
    numbers: Vec<Option<i64>>,
    poses: Vec<Pose>,
}

impl Cameras {
    /// Reads `folder/cameras.json`; `None` without such a file.
    ///
    /// # Errors
    /// [`Io`](InputError::Io) if the file cannot be read, [`Limit`](InputError::Limit) if it is too large,
    /// [`Invalid`](InputError::Invalid) if it is not JSON of the expected form or has numbers out of range.
    pub fn beside(folder: &Path) -> Result<Option<Self>, InputError> {
        let path = folder.join(FILE_NAME);
        match fs::metadata(&path) {
            Err(e) if e.kind() == std::io::ErrorKind::NotFound => Ok(None),
            _ => {
                let subject = path.display().to_string();
                Self::parse(&subject, &read(&path)?).map(Some)
            }
        }
    }

    pub(crate) fn parse(subject: &str, text: &[u8]) -> Result<Self, InputError> {
        let error = |problem: String| InputError::invalid(subject, one_line(&problem), EXPECTED);
        let text = text.strip_prefix(b"\xef\xbb\xbf").unwrap_or(text);
        let value = serde_json::from_slice(text).map_err(|e| error(format!("is not the expected JSON ({e})")))?;
        Self::of(subject, camera_forms::read(value).map_err(error)?)
    }

    /// Checks what a file says.
    pub(super) fn of(subject: &str, form: FileForm) -> Result<Self, InputError> {
        let in_range = |name: &str, value: Option<f64>, max: f64| match value {
            Some(v) if !(v > 0.0 && v < max) => Err(InputError::invalid(
                subject,
                format!("its {name} is {v}"),
                format!("expected a number above 0 and below {max}; correct or remove it"),
            )),
            other => Ok(other.map(|v| v as f32)),
        };
        let mut poses = Vec::new();
        for (i, frame) in form.frames.iter().enumerate() {
            let number = frame.frame.unwrap_or(i as i64);
            poses.extend(pose(subject, number, frame)?);
        }
        if !poses.is_empty() && poses.len() != form.frames.len() {
            return Err(InputError::invalid(
                subject,
                format!("has matrices for {} of its {} frames", poses.len(), form.frames.len()),
                "expected camera_to_world for every frame, or for none",
            ));
        }
        Ok(Self {
            fps: in_range("fps", form.fps, 100_000.0)?,
            hfov_deg: in_range("horizontal field of view", form.hfov_deg, 180.0)?,
            kind: form.kind,
            subject: subject.to_owned(),
            size: form.size,
            numbers: form.frames.iter().map(|f| f.frame).collect(),
            poses,
        })
    }

    /// Camera-to-world matrix of every frame, in the file's axes.
    pub(crate) fn world_from_camera(&self) -> impl ExactSizeIterator<Item = DMat4> {
        self.poses.iter().map(|p| p.world_from_camera)
    }

    /// Checks that the images have the size that the file states, if it states one.
    pub(crate) fn check_size(&self, size: [u32; 2]) -> Result<(), InputError> {
        match self.size {
            Some(s) if s != size => Err(InputError::invalid(
                &self.subject,
                format!("states {}x{} pixels but the frames have {}x{}", s[0], s[1], size[0], size[1]),
                "use the file that belongs to these frames, or remove width and height from it",
            )),
            _ => Ok(()),
        }
    }

    /// Index of the pose of every frame: by the number in the frame's file name, or in order if a pose or a file has no
    /// number. `None` without matrices.
    pub(crate) fn assign(&self, file_numbers: &[Option<i64>]) -> Result<Option<Vec<usize>>, InputError> {
        if self.poses.is_empty() {
            return Ok(None);
        }
        if self.numbers.iter().chain(file_numbers).all(Option::is_some) {
            let find = |n: &Option<i64>| {
                self.numbers.iter().position(|m| m == n).ok_or_else(|| {
                    InputError::invalid(
                        &self.subject,
                        format!("has no camera for frame {}", n.unwrap_or_default()),
                        "expected one for every file; use the file that belongs to these frames, or remove it",
                    )
                })
            };
            return file_numbers.iter().map(find).collect::<Result<_, _>>().map(Some);
        }
        if self.poses.len() == file_numbers.len() {
            return Ok(Some((0..self.poses.len()).collect()));
        }
        Err(InputError::invalid(
            &self.subject,
            format!("has {} cameras for {} files", self.poses.len(), file_numbers.len()),
            "expected one for every file, or numbers in both the file names and `frame`",
        ))
    }

    /// Matrix from the view space of pose `current` to that of `previous`; row-major; x right, y down, z forward.
    pub(crate) fn previous_from_current(&self, previous: usize, current: usize) -> [[f32; 4]; 4] {
        // The file's cameras have y up and look along -z; the flip is its own inverse.
        let flip = DMat4::from_scale(DVec3::new(1.0, -1.0, -1.0));
        let matrix = flip * self.poses[previous].camera_from_world * self.poses[current].world_from_camera * flip;
        matrix.transpose().to_cols_array_2d().map(|row| row.map(|v| v as f32))
    }
}

/// Reads a camera file of at most [`MAX_BYTES`].
pub(crate) fn read(path: &Path) -> Result<Vec<u8>, InputError> {
    let subject = path.display().to_string();
    let bytes = fs::metadata(path).map_err(|e| io_error(&subject, &e))?.len();
    if bytes > MAX_BYTES {
        return Err(InputError::limit(
            Exceeded { bound: Bound::Fixed, needed: Some(bytes), allowed: MAX_BYTES },
            &subject,
            format!("has {} MB, above the limit of {} MB", bytes >> 20, MAX_BYTES >> 20),
            "expected fps, horizontal_fov_deg and two matrices for each frame; remove the rest",
        ));
    }
    fs::read(path).map_err(|e| io_error(&subject, &e))
}

fn pose(subject: &str, number: i64, frame: &FrameForm) -> Result<Option<Pose>, InputError> {
    let (Some(pose), name) = (match (frame.camera_to_world, frame.world_to_camera) {
        (None, Some(m)) => (Some(m.inverse()), "world_to_camera"),
        (pose, _) => (pose, "camera_to_world"),
    }) else {
        return Ok(None);
    };
    let world_from_camera = rigid(pose).map_err(|why| {
        InputError::invalid(
            subject,
            format!("{name} of frame {number} {why}"),
            "expected a rotation and a translation, row by row, for column vectors",
        )
    })?;
    if let (Some(a), Some(b)) = (frame.camera_to_world, frame.world_to_camera) {
        let distance = a.w_axis.truncate().length();
        if !(a * b).abs_diff_eq(DMat4::IDENTITY, RIGID_TOLERANCE * (1.0 + distance)) {
            return Err(InputError::invalid(
                subject,
                format!("camera_to_world and world_to_camera of frame {number} are not inverse to each other"),
                "correct one of them, or remove it",
            ));
        }
    }
    let stated = frame.world_to_camera.filter(|_| pose == world_from_camera);
    Ok(Some(Pose { world_from_camera, camera_from_world: stated.unwrap_or_else(|| world_from_camera.inverse()) }))
}

/// A pose without the scale of its axes, which moves no pixel; the error says why no camera has it.
fn rigid(m: DMat4) -> Result<DMat4, &'static str> {
    let rotation = DMat3::from_mat4(m);
    if !m.is_finite() {
        return Err("is not finite");
    }
    if m.row(3).to_array() != [0.0, 0.0, 0.0, 1.0] {
        return Err("has a last row other than 0 0 0 1");
    }
    let is_rigid = |r: DMat3| (r.transpose() * r).abs_diff_eq(DMat3::IDENTITY, RIGID_TOLERANCE);
    let axes = [rotation.x_axis, rotation.y_axis, rotation.z_axis].map(DVec3::try_normalize);
    let [Some(x), Some(y), Some(z)] = axes else {
        return Err("has an axis of length 0, as no camera has");
    };
    let unscaled = DMat3::from_cols(x, y, z);
    if !is_rigid(unscaled) {
        return Err("shears");
    }
    if unscaled.determinant() < 0.0 {
        return Err("mirrors");
    }
    if is_rigid(rotation) {
        return Ok(m);
    }
    Ok(DMat4::from_cols(x.extend(0.0), y.extend(0.0), z.extend(0.0), m.w_axis))
}

#[cfg(test)]
mod tests {
    use super::*;

    const TURN: &str = "[[0,-1,0,2],[1,0,0,3],[0,0,1,4],[0,0,0,1]]";

    fn parse(frames: &str) -> Result<Cameras, InputError> {
        Cameras::parse("c.json", format!(r#"{{"frames":[{frames}]}}"#).as_bytes())
    }

    #[test]
    fn one_matrix_is_enough_and_none_is_fine() {
        let c = parse(&format!(r#"{{"camera_to_world":{TURN}}}"#)).unwrap();
        let d = parse(&format!(r#"{{"world_to_camera":{TURN}}}"#)).unwrap();
        let product = c.poses[0].world_from_camera * d.poses[0].world_from_camera;
        assert!(product.abs_diff_eq(DMat4::IDENTITY, 1e-12));
        assert!(parse("{}").unwrap().assign(&[None]).unwrap().is_none());
    }

    #[test]
    fn matrices_that_no_camera_has_are_refused() {
        for (bad, word) in [
            ("[[1,0.2,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]]", "shears"),
            ("[[1,0,0,0],[0,0,0,0],[0,0,1,0],[0,0,0,1]]", "length 0"),
            ("[[1,0,0,0],[0,1,0],[0,0,1,0],[0,0,0,1]]", "rows of 4 numbers"),
            ("[[-1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]]", "mirrors"),
            ("[[1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,1,0]]", "last row"),
            ("[[1,0,0,1e308],[0,1,0,0],[0,0,1,0],[0,0,0,1e400]]", "JSON"),
        ] {
            let e = parse(&format!(r#"{{"camera_to_world":{bad}}}"#)).unwrap_err();
            assert!(e.to_string().contains(word), "{e}");
        }
        let both = format!(r#"{{"camera_to_world":{TURN},"world_to_camera":{TURN}}}"#);
        let e = parse(&both).unwrap_err().to_string();
        assert!(e.contains("not inverse"), "{e}");
    }

    #[test]
    fn moving_forward_in_blender_axes_moves_the_scene_towards_the_eye() {
        // The camera looks along -z: at z = -1 it is one unit further on. A point 5 ahead of it was 6 ahead before.
        let at = |z: f64| format!(r#"{{"camera_to_world":[[1,0,0,0],[0,1,0,0],[0,0,1,{z}],[0,0,0,1]]}}"#);
        let c = parse(&format!("{},{}", at(0.0), at(-1.0))).unwrap();
        let m = c.previous_from_current(0, 1);
        assert_eq!(m[2], [0.0, 0.0, 1.0, 1.0]);
        assert_eq!(m[1], [0.0, 1.0, 0.0, 0.0]);
    }
}

//! Camera files: a pose for each frame, or a path of keyframes.

use crate::error::InputError;
use crate::error::one_line;
use crate::scene::camera_forms::EXPECTED;
use crate::scene::cameras;
use crate::scene::cameras::Cameras;
use crate::scene::colmap;
use glam::{DMat3, DMat4, DVec3};
use serde::Deserialize;
use std::cmp::Ordering;
use std::path::Path;

/// A camera path read from a file, in the scene's axes.
#[derive(Clone, Debug)]
pub struct CameraFile {
    /// Frames per second, if the file states them.
    pub fps: Option<f32>,
    /// Horizontal field of view in degrees, if the file states it.
    pub hfov_deg: Option<f32>,
    kind: &'static str,
    path: CameraPath,
}

#[derive(Clone, Debug)]
enum CameraPath {
    /// One pose per frame; the last one is held.
    Frames(Vec<DMat4>),
    /// Sorted by time; the first and the last one are held.
    Keyframes(Vec<Keyframe>),
}

/// One point of a path, in the scene's axes (y up, metres).
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Keyframe {
    time_s: f64,
    position: [f64; 3],
    target: [f64; 3],
}

#[derive(Deserialize)]
struct KeyframesForm {
    fps: Option<f64>,
    horizontal_fov_deg: Option<f64>,
    keyframes: Vec<Keyframe>,
}

impl CameraFile {
    /// Reads a `cameras.json` (poses in Blender's axes, z up), the camera files of other programs (`docs/cameras.md`),
    /// COLMAP's `images.txt` with the `cameras.txt` beside it, or keyframes in the scene's axes:
    /// `{"keyframes": [{"time_s": 0, "position": [x, y, z], "target": [x, y, z]}, ...]}`. The camera follows a smooth
    /// curve through the keyframes, with y up.
    ///
    /// # Errors
    /// [`Io`](InputError::Io) if the file cannot be read, [`Limit`](InputError::Limit) if it is too large, and those of
    /// [`CameraFile::parse`].
    pub fn open(path: &Path) -> Result<Self, InputError> {
        let subject = path.display().to_string();
        let text = cameras::read(path)?;
        if !Self::is_colmap(path) {
            return Self::parse(&subject, &text);
        }
        let beside = path.with_file_name("cameras.txt");
        let beside = if beside.is_file() { Some(cameras::read(&beside)?) } else { None };
        let beside = beside.as_deref().map(String::from_utf8_lossy);
        let form = colmap::read(&String::from_utf8_lossy(&text), beside.as_deref())
            .map_err(|problem| InputError::invalid(&subject, one_line(&problem), "export the model as text again"))?;
        let has_none = || InputError::invalid(&subject, "has no camera", "expected the images.txt of COLMAP");
        Self::of_poses(Cameras::of(&subject, form)?).ok_or_else(has_none)
    }

    /// Whether a file is COLMAP's `images.txt`, by its name.
    pub fn is_colmap(path: &Path) -> bool {
        path.file_name().is_some_and(|name| name.eq_ignore_ascii_case("images.txt"))
    }

    /// The poses of a file in the scene's axes; `None` without any.
    fn of_poses(file: Cameras) -> Option<Self> {
        // From Blender's axes (x, y, z) to the scene's (x, z, -y).
        let turn = DMat4::from_cols(
            DVec3::X.extend(0.0),
            (-DVec3::Z).extend(0.0),
            DVec3::Y.extend(0.0),
            DVec3::ZERO.extend(1.0),
        );
        let poses: Vec<DMat4> = file.world_from_camera().map(|m| turn * m).collect();
        let path = CameraPath::Frames(poses);
        (file.world_from_camera().len() > 0).then_some(Self {
            fps: file.fps,
            hfov_deg: file.hfov_deg,
            kind: file.kind,
            path,
        })
    }

    /// Parses the text of a camera file; `subject` is the file's name in errors.
    ///
    /// # Errors
    /// [`Invalid`](InputError::Invalid) if the text is neither form, has no camera, or has numbers out of range.
    pub fn parse(subject: &str, text: &[u8]) -> Result<Self, InputError> {
        let error = |problem: String| {
            let expected = format!("{EXPECTED}, or {{keyframes: [{{time_s, position, target}}]}}");
            InputError::invalid(subject, one_line(&problem), expected)
        };
        let text = text.strip_prefix(b"\xef\xbb\xbf").unwrap_or(text);
        let form: serde_json::Value = serde_json::from_slice(text).map_err(|e| error(format!("is not JSON ({e})")))?;
        if form.get("keyframes").is_none() || form.get("camera_path").is_some() {
            let file = Cameras::parse(subject, text)?;
            return Self::of_poses(file).ok_or_else(|| error("has no camera".into()));
        }
        if form["keyframes"].get(0).is_some_and(|key| key.get("matrix").is_some()) {
            return Err(error("has keyframes of nerfstudio and no camera_path; render the path in its viewer".into()));
        }
        let form: KeyframesForm =
            serde_json::from_value(form).map_err(|e| error(format!("is not the expected JSON ({e})")))?;
        let hfov_deg = form.horizontal_fov_deg.map(|v| v as f32);
        if hfov_deg.is_some_and(|v| !(v > 0.0 && v < 180.0)) {
            return Err(error("has a horizontal_fov_deg that is not above 0 and below 180".into()));
        }
        let fps = form.fps.map(|v| v as f32);
        if fps.is_some_and(|v| !(v > 0.0 && v < 100_000.0)) {
            return Err(error("has an fps that is not above 0 and below 100000".into()));
        }
        let keys = form.keyframes;
        if keys.is_empty() {
            return Err(error("has no keyframe".into()));
        }
        if let Some(i) =
            (1..keys.len()).find(|&i| keys[i].time_s.partial_cmp(&keys[i - 1].time_s) != Some(Ordering::Greater))
        {
            return Err(error(format!("has keyframe {i} at {} s, not after the one before", keys[i].time_s)));
        }
        if let Some(i) = keys.iter().position(|k| looking(DVec3::from(k.position), DVec3::from(k.target)).is_none()) {
            return Err(error(format!("has keyframe {i} whose target gives no direction to look in")));
        }
        Ok(Self { fps, hfov_deg, kind: "keyframes", path: CameraPath::Keyframes(keys) })
    }

    /// What the file is, in words.
    pub fn kind(&self) -> &'static str {
        self.kind
    }

    /// Number of frames with a pose; `None` for keyframes, which define any number of frames.
    pub fn frames(&self) -> Option<usize> {
        match &self.path {
            CameraPath::Frames(poses) => Some(poses.len()),
            CameraPath::Keyframes(_) => None,
        }
    }

    /// Whether all poses are equal.
    pub fn is_still(&self) -> bool {
        match &self.path {
            CameraPath::Frames(poses) => poses.iter().all(|p| *p == poses[0]),
            CameraPath::Keyframes(keys) => {
                keys.iter().all(|k| (k.position, k.target) == (keys[0].position, keys[0].target))
            }
        }
    }

    /// Camera-to-world (x right, y up, looking along -z) of frame `index` at `time_s`.
    pub fn world_from_camera(&self, index: u64, time_s: f64) -> DMat4 {
        match &self.path {
            CameraPath::Frames(poses) => poses[(index as usize).min(poses.len() - 1)],
            CameraPath::Keyframes(keys) => {
                let (position, target) = along(keys, time_s);
                // Between keyframes, position and target may coincide: then use the nearest keyframe's view.
                looking(position, target).unwrap_or_else(|| {
                    let nearest =
                        keys.iter().min_by(|a, b| (a.time_s - time_s).abs().total_cmp(&(b.time_s - time_s).abs()));
                    let key = nearest.expect("a path has keyframes");
                    looking(DVec3::from(key.position), DVec3::from(key.target)).expect("checked when read")
                })
            }
        }
    }
}

/// Camera at `position` that looks at `target`, with y up; `None` if the two coincide or are not finite.
fn looking(position: DVec3, target: DVec3) -> Option<DMat4> {
    let back = (position - target).try_normalize()?;
    let across = DVec3::Y.cross(back);
    // Looking straight up or down: keep the world's x axis.
    let right = if across.length() > 1e-6 { across.normalize() } else { DVec3::X };
    let rotation = DMat3::from_cols(right, back.cross(right), back);
    position.is_finite().then(|| {
        let mut m = DMat4::from_mat3(rotation);
        m.w_axis = position.extend(1.0);
        m
    })
}

/// Position and target at a time, by a Catmull-Rom spline with non-uniform knots.
fn along(keys: &[Keyframe], time_s: f64) -> (DVec3, DVec3) {
    let next = keys.partition_point(|k| k.time_s <= time_s);
    if next == 0 || next == keys.len() {
        let key = keys[next.min(keys.len() - 1)];
        return (DVec3::from(key.position), DVec3::from(key.target));
    }
    let (i, j) = (next - 1, next);
    let span = keys[j].time_s - keys[i].time_s;
    let t = (time_s - keys[i].time_s) / span;
    let at = |value: fn(&Keyframe) -> [f64; 3]| {
        let v = |k: usize| DVec3::from(value(&keys[k]));
        let tangent = |k: usize| {
            let (before, after) = (k.saturating_sub(1), (k + 1).min(keys.len() - 1));
            (v(after) - v(before)) / (keys[after].time_s - keys[before].time_s) * span
        };
        let (t2, t3) = (t * t, t * t * t);
        v(i) * (2.0 * t3 - 3.0 * t2 + 1.0)
            + tangent(i) * (t3 - 2.0 * t2 + t)
            + v(j) * (3.0 * t2 - 2.0 * t3)
            + tangent(j) * (t3 - t2)
    };
    (at(|k| k.position), at(|k| k.target))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blenders_axes_become_the_scenes() {
        // In Blender a camera with this matrix stands at (1, 2, 3) and looks along +y, z up.
        let text = r#"{"frames":[{"camera_to_world":[[1,0,0,1],[0,0,-1,2],[0,1,0,3],[0,0,0,1]]}]}"#;
        let m = CameraFile::parse("c.json", text.as_bytes()).unwrap().world_from_camera(5, 0.0);
        assert_eq!(m.w_axis.truncate(), DVec3::new(1.0, 3.0, -2.0));
        assert_eq!(m.transform_vector3(-DVec3::Z), -DVec3::Z, "+y in Blender is -z in glTF");
        assert_eq!(m.transform_vector3(DVec3::Y), DVec3::Y);
    }

    #[test]
    fn a_path_meets_its_keyframes_and_stays_at_its_ends() {
        let text = r#"{"keyframes":[{"time_s":0,"position":[0,1,5],"target":[0,1,0]},
            {"time_s":1,"position":[1,1,5],"target":[0,1,0]},{"time_s":3,"position":[4,1,5],"target":[0,1,0]}]}"#;
        let file = CameraFile::parse("c.json", text.as_bytes()).unwrap();
        let x = |t: f64| file.world_from_camera(0, t).w_axis.x;
        for (t, expected) in [(-1.0, 0.0), (0.0, 0.0), (1.0, 1.0), (3.0, 4.0), (9.0, 4.0)] {
            assert!((x(t) - expected).abs() < 1e-12, "{t}");
        }
        assert!((0..300).all(|i| x(f64::from(i) * 0.01) <= x(f64::from(i + 1) * 0.01)));
    }

    #[test]
    fn a_path_that_goes_nowhere_is_still() {
        let key = |t: u32, x: u32| format!(r#"{{"time_s":{t},"position":[{x},1,5],"target":[0,1,0]}}"#);
        let is_still = |keys: &[String]| {
            let text = format!(r#"{{"keyframes":[{}]}}"#, keys.join(","));
            CameraFile::parse("c.json", text.as_bytes()).unwrap().is_still()
        };
        assert!(is_still(&[key(0, 1)]) && is_still(&[key(0, 1), key(1, 1)]));
        assert!(!is_still(&[key(0, 1), key(1, 2)]));
    }

    #[test]
    fn invalid_paths_are_refused() {
        for (text, word) in [
            ("{", "JSON"),
            (r#"{"keyframes":[]}"#, "no keyframe"),
            (r#"{"frames":[]}"#, "no camera"),
            (r#"{"keyframes":[{"time_s":0,"position":[0,0,0],"target":[0,0,0]}]}"#, "direction"),
            (r#"{"keyframes":[{"time_s":0,"position":[0,0,0],"targte":[0,0,0]}]}"#, "targte"),
            (
                r#"{"keyframes":[{"time_s":1,"position":[0,0,0],"target":[1,0,0]},{"time_s":1,"position":[0,0,0],"target":[1,0,0]}]}"#,
                "not after",
            ),
            (
                r#"{"horizontal_fov_deg":180,"keyframes":[{"time_s":1,"position":[0,0,0],"target":[1,0,0]}]}"#,
                "below 180",
            ),
        ] {
            let error = CameraFile::parse("c.json", text.as_bytes()).unwrap_err().to_string();
            assert!(error.contains(word), "{error}");
        }
    }
}

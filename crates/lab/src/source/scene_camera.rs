//! Cameras and camera paths of scenes.

use super::CameraPose;
use crate::error::InputError;
use crate::scene::camera_file::CameraFile;
use crate::scene::{Camera, Scene, SceneLimits};
use crate::view::View;
use afterimage::ViewGeometry;
use afterimage_eval::scanpath::HeadPath;
use afterimage_eval::source::gait::Head;
use glam::{DMat4, DQuat, DVec3};
use std::f64::consts::FRAC_PI_2;
use std::path::Path;
use std::sync::Arc;

/// Horizontal field of view in degrees of camera files that do not state one.
const DEFAULT_HFOV_DEG: f32 = 70.0;
/// Amplitude of a `lateral` path in metres, over its largest speed in m/s.
const LATERAL_SECONDS: f64 = 0.8;
/// Angular speed of `orbit`, degrees per second.
const ORBIT_DEG_PER_S: f64 = 15.0;
/// Height of the eye above the floor in metres, where a scene has no camera.
const EYE_HEIGHT_M: f64 = 1.6;

/// A camera, its path, and its view parameters.
#[derive(Clone, Debug)]
pub struct SceneCamera {
    path: CameraPath,
    geometry: ViewGeometry,
    /// `None`: the camera follows its path.
    steering: Option<Steering>,
}

/// Camera-to-world matrices that override the path.
#[derive(Clone, Copy, Debug)]
struct Steering {
    /// First frame with the pose `now`.
    from_frame: u64,
    /// Pose of all earlier frames.
    before: DMat4,
    /// Pose from `from_frame` on.
    now: DMat4,
}

#[derive(Clone, Debug)]
enum CameraPath {
    /// Camera of this index in the scene, which may be animated.
    Scene(usize),
    /// A static camera.
    Framing(Camera),
    File(CameraFile),
    /// The first camera of another scene, which may be animated.
    Other(Arc<Scene>),
    /// Sideways oscillation with a largest speed of `speed` m/s.
    Lateral {
        from: DMat4,
        speed: f64,
    },
    /// Rotation about the vertical axis through `middle`.
    Orbit {
        from: DMat4,
        middle: DVec3,
    },
    /// The head of a person who walks forwards.
    Walk {
        from: DMat4,
    },
    /// A recorded or generated head.
    Head {
        /// Transform to the world from the space of the head's poses.
        world_from_space: DMat4,
        path: HeadPath,
    },
}

impl SceneCamera {
    /// Selects a camera by name: a camera of the scene, a `.json` file ([`CameraFile`]), the first camera of another
    /// scene (`.gltf` or `.glb`), or one of
    ///
    /// - `still`: the scene's first camera, else `framing`;
    /// - `framing`: a static camera with all of the scene in view;
    /// - `lateral`: the scene's first camera, else `framing`, moving to the right and back. Its largest speed is an
    ///   eighteenth of the scene's radius per second if it is inside the scene's bounding box (1 m/s in a hall of 36
    ///   m), else a fifth of its distance from the box's middle;
    /// - `orbit`: the scene's first camera, else `framing`, rotating about the scene's middle at 15 degrees per second;
    /// - `walk`: the head of a person who walks forwards at 0.9 m/s for 3 s and then back, from the scene's first
    ///   camera, else from 1.6 m above the middle of the floor along the longer side. It looks left and right (by 14
    ///   degrees, 45 degrees per second), nods (4.5 degrees, twice a second) and rolls (5 degrees, once a second).
    ///
    /// `None` selects `still` for an animated scene and `lateral` for a static one.
    ///
    /// `hfov_deg` replaces the camera's horizontal field of view.
    ///
    /// # Errors
    /// [`Request`](InputError::Request) if there is no such camera, or the size or the field of view is out of range;
    /// those of [`CameraFile::open`] and [`Scene::open`].
    pub fn choose(
        scene: &Scene,
        name: Option<&str>,
        size_px: [u32; 2],
        hfov_deg: Option<f32>,
    ) -> Result<Self, InputError> {
        let cameras = scene.pose(0.0).cameras;
        let aspect = size_px[0] as f32 / size_px[1].max(1) as f32;
        let first = || cameras.first().cloned().unwrap_or_else(|| scene.framing_camera(aspect));
        let found = name.and_then(|name| cameras.iter().position(|c| c.name == name));
        let (path, camera) = match name {
            _ if let Some(index) = found => (CameraPath::Scene(index), cameras[index].clone()),
            Some("still") => (own_path(&cameras, &first()), first()),
            None if scene.duration_s() > 0.0 => (own_path(&cameras, &first()), first()),
            None | Some("lateral") => (lateral(scene, &first()), first()),
            Some("orbit") => {
                let (_, middle) = middle(scene);
                (CameraPath::Orbit { from: first().world_from_camera, middle }, first())
            }
            Some("walk") => {
                let camera = cameras.first().cloned().unwrap_or_else(|| standing(scene, scene.framing_camera(aspect)));
                (CameraPath::Walk { from: camera.world_from_camera }, camera)
            }
            Some("framing") => {
                let camera = scene.framing_camera(aspect);
                (CameraPath::Framing(camera.clone()), camera)
            }
            Some(file) if file.to_lowercase().ends_with(".json") || CameraFile::is_colmap(Path::new(file)) => {
                let file = CameraFile::open(Path::new(file))?;
                let hfov_deg = hfov_deg.or(file.hfov_deg).unwrap_or(DEFAULT_HFOV_DEG);
                let geometry = flat(scene, size_px, hfov_deg)?;
                return Ok(Self { path: CameraPath::File(file), geometry, steering: None });
            }
            Some(file) if [".gltf", ".glb"].iter().any(|ending| file.to_lowercase().ends_with(ending)) => {
                other_scene(file)?
            }
            Some("head") => {
                return Err(InputError::request(
                    "camera head",
                    "there is no scanpath with poses of a head",
                    "give one with the columns head_x_m to head_qw, or a synthetic one",
                ));
            }
            Some(name) => {
                let names: Vec<_> = cameras.iter().map(|c| format!("'{}'", c.name)).collect();
                let listed = if names.is_empty() { "none".to_owned() } else { names.join(", ") };
                return Err(InputError::request(
                    format!("camera {name}"),
                    "the scene has no such camera",
                    format!(
                        "expected still, lateral, orbit, walk, framing, a .json file, another scene, or one of its \
                         cameras: {listed}"
                    ),
                ));
            }
        };
        // Scenes state the vertical angle, `ViewGeometry` takes the horizontal one.
        let own = || {
            let half = (camera.vfov_deg.to_radians() * 0.5).tan() * aspect;
            2.0 * half.atan().to_degrees()
        };
        Ok(Self { path, geometry: flat(scene, size_px, hfov_deg.unwrap_or_else(own))?, steering: None })
    }

    /// A camera between the eyes of a head whose poses are in the space of [`SceneCamera::head_space`]. Field of view:
    /// `hfov_deg` (horizontal, degrees), or that of the scene's first camera if `None`.
    ///
    /// # Errors
    /// [`Request`](InputError::Request) if the size or the field of view is out of range.
    pub fn head(scene: &Scene, path: HeadPath, size_px: [u32; 2], hfov_deg: Option<f32>) -> Result<Self, InputError> {
        let still = Self::choose(scene, Some("still"), size_px, hfov_deg)?;
        Ok(Self { path: CameraPath::Head { world_from_space: Self::head_space(scene), path }, ..still })
    }

    /// Transform to the world from the space of head poses. This space has the position and the direction of the
    /// scene's first camera; in a scene without cameras, those of a person in the middle of the floor. It is level even
    /// if the camera looks up or down.
    pub fn head_space(scene: &Scene) -> DMat4 {
        let first = scene.pose(0.0).cameras.into_iter().next();
        let from = first.unwrap_or_else(|| standing(scene, scene.framing_camera(1.0))).world_from_camera;
        let back = -heading(&from);
        DMat4::from_cols(DVec3::Y.cross(back).extend(0.0), DVec3::Y.extend(0.0), back.extend(0.0), from.w_axis)
    }

    /// Poses of the head that the camera follows; `None` for other paths.
    pub fn head_path(&self) -> Option<&HeadPath> {
        match &self.path {
            CameraPath::Head { path, .. } => Some(path),
            _ => None,
        }
    }

    /// Frame size and field of view of all frames.
    pub fn geometry(&self) -> &ViewGeometry {
        &self.geometry
    }

    /// The same camera with another frame size or field of view.
    #[must_use]
    pub fn with_geometry(self, geometry: ViewGeometry) -> Self {
        Self { geometry, ..self }
    }

    /// Frames per second, if a camera file states them.
    pub fn fps(&self) -> Option<f32> {
        match &self.path {
            CameraPath::File(file) => file.fps,
            _ => None,
        }
    }

    /// Number of frames that a camera file has poses for; `None` for endless paths.
    pub fn frames(&self) -> Option<u64> {
        match &self.path {
            CameraPath::File(file) => file.frames().map(|n| n as u64),
            _ => None,
        }
    }

    /// Whether the camera never moves in `scene`.
    pub fn is_still(&self, scene: &Scene) -> bool {
        match &self.path {
            CameraPath::Scene(_) => scene.duration_s() <= 0.0,
            CameraPath::Framing(_) => true,
            CameraPath::File(file) => file.is_still(),
            CameraPath::Other(other) => other.duration_s() <= 0.0,
            CameraPath::Lateral { .. }
            | CameraPath::Orbit { .. }
            | CameraPath::Walk { .. }
            | CameraPath::Head { .. } => false,
        }
    }

    /// Overrides the path with camera-to-world matrices (x right, y up, looking along -z): the second from frame
    /// `index` on, the first for earlier frames. `None` returns the camera to its path.
    pub fn steer(&mut self, index: u64, before_and_now: Option<[DMat4; 2]>) {
        self.steering = before_and_now.map(|[before, now]| Steering { from_frame: index, before, now });
    }

    /// Whether the path is overridden.
    pub fn is_steered(&self) -> bool {
        self.steering.is_some()
    }

    /// Camera pose in frame `index`, at `time_s`.
    pub fn camera_pose(&self, scene: &Scene, index: u64, time_s: f64) -> CameraPose {
        let (radius, _) = middle(scene);
        let world_from_camera = self.view(scene, index, time_s).world_from_camera();
        CameraPose { world_from_camera, origin: scene.origin, speed_m_s: radius / 5.0 }
    }

    /// View of frame `index`, at `time_s`.
    pub fn view(&self, scene: &Scene, index: u64, time_s: f64) -> View {
        if let Some(Steering { from_frame, before, now }) = self.steering {
            return View::new(self.geometry, if index < from_frame { before } else { now });
        }
        let world_from_camera = match &self.path {
            CameraPath::Scene(camera) => scene.pose(time_s).cameras[*camera].world_from_camera,
            CameraPath::Framing(camera) => camera.world_from_camera,
            CameraPath::File(file) => DMat4::from_translation(-scene.origin) * file.world_from_camera(index, time_s),
            CameraPath::Other(other) => {
                DMat4::from_translation(other.origin - scene.origin) * other.pose(time_s).cameras[0].world_from_camera
            }
            CameraPath::Lateral { from, speed } => {
                let aside = speed * LATERAL_SECONDS * (time_s / LATERAL_SECONDS).sin();
                DMat4::from_translation(from.x_axis.truncate() * aside) * *from
            }
            CameraPath::Orbit { from, middle } => {
                let turn = DQuat::from_rotation_y((ORBIT_DEG_PER_S * time_s).to_radians());
                DMat4::from_translation(*middle) * DMat4::from_quat(turn) * DMat4::from_translation(-*middle) * *from
            }
            CameraPath::Walk { from } => walk(from, time_s),
            CameraPath::Head { world_from_space, path } => *world_from_space * path.pose(time_s).space_from_head(),
        };
        View::new(self.geometry, world_from_camera)
    }
}

/// The first camera of another scene.
fn other_scene(file: &str) -> Result<(CameraPath, Camera), InputError> {
    let other = Scene::open(file, &SceneLimits::default())?;
    let camera =
        other.pose(0.0).cameras.first().cloned().ok_or_else(|| {
            InputError::request(format!("camera {file}"), "the file has no camera", "export it with one")
        })?;
    Ok((CameraPath::Other(Arc::new(other)), camera))
}

/// Path of the scene's first camera, or a static one with the pose of `framing`.
fn own_path(cameras: &[Camera], framing: &Camera) -> CameraPath {
    if cameras.is_empty() { CameraPath::Framing(framing.clone()) } else { CameraPath::Scene(0) }
}

fn flat(scene: &Scene, size_px: [u32; 2], hfov_deg: f32) -> Result<ViewGeometry, InputError> {
    ViewGeometry::flat(size_px, hfov_deg).map_err(|e| {
        InputError::request(&scene.name, format!("{} is {}", e.setting, e.found), format!("expected {}", e.expected))
    })
}

/// Half the diagonal of the scene's bounding box, and the box's middle.
fn middle(scene: &Scene) -> (f64, DVec3) {
    scene.bounds().map_or((1.0, DVec3::ZERO), |b| {
        let (min, max) = (b.min.as_dvec3(), b.max.as_dvec3());
        (0.5 * (max - min).length(), 0.5 * (min + max))
    })
}

fn lateral(scene: &Scene, camera: &Camera) -> CameraPath {
    let (radius, middle) = middle(scene);
    let eye = camera.world_from_camera.w_axis.truncate();
    let p = eye.as_vec3();
    let is_inside = scene.bounds().is_some_and(|b| p.cmpge(b.min).all() && p.cmple(b.max).all());
    let speed = if is_inside { radius / 18.0 } else { eye.distance(middle) / 5.0 };
    CameraPath::Lateral { from: camera.world_from_camera, speed }
}

/// Camera at eye height in the middle of the scene, looking along the longer side of its floor; with the field of view
/// of `camera`.
fn standing(scene: &Scene, camera: Camera) -> Camera {
    let Some(bounds) = scene.bounds() else { return camera };
    let (min, max) = (bounds.min.as_dvec3(), bounds.max.as_dvec3());
    let middle = 0.5 * (min + max);
    let turn = if max.x - min.x > max.z - min.z { DQuat::from_rotation_y(-FRAC_PI_2) } else { DQuat::IDENTITY };
    let eye = DVec3::new(middle.x, min.y + EYE_HEIGHT_M, middle.z);
    Camera { world_from_camera: DMat4::from_rotation_translation(turn, eye), ..camera }
}

/// Level direction in which a camera looks. For a camera that looks straight up or down it is -z.
fn heading(from: &DMat4) -> DVec3 {
    (-from.z_axis.truncate() * DVec3::new(1.0, 0.0, 1.0)).normalize_or(DVec3::NEG_Z)
}

/// Pose of the head at `time_s` of a walk that starts at `from`.
fn walk(from: &DMat4, time_s: f64) -> DMat4 {
    let ahead = heading(from);
    let head = Head::at(time_s);
    let step = ahead * head.ahead_m + DVec3::Y * head.up_m + ahead.cross(DVec3::Y) * head.right_m;
    let eye = from.w_axis.truncate();
    let turned = DQuat::from_rotation_y(head.yaw) * DQuat::from_mat4(from);
    let turned = turned * DQuat::from_rotation_x(head.nod) * DQuat::from_rotation_z(head.roll);
    DMat4::from_rotation_translation(turned, eye + step)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::builtin;

    fn eye(camera: &SceneCamera, scene: &Scene, time_s: f64) -> DVec3 {
        camera.view(scene, 0, time_s).world_from_camera().w_axis.truncate()
    }

    #[test]
    fn a_static_scene_gets_a_moving_camera_and_named_cameras_stand_still() {
        let scene = builtin::courtyard();
        let passing = SceneCamera::choose(&scene, None, [64, 36], None).unwrap();
        assert!(!passing.is_still(&scene));
        let (radius, _) = middle(&scene);
        let start = eye(&passing, &scene, 0.0);
        let step = eye(&passing, &scene, 1e-3).distance(start) / 1e-3;
        let fastest = (radius / 18.0).max(start.distance(middle(&scene).1) / 5.0);
        assert!(step > 0.0 && step <= fastest * 1.000_001, "{step} m/s of at most {fastest}");
        // The camera stays within its amplitude.
        assert!((0..1000).all(|i| eye(&passing, &scene, f64::from(i)).distance(start) <= fastest * LATERAL_SECONDS));
        let framing = SceneCamera::choose(&scene, Some("framing"), [64, 36], Some(60.0)).unwrap();
        assert!(framing.is_still(&scene) && (framing.geometry().hfov_deg() - 60.0).abs() < 1e-3);
    }

    #[test]
    fn an_orbit_keeps_its_distance() {
        let scene = builtin::courtyard();
        let orbit = SceneCamera::choose(&scene, Some("orbit"), [64, 36], None).unwrap();
        let (_, middle) = middle(&scene);
        let far = eye(&orbit, &scene, 0.0).distance(middle);
        assert!(eye(&orbit, &scene, 1.0).distance(eye(&orbit, &scene, 0.0)) > 0.1 * far);
        assert!((eye(&orbit, &scene, 7.0).distance(middle) - far).abs() < 1e-9 * far.max(1.0));
    }

    #[test]
    fn a_walk_stays_in_the_courtyard_and_turns_as_fast_as_a_head() {
        let scene = builtin::courtyard();
        let walker = SceneCamera::choose(&scene, Some("walk"), [480, 270], None).unwrap();
        assert!(!walker.is_still(&scene));
        let pose = |i: i32| walker.view(&scene, 0, f64::from(i) / 60.0).world_from_camera();
        assert!(pose(0).abs_diff_eq(scene.pose(0.0).cameras[0].world_from_camera, 1e-12));
        let ahead = -pose(0).z_axis.truncate();
        let (mut least_speed, mut most_speed, mut fastest_turn) = (f64::INFINITY, 0.0_f64, 0.0_f64);
        for i in 0..720 {
            let (now, next) = (pose(i), pose(i + 1));
            let p = now.w_axis.truncate();
            // Columns stand at 7.2 m, bushes reach up to 1.5 m.
            assert!(p.x.abs() < 6.5 && p.z.abs() < 6.5 && (2.0..2.4).contains(&p.y), "{p} in frame {i}");
            let step = (next.w_axis - now.w_axis).truncate() * 60.0;
            let along = step.dot(DVec3::new(ahead.x, 0.0, ahead.z).normalize()).abs();
            (least_speed, most_speed) = (least_speed.min(along), most_speed.max(along));
            let turn = DQuat::from_mat4(&now).angle_between(DQuat::from_mat4(&next)).to_degrees() * 60.0;
            fastest_turn = fastest_turn.max(turn);
        }
        println!("{least_speed:.3} to {most_speed:.3} m/s ahead, turning at most {fastest_turn:.1} degrees/s");
        assert!((least_speed - 0.9).abs() < 1e-6 && (most_speed - 0.9).abs() < 1e-6);
        // Yaw, nod and roll are at their fastest together once a second.
        assert!((70.0..81.0).contains(&fastest_turn));
    }

    #[test]
    fn a_walk_in_a_scene_without_cameras_starts_at_eye_height_along_the_longer_side() {
        let mut scene = builtin::courtyard();
        scene.rest.cameras.clear();
        let p = SceneCamera::choose(&scene, Some("walk"), [64, 36], None).unwrap().view(&scene, 0, 0.0);
        let bounds = scene.bounds().unwrap();
        let m = p.world_from_camera();
        assert!((m.w_axis.y - f64::from(bounds.min.y) - EYE_HEIGHT_M).abs() < 1e-6);
        let ahead = -m.z_axis.truncate();
        assert!(ahead.y.abs() < 1e-12 && (ahead.x.abs() > 0.999 || ahead.z.abs() > 0.999));
    }

    #[test]
    fn a_steered_camera_takes_the_given_poses_and_returns_to_its_path() {
        let scene = builtin::courtyard();
        let mut camera = SceneCamera::choose(&scene, Some("orbit"), [64, 36], None).unwrap();
        let on_path = camera.camera_pose(&scene, 7, 0.5);
        let [before, now] = [1.0, 2.0].map(|x| DMat4::from_translation(DVec3::X * x));
        camera.steer(7, Some([before, now]));
        let places = [6, 7, 8].map(|i| camera.view(&scene, i, 0.5).world_from_camera());
        assert_eq!((places, camera.is_steered()), ([before, now, now], true));
        camera.steer(8, None);
        assert_eq!((camera.camera_pose(&scene, 7, 0.5), camera.is_steered()), (on_path, false));
    }

    #[test]
    fn unknown_cameras_and_fields_of_view_are_refused() {
        let scene = builtin::courtyard();
        let error = SceneCamera::choose(&scene, Some("left"), [64, 36], None).unwrap_err().to_string();
        assert!(error.contains("lateral") && error.contains("left"), "{error}");
        assert!(SceneCamera::choose(&scene, Some("no/such.json"), [64, 36], None).is_err());
        assert!(SceneCamera::choose(&scene, None, [64, 36], Some(180.0)).is_err());
    }
}

//! Where a scene is seen from, frame by frame.

use super::Stance;
use crate::error::InputError;
use crate::scene::camera_file::CameraFile;
use crate::scene::{Camera, Scene};
use crate::trace::view::View;
use afterimage::ViewGeometry;
use glam::{DMat4, DQuat, DVec3};
use std::path::Path;

/// Horizontal field of view of camera files that say nothing about it, degrees.
const DEFAULT_HFOV_DEG: f32 = 70.0;
/// Largest distance from the middle of a `lateral` path over the distance that is moved in a second.
const LATERAL_SECONDS: f64 = 0.8;
/// Degrees that an `orbit` turns in a second.
const ORBIT_DEG_PER_S: f64 = 15.0;

/// A camera and its path.
#[derive(Clone, Debug)]
pub struct SceneCamera {
    path: CameraPath,
    geometry: ViewGeometry,
    /// From frame `.0` on in the second of these places, in the first before; `None`: on its path.
    steered: Option<(u64, [DMat4; 2])>,
}

#[derive(Clone, Debug)]
enum CameraPath {
    /// The scene's camera of that number, as the scene moves it.
    Scene(usize),
    /// Stands still.
    Framing(Camera),
    File(CameraFile),
    /// Sideways and back, at most `speed` m/s.
    Lateral {
        from: DMat4,
        speed: f64,
    },
    /// Around an upright axis through the middle.
    Orbit {
        from: DMat4,
        middle: DVec3,
    },
}

impl SceneCamera {
    /// A camera by what the user named: a camera of the scene, a `.json` file ([`CameraFile`]), or one of
    ///
    /// - `still`: the scene's first camera, else `framing`;
    /// - `framing`: one that stands still with all of the scene in view;
    /// - `lateral`: the scene's first camera, else `framing`, that glides to the right and back. At its fastest it moves an
    ///   eighteenth of the scene's radius a second where it stands inside the scene's box (1 m/s in a hall of 36 m), else a fifth of
    ///   its distance from the middle;
    /// - `orbit`: the same camera around the scene's middle, 15 degrees a second.
    ///
    /// `None`: the scene's first camera, else `framing`; if nothing moves then, `lateral`.
    ///
    /// `hfov_deg` replaces the camera's horizontal field of view.
    ///
    /// # Errors
    /// If there is no such camera, the file is none, or the size or field of view is none.
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
            Some("framing") => {
                let camera = scene.framing_camera(aspect);
                (CameraPath::Framing(camera.clone()), camera)
            }
            Some(file) if file.to_lowercase().ends_with(".json") => {
                let file = CameraFile::open(Path::new(file))?;
                let hfov_deg = hfov_deg.or(file.hfov_deg).unwrap_or(DEFAULT_HFOV_DEG);
                let geometry = flat(scene, size_px, hfov_deg)?;
                return Ok(Self { path: CameraPath::File(file), geometry, steered: None });
            }
            Some(name) => {
                let names: Vec<_> = cameras.iter().map(|c| format!("'{}'", c.name)).collect();
                let there = if names.is_empty() { "none".to_owned() } else { names.join(", ") };
                return Err(InputError::request(
                    format!("camera {name}"),
                    "the scene has no such camera",
                    format!("expected still, lateral, orbit, framing, a .json file, or one of its cameras: {there}"),
                ));
            }
        };
        // As a symmetric view, which the rest of the tool describes by its horizontal angle.
        let own = || {
            let half = (camera.vfov_deg.to_radians() * 0.5).tan() * aspect;
            2.0 * half.atan().to_degrees()
        };
        Ok(Self { path, geometry: flat(scene, size_px, hfov_deg.unwrap_or_else(own))?, steered: None })
    }

    /// Pixels and angles of all frames.
    pub fn geometry(&self) -> &ViewGeometry {
        &self.geometry
    }

    /// Frames per second, where a camera file says so.
    pub fn fps(&self) -> Option<f32> {
        match &self.path {
            CameraPath::File(file) => file.fps,
            _ => None,
        }
    }

    /// How many frames a camera file has poses for; other paths have any number.
    pub fn frames(&self) -> Option<u64> {
        match &self.path {
            CameraPath::File(file) => file.frames().map(|n| n as u64),
            _ => None,
        }
    }

    /// Whether it never moves in `scene`.
    pub fn is_still(&self, scene: &Scene) -> bool {
        match &self.path {
            CameraPath::Scene(_) => scene.duration_s() <= 0.0,
            CameraPath::Framing(_) => true,
            CameraPath::File(file) => file.is_still(),
            CameraPath::Lateral { .. } | CameraPath::Orbit { .. } => false,
        }
    }

    /// Takes the camera off its path: from frame `index` on it is at the second of these places (x right, y up, looking along -z), until
    /// then it was at the first. `None`: back onto its path.
    pub fn steer(&mut self, index: u64, before_and_now: Option<[DMat4; 2]>) {
        self.steered = before_and_now.map(|places| (index, places));
    }

    /// Whether it is off its path.
    pub fn is_steered(&self) -> bool {
        self.steered.is_some()
    }

    /// Where it stands in frame `index`, at `time_s`.
    pub fn stance(&self, scene: &Scene, index: u64, time_s: f64) -> Stance {
        let (radius, _) = middle(scene);
        Stance { world_from_camera: self.view(scene, index, time_s).world_from_camera(), speed_m_s: radius / 5.0 }
    }

    /// What it sees in frame `index`, at `time_s`.
    pub fn view(&self, scene: &Scene, index: u64, time_s: f64) -> View {
        if let Some((from, [before, now])) = self.steered {
            return View::new(self.geometry, if index < from { before } else { now });
        }
        let world_from_camera = match &self.path {
            CameraPath::Scene(camera) => scene.pose(time_s).cameras[*camera].world_from_camera,
            CameraPath::Framing(camera) => camera.world_from_camera,
            CameraPath::File(file) => file.world_from_camera(index, time_s),
            CameraPath::Lateral { from, speed } => {
                let aside = speed * LATERAL_SECONDS * (time_s / LATERAL_SECONDS).sin();
                DMat4::from_translation(from.x_axis.truncate() * aside) * *from
            }
            CameraPath::Orbit { from, middle } => {
                let turn = DQuat::from_rotation_y((ORBIT_DEG_PER_S * time_s).to_radians());
                DMat4::from_translation(*middle) * DMat4::from_quat(turn) * DMat4::from_translation(-*middle) * *from
            }
        };
        View::new(self.geometry, world_from_camera)
    }
}

/// The scene's first camera, or one that stands still.
fn own_path(cameras: &[Camera], framing: &Camera) -> CameraPath {
    if cameras.is_empty() { CameraPath::Framing(framing.clone()) } else { CameraPath::Scene(0) }
}

fn flat(scene: &Scene, size_px: [u32; 2], hfov_deg: f32) -> Result<ViewGeometry, InputError> {
    ViewGeometry::flat(size_px, hfov_deg).map_err(|e| {
        InputError::request(&scene.name, format!("{} is {}", e.setting, e.found), format!("expected {}", e.expected))
    })
}

/// Half the diagonal of the scene's box and its middle.
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::builtin;

    fn eye(camera: &SceneCamera, scene: &Scene, time_s: f64) -> DVec3 {
        camera.view(scene, 0, time_s).world_from_camera().w_axis.truncate()
    }

    #[test]
    fn a_scene_that_stands_still_is_passed_by_and_named_cameras_stand() {
        let scene = builtin::courtyard();
        let passing = SceneCamera::choose(&scene, None, [64, 36], None).unwrap();
        assert!(!passing.is_still(&scene));
        let (radius, _) = middle(&scene);
        let start = eye(&passing, &scene, 0.0);
        let step = eye(&passing, &scene, 1e-3).distance(start) / 1e-3;
        let fastest = (radius / 18.0).max(start.distance(middle(&scene).1) / 5.0);
        assert!(step > 0.0 && step <= fastest * 1.000_001, "{step} m/s of at most {fastest}");
        // It never leaves its stretch.
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
    fn a_steered_camera_is_where_it_is_put_and_finds_its_path_again() {
        let scene = builtin::courtyard();
        let mut camera = SceneCamera::choose(&scene, Some("orbit"), [64, 36], None).unwrap();
        let on_path = camera.stance(&scene, 7, 0.5);
        let [before, now] = [1.0, 2.0].map(|x| DMat4::from_translation(DVec3::X * x));
        camera.steer(7, Some([before, now]));
        let places = [6, 7, 8].map(|i| camera.view(&scene, i, 0.5).world_from_camera());
        assert_eq!((places, camera.is_steered()), ([before, now, now], true));
        camera.steer(8, None);
        assert_eq!((camera.stance(&scene, 7, 0.5), camera.is_steered()), (on_path, false));
    }

    #[test]
    fn what_is_no_camera_is_refused() {
        let scene = builtin::courtyard();
        let error = SceneCamera::choose(&scene, Some("left"), [64, 36], None).unwrap_err().to_string();
        assert!(error.contains("lateral") && error.contains("left"), "{error}");
        assert!(SceneCamera::choose(&scene, Some("no/such.json"), [64, 36], None).is_err());
        assert!(SceneCamera::choose(&scene, None, [64, 36], Some(180.0)).is_err());
    }
}

//! A scene, its light, and the camera that sees it: the input of every renderer of scenes.

use super::open::check_size;
use super::{ReadLimits, SceneCamera, SceneOptions, SourceInfo};
use crate::error::InputError;
use crate::scene::effects::Effects;
use crate::scene::{Environment, Scene, SceneLimits};
use crate::view::View;
use afterimage::ViewGeometry;
use afterimage_eval::scanpath::HeadPath;
use std::sync::Arc;

/// Default width and height in pixels.
pub const DEFAULT_SIZE: [u32; 2] = [640, 360];
/// Default frames per second.
pub const DEFAULT_FPS: f32 = 60.0;

/// Which scene, and how it is seen.
#[derive(Clone, Debug)]
pub struct SceneChoice<'a> {
    /// A `.gltf` or `.glb` file or `builtin:NAME`.
    pub name: &'a str,
    /// Animation of the file; `None`: the first.
    pub clip: Option<&'a str>,
    /// The camera that [`SceneCamera::choose`] selects for this.
    pub camera: Option<&'a str>,
    /// Poses of a head that the camera follows ([`SceneCamera::head`]) instead.
    pub head: Option<HeadPath>,
    /// Light besides the scene's own.
    pub light: Light,
    /// Size, field of view and frame rate.
    pub options: SceneOptions,
    /// Limits of the frame.
    pub limits: ReadLimits,
}

impl<'a> SceneChoice<'a> {
    /// The scene as it is, with defaults for the rest.
    pub fn new(name: &'a str) -> Self {
        let (options, limits) = (SceneOptions::default(), ReadLimits::default());
        Self { name, clip: None, camera: None, head: None, light: Light::Own, options, limits }
    }
}

/// Light of a scene.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Light {
    /// The scene's own.
    #[default]
    Own,
    /// A uniform white environment if the scene has no light.
    IfDark,
    /// This environment.
    Environment(Environment),
}

/// A scene and the camera that sees it.
#[derive(Clone)]
pub struct ViewedScene {
    /// The scene.
    pub scene: Arc<Scene>,
    /// The camera.
    pub camera: SceneCamera,
    /// Frames per second.
    pub fps: f32,
    info: SourceInfo,
}

impl ViewedScene {
    /// Opens a scene.
    ///
    /// # Errors
    /// Those of [`Scene::open_clip`], [`SceneCamera::choose`], [`SceneCamera::head`] and [`new`](Self::new), and
    /// [`Limit`](InputError::Limit) if the frame has more pixels than the limits allow.
    pub fn open(choice: &SceneChoice<'_>) -> Result<Self, InputError> {
        let size = choice.options.size.unwrap_or(DEFAULT_SIZE);
        check_size(choice.name, size, &choice.limits)?;
        let mut scene = Scene::open_clip(choice.name, choice.clip, &SceneLimits::default())?;
        match &choice.light {
            Light::Own => {}
            Light::IfDark => light_if_dark(&mut scene),
            Light::Environment(environment) => scene.environment = environment.clone(),
        }
        let hfov_deg = choice.options.hfov_deg;
        let camera = match &choice.head {
            Some(path) => SceneCamera::head(&scene, path.clone(), size, hfov_deg)?,
            None => SceneCamera::choose(&scene, choice.camera, size, hfov_deg)?,
        };
        Self::new(scene, camera, choice.options.fps)
    }

    /// `scene` seen by `camera` at `fps` frames per second (default: those of the camera file, else 60).
    ///
    /// # Errors
    /// [`Request`](InputError::Request) if the frame rate is not above 0.
    pub fn new(scene: Scene, camera: SceneCamera, fps: Option<f32>) -> Result<Self, InputError> {
        let fps = fps.or(camera.fps()).unwrap_or(DEFAULT_FPS);
        if !(fps.is_finite() && fps > 0.0) {
            let problem = format!("the frame rate is {fps}");
            return Err(InputError::request(&scene.name, problem, "expected frames per second above 0"));
        }
        let info = SourceInfo {
            name: scene.name.clone(),
            size: camera.geometry().size_px(),
            frames: camera.frames(),
            fps: Some(fps),
            hfov_deg: Some(camera.geometry().hfov_deg()),
            still: scene.duration_s() <= 0.0 && camera.is_still(&scene),
            has_albedo: true,
        };
        Ok(Self { scene: Arc::new(scene), camera, fps, info })
    }

    /// The same camera with another frame size or field of view.
    #[must_use]
    pub fn with_geometry(mut self, geometry: ViewGeometry) -> Self {
        self.camera = self.camera.with_geometry(geometry);
        (self.info.size, self.info.hfov_deg) = (geometry.size_px(), Some(geometry.hfov_deg()));
        self
    }

    /// Properties that hold for all frames.
    pub fn info(&self) -> &SourceInfo {
        &self.info
    }

    /// Features of the scene file that are ignored or approximated.
    pub fn warnings(&self) -> &[String] {
        &self.scene.warnings
    }

    /// Time of frame `index` in seconds.
    pub fn time_s(&self, index: u64) -> f64 {
        index as f64 / f64::from(self.fps)
    }

    /// Views of frame `index` and of the previous one, and the times of both in seconds.
    pub fn views(&self, index: u64) -> ([View; 2], [f64; 2]) {
        let both = [index, index.saturating_sub(1)];
        let times = both.map(|i| self.time_s(i));
        ([0, 1].map(|i| self.camera.view(&self.scene, both[i], times[i])), times)
    }
}

/// Sky radiance of scenes without light.
const SOFT_WHITE: [f32; 3] = [1.0; 3];

/// Adds a constant white sky to a scene without any light.
fn light_if_dark(scene: &mut Scene) {
    if !Effects::needed(scene).has_light() {
        scene.environment = Environment::Constant(SOFT_WHITE);
    }
}

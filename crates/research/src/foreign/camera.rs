//! Moving cameras: a walking person where the scene is a place, a turn about the scene's middle elsewhere.

use super::options::ForeignArgs;
use super::scenes::SceneInput;
use crate::error::AnyError;
use afterimage_lab::source::{Light, ReadLimits, SceneChoice, SceneOptions, ViewedScene};
use glam::{DMat4, DQuat, DVec3};

/// Horizontal field of view in degrees: that of the tables of `docs/equal-time.md`.
pub const HFOV_DEG: f32 = 40.0;
/// Frames per second.
pub const FPS: f32 = 60.0;
/// Scenes that a person walks through (`SceneCamera::choose`, `walk`).
const WALKED: [&str; 3] = ["sponza", "courtyard", "interior"];
/// Motion in pixels a frame of what is nearest, or of the whole view from inside the scene, that a turn aims at. More
/// gives history less time.
const TURN_PX: f64 = 2.0;
/// Fastest turn, in degrees a frame: 45 a second.
const FASTEST_DEG: f64 = 0.75;
/// Share of the distance to the scene's middle that the camera covers in a frame: the edge of a view of 320 pixels
/// moves by half a pixel.
const DOLLY: f64 = 0.003;

/// A turn about the vertical axis through the scene's middle, which the camera approaches.
#[derive(Clone, Copy, Debug)]
pub struct Turn {
    /// Pose in the middle of the clip.
    from: DMat4,
    middle: DVec3,
    /// Speed in radians a frame.
    speed: f64,
    middle_frame: f64,
}

impl Turn {
    /// Camera-to-world matrix of a frame.
    pub fn pose(&self, index: u64) -> DMat4 {
        let frames = index as f64 - self.middle_frame;
        let turn = DMat4::from_quat(DQuat::from_rotation_y(self.speed * frames));
        let eye = self.from.w_axis.truncate();
        let nearer = DMat4::from_translation((self.middle - eye) * DOLLY * frames);
        DMat4::from_translation(self.middle) * turn * DMat4::from_translation(-self.middle) * nearer * self.from
    }
}

/// The scene with its camera, and the turn that moves it if it does not walk.
pub fn open(scene: &SceneInput, options: &ForeignArgs) -> Result<(ViewedScene, Option<Turn>), AnyError> {
    let walks = WALKED.contains(&&*scene.name);
    let choice = SceneChoice {
        camera: Some(if walks { "walk" } else { "still" }),
        light: Light::IfDark,
        options: SceneOptions { size: Some(options.size), hfov_deg: Some(HFOV_DEG), fps: Some(FPS) },
        limits: ReadLimits::from_megapixels(64),
        ..SceneChoice::new(&scene.path)
    };
    let viewed = ViewedScene::open(&choice)?;
    let turn = (!walks).then(|| turn(&viewed, options));
    Ok((viewed, turn))
}

/// The turn from the scene's first camera, or from where the scene fills the view.
fn turn(viewed: &ViewedScene, options: &ForeignArgs) -> Turn {
    let scene = &viewed.scene;
    let bounds = scene.bounds();
    let (middle, radius) = bounds.map_or((DVec3::ZERO, 1.0), |b| {
        let (min, max) = (b.min.as_dvec3(), b.max.as_dvec3());
        (0.5 * (min + max), 0.5 * (max - min).length())
    });
    let half_width = (f64::from(HFOV_DEG) * 0.5).to_radians().tan();
    let aspect = f64::from(options.size[0]) / f64::from(options.size[1]);
    let framing = || {
        let framing = scene.framing_camera(aspect as f32);
        let eye = framing.world_from_camera.w_axis.truncate();
        let farther = (f64::from(framing.vfov_deg) * 0.5).to_radians().tan() * aspect / half_width;
        DMat4::from_translation((eye - middle) * (farther - 1.0)) * framing.world_from_camera
    };
    let from = scene.pose(0.0).cameras.first().map_or_else(framing, |camera| camera.world_from_camera);
    let focal_px = 0.5 * f64::from(options.size[0]) / half_width;
    let distance = from.w_axis.truncate().distance(middle);
    let px_per_rad = focal_px * (radius / distance).min(1.0);
    let speed = (TURN_PX / px_per_rad).min(FASTEST_DEG.to_radians());
    Turn { from, middle, speed, middle_frame: options.frames as f64 / 2.0 }
}

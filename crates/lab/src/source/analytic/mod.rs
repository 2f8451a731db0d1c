//! Scenes whose every pixel is known in closed form: a courtyard of textured rectangles, balls and posts, ray-cast on the
//! CPU. Color, depth, motion vectors and the camera's motion are exact, so what a temporal method makes of them can be
//! told from errors of its input.
//!
//! | scene | what moves | what it is for |
//! |---|---|---|
//! | `still` | nothing | the picture to look at; how much detail comes back |
//! | `lateral` | the camera, sideways, 1 m/s at the most | reprojection, disocclusion behind near posts |
//! | `turn` | the camera, about itself, 17 degrees a second at the most | camera rotation: every pixel moves, nothing is disoccluded |
//! | `occluder` | a fence and a rolling ball in front, a spinning globe, the camera a little | motion of objects |
//! | `light-step` | nothing; the light falls to 0.45 for 0.75 s | change without motion |
//! | `scroll` | the page on a panel, without motion vectors | content that lies about its motion |

mod cast;
mod courtyard;
mod glyph;
mod light;
mod noise;
mod print;
mod scene;
mod shape;
mod texture;
mod tile;

use crate::error::InputError;
use crate::frame::SourceFrame;
use crate::source::{FrameSource, SourceInfo};
use afterimage::{Image, ViewGeometry};
use cast::{Caster, Geometry, Pattern};
use scene::{Scene, Stage};
use texture::Material;

/// Width and height in pixels where nothing else is asked for.
pub const DEFAULT_SIZE: [u32; 2] = [640, 360];
/// Horizontal field of view in degrees where nothing else is asked for.
pub const DEFAULT_HFOV_DEG: f32 = 70.0;
/// Frames per second where nothing else is asked for.
pub const DEFAULT_FPS: f32 = 60.0;
/// Largest width and height in pixels.
pub const MAX_SIDE: u32 = 16_384;
/// Factor on all light while `light-step` is dark.
pub const LIGHT_STEP: f32 = 0.45;
/// From when until when `light-step` is dark, in seconds: frames 30 to 74 at 60 frames per second.
pub const LIGHT_STEP_SECONDS: [f64; 2] = [0.5, 1.25];
/// Pixels by which the page of `scroll` moves up each frame, at the default size and field of view.
pub const SCROLL_PX: f64 = 2.0;

/// Color samples of a pixel: many where the picture is kept, few where each frame is cast anew.
const SAMPLES_KEPT: u32 = 16;
const SAMPLES_MOVING: u32 = 4;
/// Metres after which the page of `scroll` starts again, so that a late frame is as exact as an early one.
const SCROLL_PERIOD: f64 = 1024.0;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Still,
    Lateral,
    Turn,
    Occluder,
    LightStep,
    Scroll,
}

const KINDS: [(&str, Kind); 6] = [
    ("still", Kind::Still),
    ("lateral", Kind::Lateral),
    ("turn", Kind::Turn),
    ("occluder", Kind::Occluder),
    ("light-step", Kind::LightStep),
    ("scroll", Kind::Scroll),
];

/// A scene with exact color, depth and motion, without an end.
///
/// Each frame is a function of its index alone: the same bytes in any order of calls, on any number of threads. Depth and
/// motion are those at the pixels' centres, color is the mean over the pixel's area.
///
/// `previous_from_current` is always given (the identity where the camera stands still), and so are depth and motion. Frame 0
/// is a cut, with the vectors it would have if there were a frame before.
pub struct AnalyticSource {
    info: SourceInfo,
    kind: Kind,
    scene: Scene,
    view: ViewGeometry,
    pattern: Pattern,
    fps: f64,
    /// Frame 0, where later frames are made from it.
    base: Option<SourceFrame>,
}

impl AnalyticSource {
    /// The scene `name` (see [`AnalyticSource::names`]) in frames of `size` pixels, seen under the horizontal field of view
    /// `hfov_deg` in degrees, at `fps` frames per second.
    ///
    /// # Errors
    /// If there is no such scene, a side is 0 or above [`MAX_SIDE`], the field of view is not in (0, 180) degrees, or the
    /// frame rate is not above 0 and finite.
    pub fn new(name: &str, size: [u32; 2], hfov_deg: f32, fps: f32) -> Result<Self, InputError> {
        let subject = format!("analytic:{name}");
        let Some(&(_, kind)) = KINDS.iter().find(|(known, _)| *known == name) else {
            let names: Vec<_> = Self::names().collect();
            return Err(InputError::request(
                &subject,
                "there is no analytic scene of this name",
                format!("expected one of {}", names.join(", ")),
            ));
        };
        if size.iter().any(|&s| s == 0 || s > MAX_SIDE) {
            return Err(InputError::request(
                &subject,
                format!("the size is {}x{}", size[0], size[1]),
                format!("expected 1 to {MAX_SIDE} pixels a side"),
            ));
        }
        if !(fps.is_finite() && fps > 0.0) {
            return Err(InputError::request(
                &subject,
                format!("the frame rate is {fps}"),
                "expected frames per second above 0",
            ));
        }
        let view = ViewGeometry::flat(size, hfov_deg).map_err(|error| {
            InputError::request(
                &subject,
                format!("{} is {}", error.setting, error.found),
                format!("expected {}", error.expected),
            )
        })?;
        let (scene, samples) = match kind {
            Kind::Still | Kind::LightStep => (courtyard::still(), SAMPLES_KEPT),
            Kind::Lateral => (courtyard::lateral(), SAMPLES_MOVING),
            Kind::Turn => (courtyard::turn(), SAMPLES_MOVING),
            Kind::Occluder => (courtyard::occluder(), SAMPLES_MOVING),
            Kind::Scroll => (courtyard::scroll(), SAMPLES_MOVING),
        };
        Ok(Self {
            info: SourceInfo {
                name: subject,
                size,
                frames: None,
                fps: Some(fps),
                hfov_deg: Some(hfov_deg),
                still: kind == Kind::Still,
            },
            kind,
            scene,
            view,
            pattern: Pattern::new(samples),
            fps: f64::from(fps),
            base: None,
        })
    }

    /// The names [`AnalyticSource::new`] knows.
    pub fn names() -> impl Iterator<Item = &'static str> {
        KINDS.iter().map(|&(name, _)| name)
    }

    /// The view all frames are seen through.
    pub fn view(&self) -> &ViewGeometry {
        &self.view
    }

    /// Pixels of frame `index` that the panel without motion vectors covers, wholly or in part: all that changes in `scroll`.
    /// `None` for scenes without one.
    pub fn panel_mask(&self, index: u64) -> Option<Image<bool>> {
        let stage = self.stage(index);
        let panel = stage.panel?;
        let caster = self.caster(&stage);
        let pixels = caster.render(false, |x, y, tile| caster.touches(x, y, tile, panel));
        Some(image(self.info.size, pixels))
    }

    fn caster<'a>(&'a self, stage: &'a Stage) -> Caster<'a> {
        Caster::new(stage, &self.view, &self.pattern)
    }

    fn stage(&self, index: u64) -> Stage {
        let now = index as f64;
        let mut stage = self.scene.stage(now / self.fps, (now - 1.0) / self.fps);
        if let Some(panel) = stage.panel
            && let Material::Scroll { shift, .. } = &mut stage.objects[panel].material
        {
            let tangent = 2.0 * f64::from(0.5 * DEFAULT_HFOV_DEG).to_radians().tan() / f64::from(DEFAULT_SIZE[0]);
            let metres = courtyard::panel_metres(SCROLL_PX, tangent) * now;
            *shift = metres.rem_euclid(SCROLL_PERIOD) as f32;
        }
        stage
    }

    fn cast(&self, index: u64) -> SourceFrame {
        let stage = self.stage(index);
        let caster = self.caster(&stage);
        let empty = Geometry { depth: f32::INFINITY, motion: [0.0; 2] };
        let pixels =
            caster.render(([0.0; 3], empty), |x, y, tile| (caster.color(x, y, tile), caster.geometry(x, y, tile)));
        let size = self.info.size;
        let geometry = image(size, pixels);
        SourceFrame {
            color: geometry.map(|(color, _)| color),
            depth: Some(geometry.map(|(_, at)| at.depth)),
            motion: Some(geometry.map(|(_, at)| at.motion)),
            trust: None,
            previous_from_current: Some(stage.cameras[0].to(&stage.cameras[1])),
            cut: index == 0,
            nonfinite: 0,
        }
    }

    /// Frame 0 again, for scenes that keep it.
    fn kept(&mut self) -> SourceFrame {
        if let Some(base) = &self.base {
            return base.clone();
        }
        let base = self.cast(0);
        self.base.insert(base).clone()
    }

    /// The kept picture with the panel's pixels cast anew.
    fn scrolled(&mut self, index: u64) -> SourceFrame {
        let mut frame = self.kept();
        let stage = self.stage(index);
        let Some(panel) = stage.panel else {
            return frame;
        };
        let caster = self.caster(&stage);
        let fresh = caster.render(None, |x, y, tile| {
            (tile.candidates.contains(&(panel as u16)) && caster.touches(x, y, tile, panel))
                .then(|| caster.color(x, y, tile))
        });
        for (pixel, fresh) in frame.color.pixels_mut().iter_mut().zip(fresh) {
            *pixel = fresh.unwrap_or(*pixel);
        }
        frame.trust = self.panel_mask(index).map(|mask| mask.map(|panel| if panel { 0.0 } else { 1.0 }));
        frame
    }
}

fn image<T: Copy>(size: [u32; 2], pixels: Vec<T>) -> Image<T> {
    Image::from_pixels(size, pixels).expect("one value was cast for each pixel")
}

impl FrameSource for AnalyticSource {
    fn info(&self) -> &SourceInfo {
        &self.info
    }

    fn frame(&mut self, index: u64) -> Result<SourceFrame, InputError> {
        let mut frame = match self.kind {
            Kind::Lateral | Kind::Turn | Kind::Occluder => self.cast(index),
            Kind::Still => self.kept(),
            Kind::Scroll => self.scrolled(index),
            Kind::LightStep => {
                let mut frame = self.kept();
                let [from, until] = LIGHT_STEP_SECONDS;
                if (from..until).contains(&(index as f64 / self.fps)) {
                    for pixel in frame.color.pixels_mut() {
                        *pixel = pixel.map(|channel| channel * LIGHT_STEP);
                    }
                }
                frame
            }
        };
        frame.cut = index == 0;
        Ok(frame)
    }
}

//! Analytic scenes: a courtyard of textured rectangles, spheres and posts, ray-cast on the CPU. Color, depth, motion
//! vectors and camera motion are exact, so that errors of a temporal method are not mixed with errors of its input.
//!
//! | scene | motion | tests |
//! |---|---|---|
//! | `still` | none | recovery of detail |
//! | `lateral` | the camera, sideways, at most 1 m/s | reprojection, disocclusion behind near posts |
//! | `turn` | the camera, rotation only, at most 17 degrees a second | camera rotation: every pixel moves, nothing is disoccluded |
//! | `walk` | the head of a person who walks past posts: 0.9 m/s ahead, 45 degrees a second, nodding and rolling | magnification, resampling every frame |
//! | `occluder` | a fence and a rolling ball in front, a spinning globe, the camera a little | motion of objects |
//! | `light-step` | none; the light falls to 0.45 for 0.75 s | change without motion |
//! | `spin` | a box, turning out of near-black shadow into the sun | change of light on a moving surface |
//! | `scroll` | the page on a panel, without motion vectors | content with wrong motion vectors |

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
use crate::frame::{RenderedFrame, SourceFrame};
use crate::source::{FrameRequest, FrameSource, SourceInfo};
use afterimage::{Image, ViewGeometry};
use cast::{Caster, Geometry, Pattern};
use scene::{Scene, Stage};
use texture::Material;

/// Default width and height in pixels.
pub const DEFAULT_SIZE: [u32; 2] = [640, 360];
/// Default horizontal field of view in degrees.
pub const DEFAULT_HFOV_DEG: f32 = 70.0;
/// Default frames per second.
pub const DEFAULT_FPS: f32 = 60.0;
/// Largest width and height in pixels.
pub const MAX_SIDE: u32 = 16_384;
/// Factor on all light while `light-step` is dark.
pub const LIGHT_STEP: f32 = 0.45;
/// Begin and end of the dark interval of `light-step` in seconds: frames 30 to 74 at 60 frames per second.
pub const LIGHT_STEP_SECONDS: [f64; 2] = [0.5, 1.25];
/// Upward motion of the page of `scroll` in pixels per frame, at the default size and field of view.
pub const SCROLL_PX: f64 = 2.0;

/// Color samples per pixel: many where frame 0 is cached, few where each frame is cast again.
const SAMPLES_KEPT: u32 = 16;
const SAMPLES_MOVING: u32 = 4;
/// Period of the page of `scroll` in metres: bounds the coordinates, so that late frames are as exact as early ones.
const SCROLL_PERIOD: f64 = 1024.0;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Still,
    /// Camera or objects move, so that each frame is cast anew.
    Moving,
    LightStep,
    Scroll,
}

/// Name, kind and scene.
type Named = (&'static str, Kind, fn() -> Scene);

const KINDS: [Named; 8] = [
    ("still", Kind::Still, courtyard::still),
    ("lateral", Kind::Moving, courtyard::lateral),
    ("turn", Kind::Moving, courtyard::turn),
    ("walk", Kind::Moving, courtyard::walk),
    ("occluder", Kind::Moving, courtyard::occluder),
    ("light-step", Kind::LightStep, courtyard::still),
    ("spin", Kind::Moving, courtyard::spin),
    ("scroll", Kind::Scroll, courtyard::scroll),
];

/// An endless scene with exact color, depth and motion.
///
/// Each frame is a function of its index alone: the same bytes in any order of calls, on any number of threads. Depth
/// and motion are those at pixel centres; color is the mean over the pixel's area.
///
/// Depth, motion and `previous_from_current` (the identity for a static camera) are always present. Frame 0 is a cut;
/// its motion vectors refer to the scene one frame earlier.
pub struct AnalyticSource {
    info: SourceInfo,
    kind: Kind,
    scene: Scene,
    view: ViewGeometry,
    pattern: Pattern,
    fps: f64,
    /// Cached frame 0, for scenes whose later frames derive from it, and its samples a pixel.
    base: Option<(u32, SourceFrame)>,
}

impl AnalyticSource {
    /// The scene `name` (see [`AnalyticSource::names`]) in frames of `size` pixels, with a horizontal field of view of
    /// `hfov_deg` degrees, at `fps` frames per second.
    ///
    /// # Errors
    /// [`Request`](InputError::Request) if there is no such scene, a side is 0 or above [`MAX_SIDE`], the field of view
    /// is not in (0, 180) degrees, or the frame rate is not above 0 and finite.
    pub fn new(name: &str, size: [u32; 2], hfov_deg: f32, fps: f32) -> Result<Self, InputError> {
        let subject = format!("analytic:{name}");
        let refused =
            |problem: String, expected: &str| InputError::request(&subject, problem, format!("expected {expected}"));
        let Some(&(_, kind, scene)) = KINDS.iter().find(|(known, ..)| *known == name) else {
            let names: Vec<_> = Self::names().collect();
            return Err(refused("there is no such analytic scene".into(), &format!("one of {}", names.join(", "))));
        };
        if size.iter().any(|&s| s == 0 || s > MAX_SIDE) {
            let problem = format!("the size is {}x{}", size[0], size[1]);
            return Err(refused(problem, &format!("1 to {MAX_SIDE} pixels a side")));
        }
        if !(fps.is_finite() && fps > 0.0) {
            return Err(refused(format!("the frame rate is {fps}"), "frames per second above 0"));
        }
        let view = ViewGeometry::flat(size, hfov_deg)
            .map_err(|error| refused(format!("{} is {}", error.setting, error.found), &error.expected))?;
        let is_kept = matches!(kind, Kind::Still | Kind::LightStep);
        let samples = if is_kept { SAMPLES_KEPT } else { SAMPLES_MOVING };
        Ok(Self {
            info: SourceInfo {
                name: subject,
                size,
                frames: None,
                fps: Some(fps),
                hfov_deg: Some(hfov_deg),
                still: kind == Kind::Still,
                has_albedo: false,
            },
            kind,
            scene: scene(),
            view,
            pattern: Pattern::new(samples),
            fps: f64::from(fps),
            base: None,
        })
    }

    /// Names of the scenes.
    pub fn names() -> impl Iterator<Item = &'static str> {
        KINDS.iter().map(|&(name, ..)| name)
    }

    /// View of all frames.
    pub fn view(&self) -> &ViewGeometry {
        &self.view
    }

    /// Mask of the panel without motion vectors in frame `index`: pixels that it covers fully or partly. In `scroll`,
    /// only these change. `None` for scenes without such a panel.
    pub fn panel_mask(&self, index: u64) -> Option<Image<bool>> {
        let stage = self.stage(index);
        let panel = stage.panel?;
        let caster = self.caster(&stage);
        let pixels = caster.render(false, |x, y, tile| caster.touches(x, y, tile, panel));
        Some(image(self.info.size, pixels))
    }

    /// Frame `index` of a projection that is jittered by `jitter_px` (a point at `p` without jitter is at `p +
    /// jitter_px`), with one color sample a pixel, as a rasterizer draws it. Motion vectors contain no jitter. The mean
    /// of n such frames is the frame with n samples a pixel ([`FrameRequest::reference_samples`]).
    ///
    /// # Panics
    /// If the jitter is not finite.
    pub fn jittered_frame(&self, index: u64, jitter_px: [f32; 2]) -> SourceFrame {
        let [width, height] = self.info.size.map(|s| s as f32);
        let first = self.view.ray([-0.5 - jitter_px[0], -0.5 - jitter_px[1]]);
        let last = self.view.ray([width - 0.5 - jitter_px[0], height - 0.5 - jitter_px[1]]);
        let view = ViewGeometry::off_axis(self.info.size, [first[0], last[0]], [first[1], last[1]]);
        let frame = self.cast(index, &view.expect("finite tangents"), &Pattern::new(1));
        SourceFrame { trust: self.trust(index), ..self.lit(frame, index) }
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

    fn cast(&self, index: u64, view: &ViewGeometry, pattern: &Pattern) -> SourceFrame {
        let stage = self.stage(index);
        let caster = Caster::new(&stage, view, pattern);
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

    /// Frame 0 from the cache, with a pattern of samples.
    fn cached(&mut self, pattern: &Pattern, samples: u32) -> SourceFrame {
        if let Some((_, base)) = self.base.as_ref().filter(|(held, _)| *held == samples) {
            return base.clone();
        }
        let base = self.cast(0, &self.view, pattern);
        self.base.insert((samples, base)).1.clone()
    }

    /// `frame`, which is frame 0 of `scroll`, with the panel's pixels cast again for frame `index`.
    fn scrolled(&self, mut frame: SourceFrame, index: u64, pattern: &Pattern) -> SourceFrame {
        let stage = self.stage(index);
        let Some(panel) = stage.panel else {
            return frame;
        };
        let caster = Caster::new(&stage, &self.view, pattern);
        let fresh = caster.render(None, |x, y, tile| {
            (tile.candidates.contains(&(panel as u16)) && caster.touches(x, y, tile, panel))
                .then(|| caster.color(x, y, tile))
        });
        for (pixel, fresh) in frame.color.pixels_mut().iter_mut().zip(fresh) {
            *pixel = fresh.unwrap_or(*pixel);
        }
        SourceFrame { trust: self.trust(index), ..frame }
    }

    /// History confidence: 0 on the panel without motion vectors.
    fn trust(&self, index: u64) -> Option<Image<f32>> {
        self.panel_mask(index).map(|mask| mask.map(|panel| if panel { 0.0 } else { 1.0 }))
    }

    /// The frame in the light of frame `index`, for `light-step`. Frames of other scenes stay unchanged.
    fn lit(&self, mut frame: SourceFrame, index: u64) -> SourceFrame {
        let [from, until] = LIGHT_STEP_SECONDS;
        if self.kind == Kind::LightStep && (from..until).contains(&(index as f64 / self.fps)) {
            for pixel in frame.color.pixels_mut() {
                *pixel = pixel.map(|channel| channel * LIGHT_STEP);
            }
        }
        frame
    }

    /// Full-rate frame `index`, with `samples` samples a pixel, if given, instead of the scene's own number.
    fn full_rate(&mut self, index: u64, samples: Option<u32>) -> SourceFrame {
        let pattern = samples.map_or_else(|| self.pattern.clone(), Pattern::supersampled);
        let samples = samples.unwrap_or_default();
        let frame = match self.kind {
            Kind::Moving => self.cast(index, &self.view, &pattern),
            Kind::Still | Kind::LightStep | Kind::Scroll => self.cached(&pattern, samples),
        };
        let frame = if self.kind == Kind::Scroll { self.scrolled(frame, index, &pattern) } else { frame };
        let frame = self.lit(frame, index);
        SourceFrame { cut: index == 0, ..frame }
    }
}

fn image<T: Copy>(size: [u32; 2], pixels: Vec<T>) -> Image<T> {
    Image::from_pixels(size, pixels).expect("one value was cast for each pixel")
}

impl FrameSource for AnalyticSource {
    fn info(&self) -> &SourceInfo {
        &self.info
    }

    fn render(&mut self, request: &FrameRequest) -> Result<RenderedFrame, InputError> {
        let index = request.index;
        let frame = self.full_rate(index, request.reference_samples);
        let frame = RenderedFrame::full_rate(index, request.gaze_px, frame);
        Ok(match request.jitter_px {
            Some(jitter_px) => frame.jittered(self.jittered_frame(index, jitter_px), jitter_px),
            None => frame,
        })
    }
}

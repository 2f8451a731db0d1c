//! A scene whose traced frames are timed.

use crate::Tracer;
use crate::film::Film;
use crate::sampling::{Sampling, trace_requested};
use crate::settings::TraceSettings;
use crate::surfaces::Surfaces;
use crate::work::Spans;
use crate::world::World;
use afterimage::{Image, ViewGeometry};
use afterimage_lab::clock::Stopwatch;
use afterimage_lab::device::Backend;
use afterimage_lab::error::InputError;
use afterimage_lab::frame::{Content, FoveatedFrame, RenderedFrame, ShadingRequest, SourceFrame};
use afterimage_lab::source::{Light, SceneChoice, SceneOptions, ViewedScene};
use afterimage_lab::view::View;
use std::time::Duration;

/// A sampling pattern and gaze.
#[derive(Clone, Debug)]
pub struct Pattern {
    /// Name in reports.
    pub name: String,
    /// The pattern.
    pub sampling: Sampling,
    /// Samples per pixel where the pattern is densest.
    pub samples: u32,
    /// Gaze, pixels.
    pub gaze_px: [f32; 2],
}

/// Offset of the frame numbers that seed full-rate frames.
const FULL_RATE_FRAMES: u64 = 1 << 31;

/// A still scene and its camera, traced at one sample per pixel.
pub struct TracedView {
    /// Name of the scene.
    pub name: String,
    /// What is traced.
    pub world: World,
    of: ViewedScene,
    size: [u32; 2],
}

/// A foveated frame.
pub struct Foveated {
    /// Filled between the samples.
    pub frame: FoveatedFrame,
    /// Number of samples.
    pub samples: u64,
    /// Time to trace it.
    pub took: FrameTime,
}

/// Times and rays of one frame.
#[derive(Clone, Copy, Debug)]
pub struct FrameTime {
    /// CPU time of the process; wall time where it is not available.
    pub cpu_ms: f64,
    /// Wall time.
    pub wall_ms: f64,
    /// Time of the kernels by timestamp queries, on a hardware GPU.
    pub device_ms: Option<f64>,
    /// 0 where the rays stay uncounted on a device.
    pub rays: u64,
}

impl TracedView {
    /// Opens the scene `name`. `camera` as for `trace --camera`; default: its first camera, or one that frames the
    /// scene.
    ///
    /// # Errors
    /// If the scene or the camera cannot be used.
    pub fn open(name: &str, size: [u32; 2], camera: Option<&str>, hfov_deg: Option<f32>) -> Result<Self, InputError> {
        let of = ViewedScene::open(&SceneChoice {
            camera: camera.or(Some("still")),
            light: Light::IfDark,
            options: SceneOptions { size: Some(size), hfov_deg, fps: None },
            ..SceneChoice::new(name)
        })?;
        Ok(Self { name: name.to_owned(), world: World::new(&of.scene), of, size })
    }

    /// Features of the scene file that are ignored or approximated.
    pub fn warnings(&self) -> &[String] {
        self.of.warnings()
    }

    /// View geometry.
    pub fn geometry(&self) -> &ViewGeometry {
        self.of.camera.geometry()
    }

    fn view(&self, index: u64) -> View {
        self.of.camera.view(&self.of.scene, index, self.of.time_s(index))
    }

    /// A tracer of the scene.
    ///
    /// # Errors
    /// If the scene does not fit on the device.
    pub fn tracer(&self, backend: &Backend, settings: TraceSettings) -> Result<Tracer, InputError> {
        Tracer::new(backend, &self.world, settings)
            .map_err(|e| InputError::device(&self.name, e.to_string(), "trace it on the CPU"))
    }

    /// Traces frame `index`.
    pub fn frame(&self, tracer: &Tracer, index: u64) -> FrameTime {
        self.trace(tracer, index, &Spans::uniform(self.size[0], 0..self.size[1], 0..1))
    }

    /// The full-rate frame: `samples` of every pixel, with other random draws than [`foveated`](Self::foveated) frames.
    pub fn full_rate(&self, tracer: &Tracer, samples: u32, index: u64) -> Image<[f32; 3]> {
        let [width, height] = self.size;
        let mut film = Film::new(self.size);
        let spans = Spans::uniform(width, 0..height, 0..samples);
        tracer.trace(&self.world, &self.view(index), FULL_RATE_FRAMES + index, &spans, &mut film);
        film.color()
    }

    /// What a post-process needs to know of a frame in memory besides its color.
    fn without_color(&self, tracer: &Tracer, index: u64) -> SourceFrame {
        let ([view, before], _) = self.of.views(index);
        let frame = SourceFrame::without_images(Some(view.previous_from_current(&before)), index == 0);
        let seen = Surfaces::trace(&self.world, &view, &before, tracer.effects(&self.world));
        SourceFrame { depth: Some(seen.depth), motion: Some(seen.motion), ..frame }
    }

    /// Traces a few samples, which is enough to run every kernel.
    pub fn few(&self, tracer: &Tracer) -> FrameTime {
        let [width, height] = self.size;
        let first = (0..64.min(width * height)).map(|i| [i % width, i / width]);
        self.trace(tracer, 0, &Spans::new(first, 0..1))
    }

    /// Center of the frame, pixels.
    pub fn middle_px(&self) -> [f32; 2] {
        self.size.map(|s| 0.5 * (s as f32 - 1.0))
    }

    /// Traces a foveated frame. Its time includes planning and interpolation.
    pub fn foveated(&self, tracer: &Tracer, pattern: &Pattern, index: u64) -> Foveated {
        let &Pattern { sampling, samples, gaze_px, .. } = pattern;
        let (world, geometry, view) = (&self.world, self.geometry(), self.view(index));
        let watch = Stopwatch::start();
        let frame = sampling.plan(geometry, gaze_px, samples, index).trace(tracer, world, &view, index);
        let took = FrameTime::by(&watch, None, frame.rays);
        Foveated { samples: frame.samples.iter().sum(), frame, took }
    }

    /// Depth and motion of a frame whose pixels a post-process chooses, without a reference.
    pub fn surfaces(&self, tracer: &Tracer, gaze_px: [f32; 2], index: u64) -> RenderedFrame {
        let reference = self.without_color(tracer, index);
        RenderedFrame { content: Content::Surfaces, ..RenderedFrame::full_rate(index, gaze_px, reference) }
    }

    /// Traces the pixels of frame `index` that a post-process chose, with the paths that it asks for or with `samples`.
    pub fn shade(&self, tracer: &Tracer, request: &ShadingRequest, samples: u32, index: u64) -> (Film, FrameTime) {
        let watch = Stopwatch::start();
        let film = trace_requested(tracer, &self.world, &self.view(index), index, request, samples);
        let took = FrameTime::by(&watch, None, film.rays);
        (film, took)
    }

    /// Traces `samples` of every pixel. With `every` above 1, traces only every `every`-th band of rows and scales the
    /// times to the whole frame.
    pub fn uniform(&self, tracer: &Tracer, samples: u32, every: u32, index: u64) -> FrameTime {
        const BAND: u32 = 4;
        let [width, height] = self.size;
        let band = if every > 1 { BAND } else { height };
        let view = self.view(index);
        let (mut rows, mut rays) = (0, 0);
        let watch = Stopwatch::start();
        for first in (band * (every / 2)..height).step_by((band * every) as usize) {
            let band = first..(first + band).min(height);
            let mut film = Film::window([0, first], [width, band.len() as u32]);
            rows += band.len();
            tracer.trace(&self.world, &view, index, &Spans::uniform(width, band, 0..samples), &mut film);
            rays += film.rays;
            std::hint::black_box(film.color());
        }
        let took = FrameTime::by(&watch, None, rays);
        let more = f64::from(height) / rows.max(1) as f64;
        FrameTime { cpu_ms: took.cpu_ms * more, wall_ms: took.wall_ms * more, ..took }
    }

    fn trace(&self, tracer: &Tracer, index: u64, work: &Spans) -> FrameTime {
        let view = self.view(index);
        let mut film = Film::new(self.size);
        let watch = Stopwatch::start();
        let device = match tracer {
            Tracer::Gpu(tracer) => tracer.trace_timed(&self.world, &view, index, work, &mut film),
            Tracer::Cpu(tracer) => {
                tracer.trace(&self.world, &view, index, work, &mut film);
                None
            }
        };
        FrameTime::by(&watch, device, film.rays)
    }
}

impl FrameTime {
    fn by(watch: &Stopwatch, device: Option<Duration>, rays: u64) -> Self {
        let (wall_ms, cpu_ms) = (watch.wall_ms(), watch.cpu_ms());
        Self { cpu_ms: cpu_ms.unwrap_or(wall_ms), wall_ms, device_ms: device.map(|d| d.as_secs_f64() * 1e3), rays }
    }
}

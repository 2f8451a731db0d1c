//! Frames of a scene from the path tracer.

use crate::Tracer;
use crate::film::Film;
use crate::sampling::{Sampling, trace_requested};
use crate::settings::TraceSettings;
use crate::surfaces::{Surfaces, albedo};
use crate::work::Spans;
use crate::world::World;
use afterimage::Image;
use afterimage_lab::clock::Elapsed;
use afterimage_lab::device::{Backend, SpanClock};
use afterimage_lab::error::{InputError, device_lost};
use afterimage_lab::frame::{Content, RenderedFrame, Shaded, ShadedColor, ShadingRequest, SourceFrame};
use afterimage_lab::source::{
    CameraPose, FrameRequest, FrameSource, Light, ReadLimits, SceneChoice, SceneOptions, SourceInfo, ViewedScene,
    Wanted,
};
use afterimage_lab::view::View;
use glam::DMat4;

/// Samples traced per call, which bounds the memory of their paths.
const STEP: u32 = 1 << 20;
/// Offset of the frame numbers that seed full-rate frames, so that their noise is independent of the foveated frames'.
const FULL_RATE_FRAMES: u64 = 1 << 31;

/// Sample counts and distribution.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TracedSamples {
    /// Sampling pattern of the foveated frame; `None` leaves foveation to a simulator.
    pub foveated: Option<Sampling>,
    /// Largest number of samples per pixel of the foveated frame, unless the pattern states its own.
    pub samples: u32,
    /// Samples per pixel of the full-rate frame.
    pub full_rate_samples: u32,
}

/// A scene seen by a camera, path-traced frame by frame: at full rate with the same number of samples everywhere, and
/// foveated.
///
/// As with [`RasterSource`](afterimage_lab::source::RasterSource), each frame is a function of its index alone, and
/// frame 0 is a cut. Depth and motion are those at pixel centres, without noise.
pub struct TracedSource {
    of: ViewedScene,
    world: World,
    tracer: Tracer,
    settings: TraceSettings,
    samples: TracedSamples,
    /// Cached full-rate frame of a static scene, and its time.
    still: Option<(SourceFrame, Elapsed)>,
    clock: SpanClock,
}

impl TracedSource {
    /// Opens a `.gltf` or `.glb` file or `builtin:NAME`, seen by the camera that
    /// [`SceneCamera::choose`](afterimage_lab::source::SceneCamera::choose) selects for `camera`. A scene without
    /// lights gets a uniform white environment.
    ///
    /// # Errors
    /// Those of [`ViewedScene::open`] and [`TracedSource::new`].
    pub fn open(
        input: &str,
        limits: &ReadLimits,
        options: &SceneOptions,
        camera: Option<&str>,
        backend: &Backend,
        settings: TraceSettings,
        samples: TracedSamples,
    ) -> Result<Self, InputError> {
        let choice =
            SceneChoice { camera, light: Light::IfDark, options: *options, limits: *limits, ..SceneChoice::new(input) };
        Self::new(ViewedScene::open(&choice)?, backend, settings, samples)
    }

    /// Path-traces a scene without changes, with only its own light.
    ///
    /// # Errors
    /// [`Device`](InputError::Device) if the scene does not fit the device.
    pub fn new(
        of: ViewedScene,
        backend: &Backend,
        settings: TraceSettings,
        samples: TracedSamples,
    ) -> Result<Self, InputError> {
        let world = World::new(&of.scene);
        let tracer = Tracer::new(backend, &world, settings)
            .map_err(|e| InputError::device(&of.scene.name, e.to_string(), "trace it on the CPU"))?;
        Ok(Self { of, world, tracer, settings, samples, still: None, clock: SpanClock::new(backend) })
    }

    /// Features of the scene file that are ignored or approximated.
    pub fn warnings(&self) -> &[String] {
        &self.of.scene.warnings
    }
}

impl TracedSource {
    /// Poses the scene for a frame, and returns the frame's view and the previous one.
    fn pose(&mut self, request: &FrameRequest) -> Result<[View; 2], InputError> {
        let (views, times) = self.of.views(request.index);
        if self.of.scene.duration_s() > 0.0 {
            self.world.pose(&self.of.scene, times[0], times[1]);
            self.tracer
                .update(&self.world)
                .map_err(|e| InputError::device(&self.of.info().name, e.to_string(), "trace it on the CPU"))?;
        }
        Ok(views)
    }

    /// An error if the device was lost, which makes the traced samples invalid.
    fn check(&self) -> Result<(), InputError> {
        self.tracer.check().map_err(|lost| device_lost(&self.of.info().name, &lost))
    }

    /// The full-rate frame, and the time of tracing its color.
    fn full_rate(&mut self, request: &FrameRequest) -> Result<(SourceFrame, Elapsed), InputError> {
        let index = request.index;
        let [view, previous] = self.pose(request)?;
        let [width, height] = self.of.info().size;
        let mut film = Film::new(self.of.info().size);
        let samples = self.samples.full_rate_samples.max(1);
        let rows = (STEP / width.saturating_mul(samples).max(1)).max(1);
        let ((), took) = self.clock.time(|| {
            for first in (0..height).step_by(rows as usize) {
                let spans = Spans::uniform(width, first..(first + rows).min(height), 0..samples);
                self.tracer.trace(&self.world, &view, FULL_RATE_FRAMES + index, &spans, &mut film);
            }
        });
        self.check()?;
        let seen = self.without_color(index, &[view, previous], true);
        Ok((SourceFrame { color: film.color(), nonfinite: film.nonfinite, ..seen }, took))
    }

    /// As [`full_rate`](Self::full_rate), traced once if all frames are equal.
    fn kept_full_rate(&mut self, request: &FrameRequest) -> Result<(SourceFrame, Elapsed), InputError> {
        if !self.of.info().still || self.of.camera.is_steered() {
            return self.full_rate(request);
        }
        let (frame, took) = match self.still.take() {
            Some(traced) => traced,
            None => self.full_rate(&FrameRequest { index: 0, ..request.clone() })?,
        };
        self.still = Some((frame.clone(), took));
        Ok((SourceFrame { cut: request.index == 0, ..frame }, took))
    }

    /// The full-rate frame without color; `has_geometry`: with depth and motion.
    fn without_color(&self, index: u64, [view, previous]: &[View; 2], has_geometry: bool) -> SourceFrame {
        let frame = SourceFrame::without_images(Some(view.previous_from_current(previous)), index == 0);
        if !has_geometry {
            return frame;
        }
        let seen = Surfaces::trace(&self.world, view, previous, self.tracer.effects(&self.world));
        SourceFrame { depth: Some(seen.depth), motion: Some(seen.motion), ..frame }
    }

    /// Depth and motion of every pixel, from rays on the CPU.
    fn surfaces(&mut self, request: &FrameRequest) -> Result<RenderedFrame, InputError> {
        let reference = if request.reference { Some(self.kept_full_rate(request)?.0) } else { None };
        let views = self.pose(request)?;
        let (seen, took) = self.clock.time(|| self.without_color(request.index, &views, true));
        let reference = SourceFrame { color: reference.map_or(seen.color, |frame| frame.color), ..seen };
        let albedo = self.albedo(request);
        Ok(RenderedFrame { content: Content::Surfaces, render: Some(took), albedo, ..request.answer(reference) })
    }

    /// Albedo of every pixel of the frame for which the scene was posed last, if it is requested.
    fn albedo(&self, request: &FrameRequest) -> Option<Image<[f32; 3]>> {
        let [view, _] = self.of.views(request.index).0;
        request.albedo.then(|| albedo(&self.world, &view, &self.settings))
    }
}

impl FrameSource for TracedSource {
    fn info(&self) -> &SourceInfo {
        self.of.info()
    }

    /// Renders a frame by the source's own sampling pattern, or its depth and motion alone if methods choose the pixels
    /// that are traced. A source without a pattern renders the full-rate frame.
    fn render(&mut self, request: &FrameRequest) -> Result<RenderedFrame, InputError> {
        let &FrameRequest { index, gaze_px, .. } = request;
        if request.wanted == Wanted::Surfaces {
            return self.surfaces(request);
        }
        let Some(sampling) = self.samples.foveated else {
            let (frame, took) = self.kept_full_rate(request)?;
            let albedo = self.albedo(request);
            return Ok(RenderedFrame { render: Some(took), full_rate: Some(took), albedo, ..request.answer(frame) });
        };
        // The reference has another number of samples a pixel, so its time cannot be compared with that of the foveated
        // frame.
        let reference = if request.reference { Some(self.kept_full_rate(request)?.0) } else { None };
        let views = self.pose(request)?;
        let view = &views[0];
        let reference = reference.unwrap_or_else(|| self.without_color(index, &views, true));
        let samples = self.samples.samples.max(1);
        let (frame, took) = self.clock.time(|| {
            let plan = sampling.plan(view.geometry(), gaze_px, samples, index);
            plan.trace(&self.tracer, &self.world, view, index)
        });
        self.check()?;
        Ok(RenderedFrame { render: Some(took), ..request.answer(reference).foveated(frame) })
    }

    /// Traces the paths of each chosen pixel, or all samples of the source, with draws that differ from those of the
    /// full-rate frame.
    fn shade(&mut self, frame: &RenderedFrame, request: &ShadingRequest) -> Result<Option<Shaded>, InputError> {
        let [view, _] = self.of.views(frame.index).0;
        let (tracer, samples) = (&self.tracer, self.samples.samples);
        let trace = || trace_requested(tracer, &self.world, &view, frame.index, request, samples);
        let (film, took) = self.clock.time(trace);
        self.check()?;
        let (color, noise) = (ShadedColor::InMemory(film.color()), Some(film.noise()));
        Ok(Some(Shaded { color, half: None, noise, took }))
    }

    fn camera_pose(&self, index: u64) -> Option<CameraPose> {
        Some(self.of.camera.camera_pose(&self.of.scene, index, self.of.time_s(index)))
    }

    fn steer(&mut self, index: u64, before_and_now: Option<[DMat4; 2]>) {
        self.of.camera.steer(index, before_and_now);
    }
}

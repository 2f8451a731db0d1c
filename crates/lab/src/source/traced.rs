//! Frames of a scene from the path tracer.

use super::CameraPose;
use super::open::device_lost;
use super::viewed_scene::{Light, SceneChoice, ViewedScene};
use super::{FrameRequest, FrameSource, ReadLimits, SceneOptions, SourceInfo, Wanted};
use crate::clock::Elapsed;
use crate::device::{Backend, SpanClock};
use crate::error::InputError;
use crate::frame::{
    Content, DeviceSamples, FoveatedFrame, OnDevice, QuadRequest, RenderedFrame, Shaded, ShadedColor, SourceFrame,
};
use crate::lattices::{SampleOrder, Geometry};
use crate::trace::Tracer;
use crate::trace::film::Film;
use crate::trace::sampling::{Sampling, SparsePlan};
use crate::trace::settings::TraceSettings;
use crate::trace::surfaces::Surfaces;
use crate::trace::view::View;
use crate::trace::work::Spans;
use crate::trace::world::World;
use afterimage::SettingsError;
use glam::DMat4;
use std::sync::Arc;

/// Samples traced per call, which bounds the memory of their paths.
const STEP: u32 = 1 << 20;
/// Offset of the frame numbers that seed full-rate frames, so that their noise is independent of the foveated frames'.
const FULL_RATE_FRAMES: u64 = 1 << 31;

/// Sample counts and distribution.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TracedSamples {
    /// Sampling pattern of the foveated frame; `None` leaves foveation to a simulator.
    pub foveated: Option<Sampling>,
    /// Order in which the pattern's lattices move, for foveated frames that are given as samples
    /// ([`Sampling::sparse_plan`]); `None`: frames that are reconstructed between the samples.
    pub sparse: Option<SampleOrder>,
    /// Largest number of samples per pixel of the foveated frame, unless the pattern states its own.
    pub samples: u32,
    /// Samples per pixel of the full-rate frame.
    pub full_rate_samples: u32,
}

/// A scene seen by a camera, path-traced frame by frame: at full rate with the same number of samples everywhere, and
/// foveated.
///
/// As with [`RasterSource`](super::RasterSource), each frame is a function of its index alone, and frame 0 is a cut.
/// Depth and motion are those at pixel centres, without noise.
pub struct TracedSource {
    of: ViewedScene,
    world: World,
    tracer: Tracer,
    samples: TracedSamples,
    /// Cached full-rate frame of a static scene, and its time.
    still: Option<(SourceFrame, Elapsed)>,
    clock: SpanClock,
    /// Samples of the last sparse frame on the tracer's device.
    on_device: Option<DeviceSamples>,
}

impl TracedSource {
    /// Opens a `.gltf` or `.glb` file or `builtin:NAME`, seen by the camera that
    /// [`SceneCamera::choose`](super::SceneCamera::choose) selects for `camera`. A scene without lights gets a uniform
    /// white environment.
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
        Ok(Self { of, world, tracer, samples, still: None, clock: SpanClock::new(backend), on_device: None })
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

    /// Plan of a sparse frame; `None` if frames are filled between their samples, or not foveated.
    fn sparse_plan(&self, view: &View, index: u64, gaze_px: [f32; 2]) -> Result<Option<SparsePlan>, InputError> {
        let Some((sampling, order)) = self.samples.foveated.zip(self.samples.sparse) else { return Ok(None) };
        let plan = sampling.sparse_plan(view.geometry(), gaze_px, self.samples.samples.max(1), index, order);
        let refused = |e: SettingsError| {
            InputError::request(&self.of.info().name, e.to_string(), "choose another sampling pattern")
        };
        plan.map(Some).map_err(refused)
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
        Ok(RenderedFrame { content: Content::Surfaces, render: Some(took), ..request.answer(reference) })
    }

    /// The samples of a sparse frame, which stay on the tracer's device, and the time of tracing them. `None` unless
    /// the frame is sparse and the methods run on that device.
    fn samples_on_device(
        &mut self,
        request: &FrameRequest,
        [view, previous]: &[View; 2],
    ) -> Result<Option<(DeviceSamples, Elapsed)>, InputError> {
        let Tracer::Gpu(tracer) = &self.tracer else { return Ok(None) };
        let is_wanted =
            request.device.as_ref().is_some_and(|device| Arc::as_ptr(device).cast() == Arc::as_ptr(tracer.device()));
        if self.samples.sparse.is_none() || !is_wanted {
            return Ok(None);
        }
        let held = self.on_device.take();
        let mut held = held.unwrap_or_else(|| DeviceSamples::new(tracer.device(), self.of.info().size));
        let (traced, took) = self.clock.time(|| {
            let Some(plan) = self.sparse_plan(view, request.index, request.gaze_px)? else { return Ok(false) };
            let views = [view, previous];
            plan.trace_in_place(tracer, &self.world, views, request.index, request.geometry, &mut held);
            Ok(true)
        });
        if !traced? {
            return Ok(None);
        }
        self.check()?;
        self.on_device = Some(held.clone());
        Ok(Some((held, took)))
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
            return Ok(RenderedFrame { render: Some(took), full_rate: Some(took), ..request.answer(frame) });
        };
        // The reference has another number of samples a pixel, so its time cannot be compared with that of the foveated
        // frame.
        let reference = if request.reference { Some(self.kept_full_rate(request)?.0) } else { None };
        let views = self.pose(request)?;
        let view = &views[0];
        if let Some((samples, took)) = self.samples_on_device(request, &views)? {
            let has_geometry = request.geometry == Geometry::Samples;
            let reference = reference.unwrap_or_else(|| self.without_color(index, &views, !has_geometry));
            return Ok(RenderedFrame {
                samples: Some(samples.samples.iter().sum()),
                content: OnDevice::Samples(samples).into(),
                render: Some(took),
                ..request.answer(reference)
            });
        }
        let reference = reference.unwrap_or_else(|| self.without_color(index, &views, true));
        let samples = self.samples.samples.max(1);
        let (frame, took) = self.clock.time(|| {
            if let Some(plan) = self.sparse_plan(view, index, gaze_px)? {
                return Ok(plan.trace(&self.tracer, &self.world, view, index));
            }
            let plan = sampling.plan(view.geometry(), gaze_px, samples, index);
            Ok(plan.trace(&self.tracer, &self.world, view, index))
        });
        let frame: FoveatedFrame = frame?;
        self.check()?;
        Ok(RenderedFrame { render: Some(took), ..request.answer(reference).foveated(frame) })
    }

    /// Traces all samples of each chosen pixel, with draws that differ from those of the full-rate frame.
    fn shade(&mut self, frame: &RenderedFrame, request: &QuadRequest) -> Result<Option<Shaded>, InputError> {
        let [view, _] = self.of.views(frame.index).0;
        let mut film = Film::new(self.of.info().size);
        let samples = self.samples.samples.max(1);
        let ((), took) = self.clock.time(|| {
            let pixels: Vec<_> = request.pixels(self.of.info().size).collect();
            for pixels in pixels.chunks((STEP / samples).max(1) as usize) {
                let spans = Spans::new(pixels.iter().copied(), 0..samples);
                self.tracer.trace(&self.world, &view, frame.index, &spans, &mut film);
            }
        });
        self.check()?;
        Ok(Some(Shaded { color: ShadedColor::InMemory(film.color()), took }))
    }

    fn camera_pose(&self, index: u64) -> Option<CameraPose> {
        Some(self.of.camera.camera_pose(&self.of.scene, index, self.of.time_s(index)))
    }

    fn steer(&mut self, index: u64, before_and_now: Option<[DMat4; 2]>) {
        self.of.camera.steer(index, before_and_now);
    }
}

//! Frames of a scene from the rasteriser.

use super::CameraPose;
use super::scene_camera::SceneCamera;
use super::viewed_scene::{SceneChoice, ViewedScene};
use super::{FrameRequest, FrameSource, ReadLimits, SceneOptions, SourceInfo, Wanted, reference_offsets_px};
use crate::clock::{Elapsed, Stopwatch};
use crate::device::{Headless, PassClock};
use crate::error::{InputError, device_lost};
use crate::frame::{
    ComposedFrame, DeviceFrame, DeviceHandle, OnDevice, RenderedFrame, Shaded, ShadedColor, ShadingRequest, SourceFrame,
};
use crate::quad_views::QuadViews;
use crate::raster::{
    AtlasLayout, Composer, FoveatedTargets, Raster, RasterSettings, Shading, Targets, read_color, read_distance,
};
use crate::scene::Scene;
use crate::view::View;
use afterimage::Image;
use afterimage::internal::filled;
use glam::DMat4;
use std::sync::Arc;
use wgpu::{Buffer, BufferUsages, CommandEncoder, Device, Texture};

impl ViewedScene {
    /// Uploads the scene to a device. Texture filtering is anisotropic except on software devices.
    ///
    /// # Errors
    /// [`Request`](InputError::Request) if the device cannot draw the frame's size; [`Limit`](InputError::Limit) if the
    /// scene has more triangles than the device holds.
    pub fn on(&self, device: Arc<Headless>) -> Result<RasterSource, InputError> {
        self.shaded_on(device, Shading::default())
    }

    /// As [`on`](Self::on), lit as `shading` says.
    ///
    /// # Errors
    /// As for [`on`](Self::on).
    pub fn shaded_on(&self, device: Arc<Headless>, shading: Shading) -> Result<RasterSource, InputError> {
        let defaults = RasterSettings::default();
        // With an anisotropy of 16, a software device takes ten times as long for a frame of Sponza.
        let anisotropy = if device.is_software() { 1 } else { defaults.anisotropy };
        self.on_with(device, RasterSettings { anisotropy, shading, ..defaults })
    }

    fn on_with(&self, device: Arc<Headless>, settings: RasterSettings) -> Result<RasterSource, InputError> {
        let raster = Raster::new(&device.device, &device.queue, &self.scene, self.info().size, settings)?;
        Ok(RasterSource {
            of: self.clone(),
            clock: PassClock::new(&device),
            device,
            raster,
            foveated: [const { None }; 2],
            points: None,
            half: None,
            supersampled: None,
            composer: None,
        })
    }
}

/// A scene seen by a camera, rasterised frame by frame and read back to memory.
///
/// Each frame is a function of its index alone: the scene at `index / fps` seconds, with motion from
/// `(index - 1) / fps`. Frame 0 is a cut without motion. Depth, motion and `previous_from_current` are always present.
/// Depth and motion are sampled at pixel centres; color is the mean of four samples, or of as many as
/// [`FrameRequest::reference_samples`] asks for. Jittered frames have one sample a pixel.
pub struct RasterSource {
    of: ViewedScene,
    device: Arc<Headless>,
    raster: Raster,
    /// Targets of quad views, by layout of their atlases; none before the first such frame.
    foveated: [Option<FoveatedTargets>; 2],
    /// Targets of full-rate frames with one sample a pixel; none before the first such frame.
    points: Option<FoveatedTargets>,
    /// Targets of half the width and height; none before the first such frame.
    half: Option<FoveatedTargets>,
    /// Color of a scene that stands still, and its samples a pixel.
    supersampled: Option<(u32, Image<[f32; 3]>)>,
    /// None before the first frame of quad views.
    composer: Option<Composer>,
    clock: PassClock,
}

impl RasterSource {
    /// [`ViewedScene::open`] and [`ViewedScene::on`].
    ///
    /// # Errors
    /// As for those.
    pub fn open(
        input: &str,
        limits: &ReadLimits,
        options: &SceneOptions,
        camera: Option<&str>,
        device: Arc<Headless>,
    ) -> Result<Self, InputError> {
        let choice = SceneChoice { camera, options: *options, limits: *limits, ..SceneChoice::new(input) };
        ViewedScene::open(&choice)?.on(device)
    }

    /// As [`ViewedScene::new`], on a device with these settings.
    ///
    /// # Errors
    /// As for [`ViewedScene::new`] and [`ViewedScene::on`].
    pub fn new(
        device: Arc<Headless>,
        scene: Scene,
        camera: SceneCamera,
        fps: Option<f32>,
        settings: RasterSettings,
    ) -> Result<Self, InputError> {
        ViewedScene::new(scene, camera, fps)?.on_with(device, settings)
    }

    /// Features of the scene file that are ignored or approximated.
    pub fn warnings(&self) -> &[String] {
        self.of.warnings()
    }

    /// The scene.
    pub fn scene(&self) -> &Scene {
        &self.of.scene
    }

    /// Views of frame `index` and of the previous one, and the times of both in seconds.
    pub fn views(&self, index: u64) -> ([View; 2], [f64; 2]) {
        self.of.views(index)
    }

    /// Renders the full-rate frame `index` without reading it back.
    pub fn draw(&mut self, index: u64) -> &Raster {
        self.submit(|source, encoder| source.record_full_rate(encoder, &FrameRequest::full_rate(index)));
        &self.raster
    }

    /// Records the rendering of the full-rate frame.
    fn record_full_rate(&mut self, encoder: &mut CommandEncoder, request: &FrameRequest) {
        let [view, previous] = self.pose(request);
        self.raster.record(&self.device.device, encoder, &view, &previous);
    }

    /// Records the rendering of a frame that stays on the device, and of the full-rate frame if a simulator or the
    /// depth and motion of every pixel need it.
    pub fn record(&mut self, encoder: &mut CommandEncoder, request: &FrameRequest) -> RenderedFrame {
        let [view, previous] = self.pose(request);
        if request.needs_full_rate() {
            self.raster.record(&self.device.device, encoder, &view, &previous);
        }
        let frame = self.record_content(encoder, request, [view, previous], AtlasLayout::Compact);
        let full_rate = || on_device(&self.device, self.raster.targets(), self.raster.near());
        let reference_on_device = request.needs_full_rate().then(|| Arc::new(full_rate()) as DeviceHandle);
        RenderedFrame { reference_on_device, ..frame }
    }

    /// Records the rendering of the methods' content, unless that is the full-rate frame. Motion vectors contain no
    /// jitter, because both views have the same jitter.
    fn record_content(
        &mut self,
        encoder: &mut CommandEncoder,
        request: &FrameRequest,
        views: [View; 2],
        layout: AtlasLayout,
    ) -> RenderedFrame {
        let previous_from_current = views[0].previous_from_current(&views[1]);
        let frame = request.answer(SourceFrame::without_images(Some(previous_from_current), request.index == 0));
        let (views, jitter_px) = match request.jitter_px {
            Some(jitter_px) => (views.map(|view| view.jittered(jitter_px)), jitter_px),
            None => (views, [0.0; 2]),
        };
        let views = [&views[0], &views[1]];
        let (content, samples) = match &request.wanted {
            Wanted::FullRate => return frame,
            Wanted::QuadViews(quads) => {
                (OnDevice::Composed(self.record_quad_views(encoder, views, quads, layout)), Some(quads.pixels()))
            }
            // Each method chooses its own samples.
            Wanted::Surfaces => {
                let surfaces = self.record_surfaces(encoder, views);
                if request.albedo && self.raster.is_deferred() {
                    self.record_albedo_of(encoder, views);
                }
                (OnDevice::Surfaces(surfaces), None)
            }
        };
        RenderedFrame { content: content.into(), jitter_px, samples, ..frame }
    }

    /// The full-rate frame, read back.
    fn full_rate(&mut self, request: &FrameRequest) -> Result<RenderedFrame, InputError> {
        let index = request.index;
        let ((), took) = self.submit_timed(|source, encoder| source.record_full_rate(encoder, request))?;
        let ([view, previous], _) = self.of.views(index);
        let drawn = on_device(&self.device, self.raster.targets(), self.raster.near());
        let frame = read(&drawn, [&view, &previous], index);
        self.device.check().map_err(|lost| device_lost(&self.of.info().name, &lost))?;
        let frame = RenderedFrame { render: Some(took), full_rate: Some(took), ..request.answer(frame) };
        let Some(samples) = request.reference_samples else {
            return Ok(RenderedFrame { reference_on_device: Some(Arc::new(drawn)), ..frame });
        };
        let color = self.kept_supersampled(request, samples)?;
        Ok(RenderedFrame { reference: SourceFrame { color, ..frame.reference }, ..frame })
    }

    /// Mean of the colors of `samples` jittered frames, drawn once if all frames are equal.
    fn kept_supersampled(&mut self, request: &FrameRequest, samples: u32) -> Result<Image<[f32; 3]>, InputError> {
        if let Some((_, color)) = self.supersampled.as_ref().filter(|(held, _)| *held == samples) {
            return Ok(color.clone());
        }
        let mut mean = Image::filled(self.of.info().size, [0.0; 3]);
        for jitter_px in reference_offsets_px(samples) {
            let (drawn, ..) = self.draw_points(request, jitter_px)?;
            let color = finite(read_color(&self.device, &drawn.color)).0;
            for (sum, color) in mean.pixels_mut().iter_mut().zip(color.pixels()) {
                (0..3).for_each(|c| sum[c] += color[c] / samples as f32);
            }
        }
        let is_still = self.of.info().still && !self.of.camera.is_steered();
        self.supersampled = is_still.then(|| (samples, mean.clone()));
        Ok(mean)
    }

    /// The full-rate frame with a jittered projection and one sample a pixel, read back.
    fn points(&mut self, request: &FrameRequest, jitter_px: [f32; 2]) -> Result<(SourceFrame, Elapsed), InputError> {
        let (drawn, [view, previous], took) = self.draw_points(request, jitter_px)?;
        Ok((read(&drawn, [&view, &previous], request.index), took))
    }

    /// Draws the full-rate frame with a jittered projection and one sample a pixel. Returns the frame on the device,
    /// its view and the previous one, and the time.
    fn draw_points(
        &mut self,
        request: &FrameRequest,
        jitter_px: [f32; 2],
    ) -> Result<(DeviceFrame, [View; 2], Elapsed), InputError> {
        let size = self.of.info().size;
        let (views, took) = self.submit_timed(|source, encoder| {
            let views = source.pose(request).map(|view| view.jittered(jitter_px));
            let device = &source.device.device;
            let targets = fitted(&mut source.points, device, size);
            source.raster.record_points(device, encoder, [&views[0], &views[1]], targets);
            views
        })?;
        let targets = &self.points.as_ref().expect("they were drawn to").atlas;
        Ok((on_device(&self.device, targets, self.raster.near()), views, took))
    }

    /// Distance of the near plane in metres, of the frame that was drawn last.
    pub fn near(&self) -> f32 {
        self.raster.near()
    }

    /// Poses the scene for a frame, and returns the frame's view and the previous one.
    fn pose(&mut self, request: &FrameRequest) -> [View; 2] {
        let (views, times) = self.of.views(request.index);
        self.raster.pose(&self.of.scene, times[0], times[1]);
        views
    }

    /// Depth and motion of every pixel, with one sample a pixel.
    fn record_surfaces(&mut self, encoder: &mut CommandEncoder, views: [&View; 2]) -> DeviceFrame {
        let device = &self.device.device;
        let targets = fitted(&mut self.points, device, self.of.info().size);
        self.raster.record_surfaces(device, encoder, views, Some(targets));
        on_device(&self.device, &targets.atlas, self.raster.near())
    }

    /// Albedo of every pixel. Deferred frames must have drawn the same surfaces last.
    fn record_albedo_of(&mut self, encoder: &mut CommandEncoder, views: [&View; 2]) -> Texture {
        let device = &self.device.device;
        let targets = fitted(&mut self.points, device, self.of.info().size);
        self.raster.record_albedo(device, encoder, views, targets);
        targets.albedo(device).clone()
    }

    /// Records the albedo of every pixel of frame `index`, whose depth and motion were rendered last. The texture is
    /// drawn to again with the next frame.
    pub fn record_albedo(&mut self, encoder: &mut CommandEncoder, index: u64, jitter_px: [f32; 2]) -> Texture {
        let [view, previous] = self.jittered_views(index, jitter_px);
        self.record_albedo_of(encoder, [&view, &previous])
    }

    /// Records the full-rate frame `index` with one sample a pixel, in the pose that was rendered last.
    pub fn record_points(&mut self, encoder: &mut CommandEncoder, index: u64, jitter_px: [f32; 2]) -> DeviceFrame {
        let [view, previous] = self.jittered_views(index, jitter_px);
        let device = &self.device.device;
        let targets = fitted(&mut self.points, device, self.of.info().size);
        self.raster.record_points(device, encoder, [&view, &previous], targets);
        on_device(&self.device, &targets.atlas, self.raster.near())
    }

    /// Records the shadow map of frame `index` anew, as if the scene had moved.
    pub fn record_shadows(&mut self, encoder: &mut CommandEncoder, index: u64) {
        let [view, previous] = self.of.views(index).0;
        self.raster.record_shadows(&self.device.device, encoder, [&view, &previous]);
    }

    /// Whether frames with one sample a pixel are deferred ([`Shading::Deferred`]).
    pub fn is_deferred(&self) -> bool {
        self.raster.is_deferred()
    }

    /// Records the color of chosen quads of frame `index`, whose depth and motion were rendered last. `list`: the
    /// quads, in the form of `gpu::Afterimage::quad_list`. The texture is drawn to again with the next frame.
    pub fn record_quads(
        &mut self,
        encoder: &mut CommandEncoder,
        index: u64,
        jitter_px: [f32; 2],
        list: &Buffer,
    ) -> Texture {
        let [view, previous] = self.jittered_views(index, jitter_px);
        let device = &self.device.device;
        let targets = fitted(&mut self.points, device, self.of.info().size);
        self.raster.record_quads(device, encoder, [&view, &previous], list, targets);
        targets.atlas.color.clone()
    }

    /// Records the color of one pixel of each quad of frame `index`, whose depth and motion were rendered last.
    /// `place_px`: the pixel's place in its quad. The texture is drawn to again with the next such frame.
    pub fn record_half(
        &mut self,
        encoder: &mut CommandEncoder,
        index: u64,
        jitter_px: [f32; 2],
        place_px: [u32; 2],
    ) -> Texture {
        let [view, previous] = self.jittered_views(index, jitter_px);
        let device = &self.device.device;
        let targets = fitted(&mut self.half, device, self.of.info().size.map(|side| side.div_ceil(2)));
        self.raster.record_half(device, encoder, [&view, &previous], place_px, (targets, self.points.as_ref()));
        targets.atlas.color.clone()
    }

    /// The view of frame `index` and the previous one, jittered.
    fn jittered_views(&self, index: u64, jitter_px: [f32; 2]) -> [View; 2] {
        let is_jittered = jitter_px != [0.0; 2];
        self.of.views(index).0.map(|view| if is_jittered { view.jittered(jitter_px) } else { view })
    }

    /// Albedo of every pixel of frame `index`, which was rendered last, read back ([`Raster::record_albedo`]).
    ///
    /// # Errors
    /// [`Device`](InputError::Device) if the device is lost.
    pub fn albedo(&mut self, index: u64, jitter_px: [f32; 2]) -> Result<Image<[f32; 3]>, InputError> {
        let [view, previous] = self.jittered_views(index, jitter_px);
        let (color, _) = self.submit_timed(|source, encoder| {
            if source.raster.is_deferred() {
                source.record_surfaces(encoder, [&view, &previous]);
            }
            source.record_albedo_of(encoder, [&view, &previous])
        })?;
        Ok(read_color(&self.device, &color))
    }

    /// The frame without albedo. If the full-rate frame is the reference, quad views have the atlas layout in place:
    /// their samples at full rate are then exactly those of the reference.
    fn rendered(&mut self, request: &FrameRequest) -> Result<RenderedFrame, InputError> {
        let whole = request.reference.then(|| self.full_rate(request)).transpose()?;
        let Some(whole) = whole else {
            let (frame, took) = self.submit_timed(|source, encoder| source.record(encoder, request))?;
            return Ok(RenderedFrame { render: Some(took), ..frame });
        };
        if request.wanted == Wanted::FullRate {
            let Some(jitter_px) = request.jitter_px else { return Ok(whole) };
            let (frame, took) = self.points(request, jitter_px)?;
            return Ok(RenderedFrame { render: Some(took), ..whole.jittered(frame, jitter_px) });
        }
        let (frame, took) = self.submit_timed(|source, encoder| {
            let views = source.pose(request);
            source.record_content(encoder, request, views, AtlasLayout::InPlace)
        })?;
        let RenderedFrame { content, jitter_px, samples, .. } = frame;
        Ok(RenderedFrame { content, jitter_px, samples, render: Some(took), ..whole })
    }

    fn record_quad_views(
        &mut self,
        encoder: &mut CommandEncoder,
        frame_views: [&View; 2],
        quads: &QuadViews,
        layout: AtlasLayout,
    ) -> ComposedFrame {
        let (quads, size) = layout.place_views(quads, self.of.info().size);
        let device = &self.device.device;
        let targets = fitted(&mut self.foveated[layout as usize], device, size);
        let composer = self.composer.get_or_insert_with(|| Composer::new(device, self.of.info().size));
        self.raster.record_quad_views(device, encoder, frame_views, &quads, targets);
        composer.record(device, encoder, &quads, &targets.atlas, self.raster.near());
        let [color, distance, motion, lod] = composer.frame().clone();
        ComposedFrame { device: self.device.clone(), color, distance, motion, lod }
    }

    fn submit<T>(&mut self, record: impl FnOnce(&mut Self, &mut CommandEncoder) -> T) -> T {
        let mut encoder = self.device.device.create_command_encoder(&Default::default());
        let recorded = record(self, &mut encoder);
        self.device.queue.submit([encoder.finish()]);
        recorded
    }

    /// As [`submit`](Self::submit), and waits for the device: the time is that of this work alone.
    fn submit_timed<T>(
        &mut self,
        record: impl FnOnce(&mut Self, &mut CommandEncoder) -> T,
    ) -> Result<(T, Elapsed), InputError> {
        self.device.wait();
        let watch = Stopwatch::start();
        let recorded = self.submit(|source, encoder| {
            source.clock.begin(encoder);
            let recorded = record(source, encoder);
            source.clock.end(encoder);
            recorded
        });
        let took = self.clock.elapsed(&self.device, &watch);
        self.device.check().map_err(|lost| device_lost(&self.of.info().name, &lost))?;
        Ok((recorded, took))
    }
}

/// A frame on the device, read back. Pixels that are not finite are black.
fn read(drawn: &DeviceFrame, [view, previous]: [&View; 2], index: u64) -> SourceFrame {
    let DeviceFrame { device, color, depth, motion, near } = drawn;
    let (color, nonfinite) = finite(read_color(device, color));
    SourceFrame {
        color,
        depth: Some(read_distance(device, depth, *near)),
        motion: Some(device.read(motion, 0)),
        nonfinite,
        ..SourceFrame::without_images(Some(view.previous_from_current(previous)), index == 0)
    }
}

/// The color with non-finite pixels replaced by black, and the number of these pixels.
fn finite(color: Image<[f32; 3]>) -> (Image<[f32; 3]>, u64) {
    let mut nonfinite = 0;
    let color = color.map(|c| {
        let usable = c.iter().all(|v| v.is_finite());
        nonfinite += u64::from(!usable);
        if usable { c } else { [0.0; 3] }
    });
    (color, nonfinite)
}

/// List of quads in the form of `gpu::Afterimage::quad_list`.
fn quad_list(device: &Device, quads: &Image<bool>) -> Buffer {
    let width = quads.width();
    let chosen = (0..).zip(quads.pixels()).filter(|(_, chosen)| **chosen);
    let quads: Vec<u32> = chosen.map(|(i, _): (usize, _)| (i % width) as u32 | (((i / width) as u32) << 16)).collect();
    let count = quads.len() as u32;
    let header = [6, count, 0, 0, count.div_ceil(64), 1, 1, count];
    // wgpu cannot bind an empty array.
    let words: Vec<u32> = header.into_iter().chain(quads).chain([0]).collect();
    filled(device, "quads", bytemuck::cast_slice(&words), BufferUsages::STORAGE | BufferUsages::INDIRECT)
}

/// Color, depth and motion of targets.
fn on_device(device: &Arc<Headless>, targets: &Targets, near: f32) -> DeviceFrame {
    let Targets { color, depth, motion, .. } = targets;
    DeviceFrame { device: device.clone(), color: color.clone(), depth: depth.clone(), motion: motion.clone(), near }
}

/// Targets for an atlas of `size` texels, made at the first use and enlarged if they are too small.
fn fitted<'a>(held: &'a mut Option<FoveatedTargets>, device: &Device, size: [u32; 2]) -> &'a FoveatedTargets {
    let targets = held.get_or_insert_with(|| FoveatedTargets::new(device, size));
    targets.fit(device, size);
    targets
}

impl FrameSource for RasterSource {
    fn info(&self) -> &SourceInfo {
        self.of.info()
    }

    fn render(&mut self, request: &FrameRequest) -> Result<RenderedFrame, InputError> {
        let frame = self.rendered(request)?;
        if !request.albedo {
            return Ok(frame);
        }
        // Deferred frames have it beside depth and motion. Forward ones draw it apart, and their time is without.
        let albedo = match (&self.points, &request.wanted) {
            (Some(points), Wanted::Surfaces) if self.is_deferred() => {
                read_color(&self.device, points.albedo(&self.device.device))
            }
            _ => self.albedo(request.index, frame.jitter_px)?,
        };
        Ok(RenderedFrame { albedo: Some(albedo), ..frame })
    }

    /// The colors are those of a full-rate frame with the same jitter and one sample a pixel.
    fn shade(&mut self, frame: &RenderedFrame, request: &ShadingRequest) -> Result<Option<Shaded>, InputError> {
        let (index, jitter_px) = (frame.index, frame.jitter_px);
        let list = request.on_device.as_ref().and_then(|list| list.downcast_ref::<Buffer>()).cloned();
        // Quads that are requested in part are drawn apart.
        let list = list.filter(|_| request.half_place_px.is_none()).unwrap_or_else(|| {
            let is_half = request.half_place_px.is_some();
            quad_list(&self.device.device, &if is_half { request.whole_quads() } else { request.quads() })
        });
        let ((color, half), took) = self.submit_timed(|source, encoder| {
            let color = source.record_quads(encoder, index, jitter_px, &list);
            (color, request.half_place_px.map(|place_px| source.record_half(encoder, index, jitter_px, place_px)))
        })?;
        let answer = |color: Texture| match request.on_device {
            Some(_) => ShadedColor::OnDevice(Arc::new(color)),
            None => ShadedColor::InMemory(read_color(&self.device, &color)),
        };
        Ok(Some(Shaded { color: answer(color), half: half.map(answer), noise: None, took }))
    }

    fn camera_pose(&self, index: u64) -> Option<CameraPose> {
        Some(self.of.camera.camera_pose(&self.of.scene, index, self.of.time_s(index)))
    }

    fn steer(&mut self, index: u64, before_and_now: Option<[DMat4; 2]>) {
        self.of.camera.steer(index, before_and_now);
    }
}

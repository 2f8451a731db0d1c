//! Frames of a scene from the rasteriser.

use super::CameraPose;
use super::open::{check_size, device_lost};
use super::scene_camera::SceneCamera;
use super::{FrameSource, ReadLimits, SceneOptions, SourceInfo};
use crate::clock::{Elapsed, Stopwatch};
use crate::device::{Headless, PassClock};
use crate::error::InputError;
use crate::frame::{DeviceFrame, SourceFrame, SparseFrame};
use crate::raster::{AtlasLayout, FoveatedTargets, Raster, RasterSettings, Targets};
use crate::scene::{Scene, SceneLimits};
use crate::trace::view::View;
use afterimage::Lattices;
use glam::DMat4;
use std::sync::Arc;
use wgpu::CommandEncoder;

/// Default width and height in pixels.
pub const DEFAULT_SIZE: [u32; 2] = [640, 360];
/// Default frames per second.
pub const DEFAULT_FPS: f32 = 60.0;

/// A scene seen by a camera, rasterised frame by frame and read back to memory.
///
/// Each frame is a function of its index alone: the scene at `index / fps` seconds, with motion from
/// `(index - 1) / fps`. Frame 0 is a cut without motion. Depth, motion and `previous_from_current` are always present.
/// Depth and motion are sampled at pixel centres; color is the mean of four samples.
pub struct RasterSource {
    info: SourceInfo,
    device: Arc<Headless>,
    scene: Scene,
    camera: SceneCamera,
    raster: Raster,
    /// By layout of their atlases; none before the first such frame.
    foveated: [Option<FoveatedTargets>; 2],
    fps: f64,
    clock: PassClock,
    /// Of the last frame that was rendered for [`FrameSource`].
    render_time: Option<Elapsed>,
}

impl RasterSource {
    /// Opens a `.gltf` or `.glb` file or `builtin:NAME`, seen by the camera that [`SceneCamera::choose`] selects for
    /// `camera`. Texture filtering is anisotropic except on software devices.
    ///
    /// # Errors
    /// Those of [`Scene::open`], [`SceneCamera::choose`] and [`RasterSource::new`], and [`Limit`](InputError::Limit) if
    /// the frame has more pixels than `limits` allows.
    pub fn open(
        input: &str,
        limits: &ReadLimits,
        options: &SceneOptions,
        camera: Option<&str>,
        device: Arc<Headless>,
    ) -> Result<Self, InputError> {
        let size = options.size.unwrap_or(DEFAULT_SIZE);
        check_size(input, size, limits)?;
        let scene = Scene::open(input, &SceneLimits::default())?;
        let camera = SceneCamera::choose(&scene, camera, size, options.hfov_deg)?;
        let defaults = RasterSettings::default();
        // With an anisotropy of 16, a software device takes ten times as long for a frame of Sponza.
        let anisotropy = if device.is_software() { 1 } else { defaults.anisotropy };
        Self::new(device, scene, camera, options.fps, RasterSettings { anisotropy, ..defaults })
    }

    /// `scene` seen by `camera` at `fps` frames per second (default: those of the camera file, else 60).
    ///
    /// # Errors
    /// [`Request`](InputError::Request) if the frame rate is not above 0 or the device cannot draw the frame's size;
    /// [`Limit`](InputError::Limit) if the scene has more triangles than the device holds.
    pub fn new(
        device: Arc<Headless>,
        scene: Scene,
        camera: SceneCamera,
        fps: Option<f32>,
        settings: RasterSettings,
    ) -> Result<Self, InputError> {
        let fps = fps.or(camera.fps()).unwrap_or(DEFAULT_FPS);
        if !(fps.is_finite() && fps > 0.0) {
            let problem = format!("the frame rate is {fps}");
            return Err(InputError::request(&scene.name, problem, "expected frames per second above 0"));
        }
        let size = camera.geometry().size_px();
        let raster = Raster::new(&device.device, &device.queue, &scene, size, settings)?;
        let info = SourceInfo {
            name: scene.name.clone(),
            size,
            frames: camera.frames(),
            fps: Some(fps),
            hfov_deg: Some(camera.geometry().hfov_deg()),
            still: scene.duration_s() <= 0.0 && camera.is_still(&scene),
        };
        let (clock, fps) = (PassClock::new(&device), f64::from(fps));
        Ok(Self { info, device, scene, camera, raster, foveated: [const { None }; 2], fps, clock, render_time: None })
    }

    /// Features of the scene file that are ignored or approximated.
    pub fn warnings(&self) -> &[String] {
        &self.scene.warnings
    }

    /// The scene.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// Views of frame `index` and of the previous one, and the times of both in seconds.
    pub fn views(&self, index: u64) -> ([View; 2], [f64; 2]) {
        let before = index.saturating_sub(1);
        let times = [index, before].map(|i| i as f64 / self.fps);
        ([self.camera.view(&self.scene, index, times[0]), self.camera.view(&self.scene, before, times[1])], times)
    }

    /// Renders frame `index` without reading it back.
    pub fn render(&mut self, index: u64) -> &Raster {
        self.submit(|source, encoder| source.record(encoder, index));
        &self.raster
    }

    /// Renders the samples of `lattices` of frame `index`, without reading them back: [`Raster::record_foveated`].
    /// Returns the targets, and the lattices with their places in the atlases.
    pub fn render_foveated(
        &mut self,
        index: u64,
        lattices: &Lattices,
        layout: AtlasLayout,
    ) -> (&FoveatedTargets, Lattices) {
        let placed = self.submit(|source, encoder| source.record_foveated(encoder, index, lattices, layout));
        (self.foveated[layout as usize].as_ref().expect("was recorded"), placed)
    }

    fn record(&mut self, encoder: &mut CommandEncoder, index: u64) {
        let ([view, previous], times) = self.views(index);
        self.raster.pose(&self.scene, times[0], times[1]);
        self.raster.record(&self.device.device, encoder, &view, &previous);
    }

    fn record_foveated(
        &mut self,
        encoder: &mut CommandEncoder,
        index: u64,
        lattices: &Lattices,
        layout: AtlasLayout,
    ) -> Lattices {
        let ([view, previous], times) = self.views(index);
        let (placed, size) = layout.place(lattices, self.info.size);
        let device = &self.device.device;
        self.raster.pose(&self.scene, times[0], times[1]);
        let targets = self.foveated[layout as usize].get_or_insert_with(|| FoveatedTargets::new(device, size));
        targets.fit(device, size);
        self.raster.record_foveated(device, encoder, [&view, &previous], &placed, targets);
        placed
    }

    fn submit<T>(&mut self, record: impl FnOnce(&mut Self, &mut CommandEncoder) -> T) -> T {
        let mut encoder = self.device.device.create_command_encoder(&Default::default());
        let recorded = record(self, &mut encoder);
        self.device.queue.submit([encoder.finish()]);
        recorded
    }

    /// As [`submit`](Self::submit), and waits for the device: the time is that of this work alone.
    fn submit_timed<T>(&mut self, record: impl FnOnce(&mut Self, &mut CommandEncoder) -> T) -> T {
        self.device.wait();
        let watch = Stopwatch::start();
        let recorded = self.submit(|source, encoder| {
            source.clock.begin(encoder);
            let recorded = record(source, encoder);
            source.clock.end(encoder);
            recorded
        });
        self.render_time = Some(self.clock.elapsed(&self.device, &watch));
        recorded
    }
}

impl FrameSource for RasterSource {
    fn info(&self) -> &SourceInfo {
        &self.info
    }

    fn frame(&mut self, index: u64) -> Result<SourceFrame, InputError> {
        let ([view, previous], _) = self.views(index);
        self.submit_timed(|source, encoder| source.record(encoder, index));
        let targets = self.raster.targets();
        let mut nonfinite = 0;
        let color = targets.read_color(&self.device).map(|c| {
            let usable = c.iter().all(|v| v.is_finite());
            nonfinite += u64::from(!usable);
            if usable { c } else { [0.0; 3] }
        });
        let (depth, motion) =
            (targets.read_distance(&self.device, self.raster.near()), targets.read_motion(&self.device));
        self.device.check().map_err(|lost| device_lost(&self.info.name, &lost))?;
        Ok(SourceFrame {
            color,
            depth: Some(depth),
            motion: Some(motion),
            trust: None,
            previous_from_current: Some(view.previous_from_current(&previous)),
            cut: index == 0,
            nonfinite,
        })
    }

    /// The full-rate lattice lies in place: with the full-rate frame as the reference, its samples are exact. Depth and
    /// motion at every pixel, if the lattices call for them, are drawn again: they are part of the time.
    fn sparse(&mut self, index: u64, lattices: &Lattices) -> Result<Option<SparseFrame>, InputError> {
        let (device, near) = (self.device.clone(), self.raster.near());
        let layout = AtlasLayout::InPlace;
        let placed = self.submit_timed(|source, encoder| {
            let placed = source.record_foveated(encoder, index, lattices, layout);
            if !lattices.has_geometry_at_samples() {
                let ([view, previous], _) = source.views(index);
                source.raster.record_surfaces(&source.device.device, encoder, &view, &previous);
            }
            placed
        });
        let FoveatedTargets { atlas, .. } = self.foveated[layout as usize].as_ref().expect("was recorded");
        let Targets { color, depth, motion, .. } = atlas;
        let (color, depth, motion) = (color.clone(), depth.clone(), motion.clone());
        device.check().map_err(|lost| device_lost(&self.info.name, &lost))?;
        Ok(Some(SparseFrame { atlas: DeviceFrame { device, color, depth, motion, near }, lattices: placed }))
    }

    fn device_frame(&self) -> Option<DeviceFrame> {
        let targets = self.raster.targets();
        Some(DeviceFrame {
            device: self.device.clone(),
            color: targets.color.clone(),
            depth: targets.depth.clone(),
            motion: targets.motion.clone(),
            near: self.raster.near(),
        })
    }

    fn render_time(&self) -> Option<Elapsed> {
        self.render_time
    }

    fn camera_pose(&self, index: u64) -> Option<CameraPose> {
        Some(self.camera.camera_pose(&self.scene, index, index as f64 / self.fps))
    }

    fn steer(&mut self, index: u64, before_and_now: Option<[DMat4; 2]>) {
        self.camera.steer(index, before_and_now);
    }
}

//! Frames of a scene from the rasteriser.

use super::CameraPose;
use super::open::{check_size, device_lost};
use super::scene_camera::SceneCamera;
use super::{FrameSource, ReadLimits, SceneOptions, SourceInfo};
use crate::device::Headless;
use crate::error::InputError;
use crate::frame::{ComposedFrame, DeviceFrame, SourceFrame, SparseFrame};
use crate::quad_views::QuadViews;
use crate::raster::{AtlasLayout, Composer, FoveatedTargets, Raster, RasterSettings, Targets};
use crate::scene::{Scene, SceneLimits};
use crate::trace::view::View;
use afterimage::Lattices;
use glam::DMat4;
use std::sync::Arc;
use wgpu::Device;

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
    /// None before the first frame of quad views.
    composer: Option<Composer>,
    fps: f64,
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
        Ok(Self { info, device, scene, camera, raster, foveated: [const { None }; 2], composer: None, fps: f64::from(fps) })
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
        let ([view, previous], times) = self.views(index);
        self.raster.pose(&self.scene, times[0], times[1]);
        let mut encoder = self.device.device.create_command_encoder(&Default::default());
        self.raster.record(&self.device.device, &mut encoder, &view, &previous);
        self.device.queue.submit([encoder.finish()]);
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
        let ([view, previous], times) = self.views(index);
        let (lattices, size) = layout.place(lattices, self.info.size);
        let device = &self.device.device;
        self.raster.pose(&self.scene, times[0], times[1]);
        let targets = fitted(&mut self.foveated[layout as usize], device, size);
        let mut encoder = device.create_command_encoder(&Default::default());
        self.raster.record_foveated(device, &mut encoder, [&view, &previous], &lattices, targets);
        self.device.queue.submit([encoder.finish()]);
        (targets, lattices)
    }

    /// Renders the quad views of frame `index` and composes them, without reading anything back:
    /// [`Raster::record_quad_views`]. Returns the views' targets, the views with their places in the atlases, and the
    /// composer, which holds the frame.
    pub fn render_composed(
        &mut self,
        index: u64,
        views: &QuadViews,
        layout: AtlasLayout,
    ) -> (&FoveatedTargets, QuadViews, &Composer) {
        let ([view, previous], times) = self.views(index);
        let (views, size) = layout.place_views(views, self.info.size);
        let device = &self.device.device;
        self.raster.pose(&self.scene, times[0], times[1]);
        let targets = fitted(&mut self.foveated[layout as usize], device, size);
        let composer = self.composer.get_or_insert_with(|| Composer::new(device, self.info.size));
        let mut encoder = device.create_command_encoder(&Default::default());
        self.raster.record_quad_views(device, &mut encoder, [&view, &previous], &views, targets);
        composer.record(device, &mut encoder, &views, &targets.atlas, self.raster.near());
        self.device.queue.submit([encoder.finish()]);
        (targets, views, composer)
    }
}

/// Targets for an atlas of `size` texels, made at the first use and enlarged if they are too small.
fn fitted<'a>(held: &'a mut Option<FoveatedTargets>, device: &Device, size: [u32; 2]) -> &'a FoveatedTargets {
    let targets = held.get_or_insert_with(|| FoveatedTargets::new(device, size));
    targets.fit(device, size);
    targets
}

impl FrameSource for RasterSource {
    fn info(&self) -> &SourceInfo {
        &self.info
    }

    fn frame(&mut self, index: u64) -> Result<SourceFrame, InputError> {
        let ([view, previous], _) = self.views(index);
        self.render(index);
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

    /// The full-rate lattice lies in place: with the full-rate frame as the reference, its samples are exact.
    fn sparse(&mut self, index: u64, lattices: &Lattices) -> Result<Option<SparseFrame>, InputError> {
        let (device, near) = (self.device.clone(), self.raster.near());
        let (targets, lattices) = self.render_foveated(index, lattices, AtlasLayout::InPlace);
        let Targets { color, depth, motion, .. } = &targets.atlas;
        let (color, depth, motion) = (color.clone(), depth.clone(), motion.clone());
        device.wait();
        device.check().map_err(|lost| device_lost(&self.info.name, &lost))?;
        Ok(Some(SparseFrame { atlas: DeviceFrame { device, color, depth, motion, near }, lattices }))
    }

    /// The full-rate view lies in place, as in [`sparse`](Self::sparse).
    fn composed(&mut self, index: u64, views: &QuadViews) -> Result<Option<ComposedFrame>, InputError> {
        let device = self.device.clone();
        let [color, distance, motion, lod] = self.render_composed(index, views, AtlasLayout::InPlace).2.frame().clone();
        device.wait();
        device.check().map_err(|lost| device_lost(&self.info.name, &lost))?;
        Ok(Some(ComposedFrame { device, color, distance, motion, lod }))
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

    fn camera_pose(&self, index: u64) -> Option<CameraPose> {
        Some(self.camera.camera_pose(&self.scene, index, index as f64 / self.fps))
    }

    fn steer(&mut self, index: u64, before_and_now: Option<[DMat4; 2]>) {
        self.camera.steer(index, before_and_now);
    }
}

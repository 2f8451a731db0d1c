//! The viewer: takes gaze and input frames, runs the pipeline and draws the window, frame by frame.

mod output;

use super::auto_scale::AutoScale;
use super::explain::{Repeatable, ShownFrame};
use super::fly_camera::FlyCamera;
use super::frames::{Frames, NextFrame};
use super::layout::Layout;
use super::panel;
use super::panel_stats::PanelStats;
use super::record::{Record, rounded};
use super::resources::DeviceResources;
use super::setup::Setup;
use super::state::{Action, Effect, State};
use super::surface::Acquired;
use super::times::Pass;
use crate::failure::Failure;
use afterimage_lab::source::CameraPose;
use glam::DMat4;
use std::collections::HashSet;
use std::sync::Arc;
use std::time::Duration;
use winit::window::Window;

/// Result of a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Outcome {
    /// The frame is on screen.
    Shown,
    /// The input or the window is not ready.
    Waiting,
    /// The frame is on screen and was the last one.
    Done,
}

/// The viewer of a window.
pub struct Viewer {
    setup: Setup,
    pub state: State,
    pub fly_camera: FlyCamera,
    window: Arc<Window>,
    frames: Frames,
    resources: DeviceResources,
    /// Rendering resolution as a factor on the input's.
    scale: f32,
    auto_scale: AutoScale,
    stats: PanelStats,
    /// Last position of the mouse on the picture, in pixels of the window.
    pub pointer: Option<[f32; 2]>,
    gaze_px: [f32; 2],
    /// Playback position of the input and the scanpath.
    position: u64,
    /// Gaze of the frames since the last history reset.
    record: Record,
    repeatable: Repeatable,
    /// Camera of the current frame.
    camera_pose: Option<CameraPose>,
    /// Pose (world from camera) to which the user steers the camera.
    pose: Option<DMat4>,
    /// The window does not show the current state yet.
    pub is_stale: bool,
    /// Pictures to save after the next frame.
    to_save: Vec<Effect>,
    /// Faults of the inputs that the terminal shows already.
    announced: HashSet<afterimage::doctor::Outcome>,
}

impl Viewer {
    /// Opens a device for the window and requests the first frame.
    pub fn new(setup: Setup, frames: Frames, window: Arc<Window>) -> Result<Self, Failure> {
        let state = setup.state();
        let scale = setup.args.internal_scale.unwrap_or(1.0);
        let resources = DeviceResources::open(&window, &setup, &state, scale, frames.scene())?;
        let mut viewer = Self {
            gaze_px: resources.pipeline.geometry().size_px().map(|s| 0.5 * s as f32 - 0.5),
            setup,
            state,
            fly_camera: FlyCamera::default(),
            window,
            frames,
            resources,
            scale,
            auto_scale: AutoScale::default(),
            stats: PanelStats::new(),
            pointer: None,
            position: 0,
            record: Record::default(),
            repeatable: Repeatable::default(),
            camera_pose: None,
            pose: None,
            is_stale: true,
            to_save: vec![],
            announced: HashSet::new(),
        };
        viewer.request_frame();
        Ok(viewer)
    }

    /// Shortest time between two frames.
    pub fn period(&self) -> Duration {
        Duration::from_secs_f64(1.0 / f64::from(self.setup.fps))
    }

    /// Performs an action; returns whether the viewer continues.
    pub fn act(&mut self, action: Action) -> Result<bool, Failure> {
        self.is_stale = true;
        match self.state.apply(action) {
            Effect::Nothing => {}
            Effect::Update => {
                self.resources.pipeline.adapt(&self.state, &self.setup)?;
                self.reset_history();
            }
            Effect::Restart => {
                (self.position, self.pose) = (0, None);
                self.reset_history();
                self.refetch();
            }
            Effect::Explain => self.explain()?,
            effect @ (Effect::Picture | Effect::Window) => self.to_save.push(effect),
            Effect::LoseDevice => self.resources.device.gpu.device.destroy(),
            Effect::Quit => return Ok(false),
        }
        if self.state.is_flying == Some(false) {
            self.pose = None;
        }
        Ok(true)
    }

    /// Handles a new size of the window.
    pub fn resize(&mut self, size: [u32; 2]) {
        if size != self.resources.surface.size() && !size.contains(&0) {
            self.resources.surface.resize(&self.resources.device, size);
            self.reset_history();
        }
    }

    /// Resets history, record and statistics: the next frame shows nothing of earlier ones.
    pub fn reset_history(&mut self) {
        self.resources.pipeline.forget();
        self.record.clear();
        self.repeatable = Repeatable::default();
        self.auto_scale = AutoScale::default();
        self.stats.clear();
        self.resources.jod.reset();
        self.is_stale = true;
    }

    /// Position of the picture in the window.
    pub fn layout(&self) -> Layout {
        self.resources.layout()
    }

    /// The panel's action for a click at a position in the window; `None` outside the panel.
    pub fn panel_click(&self, at: [f32; 2]) -> Option<Option<Action>> {
        let at = at.map(|v| v / self.panel_scale() as f32);
        let (panel, lines) = (&self.stats.panel, self.stats.lines.len());
        self.state.has_panel.then(|| panel::click(&self.state, lines, panel.dimensions().into(), at))?
    }

    fn panel_scale(&self) -> u32 {
        (self.window.scale_factor().round() as u32).max(1)
    }

    /// Shows one frame. If the device is lost, the next call opens another.
    pub fn frame(&mut self) -> Result<Outcome, Failure> {
        match self.try_frame() {
            Err(_) if self.resources.device.is_lost() => Ok(Outcome::Waiting),
            outcome => outcome,
        }
    }

    fn try_frame(&mut self) -> Result<Outcome, Failure> {
        if self.resources.device.is_lost() {
            eprintln!("afterimage: the device is lost; opening another");
            self.reopen()?;
        }
        if self.resources.pipeline.reload(&self.state, &self.setup)? {
            self.reset_history();
        }
        self.fetch()?;
        // Playback and --frames wait for each input frame. Otherwise the last frame is shown again at the current gaze.
        let waits = self.state.is_playing || self.setup.args.frames.is_some();
        if !self.resources.has_frame || (waits && !self.resources.is_new && !self.state.is_frozen) {
            return Ok(Outcome::Waiting);
        }
        let target = match self.resources.surface.acquire(&mut self.resources.device, &self.window)? {
            Acquired::Frame(target) => target,
            Acquired::Nothing => return Ok(Outcome::Waiting),
            Acquired::Renewed => {
                self.reset_history();
                return Ok(Outcome::Waiting);
            }
        };
        self.resources.times.begin(&self.resources.device.gpu);
        // A frozen picture is computed again only after a history reset.
        if !self.state.is_frozen || self.resources.pipeline.index() == 0 {
            self.update_gaze();
            let DeviceResources { pipeline, renderer, times, is_new, .. } = &mut self.resources;
            pipeline.show(self.gaze_px, !*is_new, &self.state, renderer.as_mut(), times)?;
            self.repeatable.push(&ShownFrame {
                number: self.record.len() as u64,
                position: self.position,
                is_new: self.resources.is_new,
                is_still: self.setup.info.still,
                is_played: self.state.is_playing,
                is_steered: self.state.is_flying == Some(true) || self.pose.is_some(),
                scale: self.scale,
            });
            self.record.push(self.gaze_px);
            self.advance();
        }
        self.measure_quality();
        self.measure_jod();
        self.draw(&target.texture.create_view(&Default::default()))?;
        self.window.pre_present_notify();
        self.resources.device.gpu.queue.present(target);
        self.resources.times.end(&self.resources.device.gpu);
        self.is_stale = false;
        self.stats.frame(&self.resources.times);
        for effect in std::mem::take(&mut self.to_save) {
            if effect == Effect::Picture { self.write_picture()? } else { self.write_window()? }
        }
        if self.setup.args.frames == Some(self.record.len() as u64) {
            return Ok(Outcome::Done);
        }
        self.lower_resolution_if_slow()?;
        Ok(Outcome::Shown)
    }

    /// Uploads the requested frame, if it is ready.
    fn fetch(&mut self) -> Result<(), Failure> {
        if self.state.is_frozen && self.resources.has_frame {
            return Ok(());
        }
        let DeviceResources { pipeline, renderer, .. } = &mut self.resources;
        self.camera_pose = match self.frames.take(renderer.as_mut())? {
            None => return Ok(()),
            Some(NextFrame::Loaded(loaded)) => {
                pipeline.upload(&loaded.frame);
                loaded.camera_pose
            }
            Some(NextFrame::Posed { index, cut, camera_pose }) => {
                pipeline.pose(index, cut);
                camera_pose
            }
        };
        (self.resources.has_frame, self.resources.is_new) = (true, true);
        if self.state.is_flying.is_none() && self.camera_pose.is_some() {
            self.state.is_flying = Some(false);
        }
        Ok(())
    }

    /// Updates the gaze, as late as possible in the frame.
    fn update_gaze(&mut self) {
        if self.state.is_playing {
            self.gaze_px = self.setup.played_px(self.position, self.scale).unwrap_or(self.gaze_px);
        } else if let Some(at) = self.pointer {
            self.gaze_px = rounded(self.layout().picture_px(at));
        }
    }

    /// Moves on to the next input frame after a frame was shown.
    fn advance(&mut self) {
        if !self.resources.is_new {
            return;
        }
        self.position += 1;
        if self.setup.info.still && self.state.is_flying != Some(true) && self.pose.is_none() {
            return;
        }
        if let (Some(true), Some(camera_pose)) = (self.state.is_flying, self.camera_pose) {
            let from = self.pose.unwrap_or(camera_pose.world_from_camera);
            self.pose = Some(self.fly_camera.step(from, self.stats.since_last_s(), camera_pose.speed_m_s));
        }
        self.resources.is_new = false;
        self.request_frame();
    }

    fn request_frame(&mut self) {
        self.frames.request(self.position, self.resources.pipeline.geometry().size_px(), self.pose);
    }

    /// Discards input frames and requests the one at the playback position.
    fn refetch(&mut self) {
        self.frames.cancel();
        (self.resources.has_frame, self.resources.is_new) = (false, false);
        self.request_frame();
    }

    /// Opens the device again, after a loss or with another resolution.
    fn reopen(&mut self) -> Result<(), Failure> {
        self.resources =
            DeviceResources::open(&self.window, &self.setup, &self.state, self.scale, self.frames.scene())?;
        self.reset_history();
        self.refetch();
        Ok(())
    }

    /// Lowers the resolution on a software device if frames take too long.
    fn lower_resolution_if_slow(&mut self) -> Result<(), Failure> {
        let gpu = &self.resources.device.gpu;
        if !gpu.is_software() || self.setup.args.internal_scale.is_some() || self.state.is_frozen {
            return Ok(());
        }
        let ms = Pass::ALL.iter().filter_map(|pass| self.resources.times.ms(*pass)).sum();
        let Some(scale) = self.auto_scale.push(ms, self.scale) else { return Ok(()) };
        let [w, h] = self.setup.geometry(scale)?.size_px();
        let typical = self.auto_scale.typical_ms();
        eprintln!(
            "afterimage: {} takes {typical:.0} ms a frame; internal resolution lowered to {w}x{h}",
            gpu.info.name
        );
        let ratio = scale / self.scale;
        self.gaze_px = self.gaze_px.map(|v| (v + 0.5) * ratio - 0.5);
        self.scale = scale;
        self.reopen()
    }
}

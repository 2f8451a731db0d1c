//! From gaze and input to the window, frame by frame.

mod output;

use super::feed::Feed;
use super::figures::Figures;
use super::fly::Flight;
use super::layout::Layout;
use super::on_device::OnDevice;
use super::panel;
use super::record::{Record, rounded};
use super::setup::Setup;
use super::state::{Action, Effect, State};
use super::surface::Acquired;
use super::times::Pass;
use super::usable::Usable;
use crate::failure::Failure;
use afterimage_lab::source::CameraPose;
use glam::DMat4;
use std::sync::Arc;
use std::time::Duration;
use winit::window::Window;

/// What became of a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Outcome {
    /// It is on screen.
    Shown,
    /// The input or the window is not ready.
    Waiting,
    /// It was the last.
    Done,
}

/// The viewer behind a window.
pub struct Viewer {
    setup: Setup,
    pub state: State,
    pub flight: Flight,
    window: Arc<Window>,
    feed: Feed,
    on: OnDevice,
    /// Internal resolution as a share of the input's.
    scale: f32,
    usable: Usable,
    figures: Figures,
    /// Where the mouse last was on the picture, in pixels of the window.
    pub pointer: Option<[f32; 2]>,
    gaze_px: [f32; 2],
    /// Playback position of the input and the scanpath.
    position: u64,
    /// Frames since the last fresh start, and where the eye looked in them.
    record: Record,
    /// Where the camera is, and where it is steered to.
    stance: Option<CameraPose>,
    pose: Option<DMat4>,
    /// The window is not what the state says.
    pub is_stale: bool,
    /// Pictures to write when the next frame is on screen.
    wanted: Vec<Effect>,
}

impl Viewer {
    /// Opens the device of a window and asks for the first frame.
    pub fn new(setup: Setup, feed: Feed, window: Arc<Window>) -> Result<Self, Failure> {
        let state = setup.state();
        let scale = setup.args.internal_scale.unwrap_or(1.0);
        let on = OnDevice::open(&window, &setup, &state, scale)?;
        let mut viewer = Self {
            gaze_px: on.lanes.geometry().size_px().map(|s| 0.5 * s as f32 - 0.5),
            setup,
            state,
            flight: Flight::default(),
            window,
            feed,
            on,
            scale,
            usable: Usable::default(),
            figures: Figures::new(),
            pointer: None,
            position: 0,
            record: Record::default(),
            stance: None,
            pose: None,
            is_stale: true,
            wanted: vec![],
        };
        viewer.ask();
        Ok(viewer)
    }

    /// Shortest time between two frames.
    pub fn period(&self) -> Duration {
        Duration::from_secs_f64(1.0 / f64::from(self.setup.fps))
    }

    /// Does what a key or click asks for; whether the viewer goes on.
    pub fn act(&mut self, action: Action) -> Result<bool, Failure> {
        self.is_stale = true;
        match self.state.apply(action) {
            Effect::Nothing => {}
            Effect::Anew => {
                let (setup, state) = (&self.setup, &self.state);
                self.on.lanes.adapt(state, &|shows| setup.settings(state, shows))?;
                self.begin_anew();
            }
            Effect::Restart => {
                (self.position, self.pose) = (0, None);
                self.begin_anew();
                self.fetch_anew();
            }
            wanted @ (Effect::Picture | Effect::Window) => self.wanted.push(wanted),
            Effect::LoseDevice => self.on.device.gpu.device.destroy(),
            Effect::Quit => return Ok(false),
        }
        if self.state.is_flying == Some(false) {
            self.pose = None;
        }
        Ok(true)
    }

    /// The window has another size.
    pub fn resize(&mut self, size: [u32; 2]) {
        if size != self.on.surface.size() && !size.contains(&0) {
            self.on.surface.resize(&self.on.device, size);
            self.begin_anew();
        }
    }

    /// History, record and figures start afresh: the next frame shows nothing of what was.
    pub fn begin_anew(&mut self) {
        self.on.lanes.forget();
        self.record.clear();
        self.usable = Usable::default();
        self.figures.clear();
        self.is_stale = true;
    }

    /// Where the picture lies in the window.
    pub fn layout(&self) -> Layout {
        self.on.layout()
    }

    /// What a click at a position in the window asks of the panel; `None` beside it.
    pub fn panel_click(&self, at: [f32; 2]) -> Option<Option<Action>> {
        let at = at.map(|v| v / self.panel_scale() as f32);
        let (panel, lines) = (&self.figures.panel, self.figures.lines.len());
        self.state.has_panel.then(|| panel::click(&self.state, lines, panel.dimensions().into(), at))?
    }

    fn panel_scale(&self) -> u32 {
        (self.window.scale_factor().round() as u32).max(1)
    }

    /// One frame. A device that is lost in it is found lost at the next.
    pub fn frame(&mut self) -> Result<Outcome, Failure> {
        match self.try_frame() {
            Err(_) if self.on.device.is_lost() => Ok(Outcome::Waiting),
            outcome => outcome,
        }
    }

    fn try_frame(&mut self) -> Result<Outcome, Failure> {
        if self.on.device.is_lost() {
            eprintln!("afterimage: the device is lost; another is opened");
            self.reopen()?;
        }
        self.fetch()?;
        // Playback and counted frames wait for the input; the mouse does not, and is shown the last frame again.
        let waits = self.state.is_playing || self.setup.args.frames.is_some();
        if !self.on.has_frame || (waits && !self.on.is_new && !self.state.is_frozen) {
            return Ok(Outcome::Waiting);
        }
        let target = match self.on.surface.acquire(&mut self.on.device, &self.window)? {
            Acquired::Frame(target) => target,
            Acquired::Nothing => return Ok(Outcome::Waiting),
            Acquired::Renewed => {
                self.begin_anew();
                return Ok(Outcome::Waiting);
            }
        };
        self.on.times.begin(&self.on.device.gpu);
        // What is frozen is computed once more where its history was given up.
        if !self.state.is_frozen || self.on.lanes.index() == 0 {
            self.look();
            self.on.lanes.show(self.gaze_px, !self.on.is_new, &self.state, &mut self.on.times)?;
            self.record.push(self.gaze_px);
            self.advance();
        }
        self.measure();
        self.draw(&target.texture.create_view(&Default::default()))?;
        self.window.pre_present_notify();
        self.on.device.gpu.queue.present(target);
        self.on.times.end(&self.on.device.gpu);
        self.is_stale = false;
        self.figures.frame(&self.on.times);
        for wanted in std::mem::take(&mut self.wanted) {
            if wanted == Effect::Picture { self.write_picture()? } else { self.write_window()? }
        }
        if self.setup.args.frames == Some(self.record.len() as u64) {
            return Ok(Outcome::Done);
        }
        self.keep_usable()?;
        Ok(Outcome::Shown)
    }

    /// Takes the frame that was asked for, if it has come.
    fn fetch(&mut self) -> Result<(), Failure> {
        if self.state.is_frozen && self.on.has_frame {
            return Ok(());
        }
        if let Some(given) = self.feed.take()? {
            self.on.lanes.upload(&given.frame);
            (self.on.has_frame, self.on.is_new) = (true, true);
            self.stance = given.stance;
            if self.state.is_flying.is_none() && self.stance.is_some() {
                self.state.is_flying = Some(false);
            }
        }
        Ok(())
    }

    /// Where the eye looks in this frame, as late as possible.
    fn look(&mut self) {
        if self.state.is_playing {
            self.gaze_px = self.setup.played_px(self.position, self.scale).unwrap_or(self.gaze_px);
        } else if let Some(at) = self.pointer {
            self.gaze_px = rounded(self.layout().picture_px(at));
        }
    }

    /// After a frame was shown: on to the next.
    fn advance(&mut self) {
        if !self.on.is_new {
            return;
        }
        self.position += 1;
        if self.setup.info.still && self.state.is_flying != Some(true) && self.pose.is_none() {
            return;
        }
        if let (Some(true), Some(stance)) = (self.state.is_flying, self.stance) {
            let from = self.pose.unwrap_or(stance.world_from_camera);
            self.pose = Some(self.flight.step(from, self.figures.since_last_s(), stance.speed_m_s));
        }
        self.on.is_new = false;
        self.ask();
    }

    fn ask(&mut self) {
        self.feed.ask(self.position, self.on.lanes.geometry().size_px(), self.pose);
    }

    /// The input again, from the playback position.
    fn fetch_anew(&mut self) {
        self.feed.drop_pending();
        (self.on.has_frame, self.on.is_new) = (false, false);
        self.ask();
    }

    /// Another device in place of one that has gone, or another resolution.
    fn reopen(&mut self) -> Result<(), Failure> {
        self.on = OnDevice::open(&self.window, &self.setup, &self.state, self.scale)?;
        self.begin_anew();
        self.fetch_anew();
        Ok(())
    }

    /// On a software device: a lower resolution, if this one takes too long.
    fn keep_usable(&mut self) -> Result<(), Failure> {
        let gpu = &self.on.device.gpu;
        if !gpu.is_software() || self.setup.args.internal_scale.is_some() || self.state.is_frozen {
            return Ok(());
        }
        let ms = Pass::ALL.iter().filter_map(|pass| self.on.times.ms(*pass)).sum();
        let Some(scale) = self.usable.judge(ms, self.scale) else { return Ok(()) };
        let [w, h] = self.setup.geometry(scale)?.size_px();
        let taken = self.usable.usual_ms();
        eprintln!("afterimage: {} takes {taken:.0} ms a frame; internal resolution lowered to {w}x{h}", gpu.info.name);
        let ratio = scale / self.scale;
        self.gaze_px = self.gaze_px.map(|v| (v + 0.5) * ratio - 0.5);
        self.scale = scale;
        self.reopen()
    }
}

//! Window events, passed on to the viewer.

use super::frames::Frames;
use super::keys::action_of;
use super::layout::Layout;
use super::setup::Setup;
use super::state::Action;
use super::viewer::{Outcome, Viewer};
use crate::failure::Failure;
use std::sync::Arc;
use std::time::{Duration, Instant};
use winit::application::ApplicationHandler;
use winit::dpi::PhysicalSize;
use winit::event::{ElementState, KeyEvent, MouseButton, WindowEvent};
use winit::event_loop::{ActiveEventLoop, ControlFlow};
use winit::keyboard::{ModifiersState, PhysicalKey};
use winit::window::{CursorIcon, Window, WindowId};

/// Time until the next attempt if the input or the window is not ready.
const RETRY: Duration = Duration::from_millis(4);
/// Polling interval while the window shows nothing new.
const IDLE: Duration = Duration::from_millis(100);
/// Assumed size of a screen that does not report its size, pixels.
const SCREEN: [u32; 2] = [1920, 1080];

/// Object that the mouse drags.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Drag {
    Nothing,
    Divider,
    Camera,
}

/// A viewer and its window.
pub struct App {
    /// Arguments of the viewer, until the window is open.
    start: Option<(Setup, Frames)>,
    window: Option<Arc<Window>>,
    viewer: Option<Viewer>,
    modifiers: ModifiersState,
    drag: Drag,
    cursor: [f32; 2],
    is_occluded: bool,
    /// Whether the window was occluded or minimized at the last check.
    was_hidden: bool,
    /// Time of the next redraw.
    next: Instant,
    /// Result of the event loop.
    pub outcome: Result<(), Failure>,
}

impl App {
    pub fn new(setup: Setup, frames: Frames) -> Self {
        Self {
            start: Some((setup, frames)),
            window: None,
            viewer: None,
            modifiers: ModifiersState::empty(),
            drag: Drag::Nothing,
            cursor: [0.0; 2],
            is_occluded: false,
            was_hidden: false,
            next: Instant::now(),
            outcome: Ok(()),
        }
    }

    fn open(&mut self, events: &ActiveEventLoop) -> Result<(), Failure> {
        let Some((setup, frames)) = self.start.take() else { return Ok(()) };
        let monitor = events.primary_monitor().or_else(|| events.available_monitors().next());
        let screen = monitor.map(|m| m.size()).filter(|s| s.width > 0 && s.height > 0);
        let [width, height] = Layout::window(setup.info.size, screen.map_or(SCREEN, |s| [s.width, s.height]));
        let attributes = Window::default_attributes()
            .with_title(format!("afterimage: {}", setup.info.name))
            .with_inner_size(PhysicalSize::new(width, height));
        let window = events.create_window(attributes);
        let window = Arc::new(window.map_err(|e| Failure::Work(format!("no window can be opened ({e})")))?);
        self.viewer = Some(Viewer::new(setup, frames, window.clone())?);
        self.window = Some(window);
        Ok(())
    }

    /// Stores an error and exits.
    fn check(&mut self, events: &ActiveEventLoop, result: Result<(), Failure>) {
        if result.is_err() {
            if self.outcome.is_ok() {
                self.outcome = result;
            }
            events.exit();
        }
    }

    /// Exits normally.
    fn end(&mut self, events: &ActiveEventLoop) -> Result<(), Failure> {
        events.exit();
        self.viewer.as_mut().map_or(Ok(()), Viewer::finish)
    }

    fn handle(&mut self, events: &ActiveEventLoop, event: WindowEvent) -> Result<(), Failure> {
        let Some(viewer) = &mut self.viewer else { return Ok(()) };
        match event {
            WindowEvent::CloseRequested => return self.end(events),
            WindowEvent::Resized(size) => viewer.resize([size.width, size.height]),
            WindowEvent::Occluded(is_occluded) => self.is_occluded = is_occluded,
            WindowEvent::Focused(false) => {
                viewer.fly_camera.release();
                self.drag = Drag::Nothing;
            }
            WindowEvent::ModifiersChanged(modifiers) => {
                self.modifiers = modifiers.state();
                viewer.fly_camera.is_fast = self.modifiers.shift_key();
            }
            WindowEvent::CursorMoved { position, .. } => self.moved([position.x as f32, position.y as f32]),
            WindowEvent::MouseInput { state, button, .. } => {
                if let Some(action) = self.pressed(button, state) {
                    return self.act(events, action);
                }
            }
            WindowEvent::KeyboardInput { event, .. } => {
                if let Some(action) = self.key(&event) {
                    return self.act(events, action);
                }
            }
            WindowEvent::RedrawRequested => return self.redraw(events),
            _ => {}
        }
        Ok(())
    }

    fn act(&mut self, events: &ActiveEventLoop, action: Action) -> Result<(), Failure> {
        let continues = self.viewer.as_mut().map_or(Ok(true), |viewer| viewer.act(action))?;
        if continues { Ok(()) } else { self.end(events) }
    }

    /// Whether the window is occluded or minimized. History is reset when it becomes visible again.
    fn is_hidden(&mut self) -> bool {
        let is_minimized = self.window.as_ref().is_some_and(|window| window.is_minimized() == Some(true));
        let is_hidden = self.is_occluded || is_minimized;
        if let (Some(viewer), true, false) = (&mut self.viewer, self.was_hidden, is_hidden) {
            viewer.reset_history();
        }
        self.was_hidden = is_hidden;
        is_hidden
    }

    fn moved(&mut self, at: [f32; 2]) {
        let by = [0, 1].map(|i| f64::from(at[i] - self.cursor[i]));
        self.cursor = at;
        let (Some(viewer), Some(window)) = (&mut self.viewer, &self.window) else { return };
        match self.drag {
            Drag::Divider => {
                viewer.state.divider = viewer.layout().share(at[0]);
                viewer.is_stale = true;
            }
            Drag::Camera => viewer.fly_camera.drag(by),
            Drag::Nothing => {
                let over_panel = viewer.panel_click(at);
                let grips = viewer.state.is_split && viewer.layout().grips(at[0], viewer.state.divider);
                if over_panel.is_none() {
                    viewer.pointer = Some(at);
                }
                window.set_cursor(match over_panel {
                    Some(Some(_)) => CursorIcon::Pointer,
                    Some(None) => CursorIcon::Default,
                    None if grips => CursorIcon::EwResize,
                    None => CursorIcon::Crosshair,
                });
            }
        }
    }

    fn pressed(&mut self, button: MouseButton, state: ElementState) -> Option<Action> {
        let viewer = self.viewer.as_mut()?;
        if state == ElementState::Released {
            self.drag = Drag::Nothing;
            return None;
        }
        match button {
            MouseButton::Left => {
                if let Some(action) = viewer.panel_click(self.cursor) {
                    return action;
                }
                if viewer.state.is_split && viewer.layout().grips(self.cursor[0], viewer.state.divider) {
                    self.drag = Drag::Divider;
                }
            }
            MouseButton::Right if viewer.state.is_flying == Some(true) => self.drag = Drag::Camera,
            _ => {}
        }
        None
    }

    fn key(&mut self, event: &KeyEvent) -> Option<Action> {
        let PhysicalKey::Code(code) = event.physical_key else { return None };
        let is_down = event.state == ElementState::Pressed;
        let (shift, control) = (self.modifiers.shift_key(), self.modifiers.control_key());
        let viewer = self.viewer.as_mut()?;
        if viewer.state.is_flying == Some(true) && viewer.fly_camera.key(code, is_down && !control) {
            return None;
        }
        let action = action_of(code, shift, control)?;
        let may_repeat = matches!(action, Action::Fovea(_));
        (is_down && (may_repeat || !event.repeat)).then_some(action)
    }

    fn redraw(&mut self, events: &ActiveEventLoop) -> Result<(), Failure> {
        // The system may request a redraw before it reports that the window is visible again.
        if self.is_hidden() {
            return Ok(());
        }
        let Some(viewer) = &mut self.viewer else { return Ok(()) };
        let begun = Instant::now();
        match viewer.frame()? {
            Outcome::Shown => self.next = begun + viewer.period(),
            Outcome::Waiting => self.next = Instant::now() + RETRY,
            Outcome::Done => return self.end(events),
        }
        Ok(())
    }
}

impl ApplicationHandler for App {
    fn resumed(&mut self, events: &ActiveEventLoop) {
        let opened = self.open(events);
        self.check(events, opened);
    }

    fn window_event(&mut self, events: &ActiveEventLoop, _: WindowId, event: WindowEvent) {
        // No work after an exit.
        if self.outcome.is_ok() && !events.exiting() {
            let handled = self.handle(events, event);
            self.check(events, handled);
        }
    }

    fn about_to_wait(&mut self, events: &ActiveEventLoop) {
        let is_hidden = self.is_hidden();
        let (Some(viewer), Some(window)) = (&self.viewer, &self.window) else { return };
        let is_idle = is_hidden || (viewer.state.is_frozen && !viewer.is_stale);
        let now = Instant::now();
        let next = if is_idle { now + IDLE } else { self.next };
        if !is_idle && now >= next {
            window.request_redraw();
        }
        events.set_control_flow(ControlFlow::WaitUntil(next.max(now + Duration::from_micros(100))));
    }
}

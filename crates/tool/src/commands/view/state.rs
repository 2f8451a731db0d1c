//! User-controlled state of the viewer, and how actions change it. Needs no window and no device.

use crate::args::{FilterName, Named};
use afterimage::DebugView;
use afterimage::internal::{FoveationKind, MethodKind};

/// What a side of the picture shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shows {
    /// A method of the post-process.
    Post(MethodKind),
    /// The full-rate frame.
    Reference,
}

impl Shows {
    /// The method; `None`: the full-rate frame is shown.
    pub fn method(self) -> Option<MethodKind> {
        match self {
            Self::Post(method) => Some(method),
            Self::Reference => None,
        }
    }
}

impl Named for Shows {
    fn rows() -> Vec<(Self, &'static str, &'static str)> {
        let posts = MethodKind::ALL.map(|method| (Self::Post(method), method.name(), method.summary()));
        posts.into_iter().chain([(Self::Reference, "reference", "the full-rate frame")]).collect()
    }
}

/// A side of the split picture; without a split, the left side fills the picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    Left = 0,
    Right = 1,
}

impl Side {
    /// Both.
    pub const BOTH: [Self; 2] = [Self::Left, Self::Right];
}

/// Command of a key or a click.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Action {
    Show(Side, Shows),
    /// Switch to the next method.
    Next(Side),
    Split,
    Filter,
    /// Switch between what is rendered of a scene: chosen quads, quad views, full rate.
    Render,
    /// Multiply the fovea's diameter.
    Fovea(f32),
    Debug,
    Freeze,
    Play,
    Fly,
    /// Check the inputs.
    Examine,
    Mark,
    Panel,
    Restart,
    /// Print the command that explains the pixel under the pointer.
    Explain,
    /// Save the picture at its own resolution, without overlays.
    Picture,
    /// Save the contents of the window.
    Window,
    LoseDevice,
    Quit,
}

/// Work for the viewer that follows from an action.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Effect {
    /// None: the next frame uses the new state.
    Nothing,
    /// Update the pipeline and reset the history of both sides, so that both have the same past.
    Update,
    /// Start again at the input's first frame.
    Restart,
    /// Print the command that explains the pixel under the pointer.
    Explain,
    /// Save the picture.
    Picture,
    /// Save the window.
    Window,
    LoseDevice,
    Quit,
}

/// Smallest and largest diameter of the fovea, degrees.
const FOVEA_DEG: [f32; 2] = [1.0, 60.0];

/// State that keys and clicks change.
#[derive(Clone, Debug, PartialEq)]
pub struct State {
    pub sides: [Shows; 2],
    pub is_split: bool,
    /// Position of the divider, as a fraction of the picture's width.
    pub divider: f32,
    pub filter: FilterName,
    /// Whether frames are rasterised as the foveation wants them.
    pub is_rasterised: bool,
    pub fovea_deg: f32,
    /// Diameter of the middle region, degrees; upper limit of the fovea.
    pub mid_deg: f32,
    pub debug: Option<DebugView>,
    pub is_frozen: bool,
    /// The gaze follows the scanpath, not the mouse.
    pub is_playing: bool,
    /// Whether the user steers the camera; `None`: the input has no camera.
    pub is_flying: Option<bool>,
    /// Whether the inputs are checked.
    pub is_examined: bool,
    /// Whether the gaze and the fovea are marked.
    pub is_marked: bool,
    pub has_panel: bool,
}

impl State {
    /// Applies an action.
    pub fn apply(&mut self, action: Action) -> Effect {
        match action {
            Action::Show(Side::Right, _) | Action::Next(Side::Right) if !self.is_split => {
                self.is_split = true;
                self.apply(action);
                return Effect::Update;
            }
            Action::Show(side, shows) => {
                let before = std::mem::replace(&mut self.sides[side as usize], shows);
                return if before == shows { Effect::Nothing } else { Effect::Update };
            }
            Action::Next(side) => {
                self.sides[side as usize] = next(self.sides[side as usize]);
                return Effect::Update;
            }
            Action::Split => {
                self.is_split = !self.is_split;
                return Effect::Update;
            }
            Action::Filter => {
                self.filter = next(self.filter);
                while self.filter.is_quad_views() && !self.is_rasterised {
                    self.filter = next(self.filter);
                }
                return Effect::Update;
            }
            Action::Render if !self.is_rasterised => return Effect::Nothing,
            Action::Render => {
                self.filter = match self.filter {
                    FilterName::Of(FoveationKind::Quads) => FilterName::Layers,
                    FilterName::Layers => FilterName::Of(FoveationKind::Off),
                    _ => FilterName::Of(FoveationKind::Quads),
                };
                return Effect::Update;
            }
            Action::Fovea(factor) => {
                let most = FOVEA_DEG[1].min(self.mid_deg);
                let fovea_deg = (self.fovea_deg * factor).clamp(FOVEA_DEG[0].min(most), most);
                if fovea_deg == self.fovea_deg {
                    return Effect::Nothing;
                }
                self.fovea_deg = fovea_deg;
                return Effect::Update;
            }
            Action::Debug => {
                self.debug = match self.debug {
                    None => Some(DebugView::rows()[0].0),
                    Some(view) => following(view),
                };
            }
            Action::Freeze => self.is_frozen = !self.is_frozen,
            Action::Play => self.is_playing = !self.is_playing,
            Action::Fly => self.is_flying = self.is_flying.map(|is_flying| !is_flying),
            Action::Examine => self.is_examined = !self.is_examined,
            Action::Mark => self.is_marked = !self.is_marked,
            Action::Panel => self.has_panel = !self.has_panel,
            Action::Restart => {
                self.is_frozen = false;
                return Effect::Restart;
            }
            Action::Explain => return Effect::Explain,
            Action::Picture => return Effect::Picture,
            Action::Window => return Effect::Window,
            Action::LoseDevice => return Effect::LoseDevice,
            Action::Quit => return Effect::Quit,
        }
        Effect::Nothing
    }

    /// Whether a side on screen shows the full-rate frame.
    pub fn shows_reference(&self) -> bool {
        self.shown_sides().iter().any(|&side| self.sides[side as usize] == Shows::Reference)
    }

    /// Sides that are on screen.
    pub fn shown_sides(&self) -> &'static [Side] {
        if self.is_split { &Side::BOTH } else { &Side::BOTH[..1] }
    }
}

/// The next value of the enum; `None` after the last.
fn following<T: Named>(value: T) -> Option<T> {
    T::rows().into_iter().map(|row| row.0).skip_while(|v| *v != value).nth(1)
}

/// The next value of the enum; the first after the last.
fn next<T: Named>(value: T) -> T {
    following(value).unwrap_or_else(|| T::rows()[0].0)
}

#[cfg(test)]
pub(super) mod tests {
    use super::super::keys::action_of;
    use super::*;
    use winit::keyboard::KeyCode;

    pub fn state() -> State {
        State {
            sides: [Shows::Post(MethodKind::Smr), Shows::Reference],
            is_split: false,
            divider: 0.5,
            filter: FilterName::Of(FoveationKind::Mip),
            is_rasterised: false,
            fovea_deg: 5.0,
            mid_deg: 15.0,
            debug: None,
            is_frozen: false,
            is_playing: false,
            is_flying: None,
            is_examined: false,
            is_marked: true,
            has_panel: true,
        }
    }

    fn press(state: &mut State, key: KeyCode, shift: bool) -> Effect {
        state.apply(action_of(key, shift, false).unwrap())
    }

    #[test]
    fn digits_choose_methods_and_only_changes_cost_anything() {
        let mut state = state();
        assert_eq!(press(&mut state, KeyCode::Digit4, false), Effect::Nothing, "smr is shown already");
        assert_eq!(press(&mut state, KeyCode::Digit3, false), Effect::Update);
        assert_eq!((state.sides, state.is_split), ([Shows::Post(MethodKind::Wrs), Shows::Reference], false));
        assert_eq!(press(&mut state, KeyCode::Digit2, true), Effect::Update);
        assert_eq!(
            (state.sides, state.is_split),
            ([Shows::Post(MethodKind::Wrs), Shows::Post(MethodKind::Taa)], true),
            "what is chosen is shown"
        );
        assert_eq!(state.shown_sides(), Side::BOTH);
        press(&mut state, KeyCode::Tab, false);
        assert_eq!(state.shown_sides(), [Side::Left]);
    }

    #[test]
    fn clicks_go_through_all_values_and_round() {
        let mut state = state();
        let all: Vec<_> = Shows::rows().into_iter().map(|row| row.0).collect();
        let at = all.iter().position(|shows| *shows == state.sides[0]).unwrap();
        for i in 1..=all.len() {
            state.apply(Action::Next(Side::Left));
            assert_eq!(state.sides[0], all[(at + i) % all.len()]);
        }
        let views: Vec<_> = (0..7).map(|_| (state.apply(Action::Debug), state.debug.map(DebugView::name)).1).collect();
        let expected = ["weight", "age", "survival", "flush", "gate", "motion"].map(Some);
        assert_eq!((&views[..6], views[6]), (&expected[..], None));
        let filters: Vec<_> = (0..5).map(|_| (state.apply(Action::Filter), state.filter.name()).1).collect();
        assert_eq!(filters, ["gauss", "block", "planned", "off", "mip"]);
    }

    #[test]
    fn scenes_are_rendered_as_quads_as_quad_views_or_at_full_rate() {
        let mut state = state();
        assert_eq!(press(&mut state, KeyCode::KeyT, false), Effect::Nothing, "nothing is rendered");
        assert_eq!(state.filter, FilterName::Of(FoveationKind::Mip));
        state.is_rasterised = true;
        let rendered: Vec<_> =
            (0..4).map(|_| (press(&mut state, KeyCode::KeyT, false), state.filter.name()).1).collect();
        assert_eq!(rendered, ["planned", "layers", "off", "planned"]);
        let filters: Vec<_> = (0..6).map(|_| (state.apply(Action::Filter), state.filter.name()).1).collect();
        assert_eq!(filters, ["layers", "uniform", "off", "mip", "gauss", "block"]);
    }

    #[test]
    fn the_fovea_stays_within_its_bounds() {
        let mut state = state();
        for _ in 0..40 {
            press(&mut state, KeyCode::Equal, false);
        }
        assert_eq!(state.fovea_deg, 15.0, "never beyond the middle region");
        assert_eq!(press(&mut state, KeyCode::ArrowUp, false), Effect::Nothing);
        for _ in 0..40 {
            press(&mut state, KeyCode::Minus, false);
        }
        assert_eq!(state.fovea_deg, 1.0);
        state.mid_deg = 0.5;
        press(&mut state, KeyCode::Minus, false);
        assert_eq!(state.fovea_deg, 0.5);
    }

    #[test]
    fn what_cannot_be_steered_does_not_fly_and_a_restart_thaws() {
        let mut state = state();
        press(&mut state, KeyCode::KeyC, false);
        assert_eq!(state.is_flying, None);
        state.is_flying = Some(false);
        press(&mut state, KeyCode::KeyC, false);
        assert_eq!(state.is_flying, Some(true));
        press(&mut state, KeyCode::Space, false);
        assert!(state.is_frozen);
        assert_eq!(press(&mut state, KeyCode::KeyR, false), Effect::Restart);
        assert!(!state.is_frozen);
    }
}

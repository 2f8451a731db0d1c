//! Keys of the viewer: one table, which the keyboard, the panel and `--help` read.

use super::state::{Action, Shows, Side, State};
use crate::args::{FilterName, Named};
use afterimage::internal::FoveationKind;
use winit::keyboard::KeyCode;

/// Keys that have to be held. A key without any may be pressed together with Shift.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Modifiers {
    Nothing,
    Shift,
    ControlShift,
}

/// Value of a row of the panel; `None`: the panel does not show the row now.
type Value = fn(&State) -> Option<String>;

/// A key, and others that do the same.
struct Key {
    codes: &'static [KeyCode],
    modifiers: Modifiers,
    /// Name of the key, with what has to be held.
    label: &'static str,
    action: Action,
    /// What the key does, after its name in `--help`; empty: said with another key.
    help: &'static str,
    /// Row of the panel: its name, and the value that it shows.
    row: Option<(&'static str, Value)>,
}

const fn key(codes: &'static [KeyCode], label: &'static str, action: Action, help: &'static str) -> Key {
    Key { codes, modifiers: Modifiers::Nothing, label, action, help, row: None }
}

impl Key {
    const fn modifiers(self, modifiers: Modifiers) -> Self {
        Self { modifiers, ..self }
    }

    const fn row(self, name: &'static str, value: Value) -> Self {
        Self { row: Some((name, value)), ..self }
    }
}

/// Factor per key press on the fovea's diameter; larger steps are hard to compare by eye.
const FOVEA_STEP: f32 = 1.25;

const LARGER: &[KeyCode] = &[KeyCode::Equal, KeyCode::NumpadAdd, KeyCode::ArrowUp];
const SMALLER: &[KeyCode] = &[KeyCode::Minus, KeyCode::NumpadSubtract, KeyCode::ArrowDown];

/// All keys but the digits, in the order of the panel and of `--help`.
const KEYS: &[Key] = &[
    key(&[KeyCode::Tab], "Tab", Action::Split, "splits the picture (drag the divider with the left button)")
        .row("split", |state| on_off(state.is_split)),
    key(&[KeyCode::KeyF], "F", Action::Filter, "foveation").row("foveation", |state| text(state.filter.name())),
    key(&[KeyCode::KeyT], "T", Action::Render, "renders a scene's chosen quads, samples, quad views or full rate")
        .row("rendered", rendered),
    key(LARGER, "- =", Action::Fovea(FOVEA_STEP), "fovea diameter")
        .row("fovea", |state| Some(format!("{:.1} deg", state.fovea_deg))),
    key(SMALLER, "- =", Action::Fovea(1.0 / FOVEA_STEP), ""),
    key(&[KeyCode::KeyV], "V", Action::Debug, "debug views")
        .row("decisions", |state| text(state.debug.map_or("off", Named::name))),
    key(&[KeyCode::KeyP], "P", Action::Play, "scanpath or mouse")
        .row("gaze", |state| text(if state.is_playing { "scanpath" } else { "mouse" })),
    key(&[KeyCode::KeyI], "I", Action::Examine, "checks the inputs")
        .row("inputs", |state| text(if state.is_examined { "checked" } else { "off" })),
    key(&[KeyCode::KeyG], "G", Action::Mark, "gaze mark").row("gaze mark", |state| on_off(state.is_marked)),
    key(&[KeyCode::Space], "Space", Action::Freeze, "freezes").row("frozen", |state| on_off(state.is_frozen)),
    key(
        &[KeyCode::KeyC],
        "C",
        Action::Fly,
        "steers the camera of a scene (W A S D, Q E down and up, Shift faster, right button turns)",
    )
    .row("camera", |state| text(if state.is_flying? { "WASD, drag" } else { "on its path" })),
    key(&[KeyCode::KeyR], "R", Action::Restart, "restarts").row("restart", |_| text("")),
    key(&[KeyCode::KeyX], "X", Action::Explain, "prints the command that explains the pixel under the mouse")
        .row("explain pixel", |_| text("")),
    key(&[KeyCode::F12], "F12", Action::Picture, "saves the picture").row("picture", |_| text("")),
    key(&[KeyCode::F12], "Shift F12", Action::Window, "the window")
        .modifiers(Modifiers::Shift)
        .row("window", |_| text("")),
    key(&[KeyCode::KeyH], "H", Action::Panel, "hides the panel").row("panel", |_| text("")),
    key(&[KeyCode::KeyL], "Ctrl Shift L", Action::LoseDevice, "destroys the device (to test recovery)")
        .modifiers(Modifiers::ControlShift),
    key(&[KeyCode::Escape], "Esc", Action::Quit, "quits"),
];

/// Keys of what is shown, in the order of `--method`.
const DIGITS: [KeyCode; 9] = [
    KeyCode::Digit1,
    KeyCode::Digit2,
    KeyCode::Digit3,
    KeyCode::Digit4,
    KeyCode::Digit5,
    KeyCode::Digit6,
    KeyCode::Digit7,
    KeyCode::Digit8,
    KeyCode::Digit9,
];

fn text(value: &str) -> Option<String> {
    Some(value.to_owned())
}

fn on_off(is_on: bool) -> Option<String> {
    text(if is_on { "on" } else { "off" })
}

fn rendered(state: &State) -> Option<String> {
    let value = match state.filter {
        FilterName::Of(FoveationKind::Quads) => "chosen quads",
        filter if filter.is_quad_views() => "quad views",
        _ => "full rate",
    };
    state.is_rasterised.then(|| value.to_owned())
}

/// The action of a key.
pub fn action_of(code: KeyCode, shift: bool, control: bool) -> Option<Action> {
    if let Some(digit) = DIGITS.iter().position(|digit| *digit == code).filter(|_| !control) {
        let side = if shift { Side::Right } else { Side::Left };
        return Shows::rows().get(digit).map(|row| Action::Show(side, row.0));
    }
    let is_pressed = |key: &&Key| {
        key.codes.contains(&code)
            && match key.modifiers {
                Modifiers::Nothing => !control,
                Modifiers::Shift => shift && !control,
                Modifiers::ControlShift => shift && control,
            }
    };
    KEYS.iter().filter(is_pressed).max_by_key(|key| key.modifiers).map(|key| key.action)
}

/// Row of the panel.
pub struct Row {
    pub name: &'static str,
    pub value: String,
    pub key: String,
    pub action: Action,
}

/// Rows of the panel.
pub fn rows(state: &State) -> Vec<Row> {
    let digits = format!("1..{}", Shows::rows().len());
    let shown = |name, side, key| {
        let value = state.sides[side as usize].name().to_owned();
        Row { name, value, key, action: Action::Next(side) }
    };
    let mut rows = vec![shown(if state.is_split { "left" } else { "method" }, Side::Left, digits.clone())];
    if state.is_split {
        rows.push(shown("right", Side::Right, format!("Shift {digits}")));
    }
    rows.extend(KEYS.iter().filter_map(|key| {
        let (name, value) = key.row?;
        Some(Row { name, value: value(state)?, key: key.label.to_owned(), action: key.action })
    }));
    rows
}

/// The keys, as `--help` lists them.
pub fn help() -> String {
    let shown: Vec<_> = Shows::rows().into_iter().map(|row| row.1).collect();
    let keys = KEYS.iter().filter(|key| !key.help.is_empty()).map(|key| format!("{} {}", key.label, key.help));
    format!(
        "Keys: 1 to {} choose the method ({}), with Shift that of the right side; {}.",
        shown.len(),
        shown.join(", "),
        keys.collect::<Vec<_>>().join(", ")
    )
}

#[cfg(test)]
mod tests {
    use super::super::state::tests::state;
    use super::*;

    #[test]
    fn rare_keys_need_their_modifiers() {
        assert_eq!(action_of(KeyCode::KeyL, false, false), None);
        assert_eq!(action_of(KeyCode::KeyL, true, true), Some(Action::LoseDevice));
        assert_eq!(action_of(KeyCode::KeyP, false, true), None, "Control and a letter are the system's");
        assert_eq!(action_of(KeyCode::F12, true, false), Some(Action::Window));
    }

    #[test]
    fn a_digit_is_there_for_everything_that_is_shown() {
        let last = Shows::rows().len();
        assert_eq!(rows(&state())[0].key, format!("1..{last}"));
        let of_last = action_of(DIGITS[last - 1], true, false);
        assert_eq!(of_last, Some(Action::Show(Side::Right, Shows::Reference)));
        assert_eq!(DIGITS.get(last).and_then(|digit| action_of(*digit, false, false)), None);
    }

    #[test]
    fn help_lists_all_keys() {
        let help = help();
        assert!(help.contains(" choose the method (none, taa, wrs, smr, taau, "));
        for key in KEYS {
            assert!(help.contains(&format!(" {} ", key.label)), "{}", key.label);
        }
    }
}

//! The command that repeats the frames of the window with `run`, and explains a pixel.

use super::ViewArgs;
use super::state::{Shows, Side, State};
use crate::args::gaze_log::GazeLogArgs;
use crate::args::{FilterName, Named};
use afterimage::internal::FoveationKind;
use clap::{Args, Command};
use std::path::Path;

/// Options that [`command`] gives anew or that `run` does not have.
const REPLACED: [&str; 10] =
    ["method", "split", "frames", "foveation", "fovea", "screenshot", "record", "no-panel", "internal-scale", "fps"];
/// Options of the scanpath.
const OF_GAZE: [&str; 3] = ["gaze", "gaze-map", "start"];
/// Options that suit the filter that the viewer started with.
const OF_FILTER: [&str; 2] = ["rate-mid", "rate-far"];

/// A frame in the window.
#[derive(Clone, Copy, Debug)]
pub struct ShownFrame {
    /// Number since the last history reset.
    pub number: u64,
    /// Position of input and scanpath.
    pub position: u64,
    /// Whether it is shown for the first time.
    pub is_new: bool,
    /// Whether all frames of the input are equal.
    pub is_still: bool,
    /// Whether the gaze is that of the scanpath.
    pub is_played: bool,
    /// Whether the user steers the camera.
    pub is_steered: bool,
    /// Resolution as a factor on the input's.
    pub scale: f32,
}

/// Whether `run` shows the frames since the last history reset, too.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Repeatable {
    /// Whether all frames had the scanpath's gaze from its start on.
    is_played: bool,
    /// Why it does not, and what to do.
    hindrance: Option<&'static str>,
}

impl Default for Repeatable {
    fn default() -> Self {
        Self { is_played: true, hindrance: None }
    }
}

impl Repeatable {
    /// Adds the next frame.
    pub fn push(&mut self, frame: &ShownFrame) {
        let follows = frame.number == frame.position;
        let repeats_input = frame.is_still || (follows && frame.is_new);
        self.is_played &= frame.is_played && follows;
        let hindrance = if frame.scale != 1.0 {
            Some("the resolution is lower than the input's; start the viewer with --internal-scale 1")
        } else if frame.is_steered {
            Some("the camera was steered; press C and R")
        } else if !repeats_input {
            Some("frames were shown twice, or not from the input's first on; press P and R")
        } else {
            None
        };
        self.hindrance = self.hindrance.or(hindrance);
    }

    /// The command for a pixel of the last of `frames` frames on a side. `words`: those of the viewer's command line;
    /// `record`: file with the gaze of the frames. If `run` cannot repeat the frames: the reason.
    pub fn command(
        &self,
        words: &[String],
        args: &ViewArgs,
        (state, side): (&State, Side),
        (px, frames): ([u32; 2], usize),
        (record, fps): (&Path, f32),
    ) -> Result<String, &'static str> {
        let Shows::Post(method) = state.sides[side as usize] else {
            return Err("the full-rate frame is shown there, which no method computes; press 1 for none");
        };
        if let Some(hindrance) = self.hindrance {
            return Err(hindrance);
        }
        if !self.is_played && args.input.camera.as_deref().is_some_and(|camera| camera.starts_with("head")) {
            return Err("the head moves with the scanpath, and the gaze is that of the mouse; press P and R");
        }
        let of_log = GazeLogArgs::augment_args(Command::new("log"));
        let of_log: Vec<_> = of_log.get_arguments().filter_map(|arg| arg.get_long()).collect();
        let has_quads = |filter: FilterName| filter == FilterName::Of(FoveationKind::Quads);
        let is_dropped = |name: &str| {
            REPLACED.contains(&name)
                || (!self.is_played && (OF_GAZE.contains(&name) || of_log.contains(&name)))
                || (has_quads(state.filter) && !has_quads(args.foveation.filter()) && OF_FILTER.contains(&name))
        };
        let mut all = vec!["afterimage".to_owned(), "run".to_owned()];
        all.extend(without(words, is_dropped));
        let mut add = |name: &str, value: &dyn std::fmt::Display| all.extend([format!("--{name}"), value.to_string()]);
        if !self.is_played {
            add("gaze", &record.display());
        }
        add("frames", &frames);
        add("fps", &fps);
        add("method", &method.name());
        add("foveation", &state.filter.name());
        add("fovea", &state.fovea_deg);
        add("pixel", &format!("{},{}", px[0], px[1]));
        add("pixel-frames", &format!("{0}..{0}", frames - 1));
        add("out", &"out/pixel");
        Ok(all.iter().map(|word| quoted(word)).collect::<Vec<_>>().join(" "))
    }
}

/// Words after `view`, without the options that are dropped.
fn without(words: &[String], is_dropped: impl Fn(&str) -> bool) -> Vec<String> {
    let mut kept = vec![];
    let mut words = words.iter().skip_while(|word| *word != "view").skip(1);
    while let Some(word) = words.next() {
        let option =
            word.strip_prefix("--").map(|option| option.split_once('=').map_or((option, false), |o| (o.0, true)));
        match option.filter(|(name, _)| is_dropped(name)) {
            None => kept.push(word.clone()),
            Some((_, true)) | Some(("no-panel", _)) => {}
            // Its value.
            Some(_) => drop(words.next()),
        }
    }
    kept
}

/// A word as a shell reads it.
fn quoted(word: &str) -> String {
    let is_plain = |c: char| c.is_ascii_alphanumeric() || "-_=./:,+%@\\".contains(c);
    if !word.is_empty() && word.chars().all(is_plain) {
        return word.into();
    }
    format!("'{}'", word.replace('\'', r"'\''"))
}

#[cfg(test)]
mod tests {
    use super::super::state::tests::state;
    use super::*;
    use clap::Parser;

    #[derive(Parser)]
    struct Line {
        #[command(flatten)]
        args: ViewArgs,
    }

    fn frame(number: u64) -> ShownFrame {
        let (is_new, is_still, is_played, is_steered) = (true, false, true, false);
        ShownFrame { number, position: number, is_new, is_still, is_played, is_steered, scale: 1.0 }
    }

    fn shown(frames: &[ShownFrame], line: &str) -> Result<String, &'static str> {
        let words: Vec<String> = line.split(' ').map(str::to_owned).collect();
        let args = Line::parse_from(&words[1..]).args;
        let mut repeatable = Repeatable::default();
        frames.iter().for_each(|frame| repeatable.push(frame));
        let at = ([3, 4], frames.len());
        repeatable.command(&words, &args, (&state(), Side::Left), at, (Path::new("my gaze.csv"), 60.0))
    }

    #[test]
    fn the_command_has_the_options_of_the_viewer_and_its_state() {
        let line = "afterimage view a/ --no-panel --seed 3 --gaze synthetic:2 --method wrs --fovea=7 --record r.csv";
        let end = "--frames 2 --fps 60 --method smr --foveation mip --fovea 5 --pixel 3,4 --pixel-frames 1..1 \
                   --out out/pixel";
        let played = format!("afterimage run a/ --seed 3 --gaze synthetic:2 {end}");
        assert_eq!(shown(&[frame(0), frame(1)], line), Ok(played));
        let pointed = ShownFrame { is_played: false, ..frame(1) };
        let recorded = format!("afterimage run a/ --seed 3 --gaze 'my gaze.csv' {end}");
        assert_eq!(shown(&[frame(0), pointed], line), Ok(recorded));
    }

    #[test]
    fn frames_that_run_does_not_show_have_no_command() {
        let of = |last: ShownFrame| shown(&[frame(0), last, frame(2)], "afterimage view a/");
        assert!(of(frame(1)).is_ok());
        assert!(of(ShownFrame { position: 9, is_still: true, ..frame(1) }).is_ok(), "a still has one frame");
        assert!(of(ShownFrame { scale: 0.5, ..frame(1) }).unwrap_err().contains("--internal-scale 1"));
        assert!(of(ShownFrame { is_steered: true, ..frame(1) }).unwrap_err().contains("steered"));
        for frame in [ShownFrame { is_new: false, ..frame(1) }, ShownFrame { position: 9, ..frame(1) }] {
            assert!(of(frame).unwrap_err().contains("press P and R"));
        }
        let mut state = state();
        state.sides[0] = Shows::Reference;
        let args = Line::parse_from(["view", "a/"]).args;
        let none = Repeatable::default().command(&[], &args, (&state, Side::Left), ([0; 2], 1), (Path::new("g"), 60.0));
        assert!(none.unwrap_err().contains("full-rate"));
    }
}

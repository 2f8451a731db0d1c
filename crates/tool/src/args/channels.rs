//! Options that name the channels of EXR frames and their conventions.

use crate::failure::Failure;
use afterimage_lab::source::exr_file::{DepthReading, MotionReading};
use afterimage_lab::source::{AlbedoLayer, ChannelNames};
use clap::Args;

/// Heading of these options in the help.
const HEADING: &str = "Channels of EXR frames";

/// Names of channels; docs/renderers.md has those of renderers.
#[derive(Args, Clone, Debug, Default)]
pub struct ChannelArgs {
    /// Layer of the color; default: by its name, as of the next four (docs/renderers.md)
    #[arg(long, value_name = "NAME", help_heading = HEADING)]
    pub color: Option<String>,
    /// Layer or channel of the depth
    #[arg(long, value_name = "NAME", help_heading = HEADING)]
    pub depth: Option<String>,
    /// Layer of the motion vectors, or two channels: a.x,a.y
    #[arg(long, value_name = "NAME", help_heading = HEADING)]
    pub motion: Option<String>,
    /// blender|unreal|unity|arnold|karma|vray|nuke, or px|uv|ndc,to-previous|from-previous,up|down; info finds it
    #[arg(long, value_name = "NAME|LIST", help_heading = HEADING)]
    pub motion_convention: Option<MotionReading>,
    /// unreal|nuke, or view|inverse|forward|reversed|orthographic[,near=D][,far=D][,scale=N]
    #[arg(long, value_name = "NAME|LIST", help_heading = HEADING)]
    pub depth_convention: Option<DepthReading>,
    /// Layer of the albedo, which is an option of the frames that need it.
    #[arg(skip)]
    pub albedo: AlbedoLayer,
}

impl ChannelArgs {
    /// The names.
    pub fn names(&self) -> ChannelNames {
        ChannelNames {
            color: self.color.clone(),
            depth: self.depth.clone(),
            motion: self.motion.clone(),
            motion_convention: self.motion_convention,
            depth_convention: self.depth_convention,
            albedo: self.albedo.clone(),
            assume_own_convention: false,
        }
    }

    /// The options as they were given, except for the convention of motion vectors.
    pub fn text(&self) -> String {
        let names = [("--color", &self.color), ("--depth", &self.depth), ("--motion", &self.motion)];
        let names =
            names.into_iter().filter_map(|(option, name)| Some(format!(" {option} {}", quoted(name.as_ref()?))));
        let depth = self.depth_convention.map(|depth| format!(" --depth-convention {depth}"));
        names.chain(depth).collect()
    }

    /// Refuses these options for an input without channels.
    pub fn refuse_for(&self, input: &str) -> Result<(), Failure> {
        let given = [
            ("--color", self.color.is_some()),
            ("--depth", self.depth.is_some()),
            ("--motion", self.motion.is_some()),
            ("--motion-convention", self.motion_convention.is_some()),
            ("--depth-convention", self.depth_convention.is_some()),
        ];
        match given.into_iter().find(|(_, is_given)| *is_given) {
            Some((option, _)) => Err(Failure::Input(format!(
                "{option}: {input} has no channels of EXR frames; give such frames, or leave the option out"
            ))),
            None => Ok(()),
        }
    }
}

/// A word as a shell takes it.
pub fn quoted(word: &str) -> String {
    let is_plain = |c: char| c.is_alphanumeric() || "_-./,:=+".contains(c);
    if !word.is_empty() && word.chars().all(is_plain) {
        word.to_owned()
    } else {
        format!("'{}'", word.replace('\'', r"'\''"))
    }
}

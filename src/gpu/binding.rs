//! What passes bind. The number of a binding is the same in every shader.

use crate::uniforms::ORIGINS;

/// Something that passes bind, by its number. Textures of the caller, whose views may be regions, have numbers below
/// `ORIGINS`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u32)]
#[allow(missing_docs, reason = "outside the crate for its tests alone; the names are those of the inputs")]
pub enum Binding {
    /// Uniforms of the frame, or the pass's own.
    Uniforms,
    Color,
    Depth,
    Motion,
    Trust,
    Lod,
    Noise,
    Mask,
    Reactive,
    /// Colors of half the size.
    Half,
    Output = 10,
    /// Debug view beside the output.
    Debug,
    Counters,
    Albedo,
    /// Number of the frame that wrote the history.
    PastFrame = 14,
    /// First of three textures of the previous frame's history.
    Past,
    PastSecond,
    /// First of three textures of this frame's history.
    Next = 18,
    /// The pass's own textures and buffers.
    Read = 21,
    ReadSecond,
    Write,
    WriteSecond,
    State,
    List,
    /// Which quads are shaded, and the shaded quads around each.
    QuadMask,
    QuadAround,
}

/// Binding of an input of a frame.
#[derive(Debug)]
#[allow(missing_docs, reason = "outside the crate for its tests alone")]
pub struct InputBinding {
    pub binding: Binding,
    /// Name of the input's field in [`FrameInputs`](crate::frame::FrameInputs).
    pub name: &'static str,
    /// `override` of the shaders that says whether a frame has it, if they need to know.
    pub has: Option<&'static str>,
}

/// Bindings of the inputs of a frame.
pub const INPUTS: [InputBinding; 10] = [
    InputBinding { binding: Binding::Color, name: "color", has: None },
    InputBinding { binding: Binding::Depth, name: "depth", has: Some("HAS_DEPTH") },
    InputBinding { binding: Binding::Motion, name: "motion", has: Some("HAS_MOTION") },
    InputBinding { binding: Binding::Trust, name: "trust", has: Some("HAS_TRUST_MASK") },
    InputBinding { binding: Binding::Reactive, name: "reactive", has: Some("HAS_REACTIVE") },
    InputBinding { binding: Binding::Lod, name: "lod", has: Some("HAS_LOD") },
    InputBinding { binding: Binding::Noise, name: "noise", has: None },
    InputBinding { binding: Binding::Albedo, name: "albedo", has: None },
    InputBinding { binding: Binding::Mask, name: "mask", has: None },
    InputBinding { binding: Binding::Half, name: "half", has: None },
];

impl Binding {
    /// Its bit in a set of bindings.
    pub const fn bit(self) -> u32 {
        1 << self as u32
    }
}

/// Bindings that a pass uses, of those that its text declares. `None`: all.
pub fn used_by(pass: &str) -> Option<&'static [Binding]> {
    use Binding::{Color, Noise, Uniforms, Write};
    match pass {
        "candidate_pass" => Some(&[Uniforms, Color, Noise, Write]),
        _ => None,
    }
}

const _: () = assert!((Binding::Albedo as usize) < ORIGINS && (Binding::QuadAround as u32) < 32);

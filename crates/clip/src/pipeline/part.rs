//! Parts of the passes that a run can leave out.

use afterimage::MethodKind;

/// A part of the passes that can be left out, on a device.
#[derive(Debug, PartialEq, Eq)]
pub struct Part {
    /// Name on the command line.
    pub name: &'static str,
    /// Behaviour of the pass without the part.
    pub instead: &'static str,
    /// Methods whose pass contains the part.
    pub methods: &'static [MethodKind],
    /// Shader texts and their replacements. Each method's pass contains at least one of them; the others belong to
    /// other methods.
    pub replaced: &'static [(&'static str, &'static str)],
}

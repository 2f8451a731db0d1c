//! The window's shaders.

use afterimage::module;
use afterimage::shader::{Composer, Module};

static MODULES: &[Module] =
    &[module!("view", "view_luminance"), module!("view", "view_quality"), module!("view", "view_screen")];

/// Composer of the window's shaders, which may import the modules of the drop-in.
pub static SHADERS: Composer = Composer::new(&[afterimage::shader::MODULES, MODULES]);

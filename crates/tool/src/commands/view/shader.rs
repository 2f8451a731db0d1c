//! The window's shaders.

use afterimage::module;
use afterimage::shader::{Composer, Module};

static MODULES: &[Module] = &[module!("view", "view_quality"), module!("view", "view_screen")];

/// They may use the drop-in's modules.
pub static SHADERS: Composer = Composer::new(&[afterimage::shader::MODULES, MODULES]);

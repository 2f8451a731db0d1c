//! WGSL modules of the path tracer, composed with those of the lab and of the drop-in.

use afterimage::modules;
use afterimage::shader::{Composer, Module};

/// Modules of this crate.
static MODULES: &[Module] = modules! {
    "trace": "accept_all", "alpha_test", "count_pass", "effects", "expand_pass", "extend_pass", "frame",
        "generate_pass", "geometry", "hit", "hits_pass", "lights", "plan", "records", "resolve_pass",
        "scene_storage", "scene_texture", "shade_pass", "shadow_pass", "surface_point", "texture", "traverse";
};

/// Composer of this crate's shaders, which may use the modules of the lab and of the drop-in.
pub static SHADERS: Composer = Composer::new(&[afterimage::shader::MODULES, afterimage_lab::shader::MODULES, MODULES]);

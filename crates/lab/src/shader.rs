//! WGSL modules of this crate, composed with those of the drop-in.

use afterimage::modules;
use afterimage::shader::{Composer, Module};

/// Modules of this crate.
static MODULES: &[Module] = modules! {
    "pipeline": "compose_pass", "import_pass";
    "lib": "albedo", "bsdf", "direction", "layers", "light", "microfacet", "octahedral", "phong", "sampling", "shading",
        "texel", "triangle";
    "raster": "chunk_pass", "color_pass", "lighting_maps", "quads_pass", "raster_frame", "raster_material", "sky_pass",
        "sun_pass", "surface_pass", "tile_pass";
    "trace": "accept_all", "alpha_test", "count_pass", "effects", "expand_pass", "extend_pass", "frame",
        "generate_pass", "geometry", "hit", "hits_pass", "lights", "plan", "records", "resolve_pass",
        "scene_storage", "scene_texture", "shade_pass", "shadow_pass", "surface_point", "texture", "traverse";
};

/// Composer of this crate's shaders, which may use the drop-in's modules.
pub static SHADERS: Composer = Composer::new(&[afterimage::shader::MODULES, MODULES]);

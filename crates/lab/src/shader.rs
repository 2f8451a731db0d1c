//! WGSL modules of this crate, composed with those of the drop-in.

use afterimage::modules;
use afterimage::shader::{Composer, Module};

/// Modules of this crate.
pub static MODULES: &[Module] = modules! {
    "pipeline": "compose_pass", "import_pass";
    "lib": "albedo", "bsdf", "direction", "layers", "light", "microfacet", "octahedral", "phong", "sampling", "shading",
        "texel", "triangle";
    "raster": "chunk_pass", "color_pass", "g_buffer", "g_buffer_pass", "lighting_maps", "lighting_pass", "quads_pass",
        "raster_frame", "raster_lighting", "raster_material", "raster_point", "sky_pass", "sun_pass", "surface_pass",
        "tile_pass";
};

/// Composer of this crate's shaders, which may use the drop-in's modules.
pub static SHADERS: Composer = Composer::new(&[afterimage::shader::MODULES, MODULES]);

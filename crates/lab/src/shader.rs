//! WGSL modules of this crate, composed with those of the drop-in.

use afterimage::module;
use afterimage::shader::{Composer, Module};

/// Modules of this crate.
static MODULES: &[Module] = &[
    module!("pipeline", "compose_pass"),
    module!("pipeline", "import_pass"),
    module!("lib", "albedo"),
    module!("lib", "bsdf"),
    module!("lib", "direction"),
    module!("lib", "layers"),
    module!("lib", "light"),
    module!("lib", "microfacet"),
    module!("lib", "octahedral"),
    module!("lib", "phong"),
    module!("lib", "sampling"),
    module!("lib", "shading"),
    module!("lib", "texel"),
    module!("lib", "triangle"),
    module!("raster", "chunk_pass"),
    module!("raster", "color_pass"),
    module!("raster", "lighting_maps"),
    module!("raster", "quads_pass"),
    module!("raster", "raster_frame"),
    module!("raster", "raster_material"),
    module!("raster", "sky_pass"),
    module!("raster", "sun_pass"),
    module!("raster", "surface_pass"),
    module!("raster", "tile_pass"),
    module!("trace", "accept_all"),
    module!("trace", "alpha_test"),
    module!("trace", "count_pass"),
    module!("trace", "effects"),
    module!("trace", "expand_pass"),
    module!("trace", "extend_pass"),
    module!("trace", "frame"),
    module!("trace", "generate_pass"),
    module!("trace", "geometry"),
    module!("trace", "hit"),
    module!("trace", "hits_pass"),
    module!("trace", "lights"),
    module!("trace", "place_pass"),
    module!("trace", "plan"),
    module!("trace", "records"),
    module!("trace", "resolve_pass"),
    module!("trace", "scene_storage"),
    module!("trace", "scene_texture"),
    module!("trace", "shade_pass"),
    module!("trace", "shadow_pass"),
    module!("trace", "surface_point"),
    module!("trace", "texture"),
    module!("trace", "traverse"),
];

/// Composer of this crate's shaders, which may use the drop-in's modules.
pub static SHADERS: Composer = Composer::new(&[afterimage::shader::MODULES, MODULES]);

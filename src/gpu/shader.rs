//! Shaders as text: WGSL modules, put together by their `//#use` lines, each once.
//!
//! Every file under `shaders/` is valid WGSL syntax of its own; what it needs of other files it names in comment lines
//! `//#use name` at its top. `lib/` holds functions without bindings, the twins of [`kernel`](crate::kernel); `pass/` and
//! `foveation/` hold bindings, overrides and one entry point a file.

/// One WGSL file.
struct Module {
    /// As `//#use` lines name it.
    name: &'static str,
    /// As errors name it.
    path: &'static str,
    text: &'static str,
}

macro_rules! module {
    ($folder:literal, $name:literal) => {
        Module {
            name: $name,
            path: concat!("shaders/", $folder, "/", $name, ".wgsl"),
            text: include_str!(concat!("../../shaders/", $folder, "/", $name, ".wgsl")),
        }
    };
}

/// All of them.
const MODULES: &[Module] = &[
    module!("foveation", "block_show"),
    module!("foveation", "foveated_views"),
    module!("foveation", "gauss_axis"),
    module!("foveation", "mip_level"),
    module!("foveation", "mip_show"),
    module!("lib", "acuity"),
    #[cfg(feature = "lab")]
    module!("lib", "albedo"),
    module!("lib", "approx"),
    #[cfg(feature = "lab")]
    module!("lib", "bsdf"),
    module!("lib", "color"),
    module!("lib", "debug_view"),
    module!("lib", "depth"),
    #[cfg(feature = "lab")]
    module!("lib", "direction"),
    module!("lib", "foveate"),
    #[cfg(feature = "lab")]
    module!("lib", "layers"),
    #[cfg(feature = "lab")]
    module!("lib", "light"),
    module!("lib", "matched"),
    #[cfg(feature = "lab")]
    module!("lib", "microfacet"),
    module!("lib", "noise"),
    #[cfg(feature = "lab")]
    module!("lib", "octahedral"),
    module!("lib", "pack"),
    #[cfg(feature = "lab")]
    module!("lib", "phong"),
    module!("lib", "reproject"),
    module!("lib", "resample"),
    module!("lib", "reservoir"),
    module!("lib", "rng"),
    #[cfg(feature = "lab")]
    module!("lib", "sampling"),
    module!("lib", "scrub"),
    #[cfg(feature = "lab")]
    module!("lib", "shading"),
    module!("lib", "surface"),
    module!("lib", "taa"),
    #[cfg(feature = "lab")]
    module!("lib", "texel"),
    #[cfg(feature = "lab")]
    module!("lib", "triangle"),
    module!("lib", "wrs"),
    module!("pass", "candidate_pass"),
    module!("pass", "chain_pass"),
    module!("pass", "inputs"),
    module!("pass", "remembered"),
    module!("pass", "smr_pass"),
    module!("pass", "taa_pass"),
    module!("pass", "wrs_pass"),
    #[cfg(feature = "lab")]
    module!("raster", "color_pass"),
    #[cfg(feature = "lab")]
    module!("raster", "raster_frame"),
    #[cfg(feature = "lab")]
    module!("raster", "raster_material"),
    #[cfg(feature = "lab")]
    module!("raster", "scenery"),
    #[cfg(feature = "lab")]
    module!("raster", "sky_pass"),
    #[cfg(feature = "lab")]
    module!("raster", "sun_pass"),
    #[cfg(feature = "lab")]
    module!("raster", "surface_pass"),
    #[cfg(feature = "lab")]
    module!("trace", "accept_all"),
    #[cfg(feature = "lab")]
    module!("trace", "count_pass"),
    #[cfg(feature = "lab")]
    module!("trace", "effects"),
    #[cfg(feature = "lab")]
    module!("trace", "expand_pass"),
    #[cfg(feature = "lab")]
    module!("trace", "extend_pass"),
    #[cfg(feature = "lab")]
    module!("trace", "frame"),
    #[cfg(feature = "lab")]
    module!("trace", "generate_pass"),
    #[cfg(feature = "lab")]
    module!("trace", "geometry"),
    #[cfg(feature = "lab")]
    module!("trace", "heap_buffer"),
    #[cfg(feature = "lab")]
    module!("trace", "heap_texture"),
    #[cfg(feature = "lab")]
    module!("trace", "hit"),
    #[cfg(feature = "lab")]
    module!("trace", "hits_pass"),
    #[cfg(feature = "lab")]
    module!("trace", "holes"),
    #[cfg(feature = "lab")]
    module!("trace", "lights"),
    #[cfg(feature = "lab")]
    module!("trace", "plan"),
    #[cfg(feature = "lab")]
    module!("trace", "records"),
    #[cfg(feature = "lab")]
    module!("trace", "resolve_pass"),
    #[cfg(feature = "lab")]
    module!("trace", "shade_pass"),
    #[cfg(feature = "lab")]
    module!("trace", "shadow_pass"),
    #[cfg(feature = "lab")]
    module!("trace", "surface_point"),
    #[cfg(feature = "lab")]
    module!("trace", "texture"),
    #[cfg(feature = "lab")]
    module!("trace", "traverse"),
    #[cfg(feature = "view")]
    module!("view", "view_quality"),
    #[cfg(feature = "view")]
    module!("view", "view_screen"),
];

/// A shader put together, and where each of its lines comes from.
#[derive(Clone, Debug)]
pub struct Composed {
    /// The whole text.
    pub source: String,
    origins: Vec<(&'static str, u32)>,
}

impl Composed {
    /// File and line (from 1) that line `line` (from 1) of the whole text comes from.
    pub fn origin(&self, line: u32) -> Option<(&'static str, u32)> {
        self.origins.get(line.checked_sub(1)? as usize).copied()
    }

    fn push(&mut self, path: &'static str, text: &str) {
        for (i, line) in text.lines().enumerate() {
            self.source.push_str(line);
            self.source.push('\n');
            self.origins.push((path, i as u32 + 1));
        }
    }
}

/// Names of all modules, in alphabetical order within their folders.
pub fn module_names() -> impl Iterator<Item = &'static str> {
    MODULES.iter().map(|m| m.name)
}

/// The module `name` with everything that it uses, used modules first, each once.
///
/// # Panics
/// If a name is unknown or modules use each other in a circle: both are mistakes in this package, and tests compose
/// every module.
pub fn compose(name: &str) -> Composed {
    let mut composed = Composed { source: String::new(), origins: vec![] };
    add(name, &mut composed, &mut vec![], &mut vec![]);
    composed
}

/// `name` with `extra` WGSL after it, for tests that call library functions.
pub fn compose_with(names: &[&str], extra: &str) -> Composed {
    let mut composed = Composed { source: String::new(), origins: vec![] };
    let mut done = vec![];
    for name in names {
        add(name, &mut composed, &mut done, &mut vec![]);
    }
    composed.push("(the caller's text)", extra);
    composed
}

fn add(name: &str, composed: &mut Composed, done: &mut Vec<&'static str>, open: &mut Vec<&'static str>) {
    let module = MODULES.iter().find(|m| m.name == name).unwrap_or_else(|| panic!("no shader module '{name}'"));
    if done.contains(&module.name) {
        return;
    }
    assert!(!open.contains(&module.name), "shader modules use each other in a circle: {open:?}");
    open.push(module.name);
    for used in module.text.lines().map_while(|l| l.strip_prefix("//#use ")) {
        add(used.trim(), composed, done, open);
    }
    open.pop();
    composed.push(module.path, module.text);
    done.push(module.name);
}

//! Composition of WGSL shaders from modules.
//!
//! Every file under `shaders/` is a module and valid WGSL syntax. Comment lines `//#use name` at its top name the
//! modules that it uses. `lib/` contains functions without bindings, the twins of [`kernel`](crate::kernel); `pass/`
//! and `foveation/` contain bindings, overrides and one entry point a file.

/// One WGSL file.
#[derive(Debug)]
pub struct Module {
    /// Name in `//#use` lines.
    pub name: &'static str,
    /// Path of the file, for error messages.
    pub path: &'static str,
    /// WGSL text.
    pub text: &'static str,
}

/// A [`Module`] of a crate: `module!("lib", "acuity")` is `shaders/lib/acuity.wgsl` in its folder.
#[macro_export]
#[doc(hidden)]
macro_rules! module {
    ($folder:literal, $name:literal) => {
        $crate::shader::Module {
            name: $name,
            path: concat!("shaders/", $folder, "/", $name, ".wgsl"),
            text: include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/shaders/", $folder, "/", $name, ".wgsl")),
        }
    };
}

/// Modules of this crate.
pub static MODULES: &[Module] = &[
    module!("foveation", "block_show"),
    module!("foveation", "foveated_views"),
    module!("foveation", "gauss_axis"),
    module!("foveation", "mip_level"),
    module!("foveation", "mip_show"),
    module!("lib", "acuity"),
    module!("lib", "antialias"),
    module!("lib", "approx"),
    module!("lib", "color"),
    module!("lib", "debug_view"),
    module!("lib", "depth"),
    module!("lib", "doctor"),
    module!("lib", "foveate"),
    module!("lib", "stored_sample"),
    module!("lib", "lattice"),
    module!("lib", "lens"),
    module!("lib", "smr"),
    module!("lib", "noise"),
    module!("lib", "pack"),
    module!("lib", "quads"),
    module!("lib", "reproject"),
    module!("lib", "resample"),
    module!("lib", "reservoir"),
    module!("lib", "resize"),
    module!("lib", "rng"),
    module!("lib", "sanitize"),
    module!("lib", "sparse_smr"),
    module!("lib", "surface"),
    module!("lib", "taa"),
    module!("lib", "taau"),
    module!("lib", "wrs"),
    module!("pass", "candidate_lod"),
    module!("pass", "candidate_pass"),
    module!("pass", "doctor_roots_pass"),
    module!("pass", "doctor_pass"),
    module!("pass", "each_pixel"),
    module!("pass", "fill_geometry_pass"),
    module!("pass", "fill_pass"),
    module!("pass", "mip_chain_pass"),
    module!("pass", "foveation_lod"),
    module!("pass", "inputs"),
    module!("pass", "sparse_history"),
    module!("pass", "sparse_noise"),
    module!("pass", "lattices"),
    module!("pass", "none_pass"),
    module!("pass", "origin"),
    module!("pass", "past_frame"),
    module!("pass", "output"),
    module!("pass", "output_and_view"),
    module!("pass", "previous"),
    module!("pass", "quad_around_pass"),
    module!("pass", "quad_octants_pass"),
    module!("pass", "quad_runs"),
    module!("pass", "quad_key_pass"),
    module!("pass", "quad_light_pass"),
    module!("pass", "quad_list"),
    module!("pass", "quad_mask_pass"),
    module!("pass", "quad_observe_pass"),
    module!("pass", "quad_plan"),
    module!("pass", "quad_prime_pass"),
    module!("pass", "quad_samples"),
    module!("pass", "quad_state"),
    module!("pass", "quad_threshold_pass"),
    module!("pass", "quad_fill_pass"),
    module!("pass", "quad_pass"),
    module!("pass", "resize_sparse_pass"),
    module!("pass", "resize_reservoirs_pass"),
    module!("pass", "resize_surfaces_pass"),
    module!("pass", "resize_uniforms"),
    module!("pass", "settled_history"),
    module!("pass", "smr_pass"),
    module!("pass", "sparse_light_pass"),
    module!("pass", "sparse_observe_pass"),
    module!("pass", "sparse_pass"),
    module!("pass", "sparse_pixel"),
    module!("pass", "sparse_samples"),
    module!("pass", "surface_history"),
    module!("pass", "taa_pass"),
    module!("pass", "taau_pass"),
    module!("pass", "view_uniforms"),
    module!("pass", "wrs_pass"),
    module!("pass", "wrs_pixel"),
    module!("pass", "wrs_sparse_pass"),
];

/// This crate's shaders.
pub static SHADERS: Composer = Composer::new(&[MODULES]);

/// Composer of shaders from the modules of one or more crates.
#[derive(Clone, Copy, Debug)]
pub struct Composer {
    tables: &'static [&'static [Module]],
}

/// A composed shader, with the origin of each line.
#[derive(Clone, Debug)]
pub struct Composed {
    /// The whole text.
    pub source: String,
    origins: Vec<(&'static str, u32)>,
}

impl Composed {
    /// File and line of line `line` of the composed text; lines count from 1.
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

impl Composer {
    /// A composer of the modules in `tables`. Names are unique over all of them.
    pub const fn new(tables: &'static [&'static [Module]]) -> Self {
        Self { tables }
    }

    /// Names of all modules, table by table.
    pub fn module_names(&self) -> impl Iterator<Item = &'static str> {
        self.tables.iter().flat_map(|table| table.iter()).map(|m| m.name)
    }

    /// The module `name` after all modules that it uses, each once.
    ///
    /// # Panics
    /// If a name is unknown or modules use each other in a cycle. Tests compose every module.
    pub fn compose(&self, name: &str) -> Composed {
        self.compose_with(&[name], "")
    }

    /// As [`compose`](Self::compose), with the second module of `instead` in place of the first.
    ///
    /// # Panics
    /// As for [`compose`](Self::compose).
    pub fn compose_replacing(&self, name: &str, instead: (&str, &str)) -> Composed {
        let mut composed = Composed { source: String::new(), origins: vec![] };
        self.add(name, Some(instead), &mut composed, &mut vec![], &mut vec![]);
        composed
    }

    /// The modules `names` after all modules that they use, followed by `extra` WGSL.
    ///
    /// # Panics
    /// As for [`compose`](Self::compose).
    pub fn compose_with(&self, names: &[&str], extra: &str) -> Composed {
        let mut composed = Composed { source: String::new(), origins: vec![] };
        let mut done = vec![];
        for name in names {
            self.add(name, None, &mut composed, &mut done, &mut vec![]);
        }
        composed.push("(the caller's text)", extra);
        composed
    }

    fn add(
        &self,
        name: &str,
        instead: Option<(&str, &str)>,
        composed: &mut Composed,
        done: &mut Vec<&'static str>,
        open: &mut Vec<&'static str>,
    ) {
        let name = instead.filter(|(module, _)| *module == name).map_or(name, |(_, other)| other);
        let mut modules = self.tables.iter().flat_map(|table| table.iter());
        let module = modules.find(|m| m.name == name).unwrap_or_else(|| panic!("no shader module '{name}'"));
        if done.contains(&module.name) {
            return;
        }
        assert!(!open.contains(&module.name), "shader modules use each other in a cycle: {open:?}");
        open.push(module.name);
        for used in module.text.lines().map_while(|l| l.strip_prefix("//#use ")) {
            self.add(used.trim(), instead, composed, done, open);
        }
        open.pop();
        composed.push(module.path, module.text);
        done.push(module.name);
    }
}

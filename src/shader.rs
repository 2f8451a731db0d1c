//! Composition of WGSL shaders from modules.
//!
//! Every file under `shaders/` is a module and valid WGSL syntax. Comment lines `//#use name` at its top name the
//! modules that it uses. A line `//#instead name other` below them replaces one of these by another of the same
//! functions. `lib/` contains functions without bindings, the twins of [`kernel`](crate::kernel). `planned/`, `levels/`
//! and `foveation/` contain bindings, overrides and one entry point a file, `shared/` what they have in common.

use std::borrow::Cow;

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

/// The [`Module`]s of a crate, folder by folder.
#[macro_export]
#[doc(hidden)]
macro_rules! modules {
    ($($folder:literal: $($name:literal),*;)*) => { &[$($($crate::module!($folder, $name),)*)*] };
}

/// Modules of this crate.
pub static MODULES: &[Module] = modules! {
    "foveation":
        "block_show", "foveated_views", "gauss_axis", "mip_level", "mip_show";
    "levels":
        "candidate_lod", "candidate_pass", "foveation_lod", "mip_chain_pass", "none_pass", "quad_fill_pass",
        "resize_reservoirs_pass", "resize_surfaces_pass", "settled_history", "smr_pass", "surface_history", "taa_pass",
        "taau_pass", "wrs_pass", "wrs_pixel", "wrs_quad_pass";
    "lib":
        "acuity", "antialias", "approx", "candidate", "color", "debug_view", "demodulation", "depth", "doctor",
        "foveate", "lab", "lattice", "lens", "lod", "mip_noise", "noise", "pack", "quads", "reconstruction",
        "reproject", "resample", "reservoir", "resize", "rng", "sanitize", "smr", "stored_reservoir", "stored_sample",
        "surface", "taa", "taau", "wrs";
    "planned":
        "no_albedo", "quad_albedo_pass", "quad_around_pass", "quad_blocks_pass", "quad_given_pass", "quad_key_pass",
        "quad_list", "quad_mask_pass", "quad_observe_albedo_pass", "quad_observe_pass", "quad_octants_pass",
        "quad_pass", "quad_plan", "quad_prime_pass", "quad_rectify_pass", "quad_runs", "quad_state",
        "quad_threshold_pass", "resize_sparse_pass", "sparse_albedo", "sparse_history", "sparse_noise", "sparse_pixel";
    "shared":
        "doctor_pass", "doctor_roots_pass", "each_pixel", "inputs", "origin", "output", "output_and_view", "past_frame",
        "previous", "quad_samples", "resize_uniforms", "view_uniforms";
};

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
        whole(self.compose_edited(name, Some(instead), &built_in))
    }

    /// The modules `names` after all modules that they use, followed by `extra` WGSL.
    ///
    /// # Panics
    /// As for [`compose`](Self::compose).
    pub fn compose_with(&self, names: &[&str], extra: &str) -> Composed {
        let mut composition = Composition::new(self, &built_in);
        for name in names {
            whole(composition.add_whole(name, None));
        }
        composition.composed.push("(the caller's text)", extra);
        composition.composed
    }

    /// As [`compose`](Self::compose) or [`compose_replacing`](Self::compose_replacing), with the texts that `text`
    /// gives in place of the built-in ones: for shaders that change while a program runs.
    ///
    /// # Errors
    /// A line that says which name is unknown, or which modules use each other in a cycle.
    pub fn compose_edited(
        &self,
        name: &str,
        instead: Option<(&str, &str)>,
        text: &Text<'_>,
    ) -> Result<Composed, String> {
        let mut composition = Composition::new(self, text);
        composition.add_whole(name, instead)?;
        Ok(composition.composed)
    }

    fn module(&self, name: &str) -> Result<&'static Module, String> {
        let mut modules = self.tables.iter().flat_map(|table| table.iter());
        modules.find(|m| m.name == name).ok_or_else(|| format!("no shader module '{name}'"))
    }
}

/// Text of a module.
pub type Text<'t> = dyn Fn(&'static Module) -> Cow<'static, str> + 't;

fn built_in(module: &'static Module) -> Cow<'static, str> {
    module.text.into()
}

/// A composition of built-in texts.
fn whole<T>(result: Result<T, String>) -> T {
    result.unwrap_or_else(|line| panic!("{line}"))
}

/// A shader while it is composed.
struct Composition<'t> {
    composer: &'t Composer,
    text: &'t Text<'t>,
    composed: Composed,
    done: Vec<&'static str>,
    open: Vec<&'static str>,
}

impl<'t> Composition<'t> {
    fn new(composer: &'t Composer, text: &'t Text<'t>) -> Self {
        let composed = Composed { source: String::new(), origins: vec![] };
        Self { composer, text, composed, done: vec![], open: vec![] }
    }

    /// Adds a module with the replacements that it names, and one more.
    fn add_whole(&mut self, name: &str, more: Option<(&str, &str)>) -> Result<(), String> {
        let text = (self.text)(self.composer.module(name)?);
        let pair = |line| str::split_once(line, ' ').ok_or_else(|| format!("by what does '{name}' replace '{line}'?"));
        let mut instead = lines_of(&text, "//#instead ").map(pair).collect::<Result<Vec<_>, _>>()?;
        instead.extend(more);
        self.add(name, &instead)
    }

    fn add(&mut self, name: &str, instead: &[(&str, &str)]) -> Result<(), String> {
        let name = instead.iter().find(|(module, _)| *module == name).map_or(name, |(_, other)| other);
        let module = self.composer.module(name)?;
        if self.done.contains(&module.name) {
            return Ok(());
        }
        if self.open.contains(&module.name) {
            return Err(format!("shader modules use each other in a cycle: {}, {name}", self.open.join(", ")));
        }
        self.open.push(module.name);
        let text = (self.text)(module);
        for used in lines_of(&text, "//#use ") {
            self.add(used, instead)?;
        }
        self.open.pop();
        self.composed.push(module.path, &text);
        self.done.push(module.name);
        Ok(())
    }
}

/// What stands behind `key` in the lines at the top of a module's text.
fn lines_of<'t>(text: &'t str, key: &'static str) -> impl Iterator<Item = &'t str> {
    let top = text.lines().take_while(|line| line.starts_with("//#"));
    top.filter_map(move |line| line.strip_prefix(key)).map(str::trim)
}

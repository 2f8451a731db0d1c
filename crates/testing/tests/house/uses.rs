//! Which files of a crate use which: a graph from the paths in their code.
//!
//! A path counts for the file that defines what it names: re-exports and imports on the way are followed. Declaring a
//! module (`mod x;`) and re-exporting from it (`pub use x::Y;`) is not use; naming what it defines is. Methods are not
//! seen, since no path names their file. Unit tests do not count.

use super::words::{Kind, all_pieces};
use std::collections::{BTreeMap, BTreeSet};

/// Files, and those that each uses.
pub type Graph = BTreeMap<String, BTreeSet<String>>;

/// Names of nested modules, or of modules and an item in them.
type Path = Vec<String>;

/// An import or a re-export.
struct Import {
    path: Path,
    is_public: bool,
}

/// What the code of a file says.
#[derive(Default)]
struct Code {
    /// Imports by the name that they bind.
    imports: BTreeMap<String, Import>,
    /// Modules of which all is imported.
    globs: Vec<Path>,
    /// Paths outside of imports, single names among them, each with the number of inline modules around it.
    named: BTreeSet<(Path, usize)>,
}

/// The graph of a crate, from paths relative to its `src` and their texts.
pub fn graph<'a>(files: impl Iterator<Item = (&'a str, String)>) -> Graph {
    let mut crate_ = Crate { files: BTreeMap::new() };
    for (path, text) in files {
        crate_.files.insert(module_of(path), (path.to_owned(), Code::of(&text)));
    }
    crate_.files.iter().map(|(module, (file, code))| (file.clone(), crate_.used_by(module, code))).collect()
}

fn module_of(file: &str) -> Path {
    let stem = file.trim_end_matches(".rs");
    let stem = stem.strip_suffix("/mod").unwrap_or(stem);
    if ["lib", "main"].contains(&stem) { vec![] } else { stem.split('/').map(str::to_owned).collect() }
}

struct Crate {
    /// By module.
    files: BTreeMap<Path, (String, Code)>,
}

impl Crate {
    fn used_by(&self, module: &Path, code: &Code) -> BTreeSet<String> {
        let mut used = BTreeSet::new();
        // An imported module is used where its name is; an imported item may be a trait, whose name appears nowhere.
        let items = code.imports.values().filter(|i| !i.is_public).filter_map(|i| self.absolute(module, 0, &i.path));
        used.extend(items.filter(|path| !self.files.contains_key(path)).filter_map(|path| self.file_of(&path, 0)));
        used.extend(code.globs.iter().filter_map(|glob| self.file_of(&self.absolute(module, 0, glob)?, 0)));
        for (path, inline) in &code.named {
            let is_name = path.len() == 1 && !code.imports.get(&path[0]).is_some_and(|i| i.is_public);
            if !is_name && let Some(path) = self.absolute(module, *inline, path) {
                used.extend(self.file_of(&path, 0));
            }
        }
        used.remove(&self.files[module].0);
        used
    }

    /// A path from the root of the crate; `None` for what is not of this crate, or local.
    fn absolute(&self, module: &Path, inline: usize, path: &[String]) -> Option<Path> {
        let mut base = module.clone();
        base.extend(vec![String::from("(inline)"); inline]);
        let mut rest = path;
        match path[0].as_str() {
            "crate" => (base, rest) = (vec![], &path[1..]),
            "self" => rest = &path[1..],
            "super" => {}
            first => {
                let child = [module.as_slice(), &path[..1]].concat();
                if !self.files.contains_key(&child) {
                    let import = self.files.get(module)?.1.imports.get(first)?;
                    // An import that names itself is of another crate: `use std::fmt`.
                    let imported = (import.path[0] != first).then(|| self.absolute(module, 0, &import.path))??;
                    return Some([&imported, &path[1..]].concat());
                }
            }
        }
        while let Some((first, others)) = rest.split_first().filter(|(first, _)| *first == "super") {
            debug_assert_eq!(first, "super");
            base.pop()?;
            rest = others;
        }
        base.extend_from_slice(rest);
        Some(base)
    }

    /// The file that defines what an absolute path names.
    fn file_of(&self, path: &[String], followed: usize) -> Option<String> {
        assert!(followed < 16, "imports lead round: {path:?}");
        let depth = (0..=path.len()).rev().find(|&depth| self.files.contains_key(&path[..depth]))?;
        let (module, rest) = path.split_at(depth);
        let (module, (file, code)) = self.files.get_key_value(module)?;
        let Some(import) = rest.first().and_then(|item| code.imports.get(item)) else { return Some(file.clone()) };
        let imported = self.absolute(module, 0, &import.path)?;
        if imported == path[..=depth] {
            return Some(file.clone());
        }
        self.file_of(&[&imported, &rest[1..]].concat(), followed + 1)
    }
}

impl Code {
    fn of(source: &str) -> Self {
        let tokens = without_tests(tokens(source));
        let (mut code, mut at, mut level, mut inline) = (Self::default(), 0, 0_usize, vec![]);
        while at < tokens.len() {
            let next = |n: usize| tokens.get(at + n).map_or("", String::as_str);
            match next(0) {
                // Not the bound `impl X + use<'_>`.
                "use" if next(1) != "<" => {
                    let is_public = at > 0 && (tokens[at - 1] == "pub" || tokens[at - 1] == ")");
                    let end = at + tokens[at..].iter().position(|t| t == ";").unwrap_or(tokens.len() - at);
                    let mut imports = Self::default();
                    imports.import(&tokens[at + 1..end], &mut vec![], is_public);
                    code.add(imports, inline.len());
                    at = end;
                }
                "mod" if next(2) == "{" => {
                    inline.push(level);
                    at += 1;
                }
                "mod" => at += 1,
                "{" => level += 1,
                "}" => {
                    level = level.saturating_sub(1);
                    inline.pop_if(|outer| *outer == level);
                }
                name if is_name(name) && !(at > 0 && [".", "::"].contains(&tokens[at - 1].as_str())) => {
                    let mut path = vec![name.to_owned()];
                    while next(2 * path.len() - 1) == "::" && is_name(next(2 * path.len())) {
                        path.push(next(2 * path.len()).to_owned());
                    }
                    code.named.insert((path, inline.len()));
                }
                _ => {}
            }
            at += 1;
        }
        code
    }

    /// Adds imports; those of inline modules bind no name of the file.
    fn add(&mut self, imports: Self, inline: usize) {
        if inline == 0 {
            self.imports.extend(imports.imports);
            self.globs.extend(imports.globs);
        } else {
            let paths = imports.imports.into_values().map(|i| i.path).chain(imports.globs);
            self.named.extend(paths.map(|path| (path, inline)));
        }
    }

    /// Adds the imports of a tree such as `a::{b, c as d, e::*}`.
    fn import(&mut self, tree: &[String], prefix: &mut Path, is_public: bool) {
        let outer = prefix.len();
        let mut at = 0;
        while at < tree.len() {
            match tree[at].as_str() {
                "{" => {
                    let mut level = 0;
                    let end = tree[at..].iter().position(|t| {
                        level += i32::from(t == "{") - i32::from(t == "}");
                        level == 0
                    });
                    let end = at + end.expect("braces are balanced");
                    self.import(&tree[at + 1..end], prefix, is_public);
                    // What follows is a comma or the end, and the list itself binds no name.
                    prefix.truncate(outer);
                    at = end + 2;
                    continue;
                }
                "*" => {
                    self.globs.push(prefix.clone());
                    prefix.truncate(outer);
                    at += 2;
                    continue;
                }
                "::" => {}
                "," => self.bind(prefix, outer, None, is_public),
                "as" => {
                    self.bind(prefix, outer, Some(&tree[at + 1]), is_public);
                    at += 1;
                }
                name => prefix.push(name.to_owned()),
            }
            at += 1;
        }
        self.bind(prefix, outer, None, is_public);
    }

    fn bind(&mut self, path: &mut Path, outer: usize, name: Option<&str>, is_public: bool) {
        if path.len() > outer {
            if path.last().is_some_and(|last| last == "self") && path.len() > 1 {
                path.pop();
            }
            let name = name.unwrap_or(&path[path.len() - 1]).to_owned();
            self.imports.insert(name, Import { path: path.clone(), is_public });
        }
        path.truncate(outer);
    }
}

fn is_name(token: &str) -> bool {
    token.starts_with(|c: char| c.is_alphabetic() || c == '_')
}

/// Names, `::` and other single characters of a source's code.
fn tokens(source: &str) -> Vec<String> {
    let mut tokens: Vec<String> = vec![];
    let mut end = 0;
    for text in all_pieces(source).into_iter().filter(|p| p.kind == Kind::Code).map(|p| p.text) {
        let start = text.as_ptr() as usize - source.as_ptr() as usize;
        match tokens.last_mut() {
            Some(last) if last == ":" && text == ":" && start == end => last.push(':'),
            _ => tokens.push(text.to_owned()),
        }
        end = start + text.len();
    }
    tokens
}

/// Tokens without the items behind `#[cfg(test)]`.
fn without_tests(tokens: Vec<String>) -> Vec<String> {
    let (mut kept, mut at) = (vec![], 0);
    while at < tokens.len() {
        if !tokens[at..].starts_with(&["#", "[", "cfg", "(", "test", ")", "]"].map(String::from)) {
            kept.push(tokens[at].clone());
            at += 1;
            continue;
        }
        let mut level = 0;
        let end = tokens[at + 7..].iter().position(|t| {
            level += i32::from(t == "{") - i32::from(t == "}");
            level == 0 && (t == ";" || t == "}")
        });
        at = end.map_or(tokens.len(), |end| at + 7 + end + 1);
    }
    kept
}

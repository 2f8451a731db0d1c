//! Paths in comments and documents name files that exist.

use super::tree::{Tree, expect_none, package_of, read};
use super::words::{Kind, pieces};
use std::collections::BTreeSet;

/// Folders of a package. A path that begins with one of them is relative to a package or to the workspace.
const ROOTS: [&str; 7] = ["crates", "docs", "examples", "fixtures", "shaders", "src", "tests"];

/// Pages that name files of the past.
const HISTORY: &str = "CHANGELOG.md";

/// Words of a line that look like paths of files (with an extension) or of folders (with a slash at the end).
///
/// Colons end a word, so that `path:line` and `path::item` count as `path`, and addresses begin with a slash.
fn path_words(line: &str) -> impl Iterator<Item = &str> {
    let is_of_path = |c: char| c.is_ascii_alphanumeric() || "_-./*{},".contains(c);
    let words = line.split(move |c| !is_of_path(c)).map(|w| w.trim_end_matches(['.', ',', '-']));
    words.filter(|w| {
        let Some((first, rest)) = w.split_once('/') else { return false };
        if !first.starts_with(|c: char| c.is_ascii_alphabetic()) {
            return false;
        }
        let file = w.rsplit('/').next().expect("split has an item");
        let is_source = [".rs", ".wgsl"].iter().any(|ending| file.ends_with(ending));
        let is_named = file.is_empty() || file.trim_start_matches('.').contains('.') || file.contains('*');
        is_source || (ROOTS.contains(&first) && is_named && !rest.is_empty() || w.len() > 1 && is_root_alone(w))
    })
}

fn is_root_alone(word: &str) -> bool {
    word.strip_suffix('/').is_some_and(|w| ROOTS.contains(&w))
}

/// `a{b,c}d` as `abd` and `acd`.
fn alternatives(word: &str) -> Vec<String> {
    let Some((before, (inner, after))) = word.split_once('{').and_then(|(b, r)| Some((b, r.split_once('}')?))) else {
        return vec![word.to_owned()];
    };
    inner.split(',').flat_map(|choice| alternatives(&format!("{before}{choice}{after}"))).collect()
}

/// Whether a component of a path agrees with a pattern in which `*` or a word in capitals stands for any characters.
fn component_agrees(pattern: &str, name: &str) -> bool {
    if pattern == name {
        return true;
    }
    let is_placeholder = |word: &str| word.len() > 1 && word.chars().all(|c| c.is_ascii_uppercase());
    let words = pattern.split_inclusive(['_', '.', '-']);
    let pattern: String = words
        .map(|word| {
            let end = word.len() - usize::from(word.ends_with(['_', '.', '-']));
            if is_placeholder(&word[..end]) { format!("*{}", &word[end..]) } else { word.to_owned() }
        })
        .collect();
    let parts: Vec<&str> = pattern.split('*').collect();
    let [first, .., last] = parts[..] else { return false };
    name.len() >= first.len() + last.len() && name.starts_with(first) && name.ends_with(last)
}

/// Whether an entry of the tree is the path, or with `anywhere` ends with it.
fn exists(tree: &BTreeSet<String>, path: &str, anywhere: bool) -> bool {
    if tree.contains(path) {
        return true;
    }
    let wanted: Vec<&str> = path.split('/').collect();
    tree.iter().any(|entry| {
        let entry: Vec<&str> = entry.split('/').collect();
        let Some(skipped) = entry.len().checked_sub(wanted.len()) else { return false };
        (skipped == 0 || anywhere) && wanted.iter().zip(&entry[skipped..]).all(|(w, e)| component_agrees(w, e))
    })
}

/// Removes `folder/..`.
fn normalized(path: &str) -> String {
    let mut parts: Vec<&str> = vec![];
    for part in path.split('/') {
        match (part, parts.last()) {
            ("..", Some(last)) if *last != ".." => drop(parts.pop()),
            (".", _) => {}
            _ => parts.push(part),
        }
    }
    parts.join("/")
}

/// Text of a file in which paths are checked, as lines with their numbers: comments of source files, all of other
/// files.
fn checked_lines<'a>(path: &str, text: &'a str) -> Vec<(usize, &'a str)> {
    if path.ends_with(".rs") || path.ends_with(".wgsl") {
        let comments = pieces(text).into_iter().filter(|p| p.kind == Kind::Comment);
        comments.map(|p| (p.line, p.text)).collect()
    } else {
        text.lines().enumerate().map(|(index, line)| (index + 1, line)).collect()
    }
}

/// Targets of a page's links to files, without anchors.
fn links(line: &str) -> impl Iterator<Item = &str> {
    line.split("](")
        .skip(1)
        .filter_map(|rest| rest.split([')', '#', ' ']).next())
        .filter(|l| !l.is_empty() && !l.contains("://") && (l.contains('/') || l.contains('.')))
}

/// Paths in the text of the file `path` that name nothing in the tree.
fn missing_paths(tree: &BTreeSet<String>, path: &str, text: &str) -> Vec<String> {
    let package = package_of(path);
    let folder = &path[..path.rfind('/').map_or(0, |at| at + 1)];
    let mut missing = vec![];
    for (number, line) in checked_lines(path, text) {
        for word in path_words(line).flat_map(alternatives) {
            let first = word.split('/').next().unwrap_or_default();
            let is_found = if ROOTS.contains(&first) {
                ["", package, folder].iter().any(|base| exists(tree, &format!("{base}{word}"), false))
            } else {
                exists(tree, &word, true)
            };
            if !is_found {
                missing.push(format!("{path}:{number}: {word}"));
            }
        }
        if path.ends_with(".md") {
            let leads_nowhere = |link: &&str| {
                let target = normalized(&format!("{folder}{link}"));
                !tree.contains(&target) && !tree.contains(&format!("{target}/"))
            };
            let broken = links(line).filter(leads_nowhere);
            missing.extend(broken.map(|l| format!("{path}:{number}: link to {l}")));
        }
    }
    missing
}

#[test]
fn paths_in_comments_and_documents_exist() {
    let tree = Tree::read();
    let files: Vec<_> = tree.files("", &[".rs", ".wgsl", ".md", ".toml", ".sh"]).filter(|f| *f != HISTORY).collect();
    let mut checked = 0;
    let mut violations = vec![];
    for file in files {
        let text = read(file);
        checked += checked_lines(file, &text).iter().flat_map(|(_, line)| path_words(line)).count();
        violations.extend(missing_paths(&tree.entries, file, &text));
    }
    println!("{checked} paths");
    assert!(checked > 300);
    expect_none("paths that name nothing", &violations);
}

#[test]
fn a_path_that_names_nothing_is_found() {
    let tree = [
        "src/",
        "src/gpu/",
        "src/gpu/mod.rs",
        "src/gpu/smr_pass.rs",
        "tests/run.sh",
        "crates/lab/src/trace/bvh.rs",
        "docs/method.md",
    ];
    let tree: BTreeSet<String> = tree.into_iter().map(str::to_owned).collect();
    let missing = |path: &str, text: &str| missing_paths(&tree, path, text);
    let sound = "//! See src/gpu/mod.rs:7, src/gpu/NAME_pass.rs, `src/gpu/*.rs`, src/gpu/NAME.rs, trace/bvh.rs::Bvh, tests/{run,run}.sh and src/gpu/.\n\
        let ignored = \"src/none.rs\";\n// https://docs.rs/src/none.rs, and/or, tests/none\n";
    assert_eq!(missing("src/lib.rs", sound), Vec::<String>::new());
    assert_eq!(missing("crates/lab/src/lib.rs", "// src/trace/bvh.rs"), Vec::<String>::new());
    assert_eq!(missing("src/lib.rs", "fn f() {} // src/trace/bvh.rs."), ["src/lib.rs:1: src/trace/bvh.rs"]);
    assert_eq!(missing("src/lib.rs", "\n/// Twin of trace/bvh2.rs"), ["src/lib.rs:2: trace/bvh2.rs"]);
    assert_eq!(
        missing("src/lib.rs", "// src/cpu/, src/cpu/*.rs"),
        ["src/lib.rs:1: src/cpu/", "src/lib.rs:1: src/cpu/*.rs"]
    );
    assert_eq!(missing("x.toml", "a = \"tests/none.sh\" # tests/run.sh"), ["x.toml:1: tests/none.sh"]);
    let page = "[a](method.md#part) [b](../src/gpu/mod.rs) [src](../src) [c](https://x.y/z.md) [d](none.md)";
    assert_eq!(missing("docs/a.md", page), ["docs/a.md:1: link to none.md"]);
}

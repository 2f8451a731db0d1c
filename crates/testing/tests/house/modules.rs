//! Modules of a crate use each other without circles.

use super::tree::{Tree, expect_none, read};
use super::words::is_of_identifier;
use std::collections::{BTreeMap, BTreeSet};

/// Top-level modules, and those that each uses outside of its tests.
type Graph = BTreeMap<String, BTreeSet<String>>;

/// Text without line comments, up to the first unit tests.
fn code(source: &str) -> String {
    let source = source.split("#[cfg(test)]").next().unwrap_or(source);
    source.lines().filter(|l| !l.trim_start().starts_with("//")).collect::<Vec<_>>().join("\n")
}

/// Top-level modules that a file names: `crate::x`, `crate::{x, y}`, or by `super::`. `depth`: number of modules around
/// its items, 1 for a top-level module.
fn used_modules(source: &str, depth: usize) -> BTreeSet<String> {
    let code = code(source);
    let mut used = BTreeSet::new();
    let to_root = "super::".repeat(depth);
    for root in ["crate::", &to_root] {
        for (at, _) in code.match_indices(root) {
            let before = &code[..at];
            if before.ends_with(|c| is_of_identifier(c) || c == ':') || code[at + root.len()..].starts_with("super::") {
                continue;
            }
            used.extend(first_names(&code[at + root.len()..]));
        }
    }
    used
}

/// The first name of a path, or of each path between braces.
fn first_names(rest: &str) -> Vec<String> {
    let name = |text: &str| -> String { text.trim_start().chars().take_while(|c| is_of_identifier(*c)).collect() };
    let Some(list) = rest.strip_prefix('{') else { return vec![name(rest)] };
    let (mut level, mut starts_item, mut names) = (1, true, vec![]);
    for (at, c) in list.char_indices() {
        if level == 1 && starts_item && is_of_identifier(c) {
            names.push(name(&list[at..]));
            starts_item = false;
        }
        match c {
            '{' => level += 1,
            '}' => level -= 1,
            ',' => starts_item = true,
            _ => {}
        }
        if level == 0 {
            break;
        }
    }
    names
}

/// The graph of a crate, from paths relative to its `src` and their texts.
fn graph<'a>(files: impl Iterator<Item = (&'a str, String)>) -> Graph {
    let files: Vec<(Vec<String>, String)> = files
        .map(|(path, text)| {
            let stem = path.trim_end_matches(".rs").trim_end_matches("/mod");
            (stem.split('/').map(str::to_owned).collect(), text)
        })
        .collect();
    let names: BTreeSet<String> = files.iter().map(|(path, _)| path[0].clone()).collect();
    let mut graph = Graph::new();
    for (path, text) in files.iter().filter(|(path, _)| !["lib", "main"].contains(&path[0].as_str())) {
        let used = used_modules(text, path.len());
        let others = used.into_iter().filter(|name| names.contains(name) && *name != path[0]);
        graph.entry(path[0].clone()).or_default().extend(others);
    }
    graph
}

/// Modules from which a path leads back to them, each with those that it uses of the same kind.
fn circles(graph: &Graph) -> Vec<String> {
    let reached = |from: &String| {
        let mut reached = BTreeSet::new();
        let mut open: Vec<&String> = graph[from].iter().collect();
        while let Some(next) = open.pop() {
            if reached.insert(next.clone()) {
                open.extend(graph.get(next).into_iter().flatten());
            }
        }
        reached
    };
    let reach: BTreeMap<&String, BTreeSet<String>> = graph.keys().map(|name| (name, reached(name))).collect();
    let on_circle = graph.keys().filter(|name| reach[name].contains(*name));
    on_circle
        .map(|name| {
            let back: Vec<_> = graph[name].iter().filter(|n| reach.get(n).is_some_and(|r| r.contains(name))).collect();
            format!("{name} uses {back:?}")
        })
        .collect()
}

#[test]
fn modules_use_each_other_without_circles() {
    let tree = Tree::read();
    for folder in ["src/", "crates/lab/src/", "crates/tool/src/"] {
        let files = tree.files(folder, &[".rs"]).map(|f| (&f[folder.len()..], read(f)));
        let graph = graph(files);
        let edges: usize = graph.values().map(BTreeSet::len).sum();
        println!("{folder}: {} modules, {edges} edges", graph.len());
        assert!(graph.len() > 5 && edges > 10, "{graph:?}");
        expect_none(&format!("circles in {folder}"), &circles(&graph));
    }
}

#[test]
fn a_circle_is_found() {
    let files = |c: &'static str| {
        [
            ("lib.rs", "mod a;".to_owned()),
            ("a/mod.rs", "use crate::b::X;\n".to_owned()),
            ("a/deep.rs", "use super::Y; fn f() { super::super::b::g() }\n".to_owned()),
            ("b.rs", "use crate::{c::{Z, W}, error::Error};\n".to_owned()),
            ("c.rs", c.to_owned()),
            ("error.rs", "#[cfg(test)]\nmod tests { use crate::a::X; }\n".to_owned()),
        ]
        .into_iter()
    };
    assert_eq!(circles(&graph(files("// crate::a\n"))), Vec::<String>::new());
    let planted = ["a uses [\"b\"]", "b uses [\"c\"]", "c uses [\"a\"]"];
    assert_eq!(circles(&graph(files("use crate::{error::Error, a};\n"))), planted);
    assert_eq!(circles(&graph(files("fn f() { super::a::g(); }\n"))), planted);
    assert_eq!(graph(files("")).values().map(BTreeSet::len).sum::<usize>(), 3);
}

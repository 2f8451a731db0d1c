//! Files of a crate, and its top-level modules, use each other without circles.

use super::tree::{Tree, expect_none, read};
use super::uses::{Graph, graph};
use std::collections::BTreeSet;

/// Folders of crates.
const CRATES: [&str; 7] = [
    "src/",
    "crates/eval/src/",
    "crates/lab/src/",
    "crates/trace/src/",
    "crates/tool/src/",
    "crates/bevy/src/",
    "crates/research/src/",
];

/// Subcommands and the options of their parts.
const OPTIONS: &str = "A subcommand's file begins with its options, as `--help` does, and its parts read them.";

/// Uses that close a circle, and why they stay: crate, user or folder of users, used, reason.
const ALLOWED: [[&str; 4]; 7] = [
    ["src/", "method/", "method/mod.rs", "Entries are values of the type that the table lists."],
    ["src/", "gpu/", "gpu/mod.rs", "Checks of a frame say the limits of the executor that is given it."],
    ["crates/tool/src/", "commands/bench/", "commands/bench/mod.rs", OPTIONS],
    ["crates/tool/src/", "commands/run/", "commands/run/mod.rs", OPTIONS],
    ["crates/tool/src/", "commands/sweep/", "commands/sweep/mod.rs", OPTIONS],
    ["crates/tool/src/", "commands/trace/", "commands/trace/mod.rs", OPTIONS],
    ["crates/tool/src/", "commands/view/", "commands/view/mod.rs", OPTIONS],
];

/// Everything that a path leads to.
fn reached<'a>(graph: &'a Graph, from: &str) -> BTreeSet<&'a str> {
    let mut reached = BTreeSet::new();
    let mut open: Vec<&str> = graph[from].iter().map(String::as_str).collect();
    while let Some(next) = open.pop() {
        if reached.insert(next) {
            open.extend(graph[next].iter().map(String::as_str));
        }
    }
    reached
}

/// Circles: what is in each, with what each uses of it.
fn circles(graph: &Graph) -> Vec<String> {
    let mut done = BTreeSet::new();
    let mut circles = vec![];
    for name in graph.keys() {
        let ahead = reached(graph, name);
        if done.contains(name.as_str()) || !ahead.contains(name.as_str()) {
            continue;
        }
        let circle: BTreeSet<&str> =
            ahead.into_iter().filter(|other| reached(graph, other).contains(&**name)).collect();
        let uses = circle.iter().map(|user| {
            let used: Vec<_> = graph[*user].iter().filter(|used| circle.contains(used.as_str())).collect();
            format!("{user} uses {used:?}")
        });
        circles.push(uses.collect::<Vec<_>>().join("; "));
        done.extend(circle);
    }
    circles
}

/// The graph of top-level modules, without the root.
fn of_modules(files: &Graph) -> Graph {
    let top = |file: &str| file.split('/').next().unwrap_or(file).trim_end_matches(".rs").to_owned();
    let mut modules = Graph::new();
    for (file, used) in files.iter().filter(|(file, _)| !["lib.rs", "main.rs"].contains(&file.as_str())) {
        let module = modules.entry(top(file)).or_default();
        let is_other = |used: &String| ![top(file).as_str(), "lib", "main"].contains(&used.as_str());
        module.extend(used.iter().map(|used| top(used)).filter(is_other));
    }
    modules
}

/// The graph of the files below `folder`, the `src` of a crate.
pub fn graph_of(folder: &str) -> Graph {
    let tree = Tree::read();
    graph(tree.files(folder, &[".rs"]).map(|f| (&f[folder.len()..], read(f))))
}

#[test]
fn modules_use_each_other_without_circles() {
    for folder in CRATES {
        let graph = of_modules(&graph_of(folder));
        let edges: usize = graph.values().map(BTreeSet::len).sum();
        println!("{folder}: {} modules, {edges} edges", graph.len());
        assert!(graph.len() > 3 && edges > 4, "{graph:?}");
        expect_none(&format!("circles in {folder}"), &circles(&graph));
    }
}

#[test]
fn files_use_each_other_without_circles() {
    let mut violations = vec![];
    for folder in CRATES {
        let mut graph = graph_of(folder);
        let edges: usize = graph.values().map(BTreeSet::len).sum();
        println!("{folder}: {} files, {edges} edges", graph.len());
        assert!(graph.len() > 10 && edges > 15, "{graph:?}");
        for [_, user, used, _] in ALLOWED.iter().filter(|allowed| allowed[0] == folder) {
            let ahead: BTreeSet<String> = reached(&graph, used).into_iter().map(str::to_owned).collect();
            let users = graph.iter_mut().filter(|(file, _)| file.starts_with(user) && ahead.contains(*file));
            if users.filter_map(|(_, uses)| uses.take(*used)).count() == 0 {
                violations.push(format!("{folder}: {user} and {used} are in no circle: remove the exception"));
            }
        }
        violations.extend(circles(&graph).into_iter().map(|circle| format!("{folder}: {circle}")));
    }
    expect_none("circles of files", &violations);
}

/// Files of a crate without circles, with `deep` as the text of one.
fn files(deep: &str) -> Vec<(&'static str, String)> {
    let text = |path, text: &str| (path, text.to_owned());
    vec![
        text("lib.rs", "mod a;\nmod b;\npub mod c;\nmod error;\npub use error::Error;\nuse std::fmt;\n"),
        text(
            "a/mod.rs",
            "mod deep;\npub mod other;\nuse crate::b;\npub use deep::Deep;\nfn f() -> X { b::X }\nfn g() {}\n",
        ),
        text("a/deep.rs", deep),
        text("a/other.rs", "use super::Deep;\nuse std::fmt::{self, Debug as D};\n"),
        text("b.rs", "use crate::{c::{Z, W}, Error};\n"),
        text("c.rs", "// crate::a\nconst A: [&str; 2] = [\"crate::a::g\", r#\"super::a::g\"#];\n"),
        text("error.rs", "#[cfg(test)]\nmod tests {\n    use crate::a::X;\n}\nfn f() { [0; 3].a.deep() }\n"),
    ]
}

fn found(deep: &str) -> Vec<String> {
    let files = files(deep);
    circles(&graph(files.iter().map(|(path, text)| (*path, text.clone()))))
}

#[test]
fn a_circle_of_files_is_found() {
    let none: [&str; 0] = [];
    // What a parent re-exports is another child's, and what it imports another module's.
    for deep in ["", "use super::b;\nfn f() { b::X }\n", "mod inner { use super::super::b::X; }\n"] {
        assert_eq!(found(deep), none, "{deep}");
    }
    let parent = "a/deep.rs uses [\"a/mod.rs\"]; a/mod.rs uses [\"a/deep.rs\"]";
    let use_of_child = |deep: &str| {
        let mut files = files(deep);
        files[1].1.push_str("fn h() -> Deep { Deep }\n");
        circles(&graph(files.iter().map(|(path, text)| (*path, text.clone()))))
    };
    for deep in ["use super::g;\n", "fn f() { super::g() }\n", "use crate::a::*;\n", "use crate::{a::g as h};\n"] {
        assert_eq!(found(deep), none, "a parent that only re-exports uses nothing: {deep}");
        assert_eq!(use_of_child(deep), [parent], "{deep}");
    }
    let siblings = "a/deep.rs uses [\"a/other.rs\"]; a/other.rs uses [\"a/deep.rs\"]";
    for deep in ["use super::other::Y;\n", "use crate::a;\nfn f() { a::other::y() }\n", "impl super::other::Y {}\n"] {
        assert_eq!(found(deep), [siblings], "{deep}");
    }
}

#[test]
fn a_circle_of_modules_is_found() {
    let mut files = files("");
    files[5].1.push_str("fn f() { super::a::g(); }\n");
    let graph = graph(files.iter().map(|(path, text)| (*path, text.clone())));
    assert_eq!(circles(&of_modules(&graph)), ["a uses [\"b\"]; b uses [\"c\"]; c uses [\"a\"]"]);
    assert_eq!(graph.values().map(BTreeSet::len).sum::<usize>(), 5);
}

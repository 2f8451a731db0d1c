//! Manifests of published packages: what they include, and what they depend on.

use super::tree::{Tree, expect_none, read};
use std::collections::BTreeSet;
use toml::{Table, Value};

/// Folders of published packages.
const PUBLISHED: [&str; 8] = [
    "",
    "crates/eval/",
    "crates/lab/",
    "crates/metric/",
    "crates/openxr/",
    "crates/program/",
    "crates/tool/",
    "crates/trace/",
];

/// Packages for engines, which have one of several versions of wgpu. The others are on the newest.
const FOR_ENGINES: [&str; 2] = ["", "crates/openxr/"];

/// Files that every package includes, as patterns of its list; shaders if it has any.
const REQUIRED: [&str; 4] = ["/src", "/shaders", "/README.md", "/LICENSE-*"];

/// Required entries that the `include` list lacks, and entries that name no file. `entries`: the package's files and
/// folders.
fn wrong_includes(manifest: &Table, entries: &BTreeSet<&str>) -> Vec<String> {
    let list = included(manifest);
    let names_nothing = |pattern: &str| {
        let Some(path) = pattern.strip_prefix('/') else { return true };
        match path.split_once('*') {
            Some((start, end)) => !entries.iter().any(|e| e.starts_with(start) && e.ends_with(end)),
            None => !entries.contains(path) && !entries.contains(format!("{path}/").as_str()),
        }
    };
    let required = REQUIRED.iter().filter(|r| **r != "/shaders" || entries.contains("shaders/"));
    let absent = required.filter(|r| !list.contains(r)).map(|r| format!("`include` lacks {r}"));
    let nothing = list.iter().filter(|p| names_nothing(p)).map(|p| format!("`include`: {p} names nothing"));
    absent.chain(nothing).collect()
}

fn included(manifest: &Table) -> Vec<&str> {
    let list = manifest["package"].get("include").and_then(Value::as_array);
    list.map(|l| l.iter().filter_map(Value::as_str).collect()).unwrap_or_default()
}

/// Files that sources read when they are compiled and that `include` leaves out. `files`: paths in the package, and
/// texts.
fn left_out(manifest: &Table, files: &[(&str, String)]) -> Vec<String> {
    let list = included(manifest);
    let mut left_out = vec![];
    for (path, text) in files {
        for macro_name in ["include_str!(\"", "include_bytes!(\"", "#[path = \""] {
            let named = text.split(macro_name).skip(1).filter_map(|rest| rest.split('"').next());
            for name in named {
                // Relative to the file; `..` at the start leaves its folder.
                let mut folders: Vec<&str> = path.split('/').collect();
                folders.pop();
                let mut is_outside = false;
                for part in name.split('/') {
                    match part {
                        ".." => is_outside |= folders.pop().is_none(),
                        _ => folders.push(part),
                    }
                }
                let target = format!("/{}", folders.join("/"));
                let is_listed =
                    list.iter().any(|p| target.strip_prefix(p).is_some_and(|r| r.is_empty() || r.starts_with('/')));
                if is_outside || !is_listed {
                    left_out.push(format!("{path}: {name} is not in the package"));
                }
            }
        }
    }
    left_out
}

/// Absolute paths anywhere but in `include`, where a slash means the package's folder.
fn absolute_paths(manifest: &Table) -> Vec<String> {
    fn visit(key: &str, value: &Value, found: &mut Vec<String>) {
        match value {
            Value::String(text) if text.starts_with(['/', '~']) || text.contains(":\\") || text.contains("file:") => {
                found.push(format!("absolute path: {key} = {text}"));
            }
            Value::Array(items) if key != "include" => items.iter().for_each(|v| visit(key, v, found)),
            Value::Table(table) => table.iter().for_each(|(k, v)| visit(k, v, found)),
            _ => {}
        }
    }
    let mut found = vec![];
    manifest.iter().for_each(|(key, value)| visit(key, value, &mut found));
    found
}

/// Dependencies, other than those of tests, that a registry cannot resolve: with a path, but without a version.
fn without_version(manifest: &Table, workspace: &Table) -> Vec<String> {
    let shared = &workspace["workspace"]["dependencies"];
    let platforms = manifest.get("target").and_then(Value::as_table).into_iter().flat_map(|t| t.values());
    let own = Value::Table(manifest.clone());
    let sections = platforms.chain([&own]).flat_map(|s| [s.get("dependencies"), s.get("build-dependencies")]);
    let dependencies = sections.flatten().filter_map(Value::as_table).flatten();
    let lacks_version = |name: &str, given: &Value| {
        let inherits = given.get("workspace").is_some();
        let source = if inherits { shared.get(name) } else { Some(given) };
        source.is_none_or(|s| s.is_table() && s.get("version").is_none())
    };
    dependencies
        .filter(|(name, given)| lacks_version(name, given))
        .map(|(name, _)| format!("{name} has no version"))
        .collect()
}

/// Disagreements with the workspace about the versions of wgpu, its dependencies `wgpu_NN`: each is a feature
/// `wgpu-NN`, the newest is the default, and docs.rs does not build them together.
fn wgpu_versions(manifest: &Table, workspace: &Table) -> Vec<String> {
    let shared = workspace["workspace"]["dependencies"].as_table().unwrap();
    let versions: BTreeSet<String> =
        shared.keys().filter_map(|name| name.strip_prefix("wgpu_")).map(|version| format!("wgpu-{version}")).collect();
    let newest = versions.last().expect("the workspace depends on wgpu");
    let features = manifest.get("features").and_then(Value::as_table);
    let has = |name: &String| features.is_some_and(|f| f.contains_key(name));
    let lacks = versions.iter().filter(|v| !has(v)).map(|v| format!("no feature {v}"));
    let default = features.and_then(|f| f.get("default")).and_then(Value::as_array);
    let is_newest = default.is_some_and(|d| d.iter().filter_map(Value::as_str).eq([newest.as_str()]));
    let old = (!is_newest).then(|| format!("the default is not {newest}"));
    let page = manifest["package"].get("metadata").and_then(|m| m.get("docs")).and_then(|d| d.get("rs"));
    let together = page.is_some_and(|p| p.get("all-features").is_some_and(|all| all.as_bool() != Some(false)));
    lacks.chain(old).chain(together.then(|| "docs.rs builds all features together".to_owned())).collect()
}

#[test]
fn packages_for_engines_have_the_same_versions_of_wgpu() {
    let workspace: Table = read("Cargo.toml").parse().unwrap();
    let mut violations = vec![];
    for package in FOR_ENGINES {
        let path = format!("{package}Cargo.toml");
        let found = wgpu_versions(&read(&path).parse().unwrap(), &workspace);
        violations.extend(found.iter().map(|v| format!("{path}: {v}")));
    }
    expect_none("versions of wgpu", &violations);
}

#[test]
fn another_version_of_wgpu_is_found() {
    let table = |text: &str| -> Table { text.parse().unwrap() };
    let workspace = table("[workspace.dependencies]\nglam = '1'\nwgpu_8 = '8'\nwgpu_9 = '9'");
    let sound = "[package]\n[features]\ndefault = ['wgpu-9']\nwgpu-8 = []\nwgpu-9 = []";
    assert_eq!(wgpu_versions(&table(sound), &workspace), Vec::<String>::new());
    let planted = "[package.metadata.docs.rs]\nall-features = true\n[features]\ndefault = ['wgpu-8']\nwgpu-8 = []";
    let expected = ["no feature wgpu-9", "the default is not wgpu-9", "docs.rs builds all features together"];
    assert_eq!(wgpu_versions(&table(planted), &workspace), expected);
    assert_eq!(wgpu_versions(&table("[package]"), &workspace).len(), 3);
}

#[test]
fn published_packages_are_complete() {
    let tree = Tree::read();
    let workspace: Table = read("Cargo.toml").parse().unwrap();
    let mut violations = vec![];
    for package in PUBLISHED {
        let path = format!("{package}Cargo.toml");
        let manifest: Table = read(&path).parse().unwrap();
        let entries = tree.entries.iter().filter_map(|e| e.strip_prefix(package)).collect();
        let folder = format!("{package}src/");
        let sources: Vec<_> = tree.files(&folder, &[".rs"]).map(|f| (&f[package.len()..], read(f))).collect();
        let found = [
            wrong_includes(&manifest, &entries),
            left_out(&manifest, &sources),
            absolute_paths(&manifest),
            without_version(&manifest, &workspace),
        ];
        violations.extend(found.concat().iter().map(|v| format!("{path}: {v}")));
    }
    expect_none("manifests", &violations);
}

#[test]
fn an_incomplete_package_is_found() {
    let table = |text: &str| -> Table { text.parse().unwrap() };
    let entries: BTreeSet<&str> =
        ["src/", "src/lib.rs", "shaders/", "shaders/a.wgsl", "README.md", "LICENSE-MIT"].into_iter().collect();
    let sound = table("[package]\ninclude = ['/src', '/shaders', '/README.md', '/LICENSE-*']");
    assert_eq!(wrong_includes(&sound, &entries), Vec::<String>::new());
    let planted = table("[package]\ninclude = ['/src', '/shaders', '/LICENSE-*', 'examples', '/docs', '/NOTICE*']");
    let expected = [
        "`include` lacks /README.md",
        "`include`: examples names nothing",
        "`include`: /docs names nothing",
        "`include`: /NOTICE* names nothing",
    ];
    assert_eq!(wrong_includes(&planted, &entries), expected);

    let files = |name: &str| [("src/a/b.rs", format!("const A: &str = include_str!(\"{name}\");"))];
    assert_eq!(left_out(&sound, &files("../../shaders/a.wgsl")), Vec::<String>::new());
    assert_eq!(left_out(&sound, &files("b.html")), Vec::<String>::new());
    for name in ["../../fixtures/a.png", "../../../other/src/a.rs", "../../../../a.rs"] {
        assert_eq!(left_out(&sound, &files(name)), [format!("src/a/b.rs: {name} is not in the package")]);
    }

    let paths = table("[package]\ninclude = ['/src']\n[dependencies]\na = { path = '/home/a' }\nb = { path = '../b' }");
    assert_eq!(absolute_paths(&paths), ["absolute path: path = /home/a"]);

    let workspace = table("[workspace.dependencies]\na = { path = 'a' }\nb = { path = 'b', version = '1' }\nc = '1'");
    let manifest = table(
        "[dependencies]\na.workspace = true\nb.workspace = true\nc = { workspace = true }\nd = { path = '../d' }\n\
         [dev-dependencies]\na.workspace = true\n[target.'cfg(unix)'.dependencies]\ne.workspace = true\nf = '1'",
    );
    let mut found = without_version(&manifest, &workspace);
    found.sort();
    assert_eq!(found, ["a has no version", "d has no version", "e has no version"]);
}

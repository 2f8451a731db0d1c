//! Planned frames and frames with levels of detail are apart: neither uses what is the other's, in Rust or in WGSL, and
//! what both share uses neither's shaders.

use super::modules::graph_of;
use super::tree::{Tree, expect_none, read};

/// Folders of planned frames and of frames with levels of detail.
const APART: [[&str; 2]; 3] = [
    ["shaders/planned/", "shaders/levels/"],
    ["src/cpu/planned/", "src/cpu/levels/"],
    ["src/gpu/planned/", "src/gpu/levels/"],
];

/// What shaders share.
const SHARED: [&str; 2] = ["shaders/shared/", "shaders/lib/"];

/// Modules that a shader names.
fn named(text: &str) -> impl Iterator<Item = &str> {
    text.lines().filter_map(|line| line.strip_prefix("//#use ")).map(str::trim)
}

/// Pairs of a user and what it uses, that leave a room for another.
fn leaving(uses: &[(String, String)]) -> Vec<String> {
    let leaves = |user: &str, used: &str| {
        let is_apart = |[a, b]: &[&str; 2]| {
            (user.starts_with(a) && used.starts_with(b)) || (user.starts_with(b) && used.starts_with(a))
        };
        let is_shared = |path: &str| SHARED.iter().any(|shared| path.starts_with(shared));
        APART.iter().any(is_apart) || (is_shared(user) && !is_shared(used))
    };
    let found = uses.iter().filter(|(user, used)| leaves(user, used));
    found.map(|(user, used)| format!("{user} uses {used}")).collect()
}

fn uses_of_shaders() -> Vec<(String, String)> {
    let tree = Tree::read();
    let files: Vec<&str> = tree.files("shaders/", &[".wgsl"]).collect();
    let of_name = |name: &str| {
        let file = files.iter().find(|file| file.ends_with(&format!("/{name}.wgsl")));
        (*file.unwrap_or_else(|| panic!("no shader module {name}"))).to_owned()
    };
    let uses = |file: &str| named(&read(file)).map(|name| (file.to_owned(), of_name(name))).collect::<Vec<_>>();
    files.iter().flat_map(|file| uses(file)).collect()
}

#[test]
fn planned_frames_and_levels_use_nothing_of_each_other() {
    let shaders = uses_of_shaders();
    let files = graph_of("src/").into_iter().flat_map(|(user, used)| used.into_iter().map(move |u| (user.clone(), u)));
    let files = files.map(|(user, used)| (format!("src/{user}"), format!("src/{used}")));
    let uses: Vec<_> = shaders.into_iter().chain(files).collect();
    assert!(uses.len() > 400, "{} uses", uses.len());
    expect_none("uses of another room", &leaving(&uses));
}

#[test]
fn a_use_of_another_room_is_found() {
    let text = "//#use inputs\n//#instead a b\n// Text.\n";
    assert_eq!(named(text).collect::<Vec<_>>(), ["inputs"]);
    let sound = [("src/cpu/planned/a.rs", "src/cpu/quads.rs"), ("shaders/levels/a.wgsl", "shaders/shared/b.wgsl")];
    let planted = [
        ("src/cpu/planned/a.rs", "src/cpu/levels/b.rs"),
        ("src/gpu/levels/a.rs", "src/gpu/planned/b.rs"),
        ("shaders/levels/a.wgsl", "shaders/planned/b.wgsl"),
        ("shaders/shared/a.wgsl", "shaders/levels/b.wgsl"),
        ("shaders/lib/a.wgsl", "shaders/planned/b.wgsl"),
    ];
    let owned = |pairs: &[(&str, &str)]| pairs.iter().map(|&(a, b)| (a.to_owned(), b.to_owned())).collect::<Vec<_>>();
    assert_eq!(leaving(&owned(&sound)), Vec::<String>::new());
    assert_eq!(leaving(&owned(&planted)).len(), planted.len());
}

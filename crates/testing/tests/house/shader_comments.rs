//! A comment stands above each function of the library of shaders, so that it reads without its twin in Rust.

use super::tree::{Tree, expect_none, read};

/// Functions without a comment in the line above.
fn uncommented(path: &str, source: &str) -> Vec<String> {
    let mut above = "";
    let mut found = vec![];
    for (line, text) in (1..).zip(source.lines()) {
        if let Some((name, _)) = text.strip_prefix("fn ").and_then(|rest| rest.split_once('('))
            && !above.starts_with("// ")
        {
            found.push(format!("{path}:{line}: {name}"));
        }
        above = text;
    }
    found
}

#[test]
fn a_comment_stands_above_each_function_of_the_library() {
    let tree = Tree::read();
    let violations: Vec<_> = tree.files("shaders/lib/", &[".wgsl"]).flat_map(|f| uncommented(f, &read(f))).collect();
    expect_none("functions without a comment", &violations);
}

#[test]
fn a_function_without_a_comment_is_found() {
    let source = "//#use a\nfn first(x: f32) {\n    fn_of(x);\n}\n\n// Twice.\nfn second() {}\nfn third() {}\n";
    assert_eq!(uncommented("a.wgsl", source), ["a.wgsl:2: first", "a.wgsl:8: third"]);
}

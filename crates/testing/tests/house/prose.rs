//! Width of prose.

use super::tree::{Tree, expect_none, read};

/// Widest line of prose, in characters; rustfmt.toml has the same width for code.
const WIDTH: usize = 120;

/// Lines of prose that are too wide. Tables, code and links are not prose.
fn wide_lines(path: &str, text: &str) -> Vec<String> {
    let is_page = path.ends_with(".md");
    let mut is_code = false;
    let mut wide = vec![];
    for (index, line) in text.lines().enumerate() {
        let comment = line.trim_start();
        let Some(content) = (if is_page { Some(line) } else { comment.strip_prefix("//") }) else {
            is_code = false;
            continue;
        };
        let content = if is_page { content } else { content.trim_start_matches(['/', '!']) };
        let start = content.trim_start();
        if start.starts_with("```") {
            is_code = !is_code;
        }
        let is_usage = start.starts_with('`') && start.ends_with('`') && start.matches('`').count() == 2;
        let is_prose =
            !is_code && !is_usage && !content.starts_with("    ") && !start.starts_with(['|', '#', '!', '<']);
        let width = line.chars().count();
        if is_prose && width > WIDTH && !line.contains("://") {
            wide.push(format!("{path}:{}: {width} characters", index + 1));
        }
    }
    wide
}

#[test]
fn prose_is_at_most_120_characters_wide() {
    let tree = Tree::read();
    // docs/stability.md is printed by a test.
    let files = tree.files("", &[".md", ".rs", ".wgsl"]).filter(|f| *f != "docs/stability.md");
    let violations: Vec<_> = files.flat_map(|f| wide_lines(f, &read(f))).collect();
    expect_none("lines of prose wider than 120 characters", &violations);
}

#[test]
fn a_wide_line_of_prose_is_found() {
    let (fits, wide) = ("x".repeat(117), "x".repeat(118));
    let source = format!("// {fits}\n    let a = \"{wide}\";\n    // {wide}\n/// {fits}\n");
    assert_eq!(wide_lines("a.rs", &source), ["a.rs:3: 125 characters", "a.rs:4: 121 characters"]);
    let page = format!("{wide}xxx\n| {wide} |\n\n    {wide}\n```\n{wide}xxx\n```\n{wide}xxx\n");
    assert_eq!(wide_lines("a.md", &page), ["a.md:1: 121 characters", "a.md:8: 121 characters"]);
}

//! Tables of pages are tables: a header, a separator and rows of as many cells.

use super::tree::{Tree, expect_none, read};

/// Cells of a line of a table; `None` unless it ends with a bar. A bar after a backslash is text, in code, too.
fn cells(line: &str) -> Option<Vec<&str>> {
    let inner = line.trim().strip_prefix('|')?.strip_suffix('|').filter(|inner| !inner.ends_with('\\'))?;
    let mut cells = vec![];
    let mut from = 0;
    for (at, _) in inner.match_indices('|').filter(|(at, _)| !inner[..*at].ends_with('\\')) {
        cells.push(inner[from..at].trim());
        from = at + 1;
    }
    cells.push(inner[from..].trim());
    Some(cells)
}

fn is_separator(line: &str) -> bool {
    let is_rule = |cell: &&str| cell.len() >= 3 && cell.trim_matches(':').chars().all(|c| c == '-');
    cells(line).is_some_and(|cells| cells.iter().all(is_rule))
}

/// Lines of a page that begin like those of a table but do not render as one. Code, in fences or indented, is not read.
fn broken_tables(path: &str, page: &str) -> Vec<String> {
    let mut broken = vec![];
    let (mut is_code, mut columns, mut lines) = (false, None, page.lines().enumerate().peekable());
    while let Some((index, line)) = lines.next() {
        let start = line.trim_start();
        is_code ^= start.starts_with("```");
        let mut report = |what: &str| broken.push(format!("{path}:{}: {what}", index + 1));
        let is_code_here = is_code || line.starts_with("    ");
        if is_code_here || !start.starts_with('|') {
            columns = None;
            // The table of hard cases has no bars around its lines.
            if !is_code_here && start.contains("|---") && start.contains(|c| !"|-: ".contains(c)) {
                report("a separator within text");
            }
            continue;
        }
        let Some(found) = cells(line).map(|cells| cells.len()) else {
            report("the row does not end with a bar");
            continue;
        };
        match columns {
            None if !lines.peek().is_some_and(|(_, next)| is_separator(next)) => {
                report("no separator below the header")
            }
            None => {}
            Some(expected) if expected != found => report(&format!("{found} cells in a table of {expected} columns")),
            Some(_) => {}
        }
        columns = columns.or(Some(found));
    }
    broken
}

#[test]
fn tables_of_pages_are_tables() {
    let tree = Tree::read();
    let pages: Vec<_> = tree.files("", &[".md"]).map(|f| (f, read(f))).collect();
    let tables = pages.iter().flat_map(|(_, page)| page.lines()).filter(|line| is_separator(line)).count();
    println!("{tables} tables in {} pages", pages.len());
    assert!(tables > 50);
    let violations: Vec<_> = pages.iter().flat_map(|(path, page)| broken_tables(path, page)).collect();
    expect_none("tables that do not render", &violations);
}

#[test]
fn a_broken_table_is_found() {
    let table = "text\n\n   | a | b |\n   |---|:-:|\n   | `x \\| y` | |\n\n```\n| code |\n```\n";
    assert_eq!(broken_tables("a.md", table), [""; 0]);
    // Planted: a table that was wrapped like prose, and rows with a cell too few or too many.
    let wrapped = table.replace("|\n   |", "| |");
    assert_eq!(broken_tables("a.md", &wrapped), ["a.md:3: no separator below the header"]);
    let prose = format!("see {}", wrapped.lines().nth(2).unwrap().trim());
    assert_eq!(broken_tables("a.md", &prose), ["a.md:1: a separator within text"]);
    let planted = [
        ("| a | b |", "| a |", "a.md:5: 2 cells in a table of 1 columns"),
        ("`x \\| y`", "`x | y`", "a.md:5: 3 cells in a table of 2 columns"),
        ("| |\n", "|\n", "a.md:5: 1 cells in a table of 2 columns"),
        ("| |\n", "| b\n", "a.md:5: the row does not end with a bar"),
    ];
    for (right, wrong, found) in planted {
        assert!(broken_tables("a.md", &table.replacen(right, wrong, 1)).contains(&found.to_owned()), "{wrong}");
    }
}

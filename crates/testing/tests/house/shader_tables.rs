//! Tables of the pages about shaders are generated from the shaders.
//!
//! A line `<!-- generated: functions of FOLDER -->` or `<!-- generated: bindings of FOLDER -->` stands above each;
//! FOLDER is relative to the page. `AFTERIMAGE_BLESS=1 cargo test -p afterimage-testing --test house` rewrites the
//! tables.

use super::tree::{Tree, expect_none, read};
use std::collections::BTreeSet;

const PAGES: [&str; 3] = ["shaders/README.md", "crates/lab/shaders/README.md", "crates/trace/shaders/README.md"];
const MARKER: &str = "<!-- generated: ";

/// A WGSL file.
struct Shader {
    name: String,
    text: String,
}

impl Shader {
    /// First paragraph of the comment at the top.
    fn header(&self) -> String {
        let lines = self.text.lines().skip_while(|l| l.starts_with("//#"));
        let comment: Vec<&str> = lines.map_while(|l| l.strip_prefix("//")).map(str::trim).collect();
        comment.split(|l| l.is_empty()).next().unwrap_or(&[]).join(" ")
    }

    /// First sentence of the comment at the top, to its first colon or semicolon unless that follows one or two words.
    fn purpose(&self) -> String {
        let header = self.header();
        let sentence = header.split(". ").next().unwrap_or_default();
        let clause = sentence.split([':', ';']).next().unwrap_or_default();
        let purpose = if clause.split(' ').count() > 2 { clause } else { sentence };
        purpose.trim_end_matches(['.', ':']).replace('|', "\\|")
    }

    /// What the comment at the top names as the twin, if anything.
    fn twin(&self) -> String {
        let header = self.header();
        let phrases = ["CPU twin: ", "Twin on the CPU: ", "Twin of "];
        let rest = phrases.iter().find_map(|p| header.split_once(p)).map_or("", |(_, rest)| rest);
        let twin = rest.split(' ').next().unwrap_or_default().trim_matches(['.', ',', ';', ':', '`']);
        if twin.is_empty() { String::new() } else { format!("`{twin}`") }
    }

    /// Names of functions without the attributes of an entry point, in order.
    fn functions(&self) -> Vec<&str> {
        let mut before = "";
        let mut names = vec![];
        for line in self.text.lines() {
            let (attributes, function) = line.split_once("fn ").unwrap_or((line, ""));
            let starts = attributes.is_empty() || attributes.starts_with('@');
            if starts && line.contains("fn ") {
                let is_entry = [before, attributes]
                    .iter()
                    .any(|a| ["@compute", "@vertex", "@fragment"].iter().any(|e| a.starts_with(e)));
                if !is_entry {
                    names.push(function.split('(').next().expect("split has an item"));
                }
            }
            before = line;
        }
        names
    }

    /// `group.binding:name` of each binding.
    fn bindings(&self) -> Vec<String> {
        let binding = |line: &str| {
            let (group, rest) = line.strip_prefix("@group(")?.split_once(") @binding(")?;
            let (binding, rest) = rest.split_once(") var")?;
            // After `<storage, read>`, if that is there.
            let name = rest.split_once("> ").map_or(rest, |(_, name)| name).trim().split(':').next()?;
            Some(format!("`{group}.{binding}:{name}`"))
        };
        self.text.lines().filter_map(binding).collect()
    }
}

fn quoted(names: &[&str]) -> String {
    names.iter().map(|n| format!("`{n}`")).collect::<Vec<_>>().join(", ")
}

/// A table of modules, with a line feed after each row.
fn table(kind: &str, shaders: &[Shader]) -> String {
    let (head, row): (&str, fn(&Shader) -> Vec<String>) = match kind {
        "functions" => ("module|functions", |s| vec![format!("`{}`", s.name), quoted(&s.functions())]),
        "bindings" => ("file|purpose|twin|bindings", |s| {
            vec![format!("`{}`", s.name), s.purpose(), s.twin(), s.bindings().join(", ")]
        }),
        _ => panic!("a table of {kind} is not known"),
    };
    let head: Vec<String> = head.split('|').map(str::to_owned).collect();
    let rule = vec!["---".to_owned(); head.len()];
    let line =
        |cells: Vec<String>| format!("| {} |\n", cells.join(" | ")).replace("|  |", "| |").replace("|  |", "| |");
    [head, rule].into_iter().chain(shaders.iter().map(row)).map(line).collect()
}

/// The page with its tables generated anew. `shaders`: those of a folder.
fn regenerated(page: &str, shaders: impl Fn(&str) -> Vec<Shader>) -> String {
    let mut output = String::new();
    let mut is_replaced = false;
    for line in page.lines() {
        is_replaced = is_replaced && line.starts_with('|');
        if is_replaced {
            continue;
        }
        output += line;
        output.push('\n');
        if let Some((kind, folder)) = marked(line) {
            output += &table(kind, &shaders(folder));
            is_replaced = true;
        }
    }
    output
}

/// Kind and folder of the table that follows the line.
fn marked(line: &str) -> Option<(&str, &str)> {
    line.strip_prefix(MARKER)?.strip_suffix(" -->")?.split_once(" of ")
}

/// The folder of a page's shaders, relative to the workspace.
fn full_folder(page: &str, folder: &str) -> String {
    let base = page.strip_suffix("README.md").expect("pages are named README.md");
    if folder == "." { base.to_owned() } else { format!("{base}{folder}/") }
}

#[test]
fn tables_of_shaders_are_those_of_the_sources() {
    let tree = Tree::read();
    let mut violations = vec![];
    for path in PAGES {
        let page = read(path);
        let shaders = |folder: &str| -> Vec<Shader> {
            let folder = full_folder(path, folder);
            let files = tree.files(&folder, &[".wgsl"]).filter(|f| !f[folder.len()..].contains('/'));
            let shader =
                |f: &str| Shader { name: f[folder.len()..].trim_end_matches(".wgsl").to_owned(), text: read(f) };
            files.map(shader).collect()
        };
        let generated = regenerated(&page, shaders);
        if std::env::var_os("AFTERIMAGE_BLESS").is_some() {
            std::fs::write(afterimage_testing::workspace().join(path), &generated).unwrap();
        } else if generated != page {
            let line = generated.lines().zip(page.lines()).position(|(a, b)| a != b).unwrap_or_default() + 1;
            violations.push(format!("{path}:{line} is not what the sources say; AFTERIMAGE_BLESS=1 rewrites it"));
        }
        // A folder without a table.
        let listed: BTreeSet<String> =
            page.lines().filter_map(marked).map(|(_, folder)| full_folder(path, folder)).collect();
        let all = full_folder(path, ".");
        let folders: BTreeSet<&str> =
            tree.files(&all, &[".wgsl"]).map(|f| &f[..f.rfind('/').expect("a shader is in a folder") + 1]).collect();
        violations.extend(folders.iter().filter(|f| !listed.contains(**f)).map(|f| format!("{path}: no table of {f}")));
    }
    expect_none("tables of shaders", &violations);
}

#[test]
fn a_table_follows_its_sources() {
    let text = "//#use a\n//#instead b c\n// Blends two levels: linearly. CPU twin:\n// `src/mix.rs`, which counts.\n\noverride AXIS: u32 = 0u;\n\
        @group(0) @binding(1) var full: texture_2d<f32>;\n@group(2) @binding(0) var<storage, read> plan: array<u32>;\n\
        // a fn of c\nfn first(x: f32) {\n}\n@compute @workgroup_size(64)\nfn main() {\n}\n\
        @fragment fn shade() {\n}\nfn second() {}\n";
    let shaders = |text: &str| vec![Shader { name: "mix".to_owned(), text: text.to_owned() }];
    let page = "# Page\n\n<!-- generated: functions of lib -->\n| old |\n\n<!-- generated: bindings of pass -->\n| old |\ntext\n";
    let expected = "# Page\n\n<!-- generated: functions of lib -->\n\
        | module | functions |\n| --- | --- |\n| `mix` | `first`, `second` |\n\n\
        <!-- generated: bindings of pass -->\n| file | purpose | twin | bindings |\n\
        | --- | --- | --- | --- |\n\
        | `mix` | Blends two levels | `src/mix.rs` | `0.1:full`, `2.0:plan` |\ntext\n";
    let generated = regenerated(page, |_| shaders(text));
    assert_eq!(generated, expected);
    assert_eq!(regenerated(&generated, |_| shaders(text)), generated);
    assert_eq!(shaders("// Filter: linear; slow. Fast.\n")[0].purpose(), "Filter: linear; slow");
    // Planted: a function or a binding that the page does not name.
    for added in ["fn third() {\n}\n", "@group(0) @binding(9) var more: texture_2d<f32>;\n"] {
        assert_ne!(regenerated(&generated, |_| shaders(&format!("{text}{added}"))), generated, "{added}");
    }
}

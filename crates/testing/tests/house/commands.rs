//! Cargo commands in comments, documents and scripts name packages, targets and features that exist.

use super::tree::{APART, PACKAGES, Tree, expect_none, read};
use super::words::pieces;
use std::collections::BTreeSet;

/// Pages that name commands of the past.
const HISTORY: &str = "CHANGELOG.md";

/// Names that may follow each option.
struct Names {
    packages: BTreeSet<String>,
    tests: BTreeSet<String>,
    examples: BTreeSet<String>,
    features: BTreeSet<String>,
}

impl Names {
    fn read(tree: &Tree) -> Self {
        let mut names = Self { packages: [].into(), tests: [].into(), examples: [].into(), features: [].into() };
        for package in PACKAGES.iter().chain(&APART) {
            let manifest: toml::Table = read(&format!("{package}Cargo.toml")).parse().unwrap();
            names.packages.insert(manifest["package"]["name"].as_str().unwrap().to_owned());
            let features = manifest.get("features").and_then(toml::Value::as_table).into_iter();
            names.features.extend(features.flat_map(|f| f.keys().cloned()));
            let targets = |folder: &str| -> Vec<String> {
                let folder = format!("{package}{folder}/");
                let files = tree.files(&folder, &[".rs"]).filter_map(|f| f[folder.len()..].strip_suffix(".rs"));
                let stems = files.map(|f| f.strip_suffix("/main").unwrap_or(f));
                stems.filter(|s| !s.contains('/')).map(str::to_owned).collect()
            };
            names.tests.extend(targets("tests"));
            names.examples.extend(targets("examples"));
        }
        names
    }

    /// Values of options in the cargo commands of a text that name nothing.
    fn unknown(&self, text: &str) -> Vec<String> {
        let mut unknown = vec![];
        for command in text.split("cargo ").skip(1) {
            // A command ends with its line, with a quotation mark, or where the options of the program begin.
            let command = command.split(['\n', '`', '"', '#', ';', ')']).next().unwrap_or_default();
            let command = command.split(" -- ").next().unwrap_or_default();
            let words: Vec<&str> = command.split_whitespace().collect();
            for pair in words.windows(2) {
                let known = match pair[0] {
                    "-p" | "--package" => &self.packages,
                    "--test" => &self.tests,
                    "--example" => &self.examples,
                    "--features" => &self.features,
                    _ => continue,
                };
                let is_variable = pair[1].starts_with('$') || pair[1].chars().all(|c| c.is_ascii_uppercase());
                let missing = pair[1].trim_end_matches([',', '.']).split(',').filter(|v| !known.contains(*v));
                unknown.extend(missing.filter(|_| !is_variable).map(|v| format!("{} {v}", pair[0])));
            }
        }
        unknown
    }
}

#[test]
fn commands_name_what_exists() {
    let tree = Tree::read();
    let names = Names::read(&tree);
    let mut violations = vec![];
    let own = "crates/testing/tests/house/commands.rs";
    for file in tree.files("", &[".rs", ".md", ".toml", ".sh"]).filter(|f| ![HISTORY, own].contains(f)) {
        let text = read(file);
        let texts = if file.ends_with(".rs") { pieces(&text).iter().map(|p| p.text).collect() } else { vec![&*text] };
        violations.extend(texts.iter().flat_map(|t| names.unknown(t)).map(|v| format!("{file}: {v}")));
    }
    expect_none("names in cargo commands", &violations);
}

#[test]
fn a_command_that_names_nothing_is_found() {
    let names = Names::read(&Tree::read());
    let sound = "`cargo test -p afterimage-lab --test sources -- --test x`, `cargo run --features gpu,cpu --example 07_levels`\n\
        cargo test --test house -- --test-threads 2\n--test lonely\ncargo run --example \"$example\"";
    assert_eq!(names.unknown(sound), Vec::<String>::new());
    let planted =
        "cargo test -p afterimage-laboratory --features lab,cpu --test real_data\n    cargo run --example 99_none";
    let expected = ["-p afterimage-laboratory", "--features lab", "--test real_data", "--example 99_none"];
    assert_eq!(names.unknown(planted), expected);
}

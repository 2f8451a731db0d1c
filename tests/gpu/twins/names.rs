//! Twins have the same functions; literals mean the same.

use super::library::{FOLDER, RUST_ONLY, WGSL_ONLY, probes};
use super::modules::calls;
use std::collections::BTreeSet;
use std::path::Path;

pub fn read(path: &str) -> String {
    std::fs::read_to_string(Path::new(FOLDER).join(path)).unwrap()
}

/// Names after `fn ` at the start of a line, `pub` or not.
fn functions(text: &str) -> BTreeSet<String> {
    text.lines()
        .filter_map(|l| l.strip_prefix("pub ").unwrap_or(l).strip_prefix("fn "))
        .map(|l| l.split(['(', '<']).next().unwrap().to_owned())
        .collect()
}

fn stems() -> Vec<String> {
    let folder = Path::new(FOLDER).join("shaders/lib");
    let mut stems: Vec<_> = std::fs::read_dir(folder)
        .unwrap()
        .map(|e| e.unwrap().path().file_stem().unwrap().to_str().unwrap().to_owned())
        .collect();
    stems.sort();
    stems
}

#[test]
fn twins_have_the_same_functions_and_every_one_is_probed_or_called_by_one_that_is() {
    let mut left = vec![];
    for stem in stems() {
        let text = read(&format!("shaders/lib/{stem}.wgsl"));
        let rust = functions(&read(&format!("src/kernel/{stem}.rs")));
        let only = |list: &[(&str, &str)]| -> BTreeSet<String> {
            list.iter().filter(|(s, _)| *s == stem).map(|(_, name)| (*name).to_owned()).collect()
        };
        let rust_only = only(RUST_ONLY);
        assert!(rust_only.is_subset(&rust), "{stem}: {rust_only:?}");
        let mut expected: BTreeSet<String> = rust.union(&only(WGSL_ONLY)).cloned().collect();
        expected.retain(|name| name != "mix" && !rust_only.contains(name));
        assert_eq!(functions(&text), expected, "{stem}");
        let bodies = text.split("\nfn ").skip(1).map(|body| body.split_once('(').unwrap());
        left.extend(bodies.map(|(name, body)| (name.to_owned(), body.to_owned())));
    }
    let mut texts: Vec<String> = probes().map(|probe| (probe.wgsl)()).collect();
    while let Some(text) = texts.pop() {
        let (called, others): (Vec<_>, Vec<_>) = left.into_iter().partition(|(name, _)| calls(&text, name));
        texts.extend(called.into_iter().map(|(_, body)| body));
        left = others;
    }
    assert!(left.is_empty(), "neither probed nor called: {:?}", left.iter().map(|(name, _)| name).collect::<Vec<_>>());
}

/// naga reads a literal without suffix as f64 and rounds it again; Rust reads f32 at once.
#[test]
fn literals_mean_the_same_bits_in_both_languages() {
    let mut count = 0;
    for stem in stems() {
        for line in read(&format!("shaders/lib/{stem}.wgsl")).lines() {
            let code = line.split("//").next().unwrap();
            let mut rest = code;
            while let Some(start) = rest.find(|c: char| c.is_ascii_digit()) {
                let named = start > 0 && rest[..start].ends_with(|c: char| c.is_ascii_alphanumeric() || c == '_');
                let body = &rest[start..];
                let mut end = body.find(|c: char| !(c.is_ascii_alphanumeric() || c == '.')).unwrap_or(body.len());
                if body[..end].ends_with('e') {
                    end += 1 + body[end + 1..].find(|c: char| !c.is_ascii_digit()).unwrap_or(body.len() - end - 1);
                }
                let token = body[..end].trim_end_matches('f');
                if !named && token.contains('.') && !token.starts_with("0x") {
                    let twice = token.parse::<f64>().unwrap() as f32;
                    let once = token.parse::<f32>().unwrap();
                    assert_eq!(twice.to_bits(), once.to_bits(), "{stem}: {token}");
                    count += 1;
                }
                rest = &body[end..];
            }
        }
    }
    println!("{count} literals");
    assert!(count > 80);
}

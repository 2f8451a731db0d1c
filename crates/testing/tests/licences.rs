//! Licences of all dependencies: only those that deny.toml accepts.

use serde_json::Value;
use spdx::{Expression, LicenseReq, ParseMode};
use std::process::Command;

struct Accepted {
    all: Vec<String>,
    /// Additional licences by crate.
    exceptions: Vec<(String, Vec<String>)>,
}

impl Accepted {
    fn read() -> Self {
        let text = std::fs::read_to_string(afterimage_testing::workspace().join("deny.toml")).unwrap();
        let file: toml::Table = text.parse().unwrap();
        let list = |value: &toml::Value| -> Vec<String> {
            value.as_array().unwrap().iter().map(|v| v.as_str().unwrap().to_owned()).collect()
        };
        let licenses = &file["licenses"];
        let exceptions = licenses["exceptions"].as_array().unwrap().iter();
        Self {
            all: list(&licenses["allow"]),
            exceptions: exceptions.map(|e| (e["crate"].as_str().unwrap().to_owned(), list(&e["allow"]))).collect(),
        }
    }

    fn admits(&self, name: &str, license: &str) -> bool {
        let own = self.exceptions.iter().filter(|(of, _)| of == name).flat_map(|(_, also)| also);
        let accepted: Vec<&String> = self.all.iter().chain(own).collect();
        // Old crates separate alternatives with a slash.
        let expression = Expression::parse_mode(license, ParseMode::LAX);
        let is_accepted = |required: &LicenseReq| {
            required.addition.is_none() && accepted.iter().any(|a| required.license.to_string() == **a)
        };
        expression.is_ok_and(|e| e.evaluate(is_accepted))
    }
}

#[test]
fn every_dependency_has_a_licence_that_we_accept() {
    let metadata = Command::new(env!("CARGO"))
        .args(["metadata", "--format-version", "1", "--locked", "--all-features"])
        .current_dir(afterimage_testing::workspace())
        .output()
        .unwrap();
    assert!(metadata.status.success(), "{}", String::from_utf8_lossy(&metadata.stderr));
    let metadata: Value = serde_json::from_slice(&metadata.stdout).unwrap();
    let accepted = Accepted::read();
    let packages = metadata["packages"].as_array().unwrap();
    let text = |p: &Value, key: &str| p[key].as_str().unwrap_or("none").to_owned();
    let refused: Vec<_> = packages
        .iter()
        .map(|p| (text(p, "name"), text(p, "license")))
        .filter(|(name, license)| !accepted.admits(name, license))
        .collect();
    println!("{} packages", packages.len());
    assert!(packages.len() > 100 && refused.is_empty(), "{refused:?}");
}

#[test]
fn other_licences_are_refused() {
    let accepted = Accepted::read();
    for license in ["MIT", "Apache-2.0/MIT", "MIT OR GPL-3.0", "Zlib AND (MIT OR Apache-2.0)"] {
        assert!(accepted.admits("any", license), "{license}");
    }
    for license in ["GPL-3.0", "MIT AND GPL-3.0", "CC-BY-NC-4.0", "none", "", "MIT AND OFL-1.1"] {
        assert!(!accepted.admits("any", license), "{license}");
    }
    assert!(accepted.admits("epaint_default_fonts", "MIT AND OFL-1.1"));
}

//! Property tests have fixed seeds: the same cases on every machine.

use super::tree::{Tree, expect_none, read};

/// Lines of property tests whose configuration is not [`afterimage_testing::property`].
fn without_a_fixed_seed(path: &str, text: &str) -> Vec<String> {
    let lines: Vec<&str> = text.lines().map(str::trim).collect();
    let opens = |line: &str| line.starts_with("proptest!") && line.ends_with('{');
    let is_fixed = |line: &str| line.starts_with("#![proptest_config(afterimage_testing::property(");
    let next = |index: usize| lines.get(index + 1).copied().unwrap_or_default();
    let violating = (0..lines.len()).filter(|&index| opens(lines[index]) && !is_fixed(next(index)));
    violating.map(|index| format!("{path}:{}: {}", index + 1, next(index))).collect()
}

#[test]
fn property_tests_have_fixed_seeds() {
    let tree = Tree::read();
    let mut violations = vec![];
    let mut checked = 0;
    for path in tree.files("", &[".rs"]).filter(|path| !path.ends_with("house/properties.rs")) {
        let text = read(path);
        checked += text.matches("proptest! {").count();
        violations.extend(without_a_fixed_seed(path, &text));
    }
    assert!(checked >= 15, "{checked} blocks of property tests");
    expect_none("property tests with fixed seeds", &violations);
}

#[test]
fn planted_random_seeds_are_found() {
    let fixed = "proptest! {\n    #![proptest_config(afterimage_testing::property(\"a\", 9))]\n}\n";
    assert_eq!(without_a_fixed_seed("a.rs", fixed), [""; 0]);
    let random =
        "proptest! {\n    #![proptest_config(ProptestConfig::with_cases(9))]\n}\nproptest! {\n    #[test]\n}\n";
    assert_eq!(without_a_fixed_seed("a.rs", random).len(), 2);
}

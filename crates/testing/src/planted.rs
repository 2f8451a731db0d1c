//! Planted errors: a text of a shader or two is replaced, and a comparison must see it.

/// Plants each of `errors` in the `right` sources: a text, and what stands there instead. `differs` compares what the
/// sources make with what is right; `None` is a machine without an adapter. Fails unless it sees every error, and
/// nothing without one.
#[track_caller]
pub fn all_caught<const N: usize>(
    right: &[String; N],
    errors: &[(&str, &str)],
    mut differs: impl FnMut(&[String; N]) -> Option<bool>,
) {
    match differs(right) {
        None => return,
        Some(differs) => assert!(!differs, "without an error"),
    }
    for (text, instead) in errors {
        let wrong = planted(right, text, instead);
        let caught = differs(&wrong) == Some(true);
        println!("'{text}' -> '{instead}': {}", if caught { "caught" } else { "not caught" });
        assert!(caught, "planted error not caught: '{text}' -> '{instead}'");
    }
}

/// As [`all_caught`], in one source in which each text stands once.
#[track_caller]
pub fn all_caught_once(right: String, errors: &[(&str, &str)], mut differs: impl FnMut(&str) -> Option<bool>) {
    errors.iter().for_each(|(text, _)| assert_eq!(right.matches(text).count(), 1, "'{text}' in the source"));
    all_caught(&[right], errors, |[source]| differs(source));
}

/// The sources with one error, wherever its text stands.
#[track_caller]
fn planted<const N: usize>(right: &[String; N], text: &str, instead: &str) -> [String; N] {
    assert!(right.iter().any(|source| source.contains(text)), "'{text}' is in no source");
    right.each_ref().map(|source| source.replace(text, instead))
}

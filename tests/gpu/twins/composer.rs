//! Errors in shaders name the file and line that they come from.

use super::library::SHADERS;
use super::modules::validate;
use super::names::read;

#[test]
fn errors_name_file_and_line() {
    let syntax = SHADERS.compose_with(&["wrs"], "fn good() {}\nfn bad( {}\n");
    let error = validate(&syntax).unwrap_err();
    assert!(error.starts_with("(the caller's text):2: "), "{error}");

    let types = SHADERS.compose_with(&["wrs"], "// A comment.\nfn bad() -> f32 {\n    return luma(1u);\n}\n");
    let error = validate(&types).unwrap_err();
    assert!(error.starts_with("(the caller's text):3: "), "{error}");

    // An error in a library file: its text with a part removed.
    let mut broken = SHADERS.compose_with(&["wrs"], "");
    broken.source = broken.source.replacen("return 0.2126 *", "return 0.2126 * *", 1);
    let error = validate(&broken).unwrap_err();
    let path = "shaders/lib/color.wgsl";
    let line = read(path).lines().position(|l| l.contains("0.2126")).unwrap() + 1;
    assert!(error.starts_with(&format!("{path}:{line}: ")), "{error}");
}

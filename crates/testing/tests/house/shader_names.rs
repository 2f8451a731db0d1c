//! No function, variable or parameter of a shader has the name of a function of WGSL, which it would hide.

use super::tree::{Tree, expect_none, read};
use super::words::{Kind, all_pieces};

/// Functions of WGSL that shaders may want to call.
const BUILTINS: &str = "all any select arrayLength abs acos acosh asin asinh atan atanh atan2 ceil clamp cos cosh \
    countLeadingZeros countOneBits countTrailingZeros cross degrees determinant distance dot exp exp2 extractBits \
    faceForward firstLeadingBit firstTrailingBit floor fma fract frexp insertBits inverseSqrt ldexp length log log2 max \
    min mix modf normalize pow quantizeToF16 radians reflect refract reverseBits round saturate sign sin sinh smoothstep \
    sqrt step tan tanh transpose trunc dpdx dpdy fwidth";

/// Declarations in a shader that hide a function of WGSL. Fields of structs hide nothing.
fn hiding(path: &str, source: &str) -> Vec<String> {
    let code: Vec<_> = all_pieces(source).into_iter().filter(|p| p.kind == Kind::Code).collect();
    let (mut found, mut parentheses) = (vec![], 0);
    for (at, piece) in code.iter().enumerate() {
        let before = |n: usize| at.checked_sub(n).map_or("", |i| code[i].text);
        let is_parameter = parentheses > 0 && code.get(at + 1).is_some_and(|next| next.text == ":");
        let is_declared = ["fn", "let", "var", "const", "override"].contains(&before(1))
            // After `var<private>` or `var<storage, read>`.
            || (before(1) == ">" && [before(4), before(6)].contains(&"var"));
        if (is_parameter || is_declared) && BUILTINS.split_whitespace().any(|name| name == piece.text) {
            found.push(format!("{path}:{}: {}", piece.line, piece.text));
        }
        parentheses += i32::from(piece.text == "(") - i32::from(piece.text == ")");
    }
    found
}

#[test]
fn no_name_of_a_shader_hides_a_function_of_wgsl() {
    let tree = Tree::read();
    let violations: Vec<_> = tree.files("", &[".wgsl"]).flat_map(|f| hiding(f, &read(f))).collect();
    expect_none("names that hide functions of WGSL", &violations);
}

#[test]
fn a_name_that_hides_a_function_is_found() {
    let source = "// fn exp(x: f32)\nstruct S { step: f32 }\nfn exp(distance: f32, x: f32) -> f32 {\n    let all = 1.0;\n\
        for (var round = 0u; round < 2u; round++) {}\n    return exp2(x) * sign(all);\n}\n\
        var<private> min: u32;\n@group(0) @binding(1) var<storage, read_write> max: array<u32>;\n\
        fn stepped(step_px: f32) {}\n";
    let found = ["3: exp", "3: distance", "4: all", "5: round", "8: min", "9: max"];
    assert_eq!(hiding("x.wgsl", source), found.map(|f| format!("x.wgsl:{f}")));
}

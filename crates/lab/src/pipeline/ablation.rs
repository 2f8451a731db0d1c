//! Passes without one of their parts, to measure the part's cost and its benefit. For measurements only: without a
//! part, images may contain errors that the part prevents.

pub use afterimage_clip::pipeline::Part;

use afterimage::MethodKind;
use afterimage::shader::SHADERS;

const HISTORIES: &[MethodKind] = &[MethodKind::Taa, MethodKind::Wrs, MethodKind::Smr, MethodKind::Taau];
const RESAMPLED: &[MethodKind] = &[MethodKind::Taa, MethodKind::Smr, MethodKind::Taau];

/// All parts.
pub const PARTS: &[Part] = &[
    Part {
        name: "sanitize",
        instead: "NaN and infinity are accepted as colors and weights",
        methods: HISTORIES,
        replaced: &[
            ("if max(max(size.x, size.y), size.z) < 0x7f800000u {", "if true {"),
            ("return select(0.0, w, bits >= 0x00800000u && bits < 0x7f800000u);", "return w;"),
        ],
    },
    Part {
        name: "clamp",
        instead: "colors and gains are not clamped; Catmull-Rom may undershoot",
        methods: HISTORIES,
        replaced: &[
            ("let limited = clamp(c, vec3<f32>(-MAX_HALF), vec3<f32>(MAX_HALF));", "let limited = c;"),
            ("let c = clamp(linear_color, vec3<f32>(-MAX_HALF), vec3<f32>(MAX_HALF));", "let c = linear_color;"),
            ("max(g.sharp * (1.0 / weights), vec3<f32>(0.0))", "g.sharp * (1.0 / weights)"),
            (
                "let ratio = clamp((candidate + DARK) / (history + DARK), GAIN_LEAST, GAIN_MOST);",
                "let ratio = (candidate + DARK) / (history + DARK);",
            ),
        ],
    },
    Part {
        name: "stored-bias",
        instead: "the bias counts in the choice between sample and candidate (A-Chao), and the stored weight sum keeps \
                  what it takes away",
        methods: &[MethodKind::Wrs],
        replaced: &[(
            "draw * w_sum < candidate_w, w_sum, 0.0,",
            "draw * w_sum < candidate_w, weight(past.w_sum * gate_value) + candidate_w, 0.0,",
        )],
    },
    Part {
        name: "exact-color",
        instead: "cube roots without their polynomial, a few percent off",
        methods: &[MethodKind::Wrs],
        replaced: &[("let r = d + d * (e * p);", "let r = d;")],
    },
    Part {
        name: "catmull-rom",
        instead: "history is resampled bilinearly",
        methods: RESAMPLED,
        replaced: &[(
            "fraction, catmull_rom(fraction.x), catmull_rom(fraction.y));",
            "fraction, vec4(0.0, 1.0 - fraction.x, fraction.x, 0.0), vec4(0.0, 1.0 - fraction.y, fraction.y, 0.0));",
        )],
    },
    Part {
        name: "fine-history",
        instead: "history stores 6 mantissa bits of colors, as 11-bit floats do, instead of 9 (taa, taau, smr) or 10 (wrs)",
        methods: HISTORIES,
        replaced: &[
            (
                "return select(rounded, small, a < (112u << 23u));",
                "return min((select(rounded, small, a < (112u << 23u)) + 4u) & 0xfff8u, 0x3df8u);",
            ),
            (
                "half_bits(s.color.x) | (half_bits(s.color.y) << 16u),",
                "((half_bits(s.color.x) + 8u) & 0xfff0u) | (((half_bits(s.color.y) + 8u) & 0xfff0u) << 16u),",
            ),
            (
                "half_bits(s.color.z) | (disparity_code(s.disparity) << 16u),\n        (w_upper",
                "((half_bits(s.color.z) + 8u) & 0xfff0u) | (disparity_code(s.disparity) << 16u),\n        (w_upper",
            ),
        ],
    },
];

/// The part with this name.
pub fn find(name: &str) -> Option<&'static Part> {
    PARTS.iter().find(|part| part.name == name)
}

/// Shader text of a method's pass without a part.
///
/// # Panics
/// If the pass contains none of the part's texts: a bug in this file, which a test of all parts finds.
pub fn shader_without(part: &Part, method: MethodKind) -> String {
    let whole = SHADERS.compose(&format!("{}_pass", method.name())).source;
    let replaced = part.replaced.iter().fold(whole.clone(), |text, (right, instead)| text.replace(right, instead));
    assert_ne!(whole, replaced, "the pass of {method:?} has no {}", part.name);
    replaced
}

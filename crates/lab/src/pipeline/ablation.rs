//! Passes with a part left out, to see what the part costs and buys. For measurements alone: what is left out is there for a reason.

use afterimage::Method;
use afterimage::shader::SHADERS;

/// A part of the passes that can be left out.
#[derive(Debug, PartialEq, Eq)]
pub struct Part {
    /// As it is named on the command line.
    pub name: &'static str,
    /// What is then done instead.
    pub instead: &'static str,
    /// The methods that have it.
    pub methods: &'static [Method],
    /// Texts of the shaders that are replaced. Those that a method's pass does not hold are another method's.
    replaced: &'static [(&'static str, &'static str)],
}

const HISTORIES: &[Method] = &[Method::Taa, Method::Wrs, Method::Smr];
const RESAMPLED: &[Method] = &[Method::Taa, Method::Smr];

/// All parts.
pub const PARTS: &[Part] = &[
    Part {
        name: "sanitize",
        instead: "NaN and infinity are taken as they come",
        methods: HISTORIES,
        replaced: &[
            ("if is_finite(c.x) && is_finite(c.y) && is_finite(c.z) {", "if true {"),
            ("return select(0.0, w, bits >= 0x00800000u && bits < 0x7f800000u);", "return w;"),
        ],
    },
    Part {
        name: "clamp",
        instead: "colors and gains have no limits, sharp filters may undershoot",
        methods: HISTORIES,
        replaced: &[
            (
                "return Sanitized(clamp(c, vec3<f32>(-MAX_HALF), vec3<f32>(MAX_HALF)), true);",
                "return Sanitized(c, true);",
            ),
            ("let c = clamp(linear_color, vec3<f32>(-MAX_HALF), vec3<f32>(MAX_HALF));", "let c = linear_color;"),
            ("max(g.sharp * (1.0 / g.sharp_sum), vec3<f32>(0.0))", "g.sharp * (1.0 / g.sharp_sum)"),
            (
                "let ratio = clamp((candidate + DARK) / (history + DARK), GAIN_LEAST, GAIN_MOST);",
                "let ratio = (candidate + DARK) / (history + DARK);",
            ),
        ],
    },
    Part {
        name: "exact-color",
        instead: "cube roots are guessed from the bits, a few percent off (one of the two Halley steps alone changes no pixel)",
        methods: &[Method::Wrs],
        replaced: &[(
            "for (var i = 0u; i < 2u; i++) {\n        let r3",
            "for (var i = 0u; i < 0u; i++) {\n        let r3",
        )],
    },
    Part {
        name: "catmull-rom",
        instead: "history is read bilinearly",
        methods: RESAMPLED,
        replaced: &[
            ("let sharp_x = catmull_rom(source.fraction.x);", "let sharp_x = linear_weights(source.fraction.x);"),
            ("let sharp_y = catmull_rom(source.fraction.y);", "let sharp_y = linear_weights(source.fraction.y);"),
        ],
    },
    Part {
        name: "fine-history",
        instead: "history keeps 6 bits of a color's fraction, as 11-bit floats do, instead of 9 (taa, smr) or 10 (wrs)",
        methods: HISTORIES,
        replaced: &[
            ("return min((h + ((h >> 1u) & 1u)) >> 1u, 0x3dffu);", "return min(((h + 8u) & 0xfff0u) >> 1u, 0x3dffu);"),
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

impl Part {
    /// By its name.
    pub fn find(name: &str) -> Option<&'static Self> {
        PARTS.iter().find(|part| part.name == name)
    }

    /// The text of a method's pass without it.
    ///
    /// # Panics
    /// If the pass holds nothing of it: a mistake in this file, which a test of all parts finds.
    pub fn shader_without(&self, method: Method) -> String {
        let whole = SHADERS.compose(&format!("{}_pass", method.name())).source;
        let replaced = self.replaced.iter().fold(whole.clone(), |text, (right, instead)| text.replace(right, instead));
        assert_ne!(whole, replaced, "the pass of {method:?} has no {}", self.name);
        replaced
    }
}

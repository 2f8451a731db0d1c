//! Passes without one of their parts, to measure the part's cost and its benefit. For measurements only: without a
//! part, images may contain errors that the part prevents.

use afterimage::internal::MethodKind;
use afterimage::shader::SHADERS;

const HISTORIES: &[MethodKind] = &[MethodKind::Taa, MethodKind::Wrs, MethodKind::Smr, MethodKind::Taau];
const RESAMPLED: &[MethodKind] = &[MethodKind::Taa, MethodKind::Smr, MethodKind::Taau];

/// A part of the passes that can be left out, on a device.
#[derive(Debug)]
pub struct Part {
    /// Name of the part.
    pub name: &'static str,
    /// Behaviour of the pass without the part.
    pub instead: &'static str,
    /// Methods whose pass contains the part.
    pub methods: &'static [MethodKind],
    /// Shader texts and their replacements. Each method's pass contains at least one of them; the others belong to
    /// other methods.
    replaced: &'static [(&'static str, &'static str)],
}

/// The choice of where the bias of wrs counts, a reading of the paper.
pub const STORED_BIAS: Part = Part {
    name: "stored-bias",
    instead: "the bias counts in the choice between sample and candidate (A-Chao), and the stored weight sum keeps \
              what it takes away",
    methods: &[MethodKind::Wrs],
    replaced: &[(
        "draw * w_sum < candidate_w, w_sum, 0.0,",
        "draw * w_sum < candidate_w, weight(past.w_sum * gate_value) + candidate_w, 0.0,",
    )],
};

/// Parts that keep the passes safe and exact.
pub const PARTS: &[Part] = &[
    Part {
        name: "sanitizing",
        instead: "NaN and infinity are accepted as colors and weights",
        methods: HISTORIES,
        replaced: &[
            ("if max(max(size.x, size.y), size.z) < 0x7f800000u {", "if true {"),
            ("return select(0.0, w, bits >= 0x00800000u && bits < 0x7f800000u);", "return w;"),
        ],
    },
    Part {
        name: "clamps",
        instead: "colors and gains are not clamped; Catmull-Rom may undershoot",
        methods: HISTORIES,
        replaced: &[
            ("let limited = clamp(c, vec3f(-MAX_HALF), vec3f(MAX_HALF));", "let limited = c;"),
            ("max(g.sharp * (1.0 / weights), vec3f(0.0))", "g.sharp * (1.0 / weights)"),
            (
                "let ratio = clamp((observed + DARK) / (predicted + DARK), GAIN.x, GAIN.y);",
                "let ratio = (observed + DARK) / (predicted + DARK);",
            ),
        ],
    },
    Part {
        name: "exact cube roots",
        instead: "cube roots without their polynomial, a few percent off",
        methods: &[MethodKind::Wrs],
        replaced: &[("let r = d + d * (e * p);", "let r = d;")],
    },
    Part {
        name: "Catmull-Rom",
        instead: "history is resampled bilinearly",
        methods: RESAMPLED,
        replaced: &[(
            "fraction, catmull_rom(fraction.x), catmull_rom(fraction.y));",
            "fraction, vec4(0.0, 1.0 - fraction.x, fraction.x, 0.0), vec4(0.0, 1.0 - fraction.y, fraction.y, 0.0));",
        )],
    },
    Part {
        name: "fine history",
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

#[cfg(test)]
mod tests {
    use super::{PARTS, Part, STORED_BIAS, shader_without};
    use crate::safeguards::with_invalid_colors;
    use afterimage::internal::{Foveation, MethodKind, Settings};
    use afterimage::wgpu::naga;
    use afterimage::{Image, ViewGeometry};
    use afterimage_lab::device::{Backend, Headless};
    use afterimage_lab::pipeline::{Pipeline, RunKind};
    use afterimage_lab::source::{AnalyticSource, FrameSource};

    fn all() -> impl Iterator<Item = &'static Part> {
        PARTS.iter().chain([&STORED_BIAS])
    }

    const SIZE: [u32; 2] = [96, 64];
    const FRAMES: u64 = 8;

    /// Output of a run on an image that moves sideways, with invalid pixels in every frame.
    fn shown(backend: &Backend, run: RunKind) -> Vec<Image<[f32; 3]>> {
        let mut source = AnalyticSource::new("lateral", SIZE, 70.0, 60.0).unwrap();
        let geometry = ViewGeometry::flat(SIZE, 70.0).unwrap();
        let foveation = Foveation { rate_mid: 2, rate_far: 4, ..Foveation::default() };
        let mut pipeline = Pipeline::new(geometry, foveation, &[run], false, &[], backend).unwrap();
        (0..FRAMES)
            .map(|index| {
                let gaze = [20.0 + 8.0 * index as f32, 32.0];
                let frame = source.render(&pipeline.request(index, Some(gaze))).unwrap();
                let frame = with_invalid_colors(frame, &geometry, &foveation, 0.01);
                pipeline.step(&frame).unwrap().outputs.remove(0).image
            })
            .collect()
    }

    fn bits(frames: &[Image<[f32; 3]>]) -> Vec<[u32; 3]> {
        frames.iter().flat_map(|frame| frame.pixels().iter().map(|c| c.map(f32::to_bits))).collect()
    }

    #[test]
    fn parts_are_in_the_passes_and_their_texts_without_them_are_valid() {
        for part in all() {
            for &method in part.methods {
                let source = shader_without(part, method);
                let module = naga::front::wgsl::parse_str(&source).unwrap_or_else(|e| panic!("{}: {e}", part.name));
                let flags = naga::valid::ValidationFlags::all();
                naga::valid::Validator::new(flags, naga::valid::Capabilities::all()).validate(&module).unwrap();
            }
        }
    }

    #[test]
    fn leaving_a_part_out_changes_what_is_shown() {
        if afterimage_testing::gpu::adapter().is_none() {
            return;
        }
        let backend = Backend::Gpu(Headless::find(true).expect("there is an adapter"));
        for method in [MethodKind::Taa, MethodKind::Wrs, MethodKind::Smr, MethodKind::Taau] {
            let settings = Settings { method: method.into(), ..Settings::default() };
            let whole = shown(&backend, RunKind::PostProcess(settings));
            let broken = |frames: &[Image<[f32; 3]>]| {
                let pixels = frames.iter().flat_map(|f| f.pixels());
                pixels.filter(|c| !c.iter().all(|v| v.is_finite())).count()
            };
            assert_eq!(broken(&whole), 0, "{method:?}");
            for part in all().filter(|part| part.methods.contains(&method)) {
                let without = shown(&backend, RunKind::WithShader(settings, shader_without(part, method).into()));
                let differ = bits(&whole).iter().zip(bits(&without)).filter(|(a, b)| **a != *b).count();
                println!("{method:?} without {}: {differ} pixels differ, {} are broken", part.name, broken(&without));
                assert!(differ > 0, "{method:?} without {}", part.name);
            }
        }
    }

    #[test]
    fn parts_cannot_be_left_out_on_the_cpu() {
        let settings = Settings::default();
        let run = RunKind::WithShader(settings, shader_without(&PARTS[0], settings.method.kind()).into());
        let geometry = ViewGeometry::flat(SIZE, 70.0).unwrap();
        let error = Pipeline::new(geometry, Foveation::default(), &[run], false, &[], &Backend::Cpu).err().unwrap();
        assert!(error.to_string().contains("expected a device"), "{error}");
    }
}

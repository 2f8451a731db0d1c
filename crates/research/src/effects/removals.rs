//! Removal of an effect's source from the kernels, to measure the cost of an effect that is compiled in but switched
//! off.

use afterimage_lab::scene::effects::Effect;

/// Edits that remove an effect's source.
pub struct Removal {
    pub effect: Effect,
    /// Names of its override constants.
    names: &'static [&'static str],
    /// Functions that only this effect calls.
    functions: &'static [&'static str],
    /// Other text of the effect, and its replacement.
    rest: &'static [(&'static str, &'static str)],
    /// Text that replaces the functions.
    added: &'static str,
}

/// Removals for the effects with most source, and for two kinds of light.
pub const REMOVALS: &[Removal] = &[
    Removal {
        effect: Effect::Clearcoat,
        names: &["EFFECT_CLEARCOAT", "LOBE_CLEARCOAT"],
        functions: &[],
        rest: &[
            ("    clearcoat: f32,\n    clearcoat_roughness: f32,\n", ""),
            ("    coat_width: f32,\n    coat: f32,\n    coat_rise: f32,\n", ""),
            ("        coat_width,\n        coat,\n        coat_rise,\n", ""),
            ("    s.clearcoat = 0.0;\n    s.clearcoat_roughness = 0.0;\n", ""),
            ("        s.clearcoat = row.y;\n        s.clearcoat_roughness = row.z;\n", ""),
            (
                "    var coat = 0.0;\n    var coat_rise = 0.0;\n    var coat_albedo = 0.0;\n    var coat_width = 1.0;\n",
                "",
            ),
            ("    let below_coat = 1.0 - coat_albedo;\n", "    let below_coat = 1.0;\n"),
            (" + coat_albedo) + glass_probability", ") + glass_probability"),
            ("coat_albedo / total", "0.0"),
        ],
        added: "",
    },
    Removal {
        effect: Effect::Sheen,
        names: &["EFFECT_SHEEN", "LOBE_SHEEN"],
        functions: &["sheen_albedo", "charlie_visibility", "charlie_d", "charlie_lambda"],
        rest: &[
            ("    sheen_color: vec3f,\n    sheen_roughness: f32,\n", ""),
            ("    sheen: vec3f,\n    sheen_width: f32,\n    sheen_lambda: f32,\n", ""),
            ("        sheen,\n        sheen_width,\n        sheen_lambda,\n", ""),
            ("    s.sheen_color = vec3f(0.0);\n    s.sheen_roughness = 0.0;\n", ""),
            ("    var sheen = vec3f(0.0);\n    var sheen_probability = 0.0;\n", ""),
            ("    var sheen_width = 1.0;\n    var sheen_lambda = 0.0;\n", ""),
            (" + sheen_probability", ""),
        ],
        added: "",
    },
    Removal {
        effect: Effect::Transmission,
        names: &["EFFECT_TRANSMISSION", "LOBE_TRANSMISSION"],
        functions: &["eval_transmission", "glass_fresnel", "mirror_probability", "glass_albedo"],
        rest: &[
            ("    transmission: f32,\n    thin: bool,\n    entering: bool,\n", ""),
            (
                "    glass: vec3f,\n    glass_color: vec3f,\n    glass_reflect: vec3f,\n    eta: f32,\n    thin: bool,\n",
                "",
            ),
            ("        glass,\n        base,\n        glass_reflect,\n        eta,\n        thin,\n", ""),
            ("    let transmission = select(0.0, clamp(surface.transmission, 0.0, 1.0), LOBE_TRANSMISSION);\n", ""),
            (" * (1.0 - transmission)", ""),
            ("    var glass = vec3f(0.0);\n    var glass_reflect = vec3f(0.0);\n    var eta = 1.0;\n", ""),
            ("    var glass_probability = 0.0;\n", ""),
            ("    let ior = clamp(surface.ior, 1.0, MAX_REFRACTING_IOR);\n", ""),
            ("    let thin = surface.thin || ior < MIN_REFRACTING_IOR;\n", ""),
            (") + glass_probability", ")"),
            ("glass_probability / total", "0.0"),
            ("    s.transmission = 0.0;\n    s.thin = (words.x & FLAG_VOLUME) == 0u;\n    s.entering = front;\n", ""),
            ("        s.transmission = row.w;\n", ""),
        ],
        added: "",
    },
    Removal {
        effect: Effect::NormalMap,
        names: &["EFFECT_NORMAL_MAP"],
        functions: &["mapped_normal"],
        rest: &[],
        added: "",
    },
    Removal {
        effect: Effect::EmissiveTexture,
        names: &["EFFECT_EMISSIVE_TEXTURE"],
        functions: &[],
        rest: &[],
        added: "",
    },
    Removal {
        effect: Effect::PunctualLights,
        names: &["EFFECT_PUNCTUAL_LIGHTS"],
        functions: &["from_punctual", "cone_falloff", "distance_falloff"],
        rest: &[],
        added: "",
    },
    Removal {
        effect: Effect::EnvironmentMap,
        names: &["EFFECT_ENVIRONMENT_MAP", "has_map()"],
        functions: &["has_map", "map_radiance", "sky", "sky_pdf"],
        rest: &[],
        added: "fn sky(direction: vec3f) -> vec3f {
            return frame.sky;
        }
        fn sky_pdf(direction: vec3f, cosine: f32) -> f32 {
            return frame.sky_probability * cosine_hemisphere_pdf(cosine);
        }",
    },
];

impl Removal {
    /// `text` without the effect; unchanged if it does not contain the effect.
    pub fn cut(&self, text: &str) -> String {
        let declared = |line: &str| self.names.iter().any(|n| line.starts_with(&format!("override {n}:")));
        if !text.lines().any(declared) {
            return text.to_owned();
        }
        let mut text: String = text.lines().filter(|l| !declared(l)).flat_map(|l| [l, "\n"]).collect();
        let found = self.functions.iter().filter_map(|f| text.find(&format!("fn {f}(")));
        let mut functions: Vec<_> = found.collect();
        functions.sort_unstable();
        for start in functions.into_iter().rev() {
            let end = block_end(&text, start);
            text.replace_range(start..end, "");
        }
        for (from, to) in self.rest {
            text = text.replace(from, to);
        }
        for name in self.names {
            text = without_branches(text, name);
        }
        text + self.added
    }
}

/// `text` without the branches that are taken only if `name` is true.
fn without_branches(mut text: String, name: &str) -> String {
    let mut at = 0;
    while let Some(found) = text[at..].find("if ") {
        let start = at + found;
        at = start + 3;
        let Some(open) = text[at..].find('{').map(|i| at + i) else { break };
        let condition = &text[at..open];
        if condition.contains('\n') || !condition.contains(name) {
            continue;
        }
        let others: Vec<_> = condition.split(" || ").filter(|c| !c.contains(name)).collect();
        if !others.is_empty() {
            let others = format!("{} ", others.join(" || ").trim_end());
            text.replace_range(at..open, &others);
            continue;
        }
        let end = block_end(&text, open);
        if text[end..].starts_with(" else ") {
            text.replace_range(start..end + " else ".len(), "");
        } else if text[..start].ends_with("} else ") {
            text.replace_range(start - "} else ".len()..end - 1, "");
        } else {
            text.replace_range(start..end, "");
        }
        at = start.saturating_sub("} else ".len());
    }
    text
}

/// End of the first block after `from`.
fn block_end(text: &str, from: usize) -> usize {
    let mut depth = 0;
    for (i, c) in text[from..].char_indices() {
        match c {
            '{' => depth += 1,
            '}' => depth -= 1,
            _ => continue,
        }
        if depth == 0 {
            return from + i + 1;
        }
    }
    text.len()
}

#[cfg(test)]
mod tests {
    use super::*;
    use afterimage::wgpu::naga;
    use afterimage_trace::shader::SHADERS;

    #[test]
    fn nothing_of_an_effect_that_was_cut_out_is_left() {
        let text = SHADERS.compose_with(&["scene_texture", "shade_pass"], "").source;
        for removal in REMOVALS {
            for (from, _) in removal.rest {
                assert!(text.contains(from), "{}: the kernel has no '{from}'", removal.effect.name());
            }
            for function in removal.functions {
                assert!(text.contains(&format!("fn {function}(")), "{}: {function}", removal.effect.name());
            }
            let cut = removal.cut(&text);
            assert!(cut.len() < text.len());
            for name in removal.names {
                let code = |line: &str| !line.trim_start().starts_with("//") && line.contains(name);
                assert!(!cut.lines().any(code), "{}: {name} is left", removal.effect.name());
            }
            let module = naga::front::wgsl::parse_str(&cut).unwrap_or_else(|e| panic!("{}", e.emit_to_string(&cut)));
            naga::valid::Validator::new(Default::default(), naga::valid::Capabilities::all())
                .validate(&module)
                .unwrap();
        }
    }
}

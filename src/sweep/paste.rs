//! Settings as a program has them.

use crate::foveation::Foveation;
use crate::settings::{Bias, DepthTest, Gate, Settings, Smr};

/// `Settings { .. }` with what differs from the defaults, ready to paste.
pub fn as_rust(settings: &Settings) -> String {
    let plain = Settings::default();
    let mut fields = vec![];
    let mut field = |differs: bool, text: String| fields.extend(differs.then_some(text));
    field(settings.method != plain.method, format!("method: Method::{:?}", settings.method));
    field(settings.foveation != plain.foveation, format!("foveation: {}", foveation(&settings.foveation)));
    field(settings.smr != plain.smr, format!("smr: {}", smr(&settings.smr)));
    field(settings.sampler != plain.sampler, format!("sampler: Sampler::{:?}", settings.sampler));
    field(settings.bias != plain.bias, format!("bias: {}", bias(settings.bias)));
    field(settings.gate != plain.gate, format!("gate: {}", settings.gate.map_or("None".into(), gate)));
    let depth_test = settings.depth_test.map_or("None".into(), depth_test);
    field(settings.depth_test != plain.depth_test, format!("depth_test: {depth_test}"));
    field(settings.noisy, "noisy: true".into());
    field(settings.seed != plain.seed, format!("seed: {}", settings.seed));
    of("Settings", &fields)
}

fn foveation(f: &Foveation) -> String {
    let plain = Foveation::default();
    let mut fields = vec![];
    let mut field = |differs: bool, text: String| fields.extend(differs.then_some(text));
    field(f.filter != plain.filter, format!("filter: Filter::{:?}", f.filter));
    field(f.fovea_deg != plain.fovea_deg, format!("fovea_deg: {:?}", f.fovea_deg));
    field(f.mid_deg != plain.mid_deg, format!("mid_deg: {:?}", f.mid_deg));
    field(f.blend_deg != plain.blend_deg, format!("blend_deg: {:?}", f.blend_deg));
    field(f.rate_mid != plain.rate_mid, format!("rate_mid: {}", f.rate_mid));
    field(f.rate_far != plain.rate_far, format!("rate_far: {}", f.rate_far));
    of("Foveation", &fields)
}

fn smr(s: &Smr) -> String {
    let plain = Smr::default();
    let mut fields = vec![];
    let mut field = |differs: bool, text: String| fields.extend(differs.then_some(text));
    field(s.accumulate != plain.accumulate, format!("accumulate: {:?}", s.accumulate));
    field(s.tolerance != plain.tolerance, format!("tolerance: {:?}", s.tolerance));
    field(s.relight != plain.relight, format!("relight: {}", s.relight));
    of("Smr", &fields)
}

fn bias(bias: Bias) -> String {
    match bias {
        Bias::Exponential { lambda } => format!("Bias::Exponential {{ lambda: {lambda:?} }}"),
        other => format!("Bias::{other:?}"),
    }
}

fn gate(gate: Gate) -> String {
    format!(
        "Some(Gate {{ metric: GateMetric::{:?}, divisor: {:?}, offset: {:?} }})",
        gate.metric, gate.divisor, gate.offset
    )
}

fn depth_test(test: DepthTest) -> String {
    format!("Some(DepthTest {{ relative: {:?}, slope_px: {:?} }})", test.relative, test.slope_px)
}

fn of(name: &str, fields: &[String]) -> String {
    if fields.is_empty() {
        return format!("{name}::default()");
    }
    format!("{name} {{ {}, ..{name}::default() }}", fields.join(", "))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::foveation::Filter;
    use crate::settings::{GateMetric, Method, Sampler};

    /// The text compiles to the settings it was made of: it is a macro's argument and its own expectation.
    macro_rules! round_trip {
        ($settings:expr) => {
            let compact = |text: &str| text.split_whitespace().collect::<String>().replace(",}", "}");
            assert_eq!(compact(&as_rust(&$settings)), compact(stringify!($settings)));
        };
    }

    #[test]
    fn what_is_pasted_makes_the_same_settings() {
        round_trip!(Settings::default());
        round_trip!(Settings { method: Method::Wrs, gate: None, depth_test: None, seed: 3, ..Settings::default() });
        round_trip!(Settings {
            method: Method::Taa,
            foveation: Foveation { filter: Filter::Block, fovea_deg: 10.0, rate_far: 32, ..Foveation::default() },
            smr: Smr { accumulate: 0.7, relight: false, ..Smr::default() },
            sampler: Sampler::AEs,
            bias: Bias::Exponential { lambda: 0.25 },
            gate: Some(Gate { metric: GateMetric::Lightness, divisor: 50.0, offset: 2.0 }),
            depth_test: Some(DepthTest { relative: 0.1, slope_px: 0.0 }),
            noisy: true,
            ..Settings::default()
        });
    }
}

//! Settings as Rust source.

use afterimage::internal::{Bias, Foveation, Method, Settings, Smr, Wrs};

/// Settings that have a name.
fn named() -> [(&'static str, Settings); 2] {
    [("Settings::screen", Settings::screen()), ("Settings::headset", Settings::headset())]
}

/// The name of settings whose source is the name alone.
pub fn name_of(source: &str) -> Option<&'static str> {
    let call = source.strip_suffix("()")?;
    named().into_iter().map(|(name, _)| name).find(|&name| name == call)
}

/// The call that makes the settings if they have a name, else `Settings { .. }` with the fields that differ from the
/// defaults; ready to paste into a program.
pub fn as_rust(settings: &Settings) -> String {
    if let Some((name, _)) = named().iter().find(|(_, own)| own == settings) {
        return format!("{name}()");
    }
    Literal::new("Settings", settings, &Settings::default())
        .field("method", |s| match &s.method {
            Method::Smr(own) => format!("Method::Smr({})", smr(own)),
            Method::Wrs(own) => format!("Method::Wrs({})", wrs(own)),
            other => format!("Method::{other:?}"),
        })
        .field("foveation", |s| foveation(&s.foveation))
        .field("depth_test", |s| match s.depth_test {
            None => "None".into(),
            Some(t) => format!("Some(DepthTest {{ relative: {:?}, slope_px: {:?} }})", t.relative, t.slope_px),
        })
        .field("noisy", |s| s.noisy.to_string())
        .field("seed", |s| s.seed.to_string())
        .end()
}

fn foveation(foveation: &Foveation) -> String {
    Literal::new("Foveation", foveation, &Foveation::default())
        .field("kind", |f| format!("FoveationKind::{:?}", f.kind))
        .field("fovea_deg", |f| format!("{:?}", f.fovea_deg))
        .field("mid_deg", |f| format!("{:?}", f.mid_deg))
        .field("blend_deg", |f| format!("{:?}", f.blend_deg))
        .field("rate_mid", |f| f.rate_mid.to_string())
        .field("rate_far", |f| f.rate_far.to_string())
        .field("budget", |f| format!("{:?}", f.budget))
        .end()
}

fn smr(smr: &Smr) -> String {
    Literal::new("Smr", smr, &Smr::default())
        .field("accumulate", |s| format!("{:?}", s.accumulate))
        .field("tolerance", |s| format!("{:?}", s.tolerance))
        .field("relight", |s| s.relight.to_string())
        .field("antialias", |s| s.antialias.to_string())
        .end()
}

fn wrs(wrs: &Wrs) -> String {
    Literal::new("Wrs", wrs, &Wrs::default())
        .field("sampler", |w| format!("Sampler::{:?}", w.sampler))
        .field("weight_exponent", |w| w.weight_exponent.to_string())
        .field("rate_exponent", |w| w.rate_exponent.to_string())
        .field("bias", |w| match w.bias {
            Bias::Exponential { lambda } => format!("Bias::Exponential {{ lambda: {lambda:?} }}"),
            other => format!("Bias::{other:?}"),
        })
        .field("gate", |w| match w.gate {
            None => "None".into(),
            Some(g) => format!(
                "Some(Gate {{ metric: GateMetric::{:?}, scale: GateScale::{:?}, divisor: {:?}, offset: {:?} }})",
                g.metric, g.scale, g.divisor, g.offset
            ),
        })
        .end()
}

/// A struct expression, built field by field. Fields equal to the default are left out.
struct Literal<'a, T> {
    name: &'static str,
    value: &'a T,
    plain: &'a T,
    fields: Vec<String>,
}

impl<'a, T> Literal<'a, T> {
    fn new(name: &'static str, value: &'a T, plain: &'a T) -> Self {
        Self { name, value, plain, fields: vec![] }
    }

    fn field(mut self, name: &str, written: impl Fn(&T) -> String) -> Self {
        let value = written(self.value);
        if value != written(self.plain) {
            self.fields.push(format!("{name}: {value}"));
        }
        self
    }

    fn end(self) -> String {
        let Self { name, fields, .. } = self;
        if fields.is_empty() {
            format!("{name}::default()")
        } else {
            format!("{name} {{ {}, ..{name}::default() }}", fields.join(", "))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use afterimage::internal::{DepthTest, FoveationKind, Gate, GateMetric, GateScale, Sampler};

    /// Checks that the text of the settings is the macro's argument, which compiles.
    macro_rules! round_trip {
        ($settings:expr) => {
            let compact = |text: &str| text.split_whitespace().collect::<String>().replace(",}", "}");
            assert_eq!(compact(&as_rust(&$settings)), compact(stringify!($settings)));
        };
    }

    #[test]
    #[expect(clippy::needless_update, reason = "the text ends with the default whether or not fields are left")]
    fn what_is_pasted_makes_the_same_settings() {
        round_trip!(Settings::default());
        round_trip!(Settings::screen());
        round_trip!(Settings::headset());
        round_trip!(Settings { method: Method::Taau, depth_test: None, seed: 3, ..Settings::default() });
        round_trip!(Settings {
            method: Method::Wrs(Wrs {
                sampler: Sampler::AEs,
                weight_exponent: 3,
                rate_exponent: 2,
                bias: Bias::Exponential { lambda: 0.25 },
                gate: Some(Gate {
                    metric: GateMetric::Lightness,
                    scale: GateScale::Sample,
                    divisor: 50.0,
                    offset: 2.0
                }),
                ..Wrs::default()
            }),
            foveation: Foveation { kind: FoveationKind::Block, fovea_deg: 10.0, rate_far: 32, ..Foveation::default() },
            depth_test: Some(DepthTest { relative: 0.1, slope_px: 0.0 }),
            noisy: true,
            ..Settings::default()
        });
        round_trip!(Settings { method: Method::Wrs(Wrs { gate: None, ..Wrs::default() }), ..Settings::default() });
        round_trip!(Settings {
            method: Method::Smr(Smr { accumulate: 0.7, relight: false, ..Smr::default() }),
            ..Settings::default()
        });
    }
}

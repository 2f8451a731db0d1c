//! Settings and conventions in configuration files.

use afterimage::internal::{Bias, ContextDesc, FoveationKind, Method, MethodKind, Settings, Wrs};
use afterimage::{DepthConvention, MotionConvention};

fn round_trip<T: serde::Serialize + serde::de::DeserializeOwned + PartialEq + std::fmt::Debug>(value: T) -> String {
    let text = serde_json::to_string(&value).unwrap();
    assert_eq!(serde_json::from_str::<T>(&text).unwrap(), value, "{text}");
    text
}

#[test]
fn settings_survive_a_file() {
    for settings in [Settings::weighted(), Settings::steady(), Settings::responsive(), Settings::traced()] {
        round_trip(settings);
    }
    let wrs = Wrs { bias: Bias::Exponential { lambda: 0.25 }, gate: None, ..Wrs::default() };
    round_trip(Settings { method: Method::Wrs(wrs), depth_test: None, seed: u64::MAX, ..Settings::default() });
    for kind in MethodKind::ALL {
        let text = round_trip(Method::from(kind));
        assert!(text.contains(&format!("\"{}\"", kind.name())), "{text}");
    }
    assert_eq!(round_trip(Method::Taau), r#""taau""#);
}

#[test]
fn conventions_survive_a_file() {
    let conventions = [
        MotionConvention::BEVY,
        MotionConvention::BLENDER,
        MotionConvention::FSR2,
        MotionConvention::UNITY,
        MotionConvention::UNREAL,
    ];
    for convention in conventions {
        round_trip(convention);
    }
    round_trip(DepthConvention::Forward { near: 0.1, far: 100.0 });
    // JSON has no infinity.
    let text = round_trip(DepthConvention::Reversed { near: 0.1, far: f32::INFINITY });
    assert_eq!(text, r#"{"reversed":{"near":0.1,"far":"infinite"}}"#);
}

#[test]
fn what_a_file_omits_is_the_default_and_what_is_unknown_is_an_error() {
    let text = r#"{ "method": { "wrs": { "weight_exponent": 3 } }, "foveation": { "kind": "block", "rate_far": 8 } }"#;
    let settings: Settings = serde_json::from_str(text).unwrap();
    let wrs = Wrs { weight_exponent: 3, ..Wrs::default() };
    assert_eq!((settings.method, settings.foveation.kind), (Method::Wrs(wrs), FoveationKind::Block));
    let rest = Settings { method: Method::default(), foveation: Default::default(), ..settings };
    assert_eq!(rest, ContextDesc::new([1, 1]).settings);
    let misspelled = serde_json::from_str::<Settings>(r#"{ "metod": "taa" }"#).unwrap_err();
    assert!(misspelled.to_string().contains("unknown field `metod`"), "{misspelled}");
    let misplaced = serde_json::from_str::<Settings>(r#"{ "method": { "smr": { "gate": null } } }"#).unwrap_err();
    assert!(misplaced.to_string().contains("unknown field `gate`"), "{misplaced}");
    let plane = serde_json::from_str::<DepthConvention>(r#"{ "forward": { "near": 1, "far": "far" } }"#).unwrap_err();
    assert!(plane.to_string().contains("expected a distance or 'infinite'"), "{plane}");
}

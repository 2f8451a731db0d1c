//! Settings and conventions in configuration files.

use afterimage::{Bias, ContextDesc, DepthConvention, Filter, Method, MotionConvention, Settings};

fn round_trip<T: serde::Serialize + serde::de::DeserializeOwned + PartialEq + std::fmt::Debug>(value: T) -> String {
    let text = serde_json::to_string(&value).unwrap();
    assert_eq!(serde_json::from_str::<T>(&text).unwrap(), value, "{text}");
    text
}

#[test]
fn settings_survive_a_file() {
    for settings in [Settings::paper(), Settings::steady(), Settings::responsive(), Settings::traced()] {
        round_trip(settings);
    }
    let bias = Bias::Exponential { lambda: 0.25 };
    round_trip(Settings { bias, gate: None, depth_test: None, seed: u64::MAX, ..Settings::default() });
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
    let text = r#"{ "method": "wrs", "foveation": { "filter": "block", "rate_far": 8 } }"#;
    let settings: Settings = serde_json::from_str(text).unwrap();
    assert_eq!((settings.method, settings.foveation.filter), (Method::Wrs, Filter::Block));
    let rest = Settings { method: Method::default(), foveation: Default::default(), ..settings };
    assert_eq!(rest, ContextDesc::new([1, 1]).settings);
    let misspelled = serde_json::from_str::<Settings>(r#"{ "metod": "wrs" }"#).unwrap_err();
    assert!(misspelled.to_string().contains("unknown field `metod`"), "{misspelled}");
    let plane = serde_json::from_str::<DepthConvention>(r#"{ "forward": { "near": 1, "far": "far" } }"#).unwrap_err();
    assert!(plane.to_string().contains("expected a distance or 'infinite'"), "{plane}");
}

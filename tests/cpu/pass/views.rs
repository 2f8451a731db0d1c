//! Several views, lost gaze, settings.

use super::depth::run_law;
use super::*;
use crate::gaze_hard::*;
use crate::settings::wrs;
use afterimage::internal::{Foveation, Wrs};

gaze_laws!(Cpu, run_law);

#[test]
fn settings_are_checked_and_named() {
    let base = Settings::paper();
    let changed = |mut foveation: Foveation, change: fn(&mut Foveation)| {
        change(&mut foveation);
        Settings { foveation, ..base }
    };
    let with = |change| changed(Foveation::default(), change);
    let by_quads = |change| changed(Foveation { rate_mid: 4, ..Foveation::quads() }, change);
    for (settings, name) in [
        (with(|f| f.fovea_deg = -1.0), "fovea_deg"),
        (with(|f| f.fovea_deg = f32::NAN), "fovea_deg"),
        (with(|f| f.fovea_deg = 20.0), "fovea_deg"),
        (with(|f| f.rate_mid = 3), "rate_mid"),
        (with(|f| f.rate_far = 4), "rate_far"),
        (with(|f| f.rate_far = 1 << 20), "rate_far"),
        (with(|f| f.blend_deg = -1.0), "blend_deg"),
        (with(|f| f.mid_deg = f32::NAN), "mid_deg"),
        (by_quads(|f| f.rate_far = 16), "rate_far"),
        (by_quads(|f| f.rate_far = 2), "rate_far"),
        (by_quads(|f| f.rate_mid = 1), "rate_mid"),
        (by_quads(|f| f.budget = 1.5), "budget"),
        (wrs(Wrs { bias: Bias::Exponential { lambda: -0.1 }, ..Wrs::default() }), "bias.lambda"),
        (Settings { depth_test: Some(DepthTest { relative: 0.0, slope_px: 1.0 }), ..base }, "depth_test.relative"),
    ] {
        let error = CpuAfterimage::new(&ContextDesc { settings, ..ContextDesc::new(SIZE) }).unwrap_err();
        assert_eq!(error.setting, name);
        assert!(error.to_string().starts_with(&format!("{name} is ")), "{error}");
        let mut post = context(base);
        assert!(post.set_settings(settings).is_err());
        assert_eq!(post.desc().settings, base);
    }
}

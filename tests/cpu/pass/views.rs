//! Several views, lost gaze, settings.

use super::depth::run_law;
use super::*;
use crate::gaze_hard::*;
use crate::laws::laws;
use crate::settings::wrs;
use afterimage::{Foveation, Wrs};
use afterimage_testing::holds;

gaze_laws!(Cpu, run_law);

#[test]
fn settings_are_checked_and_named() {
    let base = Settings::paper();
    let with = |change: fn(&mut Foveation)| {
        let mut foveation = Foveation::default();
        change(&mut foveation);
        Settings { foveation, ..base }
    };
    for (settings, name) in [
        (with(|f| f.fovea_deg = -1.0), "fovea_deg"),
        (with(|f| f.fovea_deg = f32::NAN), "fovea_deg"),
        (with(|f| f.fovea_deg = 20.0), "fovea_deg"),
        (with(|f| f.rate_mid = 3), "rate_mid"),
        (with(|f| f.rate_far = 4), "rate_far"),
        (with(|f| f.rate_far = 1 << 20), "rate_far"),
        (with(|f| f.blend_deg = -1.0), "blend_deg"),
        (with(|f| f.mid_deg = f32::NAN), "mid_deg"),
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

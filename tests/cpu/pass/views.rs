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
    let fovea = |fovea_deg| Foveation { fovea_deg, ..Foveation::default() };
    for (settings, name) in [
        (Settings { foveation: fovea(-1.0), ..base }, "fovea_deg"),
        (Settings { foveation: fovea(f32::NAN), ..base }, "fovea_deg"),
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

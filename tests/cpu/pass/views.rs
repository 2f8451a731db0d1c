//! Several views, lost gaze, settings.

use super::depth::held;
use super::*;
use crate::gaze_hard::*;
use crate::laws::laws;
use crate::settings::{ungated, wrs};
use afterimage::{Foveation, Wrs};
use afterimage_testing::holds;

gaze_laws!(Cpu, held);

#[test]
fn h27_stereo_views_never_read_each_other() {
    let stereo = ContextDesc { view_count: 2, ..ContextDesc::new(SIZE) };
    let settings = ungated();
    let fresh = || CpuAfterimage::new(&ContextDesc { settings, ..stereo }).unwrap();
    let [mut both, mut left_only, mut right_only] = [fresh(), fresh(), fresh()];
    let mut mono = context(settings);
    let mut junk = still(Image::filled(SIZE, [f32::NAN, 9.0, 1e9]));
    junk.facts.gaze = Gaze::Lost;
    let mut eyes_differ = false;
    for index in 0..20 {
        let left = still(noise(SIZE, &format!("left {index}")));
        let right = View::still(noise(SIZE, &format!("right {index}")), [50.0, 30.0]);
        let both_out = step(&mut both, index, Reset::None, &[&left, &right]).0;
        assert_eq!(both_out[0], step(&mut left_only, index, Reset::None, &[&left, &junk]).0[0], "left");
        assert_eq!(both_out[1], step(&mut right_only, index, Reset::None, &[&junk, &right]).0[1], "right");
        assert_eq!(both_out[0], one(&mut mono, index, &left).0, "as if it were alone");
        // The same input to both eyes still draws different numbers.
        let same_out = step(&mut both.clone(), index, Reset::None, &[&left, &left]).0;
        eyes_differ |= same_out[0] != same_out[1];
    }
    assert!(eyes_differ);
}

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

#[test]
fn a_size_that_cannot_be_is_said_once() {
    let message = |size| CpuAfterimage::new(&ContextDesc::new(size)).unwrap_err().to_string();
    assert_eq!(message([0, 0]), "size_px is 0x0: expected at least 1x1; skip frames while the window is minimised");
    assert_eq!(message([16385, 1]), "size_px is 16385x1: expected at most 16384 pixels a side");
    let mut post = CpuAfterimage::new(&ContextDesc::new(SIZE)).unwrap();
    let error = post.resize([0, 5]).unwrap_err().to_string();
    assert_eq!(error, "size is 0x5: expected at least 1x1; skip frames while the window is minimised");
}

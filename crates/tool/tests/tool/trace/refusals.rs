//! Invalid values and scene files.

use super::rig::refuses;

#[test]
fn values_that_cannot_be_are_refused_in_one_line() {
    let scene = "builtin:cornell";
    for (more, words) in [
        (&["--size", "0x10"][..], &["--size"][..]),
        (&["--size", "70000x10"], &["--size", "too large"]),
        (&["--spp", "0"], &["--spp"]),
        (&["--frames", "0"], &["--frames"]),
        (&["--max-depth", "65"], &["--max-depth", "64"]),
        (&["--fps", "0"], &["--fps"]),
        (&["--hfov", "180"], &["--hfov", "below 180"]),
        (&["--exposure", "inf"], &["--exposure"]),
        (&["--integrator", "best"], &["--integrator"]),
        (&["--aov", "normals"], &["--aov"]),
        (&["--effects", "glow"], &["--effects", "glow"]),
        (&["--sky", "1,2"], &["--sky"]),
        (&["--sky", "1,2,nan"], &["--sky"]),
        (&["--sky", "missing.exr"], &["missing.exr"]),
        (&["--camera", "nobody"], &["--camera", "nobody"]),
        (&["--camera", "missing.json"], &["missing.json"]),
        (&["--clip", "dance"], &["dance"]),
        (&["--nonsense"], &["--nonsense"]),
    ] {
        refuses(scene, more, words);
    }
}

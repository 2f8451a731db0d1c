//! Invalid values and scene files.

use super::rig::refuses;

#[test]
fn values_that_cannot_be_are_refused_in_one_line() {
    let scene = "builtin:cornell";
    for (more, words) in [
        (&["--size", "0x10"][..], &["--size"][..]),
        (&["--size", "abc"], &["--size"]),
        (&["--size", "70000x10"], &["--size", "too large"]),
        (&["--size", "60000x60000"], &["--size", "too large"]),
        (&["--spp", "0"], &["--spp"]),
        (&["--spp=-1"], &["--spp"]),
        (&["--spp", "99999999"], &["--spp"]),
        (&["--frames", "0"], &["--frames"]),
        (&["--max-depth", "65"], &["--max-depth", "64"]),
        (&["--fps", "0"], &["--fps"]),
        (&["--fps", "NaN"], &["--fps"]),
        (&["--hfov", "180"], &["--hfov", "below 180"]),
        (&["--hfov=-3"], &["hfov"]),
        (&["--exposure", "inf"], &["--exposure"]),
        (&["--integrator", "best"], &["--integrator"]),
        (&["--bsdf", "lambert"], &["--bsdf"]),
        (&["--sampling", "some"], &["--sampling"]),
        (&["--format", "gif"], &["--format"]),
        (&["--tonemap", "filmic"], &["--tonemap"]),
        (&["--aov", "normals"], &["--aov"]),
        (&["--backend", "tpu"], &["--backend"]),
        (&["--effects", "glow"], &["--effects", "glow"]),
        (&["--effects", ""], &["--effects"]),
        (&["--sky", "1,2"], &["--sky"]),
        (&["--sky", "1,2,-3"], &["--sky"]),
        (&["--sky", "1,2,nan"], &["--sky"]),
        (&["--sky", "missing.exr"], &["missing.exr"]),
        (&["--camera", "nobody"], &["--camera", "nobody"]),
        (&["--camera", "missing.json"], &["missing.json"]),
        (&["--clip", "dance"], &["dance"]),
        (&["--seed=-1"], &["--seed"]),
        (&["--nonsense"], &["--nonsense"]),
    ] {
        refuses(scene, more, words);
    }
}

//! Bad usage and bad files of `afterimage run`.

use super::rig::{Folder, SMALL, refuses, run, words};
use std::fs;

#[test]
fn bad_usage_is_one_line_and_exit_code_2() {
    let folder = Folder::new();
    let out = folder.text("out");
    let still = "analytic:still";
    refuses(&["run", still], &["--out"]);
    refuses(&run(still, &out, &["--method", "none,dlss"]), &["dlss", "wrs"]);
    refuses(&run(still, &out, &["--method", "wrs,wrs"]), &["twice"]);
    refuses(&run("analytic:lateral", &out, &["--method", "oracle"]), &["stills"]);
    refuses(&run("analytic:sponza", &out, &[]), &["sponza", "lateral"]);
    refuses(&run(still, &out, &["--size", "0x5"]), &["WxH"]);
    refuses(&run(still, &out, &["--size", "100000x100000"]), &["limit", "--max-megapixels"]);
    refuses(&run(still, &out, &["--frames", "0"]), &["--frames", "1 to"]);
    refuses(&run(still, &out, &["--fovea", "20"]), &["fovea", "15"]);
    refuses(&run(still, &out, &["--rate-mid", "5"]), &["power of two"]);
    refuses(&run(still, &out, &["--foveation", "planned", "--method", "oracle"]), &["oracle", "moving samples"]);
    refuses(&run(still, &out, &["--foveation", "sparse"]), &["--foveation planned", "--single-pixels"]);
    refuses(&run(still, &out, &["--hfov", "180"]), &["180"]);
    refuses(&run(still, &out, &["--fps", "0"]), &["--fps", "above 0"]);
    refuses(&run(still, &out, &["--exposure", "65"]), &["--exposure", "64 stops"]);
    refuses(&run(still, &out, &["--reference-samples", "0"]), &["--reference-samples", "1 to"]);
    let frames = afterimage_testing::workspace().join("fixtures/sequences/lateral_160x90");
    let frames = frames.to_str().unwrap();
    refuses(&run(frames, &out, &["--reference-samples", "4"]), &["--reference-samples", "scene"]);
    refuses(&run(frames, &out, &["--jitter", "halton"]), &["--jitter halton", "--source raster", "analytic:NAME"]);
    refuses(&run("builtin:cubes", &out, &["--jitter", "halton", "--source", "trace"]), &["--jitter halton", "raster"]);
    let layers = ["--jitter", "halton", "--foveation", "layers"];
    refuses(&run("builtin:cubes", &out, &layers), &["--jitter halton", "--foveation planned"]);
    let albedo = ["--albedo", "scene", "--jitter", "halton"];
    refuses(&run("analytic:still", &out, &albedo), &["--albedo", "rasterised scenes"]);
    refuses(&run("builtin:cubes", &out, &albedo[..2]), &["--albedo", "--jitter halton"]);
    refuses(&run("builtin:cubes", &out, &[&albedo[..], &["--method", "none,taau"]].concat()), &["--albedo", "add smr"]);
    refuses(&run(still, &out, &["--start=-1"]), &["start"]);
    refuses(&run(still, &out, &["--wrs-bias", "exponential:x"]), &["LAMBDA"]);
    refuses(&run(still, &out, &["--gate-divisor", "0"]), &["gate.divisor"]);
    refuses(&run(still, &out, &["--gaze", "1,x"]), &["X,Y"]);
    refuses(&run(still, &out, &["--gaze", "synthetic:x"]), &["SEED"]);
    refuses(&run(still, &out, &["--camera", "lateral"]), &["--camera", "scene"]);
    refuses(&run("analytic:still", &out, &["--source", "raster"]), &["--source", "scene"]);
    assert!(!folder.path("out").exists(), "nothing was written");
}

#[test]
fn quad_views_of_what_cannot_have_them_are_refused() {
    if afterimage_testing::gpu::adapter().is_none() {
        return;
    }
    let folder = Folder::new();
    let out = folder.text("out");
    let refused = |input: &str, more: &[&str], words: &[&str]| {
        let size = ["--size", "32x18", "--frames", "1"];
        refuses(&run(input, &out, &[&size, more].concat()), words);
    };
    let cubes = "builtin:cubes";
    refused("analytic:still", &["--foveation", "layers"], &["--foveation layers", "--source raster"]);
    refused(cubes, &["--foveation", "uniform", "--source", "trace"], &["--foveation uniform", "--source raster"]);
    refused(cubes, &["--foveation", "uniform", "--method", "taau"], &["taau", "moving samples", "--fovea 0"]);
    refused(cubes, &["--foveation", "layers", "--method", "oracle"], &["oracle", "--foveation mip"]);
    refused(cubes, &["--foveation", "uniform", "--scale", "0.5"], &["--scale", "1 to 256 pixels"]);
    refused(cubes, &["--scale", "2"], &["--scale", "--foveation uniform"]);
    assert!(!folder.path("out").exists(), "nothing was written");
}

#[test]
fn bad_files_are_one_line_and_exit_code_2() {
    let folder = Folder::new();
    let out = folder.text("out");
    let gaze = |csv: &str, words: &[&str]| {
        let file = folder.write("gaze.csv", csv.as_bytes());
        refuses(&run("analytic:still", &out, &["--gaze", &file]), words);
    };
    gaze("# screen_px: 100x100\nt_s,x_px,y_px,valid\n0,1,1,1\n0.1,abc,1,1\n", &["gaze.csv", "line 4"]);
    gaze("# screen_px: 100x100\nt_s,x_px,y_px,valid\n0,nan,nan,0\n0.1,nan,nan,0\n", &["gaze.csv", "lost"]);
    gaze("", &["gaze.csv"]);
    refuses(&run("analytic:still", &out, &["--gaze", "no/such.csv"]), &["no/such.csv"]);
    refuses(&run("no/such/folder", &out, &[]), &["no/such/folder", "does not exist"]);
    fs::create_dir(folder.path("empty")).unwrap();
    refuses(&run(&folder.text("empty"), &out, &[]), &["empty", ".exr"]);
    let file = folder.write("broken.exr", b"v/1\x01 and nothing more");
    refuses(&run(&file, &out, &[]), &["broken.exr"]);
    assert!(!folder.path("out").exists(), "nothing was written");
    // A file in place of the folder.
    let file = folder.write("file", b"");
    refuses(&run("analytic:still", &format!("{file}/out"), &words(SMALL)), &["cannot be written", "--out"]);
}

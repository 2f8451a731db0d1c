//! Albedo of EXR frames: layers of renderers, what it is worth, and layers that are none.

use super::rig::{Folder, ran, read_json, refuses, run, same_on_both_backends, succeeds, tool, words};
use afterimage::Image;
use afterimage_lab::source::exr_file::write_channels;
use serde_json::Value;
use std::fs;
use std::path::Path;

const SIZE: [u32; 2] = [96, 60];
const FRAMES: u32 = 8;
/// What the picture moves by in a frame, pixels, y down.
const MOVED_PX: [u32; 2] = [3, 1];
const PLANNED: &str = "--foveation planned --share 5 --method smr --no-jod --no-flip --gaze 8,4";

/// Reflectance of a texture that moves: blocks of 3 pixels.
fn reflectance(frame: u32, [x, y]: [u32; 2]) -> [f32; 3] {
    let at = |p: u32, moved: u32| (p + 1000 - moved * frame) / 3;
    let hash = (at(x, MOVED_PX[0]) * 73 + at(y, MOVED_PX[1]) * 151).wrapping_mul(2_654_435_761);
    [8, 16, 24].map(|bits| 0.05 + 0.9 * ((hash >> bits) & 255) as f32 / 255.0)
}

/// Light on it, which varies slowly.
fn light([x, y]: [u32; 2]) -> f32 {
    0.5 + 0.3 * (x as f32 * 0.05).sin() + 0.15 * (y as f32 * 0.08).cos()
}

/// Channels of a frame without an albedo.
fn plain(frame: u32) -> Vec<(String, Image<f32>)> {
    let color = |i: usize| Image::from_fn(SIZE, |at| light(at) * reflectance(frame, at)[i]);
    let motion = |i: usize| Image::filled(SIZE, -(MOVED_PX[i] as f32));
    vec![
        ("R".into(), color(0)),
        ("G".into(), color(1)),
        ("B".into(), color(2)),
        ("Z".into(), Image::filled(SIZE, 4.0)),
        ("motion.X".into(), motion(0)),
        ("motion.Y".into(), motion(1)),
    ]
}

/// Channels of an albedo.
fn layer(name: &str, frame: u32) -> Vec<(String, Image<f32>)> {
    let channel = |(i, leaf): (usize, &str)| {
        let name = if name.is_empty() { leaf.to_owned() } else { format!("{name}.{leaf}") };
        (name, Image::from_fn(SIZE, |at| reflectance(frame, at)[i]))
    };
    ["R", "G", "B"].into_iter().enumerate().map(channel).collect()
}

fn save(path: &Path, channels: &[(String, Image<f32>)]) {
    fs::create_dir_all(path.parent().unwrap()).unwrap();
    let channels: Vec<_> = channels.iter().map(|(name, image)| (name.as_str(), image)).collect();
    write_channels(path, &channels).unwrap();
}

/// A folder of frames, with what `more` adds to each.
fn frames(count: u32, more: impl Fn(u32) -> Vec<(String, Image<f32>)>) -> Folder {
    let folder = Folder::new();
    for frame in 0..count {
        let channels = [plain(frame), more(frame)].concat();
        save(&folder.path(&format!("in/f_{frame:04}.exr")), &channels);
    }
    folder
}

fn report(input: &str, more: &str) -> Value {
    ran(input, &format!("{PLANNED} --backend cpu {more}")).json("report.json")
}

fn psnr_db(report: &Value) -> f64 {
    report["methods"]["smr"]["psnr_db"].as_f64().unwrap()
}

/// Beside the same frames with an albedo that is the same everywhere, which changes nothing.
#[test]
fn an_albedo_of_frames_shows_texture_and_is_the_same_on_both_executors() {
    let flat = |_| ["R", "G", "B"].map(|leaf| (format!("flat.{leaf}"), Image::filled(SIZE, 0.5)));
    let folder = frames(FRAMES, |frame| [&layer("ViewLayer.Denoising Albedo", frame)[..], &flat(frame)].concat());
    let input = folder.text("in");
    let [cpu, _] = same_on_both_backends(&input, PLANNED);
    let [flat, off] = ["flat", "off"].map(|name| report(&input, &format!("--albedo {name}")));
    assert_eq!([&cpu["albedo"], &flat["albedo"], &off["albedo"]], [true, true, false]);
    let [with, flat, off] = [&cpu, &flat, &off].map(psnr_db);
    println!("{off:.2} dB without, {flat:.2} dB with a flat albedo, {with:.2} dB with the texture");
    assert!(with > flat.max(off) + 3.0, "{off} dB without, {flat} dB flat, {with} dB");
    // A name says the same as the default.
    let folder = frames(FRAMES, |frame| layer("tex", frame));
    assert_eq!(psnr_db(&report(&folder.text("in"), "--albedo tex")), with);
}

#[test]
fn layers_of_renderers_are_recognised() {
    let names = [
        "ViewLayer.Denoising Albedo",
        "ViewLayer.DiffCol",
        "albedo",
        "diffuse_albedo",
        "DiffuseFilter",
        "VRayDiffuseFilter",
    ];
    for name in names {
        let folder = frames(2, |frame| layer(name, frame));
        let input = folder.text("in");
        assert_eq!(report(&input, "")["albedo"], true, "{name}");
        let text = succeeds(&["info", &input]);
        let read = text.lines().find(|line| line.starts_with("channels read:")).unwrap();
        assert!(["R", "G", "B"].iter().all(|leaf| read.contains(&format!("{name}.{leaf}"))), "{read}");
        // Frames of other kinds have no use for it.
        assert_eq!(
            ran(&input, "--method smr --no-jod --no-flip --gaze 8,4 --backend cpu").json("report.json")["albedo"],
            false
        );
    }
    // In a file, and in a folder, of its own.
    for pass in ["albedo_#.exr", "albedo/#.exr"] {
        let folder = Folder::new();
        for frame in 0..2 {
            let color = if pass.contains('/') { "color/#.exr" } else { "color_#.exr" };
            let path = |name: &str| folder.path(&format!("in/{}", name.replace('#', &format!("{frame:04}"))));
            save(&path(color), &plain(frame));
            save(&path(pass), &layer("", frame));
        }
        assert_eq!(report(&folder.text("in"), "")["albedo"], true, "{pass}");
    }
    // Another name is said, and the first of several is read.
    let folder = frames(2, |frame| layer("tex", frame));
    let input = folder.text("in");
    assert_eq!([&report(&input, "")["albedo"], &report(&input, "--albedo TEX")["albedo"]], [false, true]);
}

/// The only layer of a file is its picture.
#[test]
fn the_picture_is_no_albedo() {
    let folder = Folder::new();
    for frame in 0..2 {
        let motion = plain(frame).into_iter().filter(|(name, _)| name.starts_with("motion"));
        let channels: Vec<_> = motion.chain(layer("albedo", frame)).collect();
        save(&folder.path(&format!("in/f_{frame:04}.exr")), &channels);
    }
    assert_eq!(warned(&folder, &folder.text("in"), "albedo is read")["albedo"], false);
}

/// The report of a run that says this on stderr.
#[track_caller]
fn warned(folder: &Folder, input: &str, expected: &str) -> Value {
    let output = tool(&run(input, &folder.text("warned"), &words(&format!("{PLANNED} --backend cpu"))));
    let said = String::from_utf8(output.stderr).unwrap();
    assert!(output.status.success() && said.contains(expected), "{said}");
    read_json(&folder.path("warned/report.json"))
}

#[test]
fn what_is_no_albedo_is_one_line() {
    let folder = Folder::new();
    let out = folder.text("out");
    let refused = |input: &str, more: &str, expected: &[&str]| {
        refuses(&run(input, &out, &words(&format!("{PLANNED} --backend cpu {more}"))), expected);
    };
    // A name that is not there, or lacks a channel.
    let incomplete =
        frames(2, |frame| layer("albedo", frame).into_iter().filter(|(name, _)| name != "albedo.B").collect());
    let input = incomplete.text("in");
    refused(&input, "--albedo nothing", &["has no nothing for the albedo", "albedo.G, albedo.R", "R/G/B for --albedo"]);
    refused(&input, "--albedo albedo", &["has no albedo for the albedo", "R/G/B for --albedo"]);
    let left_out = |input: &str, expected: &str| assert_eq!(warned(&folder, input, expected)["albedo"], false);
    left_out(&input, "its albedo albedo lacks a channel of R, G, B, and is left out");
    // Of frames, methods and inputs that have no use for it.
    let whole = frames(2, |frame| layer("albedo", frame));
    let input = whole.text("in");
    refuses(&run(&input, &out, &["--albedo", "albedo"]), &["--albedo: ", "add --foveation planned"]);
    let taau = words("--foveation planned --method taau --albedo albedo");
    refuses(&run(&input, &out, &taau), &["--albedo: ", "add smr"]);
    refused(&input, "--albedo scene", &["--albedo: ", "rasterised scenes"]);
    for other in ["builtin:cubes", "analytic:still"] {
        refused(other, "--albedo albedo", &["--albedo: ", "a layer of EXR frames"]);
    }
    // Known nowhere. Where it is known in places, it is used there.
    let of_nan = |unknown: fn(u32) -> bool| {
        frames(2, move |frame| {
            let nan = |[x, y]: [u32; 2], v: f32| if unknown(x) { f32::NAN } else { v + 0.0 * y as f32 };
            let spoilt =
                |image: &Image<f32>| Image::from_fn(SIZE, |[x, y]| nan([x, y], image.at(x as usize, y as usize)));
            layer("albedo", frame).iter().map(|(name, image)| (name.clone(), spoilt(image))).collect()
        })
    };
    let nowhere = of_nan(|_| true);
    refused(&nowhere.text("in"), "", &["its albedo is NaN or infinite at every pixel", "--albedo off"]);
    assert_eq!(report(&nowhere.text("in"), "--albedo off")["albedo"], false);
    let (all, half) = (report(&input, ""), of_nan(|x| x < 48));
    let half = report(&half.text("in"), "");
    assert!(half["albedo"] == true && psnr_db(&half) < psnr_db(&all), "{half}");
    // Of another size: refused if it is named, else left out.
    let other_size = frames(2, |_| vec![]);
    for frame in 0..2 {
        let small = ["R", "G", "B"].map(|leaf| (leaf.to_owned(), Image::filled([48, 30], 0.5)));
        save(&other_size.path(&format!("in/albedo_{frame:04}.exr")), &small);
    }
    let input = other_size.text("in");
    refused(&input, "--albedo albedo", &["parts of different sizes", "motion and albedo of one size"]);
    left_out(&input, "its albedo has 48x30 pixels, not the color's 96x60, and is left out");
    // In some frames alone.
    let some = frames(2, |frame| if frame == 0 { layer("albedo", frame) } else { vec![] });
    refused(&some.text("in"), "", &["f_0001.exr", "has no albedo but", "the same channels in every frame"]);
    assert!(!folder.path("out").exists(), "nothing was written");
}

/// A traced sequence is read back with its albedo.
#[test]
fn traced_frames_have_it() {
    let folder = Folder::new();
    let out = folder.text("out");
    let options = "--size 32x18 --spp 1 --frames 2 --camera lateral --aov depth,motion,albedo --backend cpu";
    succeeds(&[&["trace", "builtin:courtyard", "--out", &out][..], &words(options)].concat());
    assert_eq!(report(&folder.text("out/color"), "")["albedo"], true);
    // And in folders of their own.
    for name in ["color/cameras.json", "gaze.csv"] {
        fs::remove_file(folder.path("out").join(name)).ok();
    }
    let text = succeeds(&["info", &folder.text("out/albedo/000000.exr")]);
    assert!(text.contains("brightest channel") && text.contains("32x18"), "{text}");
}

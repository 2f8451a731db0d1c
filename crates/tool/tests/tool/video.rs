//! Video as input of `compare`, and as output of `compare` and `run`. A script plays `ffmpeg`.

use super::rig::{Folder, TOOL, files, read_json, words};
use afterimage_lab::picture::write_png;
use afterimage_lab::source::{ColorFrames, ReadLimits};
use image::{Rgb, RgbImage};
use std::fs;
use std::os::unix::fs::PermissionsExt;
use std::process::{Command, Output};
use std::time::{Duration, Instant};

const SIZE: [u32; 2] = [96, 64];
const FRAMES: u32 = 3;

/// A smooth picture in colors, which half the chroma samples describe as well.
fn picture(frame: u32) -> RgbImage {
    RgbImage::from_fn(SIZE[0], SIZE[1], |x, y| {
        let wave = |k: f64, phase: f64| {
            let at = k * f64::from(x + 2 * frame) + 0.05 * f64::from(y) + phase;
            (128.0 + 90.0 * at.sin()) as u8
        };
        Rgb([wave(0.06, 0.0), wave(0.05, 1.0), wave(0.07, 2.5)])
    })
}

/// Kr and Kb of ITU-R BT.601 and BT.709.
const BT601: [f64; 2] = [0.299, 0.114];
const BT709: [f64; 2] = [0.2126, 0.0722];

/// How a test codes a video: name of the chroma, samples of luma a chroma sample, place of the first chroma sample.
struct Coding {
    name: &'static str,
    step: [u32; 2],
    at: [f64; 2],
    is_full_range: bool,
    matrix: [f64; 2],
}

const PLAIN: Coding = Coding { name: "444", step: [1, 1], at: [0.0, 0.0], is_full_range: false, matrix: BT601 };

impl Coding {
    /// Y', Cb and Cr of a place in a picture, between its pixels.
    fn samples(&self, picture: &RgbImage, x: f64, y: f64) -> [u8; 3] {
        let last = [picture.width() - 1, picture.height() - 1].map(f64::from);
        let (x, y) = (x.clamp(0.0, last[0]), y.clamp(0.0, last[1]));
        let near = |x: f64, y: f64| picture.get_pixel(x as u32, y as u32).0.map(f64::from);
        let corners = [(x.floor(), y.floor()), (x.ceil(), y.floor()), (x.floor(), y.ceil()), (x.ceil(), y.ceil())];
        let shares = [
            (1.0 - x.fract()) * (1.0 - y.fract()),
            x.fract() * (1.0 - y.fract()),
            (1.0 - x.fract()) * y.fract(),
            x.fract() * y.fract(),
        ];
        let mut rgb = [0.0; 3];
        for ((x, y), share) in corners.into_iter().zip(shares) {
            (0..3).for_each(|c| rgb[c] += share * near(x, y)[c] / 255.0);
        }
        let [kr, kb] = self.matrix;
        let luma = kr * rgb[0] + (1.0 - kr - kb) * rgb[1] + kb * rgb[2];
        let [black, white, chroma] = if self.is_full_range { [0.0, 255.0, 255.0] } else { [16.0, 235.0, 224.0] };
        let difference = |v: f64, k: f64| 128.0 + chroma * (v - luma) / (2.0 * (1.0 - k));
        [black + (white - black) * luma, difference(rgb[2], kb), difference(rgb[0], kr)].map(|v| v.round() as u8)
    }

    fn y4m(&self, fps: &str, frames: u32) -> Vec<u8> {
        let range = if self.is_full_range { "FULL" } else { "LIMITED" };
        let [w, h] = SIZE;
        let mut bytes = format!("YUV4MPEG2 W{w} H{h} F{fps} Ip A1:1 C{} XCOLORRANGE={range}\n", self.name).into_bytes();
        for frame in 0..frames {
            let picture = picture(frame);
            bytes.extend(b"FRAME\n");
            for plane in 0..3 {
                let (step, at) = if plane == 0 { ([1, 1], [0.0; 2]) } else { (self.step, self.at) };
                for (y, x) in (0..h / step[1]).flat_map(|y| (0..w / step[0]).map(move |x| (y, x))) {
                    let [x, y] = [f64::from(x * step[0]) + at[0], f64::from(y * step[1]) + at[1]];
                    bytes.push(self.samples(&picture, x, y)[plane]);
                }
            }
        }
        bytes
    }
}

/// The same frames as PNG.
fn png(folder: &Folder) -> String {
    fs::create_dir_all(folder.path("png")).unwrap();
    for frame in 0..FRAMES {
        write_png(&folder.path(&format!("png/{frame}.png")), &picture(frame)).unwrap();
    }
    folder.text("png")
}

/// Runs the tool with this `PATH`.
fn with_path(path: &str, args: &[&str]) -> Output {
    let mut command = Command::new(TOOL.0);
    command.args(args).env("PATH", path).env("NODEVICE_SELECT", "1").current_dir(afterimage_testing::workspace());
    command.output().unwrap()
}

/// A folder with a program `ffmpeg`, before the usual ones.
fn ffmpeg(folder: &Folder, script: &str) -> String {
    fs::create_dir_all(folder.path("bin")).unwrap();
    let program = folder.write("bin/ffmpeg", format!("#!/bin/sh\n{script}\n").as_bytes());
    fs::set_permissions(&program, fs::Permissions::from_mode(0o755)).unwrap();
    format!("{}:{}", folder.text("bin"), std::env::var("PATH").unwrap())
}

/// Finds the argument of `-i` as `$in` and the last one as `$out`.
const ARGUMENTS: &str =
    "for a in \"$@\"; do [ \"$out\" = -i ] && in=${a#file:}; out=$a; done; out=${out#file:}; echo $$ > \"${0%/*}/pid\"";

const OPTIONS: &str = "--no-jod --no-flip";

/// PSNR of a video against the PNG frames, and the frames a second of the report.
#[track_caller]
fn scored(folder: &Folder, path: &str, video: &str) -> (f64, f64) {
    let (png, out) = (png(folder), folder.text("out"));
    let ran = with_path(path, &[&["compare", &png, video, "--out", &out][..], &words(OPTIONS)].concat());
    assert!(ran.status.success(), "{}", String::from_utf8_lossy(&ran.stderr));
    let report = read_json(&folder.path("out/report.json"));
    let method = report["methods"].as_object().unwrap().values().next().unwrap();
    (method["psnr_db"].as_f64().unwrap(), report["fps"].as_f64().unwrap())
}

#[track_caller]
fn refused(output: &Output, code: i32, words: &[&str]) {
    let stderr = String::from_utf8_lossy(&output.stderr);
    println!("{}", stderr.trim_end());
    assert_eq!((output.status.code(), stderr.lines().count()), (Some(code), 1), "{stderr}");
    for word in words {
        assert!(stderr.contains(word), "'{word}' is missing: {stderr}");
    }
}

#[test]
fn y4m_of_every_coding_is_read_without_ffmpeg() {
    let folder = Folder::new();
    let coded = |name, step, at| Coding { name, step, at, ..PLAIN };
    for coding in [
        PLAIN,
        Coding { is_full_range: true, ..PLAIN },
        coded("422", [2, 1], [0.0, 0.0]),
        coded("420jpeg", [2, 2], [0.5, 0.5]),
        coded("420mpeg2", [2, 2], [0.0, 0.5]),
        Coding { is_full_range: true, ..coded("420paldv", [2, 2], [0.0, 0.0]) },
    ] {
        let video = folder.write("clip.y4m", &coding.y4m("30000:1001", FRAMES));
        let (psnr_db, fps) = scored(&folder, "", &video);
        println!("{} full range {}: {psnr_db:.2} dB", coding.name, coding.is_full_range);
        assert!(psnr_db > 48.0, "{}: {psnr_db}", coding.name);
        assert!((fps - 29.97).abs() < 1e-2, "{fps}");
    }
    // What is coded otherwise than it says is not close.
    let wrong = String::from_utf8_lossy(&PLAIN.y4m("25:1", 0)).replace("LIMITED", "FULL").into_bytes();
    let frames = PLAIN.y4m("25:1", FRAMES);
    let header = frames.iter().position(|byte| *byte == b'\n').unwrap() + 1;
    let video = folder.write("clip.y4m", &[wrong, frames[header..].to_vec()].concat());
    assert!(scored(&folder, "", &video).0 < 35.0);
    // A reference in video, and fewer frames than it has.
    let video = folder.write("clip.y4m", &PLAIN.y4m("25:1", FRAMES + 2));
    let (png, out) = (png(&folder), folder.text("out"));
    let compare = ["compare", &video, &png, "--out", &out, "--no-jod", "--no-flip"];
    refused(&with_path("", &compare), 2, &["png: has 3 frames", "has 5", "--frames 3"]);
    assert!(with_path("", &[&compare[..], &["--frames", "3"]].concat()).status.success());
}

#[test]
fn other_videos_are_read_through_ffmpeg() {
    let folder = Folder::new();
    let says = |color: &str| format!("echo '  Stream #0:0(und): Video: h264 (High), {color}, 96x64, 25 fps' >&2");
    let plays = format!("{ARGUMENTS}; cat \"$in\"");
    // The tag of the stream is its matrix, and without one it is that of its size.
    for (color, matrix) in [("yuv420p(tv, bt709, progressive)", BT709), ("yuv420p(tv, progressive)", BT601)] {
        let path = ffmpeg(&folder, &format!("{}; {plays}", says(color)));
        for (coded, is_near) in [(matrix, true), (if matrix == BT709 { BT601 } else { BT709 }, false)] {
            for ending in ["mp4", "mkv", "webm", "mov"] {
                let video = Coding { matrix: coded, ..PLAIN }.y4m("25:1", FRAMES);
                let (psnr_db, fps) = scored(&folder, &path, &folder.write(&format!("clip.{ending}"), &video));
                assert_eq!(psnr_db > 45.0, is_near, "{color} {ending}: {psnr_db}");
                assert!((fps - 25.0).abs() < 1e-6);
            }
        }
    }
    let video = folder.write("clip.mp4", &PLAIN.y4m("25:1", FRAMES));
    let (png, out) = (png(&folder), folder.text("out"));
    let compare = |path: &str| with_path(path, &["compare", &png, &video, "--out", &out, "--no-jod", "--no-flip"]);
    let wide = format!("{}; {plays}", says("yuv420p10le(tv, bt2020nc/bt2020/smpte2084)"));
    refused(&compare(&ffmpeg(&folder, &wide)), 2, &["clip.mp4", "high dynamic range", "convert it to BT.709"]);
    // Without a program, and with one that fails or is killed, at the start or in a frame.
    refused(&compare(&folder.text("none")), 2, &["clip.mp4", "ffmpeg", "not found", "install it", ".y4m"]);
    for (script, words) in [
        ("echo 'moov atom not found' >&2; exit 1", "ffmpeg (moov atom not found)"),
        ("exec kill -9 $$", "signal: 9"),
        ("printf 'YUV4MPEG2 W96 '; exit 3", "exit status: 3"),
    ] {
        refused(&compare(&ffmpeg(&folder, script)), 2, &["clip.mp4: is not decoded", words, "export it again"]);
    }
    let fails = format!("{plays}; echo 'error while decoding' >&2; exit 1");
    refused(&compare(&ffmpeg(&folder, &fails)), 2, &["clip.mp4: is not decoded", "error while decoding"]);
    let dies = format!("{ARGUMENTS}; head -c 30000 \"$in\"; kill -9 $$");
    refused(&compare(&ffmpeg(&folder, &dies)), 2, &["clip.mp4: is not decoded", "signal: 9"]);
    // It says much, which nobody reads, and closes its pipe without an end.
    let started = Instant::now();
    let talks = format!("yes 'error while decoding' | head -n 100000 >&2; {plays}");
    assert!(scored(&folder, &ffmpeg(&folder, &talks), &video).0 > 45.0);
    refused(&compare(&ffmpeg(&folder, "exec >&-; exec sleep 60 2>&-")), 2, &["clip.mp4: is not decoded", "signal: 9"]);
    assert!(started.elapsed() < Duration::from_secs(40), "{:?}", started.elapsed());
    // One that is not needed any longer is ended.
    let more = format!("{ARGUMENTS}; cat \"$in\"; exec sleep 60");
    let path = ffmpeg(&folder, &more);
    let short = ["compare", &png, &video, "--out", &out, "--no-jod", "--no-flip", "--frames", "3"];
    assert!(with_path(&path, &short).status.success());
    let pid = fs::read_to_string(folder.path("bin/pid")).unwrap();
    assert!(!std::path::Path::new(&format!("/proc/{}", pid.trim())).exists() || !cfg!(target_os = "linux"));
}

#[test]
fn damaged_y4m_is_one_line() {
    let folder = Folder::new();
    let (png, out) = (png(&folder), folder.text("out"));
    let whole = PLAIN.y4m("25:1", FRAMES);
    let header = whole.iter().position(|byte| *byte == b'\n').unwrap() + 1;
    for (bytes, words) in [
        (&whole[..whole.len() - 7], "truncated"),
        (&whole[..header + 3], "truncated"),
        (&whole[..header], "has no frame"),
        (&[&whole[..header], b"NOISE\n"].concat(), "a frame has no header"),
        (b"", "does not start with YUV4MPEG2"),
        (b"YUV4MPEG2 W96 H64 F25:1 C420p10\n", "ffmpeg -i IN -pix_fmt yuv444p OUT.y4m"),
    ] {
        let video = folder.write("clip.y4m", bytes);
        let ran = with_path("", &["compare", &png, &video, "--out", &out]);
        refused(&ran, 2, &["clip.y4m: ", words]);
    }
    assert!(!folder.path("out").exists());
}

/// Panels of a written video: its frames are those of the run, under a line of names.
#[test]
fn videos_show_reference_and_methods() {
    let folder = Folder::new();
    let (out, video) = (folder.text("out"), folder.text("made/clip.y4m"));
    let options = "--size 120x80 --frames 3 --fps 24 --method none,smr --reference --no-jod --no-flip --backend cpu";
    let run = |path: &str, video: &str| {
        let run = ["run", "analytic:lateral", "--out", &out, "--video", video];
        with_path(path, &[&run[..], &words(options)].concat())
    };
    let ran = run("", &video);
    assert!(ran.status.success(), "{}", String::from_utf8_lossy(&ran.stderr));
    assert_eq!(files(&folder.path("made")), ["clip.y4m"]);
    let frames = ColorFrames::open(&video, &ReadLimits::default(), None).unwrap();
    assert_eq!((frames.len(), frames.fps(), frames.size()), (3, Some(24.0), [240, 204]));
    let shown = frames.read(2).unwrap().color;
    for (name, corner) in [("reference", [0, 22]), ("none", [120, 22]), ("smr", [0, 124])] {
        let still = ColorFrames::open(&folder.text(&format!("out/{name}/000002.png")), &ReadLimits::default(), None);
        let still = still.unwrap().read(0).unwrap().color;
        let (mut sum, mut count) = (0.0, 0);
        for (x, y) in (0..120).flat_map(|x| (0..80).map(move |y| (x, y))) {
            let [a, b] = [still.at(x, y), shown.at(x + corner[0], y + corner[1])];
            sum += (0..3).map(|c| (a[c] - b[c]).abs()).sum::<f32>() / 3.0;
            count += 1;
        }
        let mean = sum / count as f32;
        println!("{name}: mean difference {mean:.5}");
        assert!(mean < 0.01, "{name}: {mean}");
    }
    // The same through ffmpeg, which gets the whole stream.
    let path = ffmpeg(&folder, &format!("{ARGUMENTS}; cat > \"$out\""));
    let ran = run(&path, &folder.text("made/clip.mp4"));
    assert!(ran.status.success(), "{}", String::from_utf8_lossy(&ran.stderr));
    assert_eq!(fs::read(folder.path("made/clip.mp4")).unwrap(), fs::read(&video).unwrap());
    // Comparisons write one, too.
    let [reference, smr] = ["out/reference", "out/smr"].map(|name| folder.text(name));
    let both = folder.text("made/both.y4m");
    let compare = ["compare", &reference, &smr, "--out", &folder.text("compared"), "--video", &both];
    assert!(with_path("", &[&compare[..], &words(OPTIONS)].concat()).status.success());
    assert_eq!(ColorFrames::open(&both, &ReadLimits::default(), None).unwrap().size(), [240, 102]);
    // What cannot be written leaves nothing; an older file stays.
    let made = files(&folder.path("made"));
    refused(&run("", &folder.text("made/clip.avi")), 2, &["clip.avi", "FILE.mp4 or FILE.y4m"]);
    fs::remove_dir_all(folder.path("out")).unwrap();
    refused(&run(&folder.text("none"), &folder.text("made/new.mp4")), 2, &["new.mp4", "ffmpeg", "install it"]);
    assert!(!folder.path("out").exists(), "it fails before the run");
    for (script, why) in [
        ("echo 'Unknown encoder libx264' >&2; exit 1", "ffmpeg: Unknown encoder libx264"),
        ("head -c 1000 > /dev/null; kill -9 $$", "signal: 9"),
    ] {
        let ran = run(&ffmpeg(&folder, script), &folder.text("made/clip.mp4"));
        refused(&ran, 1, &["clip.mp4: cannot be written", why, ".y4m file, which needs no ffmpeg"]);
    }
    assert_eq!(files(&folder.path("made")), made);
}

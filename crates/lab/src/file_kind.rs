//! Kinds of files: by their ending in any case, and by their first bytes where the ending is none that is known.

use std::fs::File;
use std::io::Read;
use std::path::Path;

/// Endings of stills and scenes.
const KNOWN: [&str; 6] = ["exr", "png", "jpg", "jpeg", "gltf", "glb"];

/// Ending of a file of this kind, in lower case and without the dot.
pub(crate) fn kind(path: &Path) -> String {
    let ending = ending(path);
    if KNOWN.contains(&ending.as_str()) || !path.is_file() {
        return ending;
    }
    by_contents(path).map_or(ending, str::to_owned)
}

/// Ending of a name in lower case, without the dot; empty without one.
pub(crate) fn ending(path: &Path) -> String {
    path.extension().map(|e| e.to_string_lossy().to_lowercase()).unwrap_or_default()
}

/// Endings of scenes that are not read.
const SCENES: [&str; 15] =
    ["obj", "fbx", "usd", "usda", "usdc", "usdz", "ply", "stl", "dae", "abc", "3ds", "blend", "max", "ma", "mb"];
/// Endings of video.
const VIDEOS: [&str; 9] = ["mp4", "mkv", "mov", "avi", "webm", "y4m", "m4v", "mpg", "gif"];
/// Endings of pictures that are not read.
const PICTURES: [&str; 9] = ["tif", "tiff", "hdr", "webp", "bmp", "tga", "dpx", "heic", "avif"];

/// Whether a file is a video, by its ending.
pub(crate) fn is_video(path: &Path) -> bool {
    VIDEOS.contains(&ending(path).as_str())
}

/// What to do with a file of a kind that people have and that is not read: problem and remedy.
pub fn other_kind(path: &Path) -> Option<(String, &'static str)> {
    let ending = ending(path);
    let is = |kinds: &[&str]| kinds.contains(&ending.as_str());
    if is(&SCENES) {
        let problem = format!("is a .{ending} scene, and scenes are read as .gltf or .glb");
        Some((problem, "export it as glTF 2.0 (.glb), or convert it with Blender"))
    } else if is(&VIDEOS) {
        let problem = format!("is a video (.{ending}), and moving frames need motion vectors, which a video lacks");
        Some((
            problem,
            "render .exr frames with motion vectors, or give one picture (.exr, .png, .jpg, .jpeg) as a still",
        ))
    } else if is(&PICTURES) {
        Some((format!("is a picture of a kind that is not read (.{ending})"), "convert it to .exr or .png"))
    } else if ending == "edf" {
        let problem = "is a recording (.edf), which only programs of the tracker's vendor read";
        Some((problem.into(), "convert an EyeLink's with edf2asc, and give the .asc file"))
    } else {
        None
    }
}

/// The folder of a pattern of file names (`f_%04d.exr`, `f_####.exr`, `f.$F4.exr`, `f.*.exr`) that is no file itself.
pub(crate) fn folder_of_pattern(path: &Path) -> Option<&Path> {
    let name = path.file_name()?.to_str()?;
    let is_printf =
        name.split('%').skip(1).any(|rest| rest.trim_start_matches(|c: char| c.is_ascii_digit()).starts_with('d'));
    let is_pattern = is_printf || ["#", "@", "*", "?", "$F", "<"].iter().any(|mark| name.contains(mark));
    let folder = path.parent().map(|folder| if folder.as_os_str().is_empty() { Path::new(".") } else { folder })?;
    (is_pattern && !path.exists() && folder.is_dir()).then_some(folder)
}

fn by_contents(path: &Path) -> Option<&'static str> {
    let mut first = Vec::new();
    File::open(path).ok()?.take(4).read_to_end(&mut first).ok()?;
    match first.as_slice() {
        [0x76, 0x2F, 0x31, 0x01] => Some("exr"),
        [0x89, b'P', b'N', b'G'] => Some("png"),
        [0xFF, 0xD8, 0xFF, _] => Some("jpg"),
        b"glTF" => Some("glb"),
        _ => None,
    }
}

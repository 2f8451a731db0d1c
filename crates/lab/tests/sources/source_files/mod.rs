//! File sources: stills, EXR sequences, their motion vectors and cameras, and damaged files.

mod bad_input;
mod conventions;
mod data;
mod formats;
mod motion;

use afterimage::Image;
use afterimage_lab::error::InputError;
use afterimage_lab::source::ReadLimits;
use afterimage_lab::source::exr_file::{FrameToWrite, write};
use exr::prelude::{AnyChannel, AnyChannels, Encoding, FlatSamples, Layer, LayerAttributes, SmallVec, WritableImage};
use std::path::{Path, PathBuf};

/// The path of a file in a temporary folder of its own.
fn temporary(name: &str) -> (tempfile::TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    (folder, path)
}

fn limits() -> ReadLimits {
    ReadLimits::default()
}

/// A small image whose pixels all differ.
fn picture(size: [u32; 2]) -> Image<[f32; 3]> {
    Image::from_fn(size, |[x, y]| [x as f32 / 8.0, y as f32 / 4.0, (x * y % 7) as f32])
}

/// Vectors that differ from pixel to pixel.
fn vectors(size: [u32; 2], offset: f32) -> Image<[f32; 2]> {
    Image::from_fn(size, |[x, y]| [x as f32 * 0.25 + offset, y as f32 * -0.5 - offset])
}

/// Images of a synthetic frame other than color.
#[derive(Clone, Copy)]
struct Extras {
    depth: bool,
    motion: bool,
    to_next: bool,
}

const ALL: Extras = Extras { depth: true, motion: true, to_next: true };

fn write_frame(path: &Path, size: [u32; 2], extras: Extras) {
    let (color, depth) = (picture(size), Image::filled(size, 2.0f32));
    let (motion, to_next) = (vectors(size, 1.0), vectors(size, 3.0));
    let frame = FrameToWrite {
        depth: extras.depth.then_some(&depth),
        motion: extras.motion.then_some(&motion),
        motion_to_next: extras.to_next.then_some(&to_next),
        ..FrameToWrite::color(&color)
    };
    write(path, &frame).unwrap();
}

/// A folder with `n` frames, named from `frame_0000.exr` on.
fn folder_of(n: u32, size: [u32; 2], extras: Extras) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    for i in 0..n {
        write_frame(&folder.path().join(format!("frame_{i:04}.exr")), size, extras);
    }
    folder
}

/// Writes an EXR file of one part.
fn save(path: &Path, size: (usize, usize), encoding: Encoding, channels: Vec<AnyChannel<FlatSamples>>) {
    let channels = AnyChannels::sort(SmallVec::from_vec(channels));
    let layer = Layer::new(size, LayerAttributes::default(), encoding, channels);
    exr::prelude::Image::from_layer(layer).write().to_file(path).unwrap();
}

/// Linear light of an encoded value.
fn srgb(v: f64) -> f32 {
    (if v <= 0.04045 { v / 12.92 } else { ((v + 0.055) / 1.055).powf(2.4) }) as f32
}

/// Overwrites the data of attribute `name` of type `kind` with `value`.
fn patch(bytes: &mut [u8], name: &str, kind: &str, value: &[i32]) {
    let key = format!("{name}\0{kind}\0");
    let at = bytes.windows(key.len()).position(|w| w == key.as_bytes()).unwrap();
    for (i, v) in value.iter().enumerate() {
        let start = at + key.len() + 4 + 4 * i;
        bytes[start..start + 4].copy_from_slice(&v.to_le_bytes());
    }
}

/// Checks that an error is one line, has a remedy, and contains all words.
#[track_caller]
fn assert_says(error: &InputError, words: &[&str]) {
    let text = error.to_string();
    assert!(!text.contains('\n'), "more than one line: {text:?}");
    assert!(!error.message().remedy.is_empty(), "no remedy: {text}");
    for word in words {
        assert!(text.contains(word), "{word:?} is not in: {text}");
    }
}

/// Checks that an error is a limit of pixels that needs this many megapixels.
#[track_caller]
fn assert_needs_megapixels(error: &InputError, megapixels: u64) {
    match error {
        InputError::Limit { exceeded, .. } => assert_eq!(exceeded.needed_megapixels(), Some(megapixels), "{error}"),
        _ => panic!("not a limit: {error}"),
    }
}

/// The error of a result whose value has no `Debug`.
#[track_caller]
fn error_of<T>(result: Result<T, InputError>) -> InputError {
    result.map(|_| ()).expect_err("was accepted")
}

//! Invalid inputs: the error names the file and a remedy.

use super::{ALL, Extras, folder_of, limits, patch, picture, save, temporary, write_frame};
use super::{assert_needs_megapixels, assert_says, error_of};
use crate::hostile::claim_size;
use afterimage_lab::error::InputError;
use afterimage_lab::source::exr_file::{ExrHeader, FrameToWrite, write};
use afterimage_lab::source::{FrameSource, ReadLimits, SceneOptions, SequenceSource, StillSource, open};
use exr::prelude::*;
use image::{DynamicImage, ImageBuffer, Rgb};
use std::path::Path;

fn refused(path: &Path) -> InputError {
    error_of(open(path.to_str().unwrap(), &limits(), &SceneOptions::default()))
}

#[test]
fn paths_and_kinds() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    for name in ["none", "none.exr", "none.png", "none.jpg"] {
        assert_says(&refused(&at(name)), &[name, "does not exist"]);
    }
    assert_says(&refused(folder.path()), &["no .exr", "one image"]);
    std::fs::write(at("clip.mp4"), b"x").unwrap();
    assert_says(&refused(&at("clip.mp4")), &["clip.mp4", ".exr", ".png", ".jpg", ".jpeg"]);
    for scene in ["builtin:cornell", "scene.gltf", "scene.GLB"] {
        let e = error_of(open(scene, &limits(), &SceneOptions::default()));
        assert_says(&e, &[scene, "renderer", "EXR frames"]);
    }
    std::fs::write(at("empty.exr"), b"").unwrap();
    assert_says(&refused(&at("empty.exr")), &["empty.exr", "is empty"]);
    for name in ["text.exr", "text.png", "text.jpg"] {
        std::fs::write(at(name), b"this is not an image at all, but text").unwrap();
        assert_says(&refused(&at(name)), &[name, "export it again"]);
    }
    std::fs::create_dir(at("dir.png")).unwrap();
    assert_says(&error_of(StillSource::open(&at("dir.png"), &limits())), &["dir.png", "is a folder"]);
}

#[test]
fn frames_that_do_not_fit_together() {
    let still = Extras { motion: false, to_next: false, ..ALL };
    for (size, extras, words) in [
        ([8, 5], ALL, &["8x5", "8x4", "one size"][..]),
        ([8, 4], still, &["has no motion vectors to the previous frame", "every frame"]),
        ([8, 4], Extras { to_next: false, ..ALL }, &["has no motion vectors to the next frame"]),
        ([8, 4], Extras { depth: false, ..ALL }, &["has no depth"]),
    ] {
        let folder = folder_of(3, [8, 4], ALL);
        write_frame(&folder.path().join("frame_0002.exr"), size, extras);
        let e = refused(folder.path());
        assert_says(&e, words);
        assert!(e.message().subject.ends_with("frame_0002.exr"), "{e}");
    }
    let folder = folder_of(4, [8, 4], ALL);
    std::fs::remove_file(folder.path().join("frame_0002.exr")).unwrap();
    assert_says(&refused(folder.path()), &["from 1 to 3", "missing frames"]);
}

#[test]
fn a_sequence_needs_vectors_for_the_way_it_is_played() {
    let none = Extras { motion: false, to_next: false, ..ALL };
    let folder = folder_of(2, [8, 4], none);
    assert_says(&refused(folder.path()), &["frame_0000.exr", "no motion vectors", "Vector.X/Y", "motion.X/Y"]);

    let forward = Extras { to_next: false, ..ALL };
    let folder = folder_of(3, [8, 4], forward);
    let mut source = SequenceSource::open(folder.path(), &limits()).unwrap();
    assert!(source.frame(2).is_ok());
    let words = ["frame_0001.exr", "backwards", "Vector.Z/W", "motion.Z/W"];
    assert_says(&source.frame(3).unwrap_err(), &words);

    std::fs::remove_file(folder.path().join("frame_0001.exr")).unwrap();
    assert_says(&source.frame(1).unwrap_err(), &["frame_0001.exr", "does not exist"]);
    write_frame(&folder.path().join("frame_0001.exr"), [9, 4], forward);
    assert_says(&source.frame(1).unwrap_err(), &["frame_0001.exr", "has changed"]);
}

/// Every truncation of a file is detected from its header, tables and last chunk alone.
#[test]
fn every_truncation_is_noticed_before_decoding() {
    let folder = folder_of(1, [40, 40], ALL);
    let path = folder.path().join("frame_0000.exr");
    let whole = std::fs::read(&path).unwrap();
    let cut = folder.path().join("frame_0001.exr");
    for length in 0..whole.len() {
        std::fs::write(&cut, &whole[..length]).unwrap();
        assert_says(&error_of(ExrHeader::open(&cut, &limits())), &["frame_0001.exr"]);
    }
    let e = error_of(SequenceSource::open(folder.path(), &limits()));
    assert_says(&e, &["frame_0001.exr", "truncated", "copy or export it again"]);
}

#[test]
fn missing_color_lists_what_is_there() {
    let folder = folder_of(2, [4, 4], ALL);
    let path = folder.path().join("frame_0001.exr");
    let zeros = || FlatSamples::F32(vec![0.0; 16]);
    let names = ["ViewLayer.Depth.Z", "ViewLayer.Mist.Z", "R", "G"];
    save(&path, (4, 4), Encoding::FAST_LOSSLESS, names.map(|n| AnyChannel::new(n, zeros())).into());
    let words = ["frame_0001.exr", "no color", "ViewLayer.Depth.Z, ViewLayer.Mist.Z", "Combined.R/G/B"];
    assert_says(&refused(folder.path()), &words);
}

#[test]
fn absurd_claims_are_refused_from_the_header() {
    let folder = folder_of(1, [8, 4], ALL);
    let path = folder.path().join("frame_0000.exr");
    let whole = std::fs::read(&path).unwrap();
    let with = |windows: &[&str], window: [i32; 4]| {
        let mut bytes = whole.clone();
        for name in windows {
            patch(&mut bytes, name, "box2i", &window);
        }
        std::fs::write(&path, &bytes).unwrap();
        refused(&path)
    };
    let both = ["dataWindow", "displayWindow"];
    let e = with(&both, [0, 0, 99_999, 99_999]);
    assert_says(&e, &["frame_0000.exr", "100000x100000", "64 million"]);
    assert_needs_megapixels(&e, 10_000);
    assert_says(&with(&both, [0, 0, 1_000_000_000, 1_000_000_000]), &["frame_0000.exr", "1000000001"]);
    // Within the limit, but more chunks than the file has.
    assert_says(&with(&both, [0, 0, 7, 7_000_000]), &["frame_0000.exr", "truncated"]);
    assert_says(&with(&["displayWindow"], [0, 0, 99_999, 99_999]), &["100000x100000", "64 million"]);
    assert_says(&with(&["displayWindow"], [8, 0, 15, 3]), &["beside its display window"]);

    let e = error_of(StillSource::open(&path, &ReadLimits { max_pixels: 0 }));
    assert_needs_megapixels(&e, 1);
    assert_eq!(ReadLimits::default().max_pixels, 64_000_000);
}

#[test]
fn one_huge_tile_is_refused() {
    let (_folder, path) = temporary("tile.exr");
    // 12 channels of 4 bytes in one block: 48 bytes a pixel, three times what a block may take.
    let names = ["R", "G", "B"].map(str::to_owned).into_iter().chain((0..9).map(|i| format!("aux{i}")));
    let channels = names.map(|n| AnyChannel::new(n.as_str(), FlatSamples::F32(vec![0.5; 64 * 64]))).collect();
    let encoding = Encoding { blocks: Blocks::Tiles(Vec2(4096, 4096)), ..Encoding::FAST_LOSSLESS };
    save(&path, (64, 64), encoding, channels);
    assert!(StillSource::open(&path, &limits()).is_ok());
    let tight = ReadLimits { max_pixels: 64 * 64 };
    let e = error_of(StillSource::open(&path, &tight));
    assert_says(&e, &["tile.exr", "smaller tiles", "raise the limit"]);
    // 12 channels of 4 bytes for 4096 pixels, over 16 bytes a pixel.
    assert!(matches!(&e, InputError::Limit { exceeded, .. } if exceeded.needed == Some(12 * 4 * 4096 / 16)), "{e:?}");
}

#[test]
fn subsampled_channels_are_refused() {
    let (_folder, path) = temporary("yc.exr");
    let zeros = || FlatSamples::F32(vec![0.0; 64]);
    save(&path, (8, 8), Encoding::FAST_LOSSLESS, vec![AnyChannel::new("Y", zeros())]);
    let mut bytes = std::fs::read(&path).unwrap();
    // The channel list: name, zero, type, flags, then the sampling in x and y.
    let key = b"chlist\0";
    let at = bytes.windows(key.len()).position(|w| w == key).unwrap() + key.len() + 4 + 2 + 8;
    bytes[at..at + 8].copy_from_slice(&[2, 0, 0, 0, 2, 0, 0, 0]);
    std::fs::write(&path, &bytes).unwrap();
    assert_says(&refused(&path), &["yc.exr", "subsampled", "RGB"]);
}

#[test]
fn png_and_jpeg_keep_the_same_limits() {
    let flat = DynamicImage::ImageRgb8(ImageBuffer::from_pixel(16, 8, Rgb([1, 2, 3])));
    let (folder, png) = temporary("a.png");
    flat.save(&png).unwrap();
    let mut bytes = std::fs::read(&png).unwrap();
    claim_size(&mut bytes, [100_000, 90_000]);
    std::fs::write(&png, &bytes).unwrap();
    let e = refused(&png);
    assert_says(&e, &["a.png", "100000x90000", "64 million"]);
    assert_needs_megapixels(&e, 9000);
    claim_size(&mut bytes, [0, 90_000]);
    std::fs::write(&png, &bytes).unwrap();
    assert_says(&refused(&png), &["a.png", "export it again"]);

    let jpg = folder.path().join("a.jpg");
    flat.save(&jpg).unwrap();
    let mut bytes = std::fs::read(&jpg).unwrap();
    let sof = bytes.windows(2).position(|w| w == [0xFF, 0xC0]).unwrap();
    bytes[sof + 5..sof + 9].copy_from_slice(&[0xFF, 0xFE, 0xFF, 0xFD]);
    std::fs::write(&jpg, &bytes).unwrap();
    let e = refused(&jpg);
    assert_says(&e, &["a.jpg", "65533x65534"]);
    assert_needs_megapixels(&e, 4295);
}

#[test]
fn cameras_that_do_not_belong() {
    let folder = folder_of(2, [8, 4], ALL);
    let json = folder.path().join("cameras.json");
    let one = "[[1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]]";
    let bent = "[[1,0.2,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]]";
    let frame = |n: u32, m: &str| format!(r#"{{"frame":{n},"camera_to_world":{m}}}"#);
    let frames = |list: &[String]| format!(r#"{{"frames":[{}]}}"#, list.join(","));
    let cases = [
        ("{".to_owned(), "not the expected JSON"),
        (r#"{"fps":"fast"}"#.to_owned(), "not the expected JSON"),
        (r#"{"fps":0}"#.to_owned(), "fps is 0"),
        (r#"{"horizontal_fov_deg":180}"#.to_owned(), "horizontal field of view is 180"),
        (r#"{"width":4,"height":8}"#.to_owned(), "4x8"),
        (frames(&[frame(0, one), frame(7, one)]), "no camera for frame 1"),
        (frames(&[frame(0, one), frame(1, bent)]), "camera_to_world of frame 1 shears"),
        (frames(&[frame(0, one), r#"{"frame":1}"#.to_owned()]), "1 of its 2 frames"),
    ];
    for (text, word) in cases {
        std::fs::write(&json, &text).unwrap();
        assert_says(&refused(folder.path()), &["cameras.json", word]);
    }
    std::fs::write(&json, frames(&[frame(1, one), frame(0, one)])).unwrap();
    let mut source = SequenceSource::open(folder.path(), &limits()).unwrap();
    assert!(source.frame(1).unwrap().previous_from_current.is_some());
}

#[test]
fn a_sequence_is_opened_without_decoding_it() {
    let folder = folder_of(3, [40, 40], ALL);
    let path = folder.path().join("frame_0001.exr");
    let mut bytes = std::fs::read(&path).unwrap();
    let end = bytes.len();
    bytes[end - 60..end - 20].fill(0xA5);
    std::fs::write(&path, &bytes).unwrap();
    let mut source = SequenceSource::open(folder.path(), &limits()).unwrap();
    assert!(source.frame(0).is_ok());
    assert_says(&source.frame(1).unwrap_err(), &["frame_0001.exr", "export it again"]);
    assert!(source.frame(2).is_ok());
    write(&path, &FrameToWrite::color(&picture([40, 40]))).unwrap();
    assert_says(&source.frame(1).unwrap_err(), &["frame_0001.exr", "has changed"]);
}

/// A DWA chunk starts with counters that its decoder trusts: one of 32 GB would abort the process.
#[test]
fn dwa_counters_do_not_set_memory_aside() {
    let (_folder, path) = temporary("dwaa_lines.exr");
    let whole = std::fs::read(afterimage_testing::workspace().join("fixtures/fuzz/exr/dwaa_lines.exr")).unwrap();
    // The only chunk is at the offset in the table's only entry; its data follows the line number and the size.
    let word = |at: usize| u64::from_le_bytes(whole[at..at + 8].try_into().unwrap());
    let chunk = (8..whole.len() - 8).find(|&at| word(at - 8) == at as u64).unwrap();
    for counter in 1..10 {
        let mut bytes = whole.clone();
        let at = chunk + 8 + 8 * counter;
        bytes[at..at + 8].copy_from_slice(&(1u64 << 35).to_le_bytes());
        std::fs::write(&path, &bytes).unwrap();
        assert_says(&refused(&path), &["dwaa_lines.exr", "damaged"]);
    }
}

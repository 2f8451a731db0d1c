//! Damaged files: flipped, inserted and removed bytes must give an error or an image, never a panic or excessive
//! memory.

use super::{picture, save, vectors};
use crate::hostile::peak_mb;
use afterimage_lab::source::exr_file::{ColorFormat, FrameToWrite, write};
use afterimage_lab::source::{ReadLimits, SceneOptions, open};
use afterimage_testing::panics::silence_the_exr_decoder;
use exr::prelude::*;
use image::{DynamicImage, ImageBuffer, Rgb};
use proptest::prelude::*;
use std::sync::OnceLock;

/// Small, so that a damaged file that is accepted at its claimed size takes little memory.
const LIMITS: ReadLimits = ReadLimits { max_pixels: 1 << 20 };

/// Name and bytes of a small valid file of every kind and every compression.
fn samples() -> &'static [(String, Vec<u8>)] {
    static SAMPLES: OnceLock<Vec<(String, Vec<u8>)>> = OnceLock::new();
    SAMPLES.get_or_init(|| {
        let folder = tempfile::tempdir().unwrap();
        let mut samples = Vec::new();
        let mut take = |name: &str| {
            let bytes = std::fs::read(folder.path().join(name)).unwrap();
            samples.push((name.to_owned(), bytes));
        };
        let noisy = ImageBuffer::from_fn(24, 20, |x, y| Rgb([(x * 11) as u8, (y * 13) as u8, (x * y) as u8]));
        for name in ["a.png", "a.jpg"] {
            DynamicImage::ImageRgb8(noisy.clone()).save(folder.path().join(name)).unwrap();
            take(name);
        }
        let (color, motion) = (picture([24, 20]), vectors([24, 20], 0.5));
        let frame = FrameToWrite { format: ColorFormat::Half, motion: Some(&motion), ..FrameToWrite::color(&color) };
        write(&folder.path().join("own.exr"), &frame).unwrap();
        take("own.exr");
        for (name, compression) in [
            ("raw", Compression::Uncompressed),
            ("rle", Compression::RLE),
            ("zip1", Compression::ZIP1),
            ("piz", Compression::PIZ),
            ("pxr24", Compression::PXR24),
            ("b44", Compression::B44),
            ("dwaa", Compression::DWAA(None)),
        ] {
            for (kind, blocks) in [("lines", Blocks::ScanLines), ("tiles", Blocks::Tiles(Vec2(16, 8)))] {
                let name = format!("{name}_{kind}.exr");
                let encoding = Encoding { compression, blocks, line_order: LineOrder::Increasing };
                save(&folder.path().join(&name), (24, 20), encoding, channels());
                take(&name);
            }
        }
        samples
    })
}

/// Channels of 24x20 pixels.
fn channels() -> Vec<AnyChannel<FlatSamples>> {
    let n = 24 * 20;
    let half = |k: usize| FlatSamples::F16((0..n).map(|i| f16::from_f32((i * k % 97) as f32)).collect());
    let depth = FlatSamples::F32((0..n).map(|i| i as f32).collect());
    [("R", half(3)), ("G", half(5)), ("B", half(7)), ("Z", depth)].map(|(name, of)| AnyChannel::new(name, of)).into()
}

fn mutate(bytes: &mut Vec<u8>, edits: &[(prop::sample::Index, u8, u8)]) {
    for &(at, value, how) in edits {
        if bytes.is_empty() {
            return;
        }
        // Headers are the most sensitive part: half of the edits go there.
        let span = if how % 2 == 0 { bytes.len().min(420) } else { bytes.len() };
        let i = at.index(span);
        match how / 2 % 8 {
            0 => bytes[i] = value,
            1 => bytes[i] ^= 1 << (value % 8),
            2 => bytes[i] = 0xFF,
            3 => bytes[i] = 0x7F,
            4 => bytes.insert(i, value),
            5 => drop(bytes.remove(i)),
            6 => bytes[i] = bytes[i].wrapping_add(1),
            _ if value < 32 => bytes.truncate(i),
            _ => bytes[i] = 0,
        }
    }
}

#[test]
fn the_samples_are_sound() {
    let folder = tempfile::tempdir().unwrap();
    for (name, bytes) in samples() {
        let path = folder.path().join(name);
        std::fs::write(&path, bytes).unwrap();
        let mut source = open(path.to_str().unwrap(), &LIMITS, &SceneOptions::default()).unwrap();
        assert_eq!(source.frame(0).unwrap().color.size(), [24, 20], "{name}");
    }
}

/// A DWA chunk starts with counters that its decoder trusts: one of 32 GB would abort the process.
#[test]
fn dwa_counters_do_not_set_memory_aside() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("dwaa_lines.exr");
    let (_, whole) = samples().iter().find(|s| s.0 == "dwaa_lines.exr").unwrap();
    // The only chunk is at the offset in the table's only entry; its data follows the line number and the size.
    let word = |at: usize| u64::from_le_bytes(whole[at..at + 8].try_into().unwrap());
    let chunk = (8..whole.len() - 8).find(|&at| word(at - 8) == at as u64).unwrap();
    for counter in 1..10 {
        let mut bytes = whole.clone();
        let at = chunk + 8 + 8 * counter;
        bytes[at..at + 8].copy_from_slice(&(1u64 << 35).to_le_bytes());
        std::fs::write(&path, &bytes).unwrap();
        let e = super::error_of(open(path.to_str().unwrap(), &LIMITS, &SceneOptions::default()));
        super::assert_says(&e, &["dwaa_lines.exr", "damaged"]);
    }
}

/// Cases asked for by `PROPTEST_CASES`, 4000 by default.
fn cases() -> u32 {
    std::env::var("PROPTEST_CASES").ok().and_then(|n| n.parse().ok()).unwrap_or(4000)
}

proptest! {
    #![proptest_config(afterimage_testing::property("damaged files", cases()))]

    fn damage(
        which in any::<prop::sample::Index>(),
        edits in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>(), any::<u8>()), 1..6),
    ) {
        silence_the_exr_decoder();
        static FOLDER: OnceLock<tempfile::TempDir> = OnceLock::new();
        let folder = FOLDER.get_or_init(|| tempfile::tempdir().unwrap());
        let (name, bytes) = which.get(samples());
        let mut bytes = bytes.clone();
        mutate(&mut bytes, &edits);
        let path = folder.path().join(name);
        std::fs::write(&path, &bytes).unwrap();
        let before = peak_mb();
        match open(path.to_str().unwrap(), &LIMITS, &SceneOptions::default()) {
            Err(e) => {
                let text = e.to_string();
                prop_assert!(text.contains(name.as_str()), "{}", text);
                prop_assert!(!text.contains('\n'), "{}", text);
                prop_assert!(!e.message().remedy.is_empty());
            }
            Ok(mut source) => {
                let frame = source.frame(0).unwrap();
                let [w, h] = frame.color.size();
                prop_assert!(u64::from(w) * u64::from(h) <= LIMITS.max_pixels);
            }
        }
        if let (Some(before), Some(after)) = (before, peak_mb()) {
            // The largest allowed image takes 16 MB as color and depth, and its decoder about as much again.
            prop_assert!(after - before < 100, "{} took {} MB", name, after - before);
        }
    }
}

#[test]
fn damage_gives_an_error_or_a_picture() {
    afterimage_testing::alone(damage);
}

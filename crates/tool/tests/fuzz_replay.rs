//! Runs the fuzzing targets (`tests/fuzz.sh`) on stable Rust: on every file of the corpus, which includes former
//! findings, and on a few thousand damaged copies of each kind.

#[path = "fuzz/entries.rs"]
mod entries;

use afterimage_testing::Draws;
use entries::TARGETS;
use std::fs;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::PathBuf;

/// Number of damaged copies of each kind.
const COPIES: usize = 1500;
/// Tokens of the formats, inserted into damaged copies.
const TOKENS: &[u8] = b"0129-+.eE\0\xff,;\"[]{}= \n";

fn corpus(target: &str) -> Vec<(PathBuf, Vec<u8>)> {
    let folder = afterimage_testing::workspace().join("fixtures/fuzz").join(target);
    let mut files: Vec<PathBuf> = fs::read_dir(&folder).unwrap().map(|e| e.unwrap().path()).collect();
    files.sort();
    files.into_iter().map(|f| (f.clone(), fs::read(f).unwrap())).collect()
}

#[test]
fn every_file_of_the_corpus_is_refused_or_sound() {
    for (name, target) in TARGETS {
        let files = corpus(name);
        assert!(files.len() >= 3, "{name}: fixtures/fuzz has {} files", files.len());
        let bytes: usize = files.iter().map(|f| f.1.len()).sum();
        assert!(bytes < 200_000, "{name}: {bytes} bytes; cargo fuzz cmin keeps what matters");
        for (path, bytes) in files {
            let outcome = catch_unwind(AssertUnwindSafe(|| target(&bytes)));
            assert!(outcome.is_ok(), "{}: see above", path.display());
        }
        target(&[]);
    }
}

#[test]
fn damaged_copies_are_refused_or_sound() {
    afterimage_testing::panics::silence_the_exr_decoder();
    for (name, target) in TARGETS {
        let (files, mut draws) = (corpus(name), Draws::new(&format!("fuzz {name}")));
        for copy in 0..COPIES {
            let mut bytes = files[copy % files.len()].1.clone();
            let other = &files[draws.bits() as usize % files.len()].1;
            for _ in 0..=draws.bits() % 4 {
                damage(&mut bytes, other, &mut draws);
            }
            let outcome = catch_unwind(AssertUnwindSafe(|| target(&bytes)));
            if outcome.is_err() {
                let found = std::env::temp_dir().join(format!("afterimage-found-{}-{name}-{copy}", std::process::id()));
                fs::write(&found, &bytes).unwrap();
                panic!("{name}: see above; the bytes are in {}", found.display());
            }
        }
    }
}

fn damage(bytes: &mut Vec<u8>, other: &[u8], draws: &mut Draws) {
    if bytes.is_empty() {
        return bytes.extend_from_slice(other);
    }
    let at = draws.bits() as usize % bytes.len();
    match draws.bits() % 8 {
        0 => bytes[at] = draws.bits() as u8,
        1 => bytes[at] ^= 1 << (draws.bits() % 8),
        2 => bytes.truncate(at),
        3 => drop(bytes.remove(at)),
        4 => bytes.insert(at, TOKENS[draws.bits() as usize % TOKENS.len()]),
        5 if bytes[at].is_ascii_digit() => bytes[at] = b'0' + (draws.bits() % 10) as u8,
        5 => bytes[at] = 0xff,
        6 => {
            let (from, length) = (draws.bits() as usize % (other.len() + 1), draws.bits() as usize % 32);
            let part = other[from..(from + length).min(other.len())].to_vec();
            drop(bytes.splice(at..at, part));
        }
        _ => {
            let end = (at + 4).min(bytes.len());
            let value = [0, 1, 0x7fff_ffff, 0x8000_0000, u32::MAX, 0x7fc0_0000][draws.bits() as usize % 6];
            bytes[at..end].copy_from_slice(&u32::to_le_bytes(value)[..end - at]);
        }
    }
}

/// The oracle detects invalid results.
#[test]
fn a_panic_is_noticed() {
    assert!(catch_unwind(|| entries::scanpath(b"")).is_ok());
    let unsound: fn(&[u8]) = |bytes| assert!(bytes.is_empty(), "planted");
    assert!(catch_unwind(|| unsound(b"x")).is_err());
}

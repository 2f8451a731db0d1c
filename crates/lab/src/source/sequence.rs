//! A folder of EXR frames, played forwards and backwards.

use super::exr_file::{ExrFrame, ExrHeader, Vectors};
use super::limits::ReadLimits;
use super::still::StillSource;
use super::{FrameRequest, FrameSource, SourceInfo};
use crate::error::{InputError, io_error};
use crate::file_kind::ending;
use crate::frame::{RenderedFrame, SourceFrame};
use crate::scene::cameras::Cameras;
use std::fs;
use std::path::{Path, PathBuf};

/// A folder of `.exr` frames, sorted by the number in their names that varies, with an optional `cameras.json`.
/// Opening checks every header; pixels are decoded on request and not cached.
///
/// A folder with a single frame is a still.
#[derive(Debug)]
pub struct SequenceSource {
    info: SourceInfo,
    limits: ReadLimits,
    files: Vec<PathBuf>,
    has_depth: bool,
    cameras: Option<(Cameras, Vec<usize>)>,
    still: Option<StillSource>,
    warnings: Vec<String>,
    contents: Vec<String>,
}

impl SequenceSource {
    /// Opens `folder` and checks all headers. No pixel is decoded, except for a single frame.
    ///
    /// # Errors
    /// - [`Io`](InputError::Io): the folder or a file cannot be read.
    /// - [`Request`](InputError::Request): the folder has no `.exr`, or frames of several sequences.
    /// - [`Limit`](InputError::Limit) and [`NotSupported`](InputError::NotSupported): as of [`ExrHeader::open`].
    /// - [`Invalid`](InputError::Invalid): a frame is damaged, truncated or without color; differs from the first in
    ///   size, or in whether it has depth or motion; a frame number is missing; several frames have no motion vectors;
    ///   or `cameras.json` is invalid or belongs to other frames.
    pub fn open(folder: &Path, limits: &ReadLimits) -> Result<Self, InputError> {
        let name = folder.display().to_string();
        let (files, numbers) = numbered_files(&name, exr_files(folder)?)?;
        if let [file] = files.as_slice() {
            let still = StillSource::open(file, limits)?.named(name);
            return Ok(Self {
                info: still.info().clone(),
                limits: *limits,
                has_depth: false,
                cameras: None,
                warnings: still.warnings().to_vec(),
                contents: still.contents().to_vec(),
                still: Some(still),
                files,
            });
        }
        check_gaps(&name, &numbers)?;
        let first = check_headers(&files, limits)?;
        let cameras = Cameras::beside(folder)?;
        if let Some(c) = &cameras {
            c.check_size(first.size())?;
        }
        let (warnings, contents) = (first.warnings().to_vec(), first.contents().to_vec());
        let info = SourceInfo {
            name,
            size: first.size(),
            frames: Some(files.len() as u64),
            fps: cameras.as_ref().and_then(|c| c.fps).or(first.fps()),
            hfov_deg: cameras.as_ref().and_then(|c| c.hfov_deg),
            still: false,
        };
        let cameras = match cameras {
            Some(c) => c.assign(&numbers)?.map(|poses| (c, poses)),
            None => None,
        };
        Ok(Self {
            info,
            limits: *limits,
            has_depth: first.has_depth(),
            cameras,
            still: None,
            files,
            warnings,
            contents,
        })
    }

    /// Paths of the frames in playback order.
    pub fn files(&self) -> &[PathBuf] {
        &self.files
    }
}

impl FrameSource for SequenceSource {
    fn info(&self) -> &SourceInfo {
        &self.info
    }

    fn warnings(&self) -> &[String] {
        &self.warnings
    }

    fn contents(&self) -> &[String] {
        &self.contents
    }

    fn render(&mut self, request: &FrameRequest) -> Result<RenderedFrame, InputError> {
        let index = request.index;
        if let Some(still) = &mut self.still {
            return still.render(request);
        }
        let (file, step) = playback(index, self.files.len() as u64);
        let header = ExrHeader::open(&self.files[file], &self.limits)?;
        if header.size() != self.info.size || header.has_depth() != self.has_depth {
            return Err(InputError::invalid(
                self.files[file].display().to_string(),
                "has changed since the sequence was opened",
                "leave the frames alone while they are read",
            ));
        }
        let vectors = match step {
            Step::Backward => Vectors::ToNext,
            Step::First | Step::Forward => Vectors::ToPrevious,
        };
        let ExrFrame { color, depth, motion, nonfinite } = header.read(vectors)?;
        let previous_from_current = self.cameras.as_ref().and_then(|(cameras, poses)| {
            let previous = match step {
                Step::First => return None,
                Step::Forward => file - 1,
                Step::Backward => file + 1,
            };
            Some(cameras.previous_from_current(poses[previous], poses[file]))
        });
        let cut = step == Step::First;
        let frame = SourceFrame { color, depth, motion, trust: None, previous_from_current, cut, nonfinite };
        Ok(RenderedFrame::full_rate(index, request.gaze_px, frame))
    }
}

/// Direction of playback that leads to a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Step {
    /// The frame is the first one.
    First,
    /// The previous frame is the file before.
    Forward,
    /// The previous frame is the file after.
    Backward,
}

/// File and step at playback position `index` of `n` files (at least two): 0, 1, ..., n-1, n-2, ..., 1, 0, 1, ...
fn playback(index: u64, n: u64) -> (usize, Step) {
    let period = 2 * n - 2;
    let k = index % period;
    let (file, step) = if index == 0 {
        (0, Step::First)
    } else if k == 0 || k >= n {
        ((period - k) % period, Step::Backward)
    } else {
        (k, Step::Forward)
    };
    (file as usize, step)
}

/// The `.exr` files of a folder, by name. Hidden files are skipped.
fn exr_files(folder: &Path) -> Result<Vec<PathBuf>, InputError> {
    let subject = folder.display().to_string();
    let (mut files, mut pictures) = (Vec::new(), 0);
    for entry in fs::read_dir(folder).map_err(|e| io_error(&subject, &e))? {
        let path = entry.map_err(|e| io_error(&subject, &e))?.path();
        let hidden = path.file_name().is_some_and(|n| n.to_string_lossy().starts_with('.'));
        if !hidden && ending(&path) == "exr" && path.is_file() {
            files.push(path);
        } else if !hidden && ["png", "jpg", "jpeg"].contains(&ending(&path).as_str()) {
            pictures += 1;
        }
    }
    if files.is_empty() && pictures > 0 {
        return Err(InputError::request(
            subject,
            format!("holds {pictures} pictures and no .exr file; a sequence needs motion vectors, which only EXR has"),
            "render EXR frames with motion vectors, or give the path of one picture as a still",
        ));
    }
    if files.is_empty() {
        return Err(InputError::request(
            subject,
            "holds no .exr file",
            "expected a folder of EXR frames, or the path of one image",
        ));
    }
    files.sort();
    Ok(files)
}

/// Which hyphens before a number are its sign.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Sign {
    /// Those behind neither a letter nor a digit: `f_-001`, `-001`, `shot--001`. Others separate: `shot-001`.
    Apart,
    /// All: `f-001` beside `f0000`.
    All,
}

/// A file's name without its ending: the text around its numbers, in lower case, and the numbers.
fn parts_of(file: &Path, sign: Sign) -> (String, Vec<i64>) {
    let stem = file.file_stem().unwrap_or_default().to_string_lossy().to_lowercase();
    let (mut text, mut numbers, mut rest) = (String::new(), vec![], stem.as_str());
    while let Some(first_digit) = rest.find(|c: char| c.is_ascii_digit()) {
        let end = rest[first_digit..].find(|c: char| !c.is_ascii_digit()).map_or(rest.len(), |n| first_digit + n);
        // Without text in between, the hyphen is behind the number before.
        let is_apart = |before: &str| !before.chars().next_back().map_or(!text.is_empty(), char::is_alphanumeric);
        let is_sign = |before: &str| sign == Sign::All || is_apart(before);
        let before = rest[..first_digit].strip_suffix('-').filter(|before| is_sign(before));
        let start = before.map_or(first_digit, str::len);
        text.push_str(&rest[..start]);
        match rest[start..end].parse() {
            Ok(number) => {
                text.push('#');
                numbers.push(number);
            }
            // Longer than any frame number.
            Err(_) => text.push_str(&rest[start..end]),
        }
        rest = &rest[end..];
    }
    text.push_str(rest);
    (text, numbers)
}

/// Text and numbers of each file's name. If hyphens differ, they are signs, if that makes one sequence through frame 0.
fn parts_of_all(files: &[PathBuf]) -> Vec<(String, Vec<i64>)> {
    let all = |sign| files.iter().map(|file| parts_of(file, sign)).collect::<Vec<_>>();
    let is_one = |parts: &[(String, Vec<i64>)]| parts.windows(2).all(|pair| pair[0].0 == pair[1].0);
    let parts = all(Sign::Apart);
    if is_one(&parts) {
        return parts;
    }
    let signed = all(Sign::All);
    let has_frame_0 = signed.iter().any(|(_, numbers)| numbers.contains(&0));
    if is_one(&signed) && has_frame_0 { signed } else { parts }
}

/// Files in playback order, and their frame numbers: of the numbers in their names, the one that is another in every
/// file. If several are, the last that has even steps, or else the last. Files without numbers are in order of their
/// names.
pub(super) fn numbered_files(
    subject: &str,
    files: Vec<PathBuf>,
) -> Result<(Vec<PathBuf>, Vec<Option<i64>>), InputError> {
    let parts = parts_of_all(&files);
    if files.len() < 2 || parts.iter().all(|(_, numbers)| numbers.is_empty()) {
        let numbers = vec![None; files.len()];
        return Ok((files, numbers));
    }
    let file_name = |i: usize| files[i].file_name().unwrap_or_default().to_string_lossy().into_owned();
    let refuse = |problem: String| {
        Err(InputError::request(subject, problem, "expected the frames of one sequence; keep one sequence in a folder"))
    };
    if let Some(other) = (1..files.len()).find(|&i| parts[i].0 != parts[0].0) {
        let (a, b) = (file_name(0), file_name(other));
        return refuse(format!("holds two sequences: {a} and {b} differ in more than numbers"));
    }
    let column = |place: usize| parts.iter().map(move |(_, numbers)| numbers[place]);
    let sorted = |place: usize| {
        let mut numbers: Vec<i64> = column(place).collect();
        numbers.sort_unstable();
        numbers
    };
    let places = 0..parts[0].1.len();
    let varying: Vec<usize> = places.clone().filter(|&place| sorted(place).windows(2).all(|w| w[0] < w[1])).collect();
    let is_even = |&&place: &&usize| {
        let numbers = sorted(place);
        numbers.windows(2).all(|w| w[1].abs_diff(w[0]) == numbers[1].abs_diff(numbers[0]))
    };
    let Some(&place) = varying.iter().rev().find(is_even).or(varying.last()) else {
        let distinct = |&place: &usize| {
            let mut numbers = sorted(place);
            numbers.dedup();
            numbers.len()
        };
        let place = places.max_by_key(distinct).unwrap_or(0);
        let numbers: Vec<i64> = column(place).collect();
        let pairs = (0..numbers.len()).flat_map(|i| (0..i).map(move |j| [j, i]));
        let [a, b] = pairs.into_iter().find(|&[a, b]| numbers[a] == numbers[b]).unwrap_or([0, 1]);
        let number = numbers[a];
        return refuse(format!("has two frames of number {number}: {} and {}", file_name(a), file_name(b)));
    };
    let numbers: Vec<i64> = column(place).collect();
    let mut order: Vec<usize> = (0..files.len()).collect();
    order.sort_by_key(|&i| numbers[i]);
    Ok((order.iter().map(|&i| files[i].clone()).collect(), order.iter().map(|&i| Some(numbers[i])).collect()))
}

/// Refuses a sequence with a missing frame, because the motion vectors of the frame after it refer to the missing one.
pub(super) fn check_gaps(subject: &str, numbers: &[Option<i64>]) -> Result<(), InputError> {
    let Some(numbers) = numbers.iter().copied().collect::<Option<Vec<i64>>>() else {
        return Ok(());
    };
    let steps: Vec<u64> = numbers.windows(2).map(|w| w[1].abs_diff(w[0])).collect();
    let smallest = steps.iter().copied().min().unwrap_or(0);
    match steps.iter().position(|&s| s != smallest) {
        Some(at) => Err(InputError::invalid(
            subject,
            format!("its frame numbers jump from {} to {}", numbers[at], numbers[at + 1]),
            format!(
                "expected steps of {smallest}; add the missing frames, or put each unbroken run into a folder of its own"
            ),
        )),
        None => Ok(()),
    }
}

/// Checks every header against the first, and returns the first.
fn check_headers(files: &[PathBuf], limits: &ReadLimits) -> Result<ExrHeader, InputError> {
    let first = ExrHeader::open(&files[0], limits)?;
    let first_name = files[0].display();
    for file in files {
        let header = ExrHeader::open(file, limits)?;
        let subject = file.display().to_string();
        if header.size() != first.size() {
            let ([w, h], [w0, h0]) = (header.size(), first.size());
            return Err(InputError::invalid(
                subject,
                format!("has {w}x{h} pixels but {first_name} has {w0}x{h0}"),
                "expected frames of one size; keep one sequence in a folder",
            ));
        }
        let traits = |h: &ExrHeader| {
            [
                ("depth", h.has_depth()),
                ("motion vectors to the previous frame", h.has(Vectors::ToPrevious)),
                ("motion vectors to the next frame", h.has(Vectors::ToNext)),
            ]
        };
        for ((what, here), (_, there)) in traits(&header).into_iter().zip(traits(&first)) {
            if here != there {
                let (has, lacks) = if here { ("has", "does not") } else { ("has no", "does") };
                return Err(InputError::invalid(
                    subject,
                    format!("{has} {what} but {first_name} {lacks}"),
                    "expected the same channels in every frame; export the sequence again",
                ));
            }
        }
    }
    if first.has(Vectors::ToPrevious) {
        Ok(first)
    } else {
        Err(InputError::invalid(
            first_name.to_string(),
            "has no motion vectors, which reprojection of a sequence needs",
            "expected <layer>.Vector.X/Y (Blender: enable the Vector pass) or motion.X/Y; or give one frame as a still",
        ))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn playback_goes_to_and_fro() {
        let order = |n, m| (0..m).map(|i| playback(i, n)).collect::<Vec<_>>();
        use Step::{Backward as B, First, Forward as F};
        assert_eq!(order(4, 9), [(0, First), (1, F), (2, F), (3, F), (2, B), (1, B), (0, B), (1, F), (2, F)]);
        assert_eq!(order(2, 4), [(0, First), (1, F), (0, B), (1, F)]);
        assert_eq!(playback(u64::MAX, 2).0, 1);
    }

    /// Frame numbers of files in playback order, or the error.
    fn numbered(names: &[&str]) -> Result<Vec<(String, Option<i64>)>, String> {
        let files = names.iter().map(PathBuf::from).collect();
        let (files, numbers) = numbered_files("d", files).map_err(|e| e.to_string())?;
        Ok(files.iter().map(|file| file.display().to_string()).zip(numbers).collect())
    }

    #[test]
    fn the_number_that_varies_counts() {
        let numbers = |names: &[&str]| numbered(names).unwrap().into_iter().map(|(_, n)| n).collect::<Vec<_>>();
        assert_eq!(numbers(&["t2_0041.exr", "t2_0043.exr", "t2_0042.exr"]), [Some(41), Some(42), Some(43)]);
        assert_eq!(numbers(&["f0008_v2.exr", "f0010_v2.exr", "f0009_v2.exr"]), [Some(8), Some(9), Some(10)]);
        // A time stamp beside the number, in the same order.
        assert_eq!(numbers(&["1700000100_1.exr", "1700000233_2.exr", "1700000310_3.exr"]), [Some(1), Some(2), Some(3)]);
        assert_eq!(numbers(&["1_1700000100.exr", "2_1700000233.exr", "3_1700000310.exr"]), [Some(1), Some(2), Some(3)]);
        assert_eq!(numbers(&["9.exr", "10.exr", "11.exr"]), [Some(9), Some(10), Some(11)]);
        assert_eq!(numbers(&["\u{fc}n\u{ef}12.exr", "\u{fc}n\u{ef}13.EXR"]), [Some(12), Some(13)]);
        assert_eq!(numbers(&["b.exr", "a.exr"]), [None, None]);
        assert_eq!(numbers(&["beauty.exr"]), [None]);
    }

    #[test]
    fn frames_before_zero_come_first() {
        for names in [
            ["f_-0002.exr", "f_-0001.exr", "f_0000.exr", "f_0001.exr"],
            ["-0002.exr", "-0001.exr", "0000.exr", "0001.exr"],
            ["f.-2.exr", "f.-1.exr", "f.0.exr", "f.1.exr"],
            ["render-002.exr", "render-001.exr", "render0000.exr", "render0001.exr"],
            ["shot--002.exr", "shot--001.exr", "shot-000.exr", "shot-001.exr"],
        ] {
            let in_order = |order: [usize; 4]| numbered(&order.map(|i| names[i]));
            let expected: Vec<_> = names.iter().map(|name| (*name).to_owned()).zip([-2, -1, 0, 1].map(Some)).collect();
            assert_eq!(in_order([3, 1, 2, 0]).unwrap(), expected);
        }
        assert_eq!(numbered(&["f_-3.exr", "f_-2.exr", "f_-1.exr"]).unwrap()[0].1, Some(-3));
        // A hyphen behind a word separates.
        assert_eq!(numbered(&["shot-001.exr", "shot-002.exr"]).unwrap()[0].1, Some(1));
        assert_eq!(numbered(&["2024-01-05_1.exr", "2024-01-05_2.exr"]).unwrap()[1].1, Some(2));
    }

    #[test]
    fn two_sequences_in_a_folder_are_refused_by_name() {
        for (names, expected) in [
            (["a_1.exr", "b_1.exr"], "a_1.exr and b_1.exr"),
            (["frame_1.L.exr", "frame_1.R.exr"], "frame_1.l.exr"),
            (["f1.exr", "f01.exr"], "number 1: f1.exr and f01.exr"),
            (["f-1.exr", "f1.exr"], "f-1.exr and f1.exr"),
        ] {
            let error = numbered(&names).unwrap_err();
            assert!(error.to_lowercase().contains(expected), "{names:?}: {error}");
        }
        let error = numbered(&["shot1_1.exr", "shot1_2.exr", "shot2_1.exr", "shot2_2.exr"]).unwrap_err();
        assert!(error.contains("two frames of number"), "{error}");
    }

    #[test]
    fn a_missing_frame_is_noticed() {
        let gap = |v: &[i64]| check_gaps("d", &v.iter().map(|&n| Some(n)).collect::<Vec<_>>());
        assert!(gap(&[3, 4, 5]).is_ok());
        assert!(gap(&[0, 10, 20]).is_ok());
        let e = gap(&[1, 2, 4]).unwrap_err().to_string();
        assert!(e.contains("from 2 to 4"), "{e}");
    }
}

//! A folder of EXR frames, played forwards and backwards.

use super::exr_file::{ExrHeader, Vectors};
use super::limits::ReadLimits;
use super::still::StillSource;
use super::{FrameRequest, FrameSource, SourceInfo};
use crate::error::InputError;
use crate::error::io_error;
use crate::frame::{RenderedFrame, SourceFrame};
use crate::scene::cameras::Cameras;
use std::fs;
use std::path::{Path, PathBuf};

/// A folder of `.exr` frames, sorted by the last number in their names (then by name), with an optional `cameras.json`.
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
}

impl SequenceSource {
    /// Opens `folder` and checks all headers. No pixel is decoded, except for a single frame.
    ///
    /// # Errors
    /// - [`Io`](InputError::Io): the folder or a file cannot be read.
    /// - [`Request`](InputError::Request): the folder has no `.exr`.
    /// - [`Limit`](InputError::Limit) and [`NotSupported`](InputError::NotSupported): as of [`ExrHeader::open`].
    /// - [`Invalid`](InputError::Invalid): a frame is damaged, truncated or without color; differs from the first in
    ///   size, or in whether it has depth or motion; a frame number is missing; several frames have no motion vectors;
    ///   or `cameras.json` is invalid or belongs to other frames.
    pub fn open(folder: &Path, limits: &ReadLimits) -> Result<Self, InputError> {
        let name = folder.display().to_string();
        let files = exr_files(folder)?;
        let numbers: Vec<_> = files.iter().map(|f| frame_number(f)).collect();
        if let [file] = files.as_slice() {
            let still = StillSource::open(file, limits)?.named(name);
            return Ok(Self {
                info: still.info().clone(),
                limits: *limits,
                has_depth: false,
                cameras: None,
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
        let info = SourceInfo {
            name,
            size: first.size(),
            frames: Some(files.len() as u64),
            fps: cameras.as_ref().and_then(|c| c.fps),
            hfov_deg: cameras.as_ref().and_then(|c| c.hfov_deg),
            still: false,
        };
        let cameras = match cameras {
            Some(c) => c.assign(&numbers)?.map(|poses| (c, poses)),
            None => None,
        };
        Ok(Self { info, limits: *limits, has_depth: first.has_depth(), cameras, still: None, files })
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
        let frame = header.read(vectors)?;
        let previous_from_current = self.cameras.as_ref().and_then(|(cameras, poses)| {
            let previous = match step {
                Step::First => return None,
                Step::Forward => file - 1,
                Step::Backward => file + 1,
            };
            Some(cameras.previous_from_current(poses[previous], poses[file]))
        });
        let frame = SourceFrame {
            color: frame.color,
            depth: frame.depth,
            motion: frame.motion,
            trust: None,
            previous_from_current,
            cut: step == Step::First,
            nonfinite: frame.nonfinite,
        };
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

/// The `.exr` files of a folder in playback order. Hidden files are skipped.
fn exr_files(folder: &Path) -> Result<Vec<PathBuf>, InputError> {
    let subject = folder.display().to_string();
    let mut files = Vec::new();
    for entry in fs::read_dir(folder).map_err(|e| io_error(&subject, &e))? {
        let path = entry.map_err(|e| io_error(&subject, &e))?.path();
        let hidden = path.file_name().is_some_and(|n| n.to_string_lossy().starts_with('.'));
        if !hidden && super::open::extension(&path) == "exr" && path.is_file() {
            files.push(path);
        }
    }
    if files.is_empty() {
        return Err(InputError::request(
            subject,
            "holds no .exr file",
            "expected a folder of EXR frames, or the path of one image",
        ));
    }
    files.sort_by_cached_key(|f| {
        let number = frame_number(f);
        (number.is_none(), number, f.file_name().map(|n| n.to_owned()))
    });
    Ok(files)
}

/// The last run of digits in the file name, extension excluded.
fn frame_number(path: &Path) -> Option<u64> {
    let stem = path.file_stem()?.to_string_lossy();
    let digits = |c: char| c.is_ascii_digit();
    let end = stem.rfind(digits)? + 1;
    let start = stem[..end].rfind(|c| !digits(c)).map_or(0, |i| i + stem[i..].chars().next().map_or(1, char::len_utf8));
    stem[start..end].parse().ok()
}

/// Refuses a sequence with a missing frame, because the motion vectors of the frame after it refer to the missing one.
fn check_gaps(subject: &str, numbers: &[Option<u64>]) -> Result<(), InputError> {
    let Some(numbers) = numbers.iter().copied().collect::<Option<Vec<u64>>>() else {
        return Ok(());
    };
    let steps: Vec<u64> = numbers.windows(2).map(|w| w[1] - w[0]).collect();
    let smallest = steps.iter().copied().min().unwrap_or(0);
    // If numbers repeat, they are not frame numbers.
    match steps.iter().position(|&s| s != smallest) {
        Some(at) if smallest > 0 => Err(InputError::invalid(
            subject,
            format!("its frame numbers jump from {} to {}", numbers[at], numbers[at + 1]),
            format!(
                "expected steps of {smallest}; add the missing frames, or put each unbroken run into a folder of its own"
            ),
        )),
        _ => Ok(()),
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

    #[test]
    fn the_last_number_in_a_name_counts() {
        let n = |s: &str| frame_number(Path::new(s));
        assert_eq!(n("take2_shot10_0042.exr"), Some(42));
        assert_eq!(n("frame0007_beauty.exr"), Some(7));
        assert_eq!(n("ünï12.exr"), Some(12));
        assert_eq!(n("12.exr"), Some(12));
        assert_eq!(n("beauty.exr"), None);
        assert_eq!(n("99999999999999999999999.exr"), None);
    }

    #[test]
    fn a_missing_frame_is_noticed() {
        let gap = |v: &[u64]| check_gaps("d", &v.iter().map(|&n| Some(n)).collect::<Vec<_>>());
        assert!(gap(&[3, 4, 5]).is_ok());
        assert!(gap(&[0, 10, 20]).is_ok());
        assert!(gap(&[1, 1, 2, 2]).is_ok());
        let e = gap(&[1, 2, 4]).unwrap_err().to_string();
        assert!(e.contains("from 2 to 4"), "{e}");
    }
}

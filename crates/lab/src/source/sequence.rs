//! A folder of EXR frames, played forwards and backwards.

use super::exr_file::{ChannelNames, ExrFrame, ExrHeader, MotionReading, PassFile, Vectors};
use super::frame_files::{PassFiles, check_gaps, check_same_frames, passes};
use super::limits::ReadLimits;
use super::still::StillSource;
use super::{FrameRequest, FrameSource, SourceInfo};
use crate::error::InputError;
use crate::frame::{RenderedFrame, SourceFrame};
use crate::scene::cameras::Cameras;
use std::path::Path;

/// A folder of `.exr` frames, sorted by the number in their names that varies, with an optional `cameras.json`.
/// Opening checks every header; pixels are decoded on request and not cached.
///
/// Passes in files of their own, in one folder (`beauty_0001.exr`, `depth_0001.exr`) or each in a folder of its own,
/// are merged by their numbers. A folder with a single frame is a still.
#[derive(Debug)]
pub struct SequenceSource {
    info: SourceInfo,
    frames: Frames,
    has_depth: bool,
    motion: Option<MotionReading>,
    cameras: Option<(Cameras, Vec<usize>)>,
    still: Option<StillSource>,
    warnings: Vec<String>,
    contents: Vec<String>,
}

/// The files of all frames, and how they are read.
#[derive(Debug)]
struct Frames {
    passes: Vec<PassFiles>,
    limits: ReadLimits,
    names: ChannelNames,
}

impl Frames {
    fn count(&self) -> usize {
        self.passes.first().map_or(0, |pass| pass.files.len())
    }

    /// The headers of a frame's files.
    fn header(&self, frame: usize) -> Result<ExrHeader, InputError> {
        let files = self.passes.iter().map(|pass| PassFile { pass: &pass.pass, path: &pass.files[frame] });
        ExrHeader::open_passes(&files.collect::<Vec<_>>(), &self.limits, &self.names)
    }
}

impl SequenceSource {
    /// Opens `folder`, whose channels are recognised by their names, and checks all headers: [`open_named`].
    ///
    /// # Errors
    /// As of [`open_named`].
    ///
    /// [`open_named`]: Self::open_named
    pub fn open(folder: &Path, limits: &ReadLimits) -> Result<Self, InputError> {
        Self::open_named(folder, limits, &ChannelNames::default())
    }

    /// Opens `folder` and checks all headers. No pixel is decoded, except for a single frame.
    ///
    /// # Errors
    /// - [`Io`](InputError::Io): the folder or a file cannot be read.
    /// - [`Request`](InputError::Request): the folder has no `.exr`, or frames of several sequences.
    /// - [`Limit`](InputError::Limit) and [`NotSupported`](InputError::NotSupported): as of
    ///   [`ExrHeader::open_passes`].
    /// - [`Invalid`](InputError::Invalid): a frame is damaged, truncated or without color or a channel of `names`;
    ///   differs from the first in size, or in whether it has depth, motion or albedo; a frame number is missing, or
    ///   missing in a pass; several frames have no motion vectors of a known convention; or `cameras.json` is invalid
    ///   or belongs to other frames.
    pub fn open_named(folder: &Path, limits: &ReadLimits, names: &ChannelNames) -> Result<Self, InputError> {
        let name = folder.display().to_string();
        let mut frames = Frames { passes: passes(folder)?, limits: *limits, names: names.clone() };
        let mut said = vec![];
        if frames.passes.len() > 1 {
            (frames.passes, said) = used_passes(&name, frames.passes, limits, names)?;
            check_same_frames(&name, &frames.passes)?;
        }
        let numbers = frames.passes.first().map_or(vec![], |pass| pass.numbers.clone());
        if frames.count() == 1 {
            let still = StillSource::from_header(&frames.header(0)?, folder)?.named(name);
            return Ok(Self {
                info: still.info().clone(),
                frames,
                has_depth: false,
                motion: None,
                cameras: None,
                warnings: all_said(said, still.warnings()),
                contents: still.contents().to_vec(),
                still: Some(still),
            });
        }
        check_gaps(&name, &numbers)?;
        let first = check_headers(&frames, &name)?;
        let cameras = Cameras::beside(folder)?;
        if let Some(c) = &cameras {
            c.check_size(first.size())?;
        }
        let (warnings, contents) = (all_said(said, first.warnings()), first.contents().to_vec());
        let info = SourceInfo {
            name,
            size: first.size(),
            frames: Some(frames.count() as u64),
            fps: cameras.as_ref().and_then(|c| c.fps).or(first.fps()),
            hfov_deg: cameras.as_ref().and_then(|c| c.hfov_deg),
            still: false,
            has_albedo: first.has_albedo(),
        };
        let cameras = match cameras {
            Some(c) => c.assign(&numbers)?.map(|poses| (c, poses)),
            None => None,
        };
        let (has_depth, motion) = (first.has_depth(), first.motion_reading());
        Ok(Self { info, frames, has_depth, motion, cameras, still: None, warnings, contents })
    }

    /// How the motion vectors are stored; `None` for a still.
    pub fn motion_reading(&self) -> Option<MotionReading> {
        self.motion
    }
}

/// What was said of all passes, and of those that are read.
fn all_said(mut of_all: Vec<String>, of_used: &[String]) -> Vec<String> {
    of_all.retain(|line| !of_used.contains(line));
    [of_used, &of_all].concat()
}

/// The passes from which channels are read, by the first files of all, and what was left out or assumed of all.
fn used_passes(
    folder: &str,
    passes: Vec<PassFiles>,
    limits: &ReadLimits,
    names: &ChannelNames,
) -> Result<(Vec<PassFiles>, Vec<String>), InputError> {
    let first: Vec<PassFile> = passes.iter().map(|pass| PassFile { pass: &pass.pass, path: &pass.files[0] }).collect();
    let is_whole = |file: &&PassFile| {
        let header = ExrHeader::open_passes(&[**file], limits, &ChannelNames::default());
        header.is_ok_and(|header| header.has(Vectors::ToPrevious))
    };
    let whole: Vec<&PassFile> = first.iter().filter(is_whole).collect();
    let [has_same_name, is_alone] = [(1..passes.len()).any(|i| passes[i].pass == passes[0].pass), whole.len() < 2];
    if has_same_name || !is_alone {
        let file_name = |file: &PassFile| file.path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let [a, b] = if is_alone { [&first[0], &first[1]] } else { [whole[0], whole[1]] }.map(file_name);
        return Err(InputError::request(
            folder,
            format!("holds two sequences: {a} and {b} differ in more than numbers, and are no passes of one frame"),
            "expected the frames of one sequence; keep one sequence in a folder",
        ));
    }
    let header = ExrHeader::open_passes(&first, limits, names)?;
    if passes[0].files.len() > 1 && !header.has(Vectors::ToPrevious) {
        return Err(header.without_motion(folder));
    }
    let used = header.used_files();
    let passes = passes.into_iter().enumerate().filter(|(i, _)| used.contains(i)).map(|(_, pass)| pass);
    Ok((passes.collect(), header.warnings().to_vec()))
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
        let (file, step) = playback(index, self.frames.count() as u64);
        let header = self.frames.header(file)?;
        if header.size() != self.info.size
            || header.has_depth() != self.has_depth
            || header.has_albedo() != self.info.has_albedo
        {
            return Err(InputError::invalid(
                header.subject(),
                "has changed since the sequence was opened",
                "leave the frames alone while they are read",
            ));
        }
        let vectors = match step {
            Step::Backward => Vectors::ToNext,
            Step::First | Step::Forward => Vectors::ToPrevious,
        };
        let ExrFrame { color, depth, motion, albedo, nonfinite } = header.read(vectors)?;
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
        let albedo = albedo.filter(|_| request.albedo);
        Ok(RenderedFrame { albedo, ..RenderedFrame::full_rate(index, request.gaze_px, frame) })
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

/// Checks every header against the first, and returns the first.
fn check_headers(frames: &Frames, input: &str) -> Result<ExrHeader, InputError> {
    let first = frames.header(0)?;
    let first_name = first.subject();
    for frame in 0..frames.count() {
        let header = frames.header(frame)?;
        let subject = header.subject();
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
                ("albedo", h.has_albedo()),
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
    if first.has(Vectors::ToPrevious) { Ok(first) } else { Err(first.without_motion(input)) }
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
}

//! Frames of color alone, of any renderer: a folder of numbered frames, one picture, or a video.

use super::exr_file::{ChannelNames, ExrHeader, PassFile};
use super::frame_files::{PassFiles, check_gaps, one_sequence};
use super::limits::ReadLimits;
use super::still::StillSource;
use super::video::Video;
use super::{FrameSource, is_scene};
use crate::error::{InputError, io_error};
use crate::file_kind::{ending, folder_of_pattern, is_video, kind, other_kind};
use crate::frame::SourceFrame;
use crate::scene::cameras::Cameras;
use std::fs;
use std::path::{Path, PathBuf};

/// Frames of which color alone is read: the `.exr` files of a folder, or its `.png` and `.jpg` files if it has no
/// `.exr`, by the number in their names that varies; or one picture; or a video. Opening decodes the first frame and
/// checks all headers, or counts the frames of a video; the other frames are decoded on request and not cached.
#[derive(Debug)]
pub struct ColorFrames {
    name: String,
    limits: ReadLimits,
    names: ChannelNames,
    stored: Stored,
    first_number: Option<i64>,
    size: [u32; 2],
    is_linear: bool,
    fps: Option<f32>,
    hfov_deg: Option<f32>,
    warnings: Vec<String>,
}

/// How frames are stored.
#[derive(Debug)]
enum Stored {
    /// A file each.
    Files(Vec<PathBuf>),
    Video(Box<Video>),
}

impl ColorFrames {
    /// Opens a folder, a picture or a video, of which the first `most` frames are wanted, or all.
    ///
    /// # Errors
    /// - [`Io`](InputError::Io): it does not exist or cannot be read.
    /// - [`Request`](InputError::Request): the folder has no frames or those of several sequences, or `input` is a
    ///   scene or a pattern of names.
    /// - [`Invalid`](InputError::Invalid): a frame number is missing, a frame is damaged or of another size, or
    ///   `cameras.json` is invalid.
    /// - [`NotSupported`](InputError::NotSupported) and [`Limit`](InputError::Limit): as of [`StillSource::open`].
    ///
    /// Videos other than `.y4m` need an installed `ffmpeg` ([`NotSupported`](InputError::NotSupported)).
    pub fn open(input: &str, limits: &ReadLimits, most: Option<u64>) -> Result<Self, InputError> {
        Self::open_named(input, limits, most, None)
    }

    /// As [`open`](Self::open), with `color` as the name of the layer that has the color of EXR frames.
    ///
    /// # Errors
    /// As of `open`; and [`Invalid`](InputError::Invalid) if there is no such layer.
    pub fn open_named(
        input: &str,
        limits: &ReadLimits,
        most: Option<u64>,
        color: Option<&str>,
    ) -> Result<Self, InputError> {
        let names = ChannelNames { color: color.map(str::to_owned), ..ChannelNames::default() };
        let path = Path::new(input);
        if !path.is_dir() {
            check_picture(input, path)?;
            if is_video(path) {
                return Ok(Self::of_video(input, Video::open(path, limits, most)?, limits));
            }
            return Self::of(input, vec![path.to_owned()], None, path.parent().unwrap_or(path), limits, names);
        }
        let (files, left_out) = frames_of(path)?;
        let PassFiles { files, numbers, .. } = one_sequence(input, files)?;
        check_gaps(input, &numbers)?;
        let mut frames = Self::of(input, files, numbers[0], path, limits, names)?;
        if left_out > 0 {
            frames.warnings.push(format!("{input}: its .exr frames are read, {left_out} other pictures are left out"));
        }
        Ok(frames)
    }

    fn of(
        input: &str,
        files: Vec<PathBuf>,
        first_number: Option<i64>,
        folder: &Path,
        limits: &ReadLimits,
        names: ChannelNames,
    ) -> Result<Self, InputError> {
        let first = StillSource::open_named(&files[0], limits, &names)?;
        let cameras = Cameras::beside(folder)?;
        let is_linear = kind(&files[0]) == "exr";
        let size = first.info().size;
        let header_fps = if is_linear { header(&files[0], limits, &names)?.fps() } else { None };
        let frames = Self {
            name: input.to_owned(),
            limits: *limits,
            names,
            first_number,
            size,
            is_linear,
            fps: cameras.as_ref().and_then(|c| c.fps).or(header_fps),
            hfov_deg: cameras.as_ref().and_then(|c| c.hfov_deg),
            warnings: first.warnings().to_vec(),
            stored: Stored::Files(files),
        };
        frames.check_sizes()?;
        Ok(frames)
    }

    fn of_video(input: &str, video: Video, limits: &ReadLimits) -> Self {
        Self {
            name: input.to_owned(),
            limits: *limits,
            names: ChannelNames::default(),
            first_number: None,
            size: video.size(),
            is_linear: false,
            fps: video.fps(),
            hfov_deg: None,
            warnings: video.warnings(),
            stored: Stored::Video(Box::new(video)),
        }
    }

    /// Name as the user gave it.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Number of frames.
    #[expect(clippy::len_without_is_empty, reason = "there is a first frame")]
    pub fn len(&self) -> usize {
        match &self.stored {
            Stored::Files(files) => files.len(),
            Stored::Video(video) => video.len(),
        }
    }

    /// Frame number of the first frame, if the names have numbers.
    pub fn first_number(&self) -> Option<i64> {
        self.first_number
    }

    /// Width and height of every frame in pixels.
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// Whether the files hold linear light (EXR), and not colors that are encoded for a display.
    pub fn is_linear(&self) -> bool {
        self.is_linear
    }

    /// Frames per second, if a `cameras.json`, the files or the video state them.
    pub fn fps(&self) -> Option<f32> {
        self.fps
    }

    /// Horizontal field of view in degrees, if a `cameras.json` states it.
    pub fn hfov_deg(&self) -> Option<f32> {
        self.hfov_deg
    }

    /// What was left out or assumed, a line each.
    pub fn warnings(&self) -> &[String] {
        &self.warnings
    }

    /// File of a frame.
    pub fn file(&self, index: usize) -> &Path {
        match &self.stored {
            Stored::Files(files) => &files[index],
            Stored::Video(video) => video.path(),
        }
    }

    /// Decodes a frame: linear color, and the number of pixels that were NaN or infinite and are black.
    ///
    /// # Errors
    /// As for [`Self::open`].
    pub fn read(&self, index: usize) -> Result<SourceFrame, InputError> {
        let files = match &self.stored {
            Stored::Files(files) => files,
            Stored::Video(video) => return video.read(index),
        };
        let frame = StillSource::open_named(&files[index], &self.limits, &self.names)?.frame(0)?;
        self.check_size(&files[index], frame.color.size())?;
        Ok(frame)
    }

    /// Checks the sizes in the headers of all files.
    fn check_sizes(&self) -> Result<(), InputError> {
        let Stored::Files(files) = &self.stored else { return Ok(()) };
        for file in files {
            if self.is_linear {
                self.check_size(file, header(file, &self.limits, &self.names)?.size())?;
            } else if let Ok((w, h)) = image::image_dimensions(file)
                && [h, w] != self.size
            {
                // An orientation may turn the picture, which is seen when it is decoded; so are damaged files.
                self.check_size(file, [w, h])?;
            }
        }
        Ok(())
    }

    fn check_size(&self, file: &Path, [w, h]: [u32; 2]) -> Result<(), InputError> {
        let [w0, h0] = self.size;
        if [w, h] == [w0, h0] {
            return Ok(());
        }
        Err(InputError::invalid(
            file.display().to_string(),
            format!("has {w}x{h} pixels but {} has {w0}x{h0}", self.file(0).display()),
            "expected frames of one size; keep one sequence in a folder",
        ))
    }
}

fn header(file: &Path, limits: &ReadLimits, names: &ChannelNames) -> Result<ExrHeader, InputError> {
    ExrHeader::open_passes(&[PassFile { pass: "", path: file }], limits, names)
}

/// Refuses what is neither a picture nor a video.
fn check_picture(input: &str, path: &Path) -> Result<(), InputError> {
    let expected = "expected a folder of .exr or .png frames, one picture (.exr, .png, .jpg), or a video (.y4m, .mp4)";
    if is_scene(input) || input.starts_with("analytic:") {
        let remedy = "give its full-rate frames, which a run writes on request";
        return Err(InputError::request(input, "is a scene and no frames", remedy));
    }
    if let Some(folder) = folder_of_pattern(path) {
        let remedy = format!("give the folder, {}; its frames are sorted by their numbers", folder.display());
        return Err(InputError::request(input, "is a pattern of names", remedy));
    }
    if !path.exists() {
        return Err(InputError::io(input, "does not exist", expected));
    }
    match (kind(path).as_str(), other_kind(path)) {
        ("exr" | "png" | "jpg" | "jpeg", _) => Ok(()),
        _ if is_video(path) => Ok(()),
        (_, Some((problem, remedy))) => Err(InputError::not_supported(input, problem, remedy)),
        _ => Err(InputError::not_supported(input, "is a kind of file that is not supported", expected)),
    }
}

/// Frames of a folder by name, and the number of pictures that are left out. Hidden files are skipped.
fn frames_of(folder: &Path) -> Result<(Vec<PathBuf>, usize), InputError> {
    let subject = folder.display().to_string();
    let (mut linear, mut encoded) = (vec![], vec![]);
    for entry in fs::read_dir(folder).map_err(|e| io_error(&subject, &e))? {
        let path = entry.map_err(|e| io_error(&subject, &e))?.path();
        let is_hidden = path.file_name().is_some_and(|name| name.to_string_lossy().starts_with('.'));
        match ending(&path).as_str() {
            _ if is_hidden || !path.is_file() => {}
            "exr" => linear.push(path),
            "png" | "jpg" | "jpeg" => encoded.push(path),
            _ => {}
        }
    }
    let left_out = if linear.is_empty() { 0 } else { encoded.len() };
    let mut files = if linear.is_empty() { encoded } else { linear };
    if files.is_empty() {
        let remedy = "expected numbered .exr or .png frames, or the path of one picture";
        return Err(InputError::request(subject, "holds no .exr, .png or .jpg file", remedy));
    }
    files.sort();
    Ok((files, left_out))
}

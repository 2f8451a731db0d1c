//! Frames of a video: `.y4m` as it is, other kinds through `ffmpeg`.

use super::ffmpeg::Ffmpeg;
use super::limits::ReadLimits;
use super::y4m::Header;
use super::yuv::Matrix;
use crate::error::{InputError, io_error};
use crate::file_kind::ending;
use crate::frame::SourceFrame;
use std::fs::File;
use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

/// Bytes that are read at once.
const BUFFER_BYTES: usize = 1 << 20;

/// A video. Opening reads all of it to count its frames; frames are decoded again on request, best in their order.
#[derive(Debug)]
pub(super) struct Video {
    path: PathBuf,
    limits: ReadLimits,
    most: Option<u64>,
    header: Header,
    len: usize,
    playing: Mutex<Option<Stream>>,
}

/// A video that is being decoded.
struct Stream {
    header: Header,
    reader: Box<dyn BufRead + Send>,
    /// `None` for a file that is read as it is. Declared after its pipe, and dropped after it.
    ffmpeg: Option<Ffmpeg>,
    next: usize,
    planes: Vec<u8>,
}

impl std::fmt::Debug for Stream {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Stream").field("header", &self.header).field("next", &self.next).finish_non_exhaustive()
    }
}

impl Video {
    /// Opens a video, of which the first `most` frames are wanted, or all.
    pub(super) fn open(path: &Path, limits: &ReadLimits, most: Option<u64>) -> Result<Self, InputError> {
        let mut stream = Stream::open(path, limits, most)?;
        let subject = path.display().to_string();
        let most_frames = most.map_or(usize::MAX, |most| most as usize);
        while stream.next < most_frames && stream.advance(&subject)? {}
        if stream.next == 0 {
            return Err(InputError::invalid(subject, "has no frame", "expected a video with at least one frame"));
        }
        let (header, len) = (stream.header, stream.next);
        Ok(Self { path: path.to_owned(), limits: *limits, most, header, len, playing: Mutex::new(None) })
    }

    pub(super) fn len(&self) -> usize {
        self.len
    }

    pub(super) fn size(&self) -> [u32; 2] {
        self.header.size
    }

    pub(super) fn fps(&self) -> Option<f32> {
        self.header.fps
    }

    pub(super) fn path(&self) -> &Path {
        &self.path
    }

    /// What was assumed.
    pub(super) fn warnings(&self) -> Vec<String> {
        let note = format!("{}: its pixels are no squares, and are read as squares", self.path.display());
        (!self.header.has_square_pixels).then_some(note).into_iter().collect()
    }

    /// Decodes a frame. An earlier one than the last starts the video again.
    pub(super) fn read(&self, index: usize) -> Result<SourceFrame, InputError> {
        let subject = self.path.display().to_string();
        let mut playing = self.playing.lock().unwrap_or_else(PoisonError::into_inner);
        let mut stream = match playing.take() {
            Some(stream) if stream.next <= index => stream,
            _ => Stream::open(&self.path, &self.limits, self.most)?,
        };
        while stream.next <= index {
            if stream.header != self.header || !stream.advance(&subject)? {
                let remedy = "leave the video alone while it is read";
                return Err(InputError::invalid(subject, "has changed since it was opened", remedy));
            }
        }
        let color = self.header.coding.linear(self.header.size, &stream.planes);
        *playing = Some(stream);
        Ok(SourceFrame { color, ..SourceFrame::without_images(None, false) })
    }
}

impl Stream {
    fn open(path: &Path, limits: &ReadLimits, most: Option<u64>) -> Result<Self, InputError> {
        let subject = path.display().to_string();
        let (ffmpeg, mut reader): (_, Box<dyn BufRead + Send>) = if ending(path) == "y4m" {
            let file = File::open(path).map_err(|e| io_error(&subject, &e))?;
            (None, Box::new(BufReader::with_capacity(BUFFER_BYTES, file)))
        } else {
            let (ffmpeg, pipe) = Ffmpeg::decode(path, most)?;
            (Some(ffmpeg), Box::new(BufReader::with_capacity(BUFFER_BYTES, pipe)))
        };
        let mut stream = match Header::read(&subject, &mut reader, limits) {
            Ok(header) => Self { header, reader, ffmpeg, next: 0, planes: vec![] },
            Err(error) => return Err(of_process(&subject, &mut reader, ffmpeg, error)),
        };
        let described = stream.ffmpeg.as_ref().and_then(Ffmpeg::stream);
        if let Some(matrix) = described.map_or(Ok(None), |line| matrix(&subject, &line))? {
            stream.header.coding.matrix = matrix;
        }
        Ok(stream)
    }

    /// Reads the samples of the next frame. Returns whether there was one; the end of a process that failed is an
    /// error.
    fn advance(&mut self, subject: &str) -> Result<bool, InputError> {
        match self.header.read_frame(subject, &mut self.reader, &mut self.planes) {
            Ok(true) => {
                self.next += 1;
                Ok(true)
            }
            Ok(false) => match self.ffmpeg.as_mut().and_then(Ffmpeg::failure_after_end) {
                Some(why) => Err(failed(subject, &why)),
                None => Ok(false),
            },
            Err(error) => Err(of_process(subject, &mut self.reader, self.ffmpeg.take(), error)),
        }
    }
}

/// The failure of the process behind a stream that ended too early, or else the error that was found.
fn of_process(subject: &str, reader: &mut dyn BufRead, ffmpeg: Option<Ffmpeg>, error: InputError) -> InputError {
    let has_ended = reader.fill_buf().is_ok_and(<[u8]>::is_empty);
    match ffmpeg.filter(|_| has_ended).and_then(|mut ffmpeg| ffmpeg.failure_after_end()) {
        Some(why) => failed(subject, &why),
        None => error,
    }
}

fn failed(subject: &str, why: &str) -> InputError {
    InputError::invalid(subject, format!("is not decoded by ffmpeg ({why})"), "play it, and copy or export it again")
}

/// The matrix in ffmpeg's description of a stream, if there is one: `yuv420p(tv, bt709, progressive)`, or
/// `yuv420p10le(tv, bt2020nc/bt2020/smpte2084)`.
fn matrix(subject: &str, line: &str) -> Result<Option<Matrix>, InputError> {
    let words = || line.split(|c: char| " (),/".contains(c)).filter(|word| !word.is_empty());
    let wide = |word: &&str| word.starts_with("bt2020") || ["smpte2084", "arib-std-b67"].contains(word);
    if let Some(word) = words().find(wide) {
        return Err(InputError::not_supported(
            subject,
            format!("is a video of high dynamic range or a wide gamut ({word})"),
            "convert it to BT.709, or give linear .exr frames",
        ));
    }
    let of = |word: &str| match word {
        "bt709" => Some(Matrix::Bt709),
        // ffmpeg converts R'G'B' with this matrix.
        "smpte170m" | "bt470bg" | "fcc" | "gbr" => Some(Matrix::Bt601),
        _ if ["rgb", "bgr", "gbrp", "argb", "abgr", "pal8"].iter().any(|rgb| word.starts_with(rgb)) => {
            Some(Matrix::Bt601)
        }
        _ => None,
    };
    Ok(words().find_map(of))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn streams_say_their_matrix() {
        let found = |line: &str| matrix("a.mp4", line);
        let (b601, b709) = (Some(Matrix::Bt601), Some(Matrix::Bt709));
        for (line, expected) in [
            ("Stream #0:0: Video: h264 (High) (avc1 / 0x31637661), yuv420p(tv, bt709, progressive), 1920x1080", b709),
            ("Stream #0:0: Video: h264 (High), yuv420p(tv, smpte170m/bt470bg/bt709, progressive), 1920x1080", b601),
            ("Stream #0:0: Video: vp9 (Profile 0), yuv420p(tv, progressive), 1920x1080, SAR 1:1", None),
            ("Stream #0:0: Video: h264 (High), yuv420p(tv, unknown/bt709/iec61966-2-1, progressive)", b709),
            ("Stream #0:0: Video: png (png / 0x20676E70), rgb24(pc, gbr/unknown/unknown), 64x64", b601),
            ("Stream #0:0: Video: gif, bgra, 64x64, 25 fps", b601),
        ] {
            assert_eq!(found(line).unwrap(), expected, "{line}");
        }
        for wide in ["yuv420p10le(tv, bt2020nc/bt2020/smpte2084)", "yuv420p(tv, unknown/unknown/arib-std-b67)"] {
            let error = found(&format!("Video: hevc, {wide}")).unwrap_err().to_string();
            assert!(error.contains("dynamic range"), "{error}");
        }
    }
}

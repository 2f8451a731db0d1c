//! YUV4MPEG2 (`.y4m`): uncompressed video, as files and as pipes have it.

use super::limits::ReadLimits;
use super::yuv::{Chroma, Coding, Matrix};
use crate::error::{InputError, io_error};
use std::io::{BufRead, ErrorKind, Read};

/// Longest header that is read, of the stream or of a frame.
const MOST_HEADER_BYTES: u64 = 4096;

/// What to do with a stream that is not read as it is.
const CONVERT: &str = "convert it: ffmpeg -i IN -pix_fmt yuv444p OUT.y4m";

/// Header of a stream.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Header {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Frames a second, if the stream states them.
    pub fps: Option<f32>,
    /// What the samples mean.
    pub coding: Coding,
    /// Whether pixels are squares, or not known to be none.
    pub has_square_pixels: bool,
}

impl Header {
    /// Reads the header of a stream. Its matrix is that which its size suggests.
    ///
    /// # Errors
    /// [`Invalid`](InputError::Invalid) and [`NotSupported`](InputError::NotSupported) for what is no such stream or of
    /// another coding, [`Limit`](InputError::Limit) for frames above `limits`.
    pub fn read(subject: &str, reader: &mut impl BufRead, limits: &ReadLimits) -> Result<Self, InputError> {
        let line = header_line(subject, reader)?.unwrap_or_default();
        let mut words = line.split(' ');
        if words.next() != Some("YUV4MPEG2") {
            return Err(InputError::invalid(subject, "does not start with YUV4MPEG2", CONVERT));
        }
        let (mut sides, mut fps, mut has_square_pixels) = ([0_u64; 2], None, true);
        let (mut chroma, mut is_full_range) = (Chroma::of("420").expect("a known name"), false);
        for word in words {
            let Some((first, value)) = word.split_at_checked(1) else { continue };
            match first {
                "W" | "H" => sides[usize::from(first == "H")] = value.parse().map_err(|_| damaged(subject, word))?,
                "F" => fps = rate(value).ok_or_else(|| damaged(subject, word))?,
                "A" => has_square_pixels = ["1:1", "0:0"].contains(&value),
                "I" if !["p", "?"].contains(&value) => {
                    let remedy = "deinterlace it: ffmpeg -i IN -vf bwdif -pix_fmt yuv444p OUT.y4m";
                    return Err(InputError::not_supported(subject, format!("is interlaced ({word})"), remedy));
                }
                "C" => {
                    chroma = Chroma::of(value).ok_or_else(|| {
                        let problem = format!("has samples of a kind that is not read ({word})");
                        InputError::not_supported(subject, problem, CONVERT)
                    })?;
                }
                "X" => is_full_range |= value.eq_ignore_ascii_case("COLORRANGE=FULL"),
                _ => {}
            }
        }
        let size = limits.check(subject, sides[0], sides[1])?;
        let coding = Coding { chroma, is_full_range, matrix: Matrix::of_size(size) };
        Ok(Self { size, fps, coding, has_square_pixels })
    }

    /// Reads the samples of the next frame into `planes`. Returns whether there was one.
    ///
    /// # Errors
    /// [`Invalid`](InputError::Invalid) for a frame that is cut off.
    pub fn read_frame(
        &self,
        subject: &str,
        reader: &mut impl BufRead,
        planes: &mut Vec<u8>,
    ) -> Result<bool, InputError> {
        let Some(line) = header_line(subject, reader)? else { return Ok(false) };
        if line.split(' ').next() != Some("FRAME") {
            return Err(InputError::invalid(subject, "is damaged: a frame has no header", "copy or convert it again"));
        }
        planes.resize(self.coding.chroma.frame_bytes(self.size), 0);
        reader.read_exact(planes).map_err(|e| io_error(subject, &e))?;
        Ok(true)
    }
}

fn damaged(subject: &str, word: &str) -> InputError {
    InputError::invalid(subject, format!("its header has {word}, which means nothing"), "copy or convert it again")
}

/// Frames a second of `N:D`: `None` for damage, `Some(None)` for `0:0`, which stands for unknown.
fn rate(text: &str) -> Option<Option<f32>> {
    let (n, d) = text.split_once(':')?;
    let (n, d): (u32, u32) = (n.parse().ok()?, d.parse().ok()?);
    let fps = f64::from(n) / f64::from(d);
    match (n, d) {
        (0, _) | (_, 0) => Some(None),
        _ => (0.01..=10_000.0).contains(&fps).then_some(Some(fps as f32)),
    }
}

/// A line of text; `None` at the end of the stream.
fn header_line(subject: &str, reader: &mut impl BufRead) -> Result<Option<String>, InputError> {
    let mut line = vec![];
    let io = |e: std::io::Error| io_error(subject, &e);
    reader.by_ref().take(MOST_HEADER_BYTES).read_until(b'\n', &mut line).map_err(io)?;
    match line.pop() {
        None => Ok(None),
        Some(b'\n') => Ok(Some(String::from_utf8_lossy(&line).into_owned())),
        Some(_) if (line.len() as u64) + 1 < MOST_HEADER_BYTES => Err(io(ErrorKind::UnexpectedEof.into())),
        Some(_) => Err(InputError::invalid(subject, "is damaged: a header has no end", "copy or convert it again")),
    }
}

/// Header of a stream of frames that [`yuv::encoded`](super::yuv::encoded) makes.
pub fn header_of([w, h]: [u32; 2], fps: f32) -> String {
    let (n, d) = ratio(fps);
    format!("YUV4MPEG2 W{w} H{h} F{n}:{d} Ip A1:1 C444 XCOLORRANGE=LIMITED\n")
}

/// Header of each frame.
pub const FRAME: &str = "FRAME\n";

/// Frames a second as a ratio: the rates of television (24000:1001) are no decimals.
fn ratio(fps: f32) -> (u64, u64) {
    let fps = f64::from(fps);
    let of_television = fps * 1.001;
    if (of_television - of_television.round()).abs() < 1e-4 * fps && fps.fract() != 0.0 {
        return (1000 * of_television.round() as u64, 1001);
    }
    let thousandths = (1000.0 * fps).round() as u64;
    if thousandths.is_multiple_of(1000) { (thousandths / 1000, 1) } else { (thousandths, 1000) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn header(line: &str) -> Result<Header, InputError> {
        Header::read("a.y4m", &mut format!("{line}\n").as_bytes(), &ReadLimits::default())
    }

    #[test]
    fn headers_say_size_rate_and_coding() {
        let found = header("YUV4MPEG2 W1280 H720 F30000:1001 Ip A1:1 C422 XYSCSS=422 XCOLORRANGE=FULL").unwrap();
        assert_eq!((found.size, found.coding.matrix, found.coding.is_full_range), ([1280, 720], Matrix::Bt709, true));
        assert!((found.fps.unwrap() - 29.97).abs() < 0.001);
        // What a header leaves out.
        let found = header("YUV4MPEG2 W5 H3").unwrap();
        assert_eq!((found.fps, found.coding.matrix, found.coding.is_full_range), (None, Matrix::Bt601, false));
        assert_eq!(found.coding.chroma.frame_bytes([5, 3]), 15 + 2 * 6);
        assert_eq!(header("YUV4MPEG2 W5 H3 F0:0 A4:3").unwrap().fps, None);
    }

    #[test]
    fn other_headers_are_refused() {
        for (line, words) in [
            ("RIFF", "does not start with YUV4MPEG2"),
            ("YUV4MPEG2 W8", "claims 8x0 pixels"),
            ("YUV4MPEG2 Wx H8", "has Wx"),
            ("YUV4MPEG2 W8 H8 F25", "has F25"),
            ("YUV4MPEG2 W8 H8 C420p10", "not read (C420p10)"),
            ("YUV4MPEG2 W8 H8 It", "is interlaced (It)"),
            ("YUV4MPEG2 W80000 H80000", "above the limit"),
        ] {
            let error = header(line).unwrap_err().to_string();
            assert!(error.starts_with("a.y4m: ") && error.contains(words), "{line}: {error}");
        }
        let long = header(&"x".repeat(5000)).unwrap_err().to_string();
        assert!(long.contains("no end"), "{long}");
    }

    #[test]
    fn rates_are_read_as_written() {
        for fps in [24.0, 23.976, 59.94, 29.97, 90.0, 12.5, 72.1] {
            let read = Header::read("a.y4m", &mut header_of([4, 4], fps).as_bytes(), &ReadLimits::default()).unwrap();
            assert!((read.fps.unwrap() - fps).abs() < 2e-3, "{fps}: {read:?}");
        }
        assert_eq!(ratio(23.976), (24000, 1001));
    }
}

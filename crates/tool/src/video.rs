//! Video of `--video`: reference and methods side by side, as `.y4m`, or through `ffmpeg` as `.mp4`.

use crate::failure::Failure;
use crate::output::WriteError;
use afterimage::Image;
use afterimage_eval::picture::to_rgb8;
use afterimage_eval::report::canvas::{CHAR_PX, Canvas, LINE_PX};
use afterimage_lab::source::ffmpeg::Ffmpeg;
use afterimage_lab::source::y4m;
use afterimage_lab::source::yuv::{self, Matrix};
use image::RgbImage;
use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use std::process::ChildStdin;

const GROUND: [u8; 3] = [24; 3];
const INK: [u8; 3] = [235; 3];
const GAZE: [u8; 3] = [255, 221, 0];

/// Radius of the circle that marks the gaze in the reference, pixels.
const GAZE_PX: f32 = 6.0;

/// A video of panels with their names, row by row, which grows frame by frame.
pub struct SideBySide {
    names: Vec<String>,
    panel: [u32; 2],
    columns: u32,
    file: VideoFile,
}

impl SideBySide {
    /// Starts a video of panels of one size in pixels.
    pub fn create<'a>(
        path: &Path,
        names: impl Iterator<Item = &'a str>,
        panel: [u32; 2],
        fps: f32,
    ) -> Result<Self, Failure> {
        let names: Vec<String> = names.map(|name| shortened(name, panel[0])).collect();
        let columns = (names.len() as f32).sqrt().ceil() as u32;
        let rows = (names.len() as u32).div_ceil(columns);
        // Chroma of 4:2:0 needs even sides.
        let size = [columns * panel[0], rows * (panel[1] + LINE_PX)].map(|side| side.next_multiple_of(2));
        Ok(Self { names, panel, columns, file: VideoFile::create(path, size, fps)? })
    }

    /// Adds a frame: the pictures of all panels, and the gaze, which the first of them marks.
    pub fn push<'a>(
        &mut self,
        pictures: impl Iterator<Item = &'a Image<[f32; 3]>>,
        gaze_px: [f32; 2],
    ) -> Result<(), WriteError> {
        let [width, height] = self.file.size;
        let mut canvas = Canvas::new(width, height, GROUND);
        for (i, (name, picture)) in (0..).zip(self.names.iter().zip(pictures)) {
            let corner = [i % self.columns * self.panel[0], i / self.columns * (self.panel[1] + LINE_PX)];
            canvas.text(name, corner[0] + 4, corner[1] + 1, INK);
            canvas.put(&to_rgb8(picture), corner[0], corner[1] + LINE_PX);
        }
        canvas.circle([gaze_px[0], gaze_px[1] + LINE_PX as f32], GAZE_PX, 1, GAZE);
        self.file.push(&canvas.0)
    }

    /// Ends the video, and gives it its name.
    pub fn finish(self) -> Result<(), WriteError> {
        self.file.finish()
    }
}

/// A name that fits above a panel.
fn shortened(name: &str, width_px: u32) -> String {
    let room = (width_px.saturating_sub(8) / CHAR_PX).max(1) as usize;
    if name.chars().count() <= room { name.to_owned() } else { name.chars().take(room - 1).chain(['~']).collect() }
}

/// A video under a temporary name, which is removed unless the video is finished.
struct VideoFile {
    path: PathBuf,
    partial: PathBuf,
    size: [u32; 2],
    sink: Option<Sink>,
}

/// Where frames go.
enum Sink {
    File(BufWriter<File>),
    Ffmpeg(BufWriter<ChildStdin>, Ffmpeg),
}

impl VideoFile {
    fn create(path: &Path, size: [u32; 2], fps: f32) -> Result<Self, Failure> {
        let refuse = |text: String| Failure::Input(format!("--video {}: {text}", path.display()));
        let ending = path.extension().map(|ending| ending.to_string_lossy().to_lowercase()).unwrap_or_default();
        let name = path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
        if !["mp4", "y4m"].contains(&ending.as_str()) {
            return Err(refuse("is no kind of video that is written; expected FILE.mp4 or FILE.y4m".into()));
        }
        let folder = path.parent().unwrap_or(Path::new(""));
        let cannot = |e: io::Error| refuse(format!("cannot be written ({e}); give a file in a folder that can be"));
        fs::create_dir_all(folder).map_err(cannot)?;
        let partial = folder.join(format!(".{name}.{}.part", std::process::id()));
        let file = File::create(&partial).map_err(cannot)?;
        let mut video = Self { path: path.to_owned(), partial, size, sink: None };
        video.sink = Some(if ending == "y4m" {
            Sink::File(BufWriter::new(file))
        } else {
            let matrix = if Matrix::of_size(size) == Matrix::Bt709 { "bt709" } else { "smpte170m" };
            let (ffmpeg, pipe) = Ffmpeg::encode(&video.partial, matrix, &path.display().to_string())?;
            Sink::Ffmpeg(BufWriter::new(pipe), ffmpeg)
        });
        video.write(y4m::header_of(size, fps).as_bytes())?;
        Ok(video)
    }

    fn push(&mut self, picture: &RgbImage) -> Result<(), WriteError> {
        self.write(y4m::FRAME.as_bytes())?;
        self.write(&yuv::encoded(picture))
    }

    fn write(&mut self, bytes: &[u8]) -> Result<(), WriteError> {
        let written = match &mut self.sink {
            Some(Sink::File(file)) => file.write_all(bytes),
            Some(Sink::Ffmpeg(pipe, _)) => pipe.write_all(bytes),
            None => Ok(()),
        };
        // A pipe breaks when the process ends.
        written.or_else(|e| self.close().and(Err(self.failed(&e.to_string()))))
    }

    /// Ends the file or the process.
    fn close(&mut self) -> Result<(), WriteError> {
        let closed = match self.sink.take() {
            Some(Sink::File(mut file)) => file.flush().map_err(|e| e.to_string()),
            Some(Sink::Ffmpeg(pipe, mut ffmpeg)) => {
                let flushed = pipe.into_inner().map(drop).map_err(|e| e.error().to_string());
                ffmpeg.failure().map_or(flushed, |why| Err(format!("ffmpeg: {why}")))
            }
            None => Ok(()),
        };
        closed.map_err(|why| self.failed(&why))
    }

    fn finish(mut self) -> Result<(), WriteError> {
        self.close()?;
        fs::rename(&self.partial, &self.path).map_err(|e| self.failed(&e.to_string()))
    }

    fn failed(&self, why: &str) -> WriteError {
        WriteError::new(&self.path, why).with_remedy("free space, or give a .y4m file, which needs no ffmpeg")
    }
}

impl Drop for VideoFile {
    fn drop(&mut self) {
        // The process ends first. After `finish` nothing is left.
        self.sink = None;
        let _ = fs::remove_file(&self.partial);
    }
}

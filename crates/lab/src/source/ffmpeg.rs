//! `ffmpeg` as a process that decodes or encodes video through a pipe.

use crate::error::{InputError, one_line};
use std::ffi::OsString;
use std::io::{self, BufRead, BufReader, ErrorKind, Read};
use std::path::Path;
use std::process::{Child, ChildStderr, ChildStdin, ChildStdout, Command, ExitStatus, Stdio};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

/// How long messages are awaited that the process has written: another process may hold its pipe open.
const PATIENCE: Duration = Duration::from_secs(2);

/// Longest message that is kept.
const MOST_MESSAGE_BYTES: usize = 1 << 14;

/// A running `ffmpeg`, which is killed when this is dropped.
#[derive(Debug)]
pub struct Ffmpeg {
    child: Child,
    said: Arc<Said>,
}

/// What the process wrote to its stderr.
#[derive(Debug, Default)]
struct Said {
    lines: Mutex<Lines>,
    news: Condvar,
}

#[derive(Debug, Default)]
struct Lines {
    /// The first line that describes a video stream: that of the input.
    stream: Option<String>,
    last: String,
    has_ended: bool,
}

impl Ffmpeg {
    /// Starts decoding the first `most` frames of a file, or all, to y4m of 4:4:4.
    ///
    /// # Errors
    /// [`NotSupported`](InputError::NotSupported) without an `ffmpeg`.
    pub fn decode(file: &Path, most: Option<u64>) -> Result<(Self, ChildStdout), InputError> {
        let mut command = Command::new("ffmpeg");
        // What a file names is not opened, unless it is a file, too.
        command.args(["-hide_banner", "-nostats", "-nostdin", "-v", "info", "-protocol_whitelist", "file", "-i"]);
        let mut input = OsString::from("file:");
        input.push(file);
        command.arg(input).args(["-map", "0:v:0"]);
        if let Some(most) = most {
            command.args(["-frames:v", &most.to_string()]);
        }
        command.args(["-pix_fmt", "yuv444p", "-f", "yuv4mpegpipe", "-strict", "-1", "-"]);
        command.stdin(Stdio::null()).stdout(Stdio::piped());
        let mut ffmpeg = Self::start(command, &file.display().to_string(), "reading")?;
        let pipe = ffmpeg.child.stdout.take().expect("it is piped");
        Ok((ffmpeg, pipe))
    }

    /// Starts encoding y4m to a file as H.264; `matrix` is `bt709` or `smpte170m`. `named` is the file in errors.
    ///
    /// # Errors
    /// [`NotSupported`](InputError::NotSupported) without an `ffmpeg`.
    pub fn encode(file: &Path, matrix: &str, named: &str) -> Result<(Self, ChildStdin), InputError> {
        let mut command = Command::new("ffmpeg");
        command.args(["-hide_banner", "-nostats", "-v", "error", "-y", "-f", "yuv4mpegpipe", "-i", "-"]);
        let tags = format!(
            "setparams=colorspace={matrix}:color_primaries=bt709:color_trc=iec61966-2-1:range=tv,format=yuv420p"
        );
        command.args(["-vf", &tags, "-c:v", "libx264", "-crf", "16", "-movflags", "+faststart", "-f", "mp4"]);
        let mut output = OsString::from("file:");
        output.push(file);
        command.arg(output).stdin(Stdio::piped()).stdout(Stdio::null());
        let mut ffmpeg = Self::start(command, named, "writing")?;
        let pipe = ffmpeg.child.stdin.take().expect("it is piped");
        Ok((ffmpeg, pipe))
    }

    fn start(mut command: Command, subject: &str, doing: &str) -> Result<Self, InputError> {
        let mut child = command.stderr(Stdio::piped()).spawn().map_err(|e| {
            let found = if e.kind() == ErrorKind::NotFound { "is not found".into() } else { format!("fails ({e})") };
            InputError::not_supported(
                subject,
                format!("is a video, and ffmpeg, which {doing} it needs, {found}"),
                "install it (apt install ffmpeg, brew install ffmpeg, winget install ffmpeg), or use .y4m, which needs \
                 none, or frames",
            )
        })?;
        let said = Arc::new(Said::default());
        let (stderr, listener) = (child.stderr.take().expect("it is piped"), said.clone());
        thread::spawn(move || listener.listen(stderr));
        Ok(Self { child, said })
    }

    /// The line that describes the stream that is decoded, once frames come.
    pub(super) fn stream(&self) -> Option<String> {
        self.said.wait_for(|lines| lines.stream.is_some()).stream.clone()
    }

    /// Waits for the end of a process that encodes, whose pipe is closed. Returns why it failed, unless it succeeded.
    pub fn failure(&mut self) -> Option<String> {
        let status = self.child.wait();
        self.why(status)
    }

    /// The same of a process that decodes and has closed its pipe: it has to end soon.
    pub(super) fn failure_after_end(&mut self) -> Option<String> {
        let started = Instant::now();
        while started.elapsed() < PATIENCE && matches!(self.child.try_wait(), Ok(None)) {
            thread::sleep(Duration::from_millis(5));
        }
        let status = self.child.kill().and_then(|()| self.child.wait());
        self.why(status)
    }

    fn why(&self, status: io::Result<ExitStatus>) -> Option<String> {
        let status = match status {
            Ok(status) if status.success() => return None,
            Ok(status) => status,
            Err(e) => return Some(one_line(&e.to_string())),
        };
        let last = self.said.wait_for(|_| false).last.clone();
        Some(if last.is_empty() { one_line(&format!("it ended with {status}")) } else { last })
    }
}

impl Drop for Ffmpeg {
    fn drop(&mut self) {
        // It may have ended.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

impl Said {
    /// Keeps what a later message needs; a pipe that nobody reads would stop the process.
    fn listen(&self, stderr: ChildStderr) {
        let mut reader = BufReader::new(stderr);
        let mut line = vec![];
        while reader.by_ref().take(MOST_MESSAGE_BYTES as u64).read_until(b'\n', &mut line).is_ok_and(|n| n > 0) {
            let text = one_line(&String::from_utf8_lossy(&line));
            let mut lines = self.lock();
            if lines.stream.is_none() && text.starts_with("Stream #") && text.contains("Video: ") {
                lines.stream = Some(text.clone());
            }
            if !text.is_empty() {
                lines.last = text;
            }
            self.news.notify_all();
            line.clear();
        }
        self.lock().has_ended = true;
        self.news.notify_all();
    }

    /// The lines once they satisfy a condition, or are all.
    fn wait_for(&self, is_enough: impl Fn(&Lines) -> bool) -> MutexGuard<'_, Lines> {
        let is_waiting = |lines: &mut Lines| !lines.has_ended && !is_enough(lines);
        let waited = self.news.wait_timeout_while(self.lock(), PATIENCE, is_waiting);
        waited.unwrap_or_else(PoisonError::into_inner).0
    }

    fn lock(&self) -> MutexGuard<'_, Lines> {
        self.lines.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

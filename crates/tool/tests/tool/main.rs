//! The command-line tool as a process: files and errors.

mod albedo;
mod bench;
mod cameras;
mod channels;
mod compare;
mod files;
mod gaze_logs;
mod head;
mod info;
mod inputs;
mod latency;
mod pixel;
mod quads;
mod refusals;
mod rig;
mod run;
mod sweep;
mod trace;
#[cfg(unix)]
mod video;

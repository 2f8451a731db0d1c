//! The command-line tool as a process: files and errors.

mod bench;
mod head;
mod info;
mod latency;
mod quads;
mod refusals;
mod rig;
mod run;
mod sweep;
mod trace;

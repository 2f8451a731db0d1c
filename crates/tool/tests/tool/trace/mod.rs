//! `afterimage trace` as a process: files and errors.

mod frames;
mod refusals;
mod rig;
mod stereo;

//! `afterimage trace` as a process: files and errors.

mod frames;
mod rig;
mod stereo;

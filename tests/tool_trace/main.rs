//! `afterimage trace` as other programs use it: what it writes, and how it refuses.
#![cfg(feature = "cli")]

mod frames;
mod refusals;
mod rig;
mod stereo;

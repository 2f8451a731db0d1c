//! `afterimage trace` as other programs use it: what it writes, and how it refuses.

mod frames;
mod refusals;
mod rig;
mod stereo;

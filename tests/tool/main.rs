//! The command-line tool as other programs use it: what it writes, and how it refuses.
#![cfg(feature = "cli")]

mod bench;
mod info;
mod refusals;
mod rig;
mod run;

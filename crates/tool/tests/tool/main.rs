//! The command-line tool as other programs use it: what it writes, and how it refuses.

mod bench;
mod info;
mod refusals;
mod rig;
mod run;
mod sweep;
mod trace;

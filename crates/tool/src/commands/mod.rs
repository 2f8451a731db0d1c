//! Subcommands, one file or folder each.

pub mod bench;
pub mod compare;
pub mod info;
pub mod run;
pub mod scanpath;
pub mod sweep;
pub mod trace;
#[cfg(feature = "view")]
pub mod view;

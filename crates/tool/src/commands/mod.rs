//! Subcommands, one file or folder each.

#[cfg(feature = "full")]
pub mod bench;
pub mod demo;
#[cfg(feature = "full")]
pub mod info;
#[cfg(feature = "full")]
pub mod run;
#[cfg(feature = "full")]
pub mod scanpath;
#[cfg(feature = "full")]
pub mod sweep;
#[cfg(feature = "full")]
pub mod trace;
#[cfg(feature = "view")]
pub mod view;

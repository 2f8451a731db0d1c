//! Passes over frames whose every pixel has a color: full-size frames with levels of detail, and planned frames that
//! `fill` completes.

pub(super) mod fill;
pub(super) mod mip_chain;
pub(super) mod none_pass;
pub(super) mod smr_pass;
mod surface_history;
pub(super) mod surface_pass;
pub(super) mod taa_pass;
pub(super) mod taau_pass;
pub(super) mod wrs_pass;

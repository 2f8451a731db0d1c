//! Entries of the methods that read whole frames: one file a method.

pub(super) mod none;
pub(super) mod smr;
pub(super) mod taa;
pub(super) mod taau;
pub(super) mod wrs;

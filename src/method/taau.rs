//! Temporal upsampling.

use super::{Entry, HistoryLayout};

pub(super) static ENTRY: Entry = Entry {
    name: "taau",
    summary: "temporal upsampling of sparse frames",
    history: |_| HistoryLayout::Surfaces { levels: 0, noisy: false },
    history_traffic_bytes: |_| 2 * 8,
    #[cfg(feature = "gpu")]
    shader: "taau_pass",
    #[cfg(feature = "gpu")]
    block_px: 1,
    #[cfg(feature = "gpu")]
    overrides: |_, _| vec![],
};

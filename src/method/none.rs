//! No method: the sanitized foveated frame.

use super::{Entry, HistoryLayout};

pub(super) static ENTRY: Entry = Entry {
    name: "none",
    summary: "the foveated frame alone",
    history: |_| HistoryLayout::Nothing,
    history_traffic_bytes: |_| 0,
    #[cfg(feature = "gpu")]
    shader: "none_pass",
    #[cfg(feature = "gpu")]
    block_px: 1,
    #[cfg(feature = "gpu")]
    overrides: |_, _| vec![],
};

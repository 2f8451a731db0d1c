//! Temporal antialiasing of the foveated frame.

use super::{Entry, HistoryLayout};

pub(super) static ENTRY: Entry = Entry {
    name: "taa",
    summary: "temporal antialiasing of the foveated frame",
    history: |_| HistoryLayout::Surfaces { levels: 0, noisy: false },
    history_traffic_bytes: |_| 2 * 8,
    #[cfg(feature = "gpu")]
    shader: "taa_pass",
    #[cfg(feature = "gpu")]
    block_px: 1,
    #[cfg(feature = "gpu")]
    overrides: |_, _| vec![],
};

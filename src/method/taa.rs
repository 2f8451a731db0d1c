//! Temporal antialiasing of the foveated frame.

use super::{Algorithm, Entry, HistoryLayout, PassShader, whole_frames};

pub(super) static ENTRY: Entry = Entry {
    name: "taa",
    summary: "temporal antialiasing of the foveated frame",
    algorithm: Algorithm::Taa,
    stages: whole_frames,
    history: |_| HistoryLayout::Surfaces { levels: 0, noisy: false },
    history_traffic_bytes: |_| 2 * 8,
    shader: |_| PassShader { name: "taa_pass", block_px: 1 },
    overrides: |_| vec![],
};

//! No method: the sanitized foveated frame.

use super::{Algorithm, Entry, HistoryLayout, PassShader, whole_frames};

pub(super) static ENTRY: Entry = Entry {
    name: "none",
    summary: "the foveated frame alone",
    algorithm: Algorithm::None,
    stages: whole_frames,
    history: |_| HistoryLayout::Nothing,
    history_traffic_bytes: |_| 0,
    shader: |_| PassShader { name: "none_pass", block_px: 1 },
    overrides: |_| vec![],
};

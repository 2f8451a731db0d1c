//! Temporal antialiasing of the foveated frame.

#[cfg(feature = "gpu")]
use super::PassShader;
use super::{Algorithm, Entry, HistoryLayout, whole_frames};

pub(super) static ENTRY: Entry = Entry {
    name: "taa",
    summary: "temporal antialiasing of the foveated frame",
    algorithm: Algorithm::Taa,
    stages: whole_frames,
    history: |_| HistoryLayout::Surfaces { levels: 0, noisy: false },
    history_traffic_bytes: |_| 2 * 8,
    #[cfg(feature = "gpu")]
    shader: |_| PassShader { name: "taa_pass", block_px: 1, reads_samples: false },
    #[cfg(feature = "gpu")]
    overrides: |_, _| vec![],
};

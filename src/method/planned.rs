//! Temporal reconstruction of planned frames: keeps samples with their places, compares the new ones with history
//! first, and reconstructs the pixels between them.

use super::{Algorithm, Entry, HistoryLayout, PassShader, Stage};
use crate::settings::Settings;

pub(super) static ENTRY: Entry = Entry {
    name: "reconstruction",
    summary: "temporal reconstruction of planned frames",
    algorithm: Algorithm::Reconstruction,
    stages: |_| vec![Stage::Quads, Stage::Method],
    history: |settings| HistoryLayout::Sparse { noisy: settings.noisy, means: antialiases(settings) },
    history_traffic_bytes: |settings| {
        // Samples of history: 8 bytes read, 8 written. A quarter of the pixels, or fewer, have samples of this frame.
        // For each of these, history is read (8), and the observation (16) is written and read, and so is the
        // rectification at their quad (32).
        let samples = (8 + 16 + 32_u32 / 4).div_ceil(4);
        // The noise of samples (4) and the noise of history (4) are read. The noise of history is written (4).
        2 * 8 + samples + if settings.noisy { 4 + 2 * 4 } else { 0 }
    },
    shader: |_| PassShader { name: "quad_pass", block_px: 1 },
    overrides: |settings| {
        vec![("ANTIALIAS", u32::from(antialiases(settings))), ("RELIGHT_ON", u32::from(relights(settings)))]
    },
};

/// Whether history stores means of jittered samples. Noisy samples are averaged in another way.
pub(crate) fn antialiases(settings: &Settings) -> bool {
    settings.method.smr().antialias && !settings.noisy
}

/// Whether history is relit. Noisy frames are not relit: a gain is a ratio of means of few samples, so relighting
/// would multiply history by the noise of these means.
pub(crate) fn relights(settings: &Settings) -> bool {
    settings.method.smr().relight && !settings.noisy
}

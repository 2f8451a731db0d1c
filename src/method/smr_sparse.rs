//! Scale-matched reservoirs of sparse frames. The algorithm differs from that of whole frames. It keeps samples with
//! their places, compares the samples with history first, and reconstructs the pixels between them.

use super::{Algorithm, Entry, HistoryLayout, PassShader, Stage};
use crate::foveation::Filter;
use crate::settings::Settings;

pub(super) static ENTRY: Entry = Entry {
    name: "smr-sparse",
    summary: "scale-matched reservoirs of sparse frames",
    algorithm: Algorithm::SmrSparse,
    stages: |settings| match settings.foveation.filter {
        Filter::Quads => vec![Stage::Quads, Stage::Method],
        _ => vec![Stage::Geometry, Stage::Samples, Stage::Method],
    },
    history: |settings| HistoryLayout::Sparse { noisy: settings.noisy, means: smr_sparse_antialiases(settings) },
    history_traffic_bytes: |settings| {
        // Samples of history: 8 bytes read, 8 written. At most a third of the pixels (1/4 + 1/16 + ...) have samples of
        // this frame. For each of these, history is read (8), and the observation (16) and the light (16) are written
        // and read.
        let samples = (8 + 16 + 16_u32).div_ceil(3);
        // The noise of samples (4) and the noise of history (4) are read. The noise of history is written (4).
        2 * 8 + samples + if settings.noisy { 4 + 2 * 4 } else { 0 }
    },
    shader: |settings| match settings.foveation.filter {
        Filter::Quads => PassShader { name: "quad_pass", block_px: 1 },
        _ => PassShader { name: "sparse_pass", block_px: 1 },
    },
    overrides: |settings| {
        vec![
            ("ANTIALIAS", u32::from(smr_sparse_antialiases(settings))),
            ("RELIGHT_ON", u32::from(smr_sparse_relights(settings))),
            ("SAMPLE_DEPTH", u32::from(settings.foveation.filter == Filter::Quads)),
        ]
    },
};

/// Whether history stores means of jittered samples. Noisy samples are averaged in another way.
pub(crate) fn smr_sparse_antialiases(settings: &Settings) -> bool {
    settings.method.smr().antialias && !settings.noisy
}

/// Whether history is relit. Noisy frames are not relit: a gain is a ratio of means of nine samples, so relighting
/// would multiply history by the noise of these means.
pub(crate) fn smr_sparse_relights(settings: &Settings) -> bool {
    settings.method.smr().relight && !settings.noisy
}

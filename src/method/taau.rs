//! Temporal upsampling.

use super::{Algorithm, Entry, HistoryLayout, PassShader, Stage};
use crate::foveation::FoveationKind;

pub(super) static ENTRY: Entry = Entry {
    name: "taau",
    summary: "temporal upsampling of planned frames",
    algorithm: Algorithm::Taau,
    stages: |settings| match settings.foveation.kind {
        FoveationKind::Quads => vec![Stage::Fill, Stage::Method],
        _ => vec![Stage::Method],
    },
    history: |_| HistoryLayout::Surfaces { levels: 0, noisy: false },
    history_traffic_bytes: |_| 2 * 8,
    shader: |_| PassShader { name: "taau_pass", block_px: 1 },
    overrides: |settings| vec![("BY_QUADS", u32::from(settings.foveation.kind == FoveationKind::Quads))],
};

//! Scale-matched reservoirs.

use super::{Algorithm, Entry, HistoryLayout, PassShader, Stage};
use crate::foveation::FoveationKind;
use crate::kernel::mip_noise::NOISY_LEVELS;
use crate::kernel::smr::SmrParams;
use crate::settings::Settings;

pub(super) static ENTRY: Entry = Entry {
    name: "smr",
    summary: "scale-matched reservoirs; of planned frames, temporal reconstruction",
    algorithm: Algorithm::Smr,
    stages: |settings| match settings.noisy {
        true => vec![Stage::Candidates, Stage::Method, Stage::MipChain],
        false => vec![Stage::Method, Stage::MipChain],
    },
    history,
    history_traffic_bytes,
    // An invocation processes 2x2 pixels, so that it can also write their mean, the first level of the mip chain.
    shader: |_| PassShader { name: "smr_pass", block_px: 2 },
    overrides: |settings| {
        vec![("FILTER", filter(settings) as u32), ("RELIGHT_ON", u32::from(settings.method.smr().relight))]
    },
};

fn history(settings: &Settings) -> HistoryLayout {
    // Two levels above the candidate's: one to measure contrast, one to blend with. Blocks are compared one level
    // coarser.
    let shift = match settings.foveation.kind {
        _ if settings.noisy => 2 + NOISY_LEVELS as u32,
        FoveationKind::Block => 3,
        _ => 2,
    };
    HistoryLayout::Surfaces { levels: settings.foveation.max_level() + shift, noisy: settings.noisy }
}

fn history_traffic_bytes(settings: &Settings) -> u32 {
    // Surfaces: 8 bytes read, 8 written. Their mip chain has a third of the texels, 8 bytes each: read by the pass,
    // written, and read again to fill its coarser levels.
    let surfaces = 2 * 8 + 8;
    // The candidates' mip chain: color (8) and noise (4) are read to fill it, and it has the traffic of the surfaces'
    // one (8). The pass reads noise (4), and reads and writes the stored noise (4 each).
    let noise = if settings.noisy { (8 + 4 + 8) + 4 + 2 * 4 } else { 0 };
    surfaces + noise
}

/// Kind of frames that the pass assumes. Noisy blocks are treated as mip levels, because noise exceeds their aliasing.
fn filter(settings: &Settings) -> FoveationKind {
    match settings.foveation.kind {
        FoveationKind::Block if settings.noisy => FoveationKind::Mip,
        filter => filter,
    }
}

pub(crate) fn smr_params(settings: &Settings) -> SmrParams {
    let smr = settings.method.smr();
    let blocks = filter(settings) == FoveationKind::Block;
    SmrParams {
        accumulate: smr.accumulate,
        // Rejecting coarse history costs little detail, so it must fit more strictly. The test is less strict for
        // blocks and noise, which need averaging, and for Gaussian blurs, which never agree with levels of history
        // exactly.
        accumulate_tolerance: if settings.noisy || filter(settings) == FoveationKind::Gauss {
            0.5
        } else if blocks {
            0.67
        } else {
            0.17
        },
        tolerance: smr.tolerance,
        blocks,
        relight: smr.relight,
        noisy: settings.noisy,
    }
}

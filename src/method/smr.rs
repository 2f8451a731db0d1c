//! Scale-matched reservoirs.

#[cfg(feature = "gpu")]
use super::PassShader;
use super::{Entry, HistoryLayout};
use crate::foveation::Filter;
use crate::kernel::matched::SmrParams;
use crate::kernel::noise::NOISY_LEVELS;
use crate::settings::Settings;

pub(super) static ENTRY: Entry = Entry {
    name: "smr",
    summary: "scale-matched reservoirs",
    history,
    history_traffic_bytes,
    #[cfg(feature = "gpu")]
    shader: |settings| match settings.foveation.filter {
        Filter::Sparse => PassShader { name: "sparse_pass", block_px: 1, reads_samples: true },
        // An invocation processes 2x2 pixels, so that it can also write their mean, the first level of the mip chain.
        _ => PassShader { name: "smr_pass", block_px: 2, reads_samples: false },
    },
    #[cfg(feature = "gpu")]
    overrides: |settings, has_lod| match settings.foveation.filter {
        Filter::Sparse => vec![],
        _ => vec![
            ("HAS_LOD", u32::from(has_lod)),
            ("FILTER", filter(settings) as u32),
            ("RELIGHT_ON", u32::from(settings.method.smr().relight)),
        ],
    },
};

fn history(settings: &Settings) -> HistoryLayout {
    if settings.foveation.filter == Filter::Sparse {
        return HistoryLayout::Kept { noisy: settings.noisy };
    }
    // Two levels above the candidate's: one to measure contrast, one to blend with. Blocks are compared one level
    // coarser.
    let shift = match settings.foveation.filter {
        _ if settings.noisy => 2 + NOISY_LEVELS as u32,
        Filter::Block => 3,
        _ => 2,
    };
    HistoryLayout::Surfaces { levels: settings.foveation.max_level() + shift, noisy: settings.noisy }
}

fn history_traffic_bytes(settings: &Settings) -> u32 {
    if settings.foveation.filter == Filter::Sparse {
        // Samples of history: 8 bytes read, 8 written. A quarter of the pixels, and a quarter of these, and so on, at
        // most have samples of this frame: for each, history is read (8), the observation is written and read (16), and
        // so is the light (16).
        let samples = (8 + 16 + 16_u32).div_ceil(3);
        // The noise of samples (4) and that of history (4) are read, and the latter is written (4).
        return 2 * 8 + samples + if settings.noisy { 4 + 2 * 4 } else { 0 };
    }
    // Surfaces: 8 bytes read, 8 written. Their mip chain has a third of the texels, 8 bytes each: read by the pass,
    // written, and read again to fill its coarser levels.
    let surfaces = 2 * 8 + 8;
    // The candidates' mip chain: color (8) and noise (4) are read to fill it, and it has the traffic of the surfaces'
    // one (8). The pass reads noise (4), and reads and writes the stored noise (4 each).
    let noise = if settings.noisy { (8 + 4 + 8) + 4 + 2 * 4 } else { 0 };
    surfaces + noise
}

/// Filter that the pass assumes. Noisy blocks are treated as mip levels, because noise exceeds their aliasing.
fn filter(settings: &Settings) -> Filter {
    match settings.foveation.filter {
        Filter::Block if settings.noisy => Filter::Mip,
        filter => filter,
    }
}

/// Whether history of sparse frames is relit. Not that of noisy ones: a gain is the ratio of nine samples, and history
/// would be multiplied by their noise.
pub(crate) fn smr_relights(settings: &Settings) -> bool {
    settings.method.smr().relight && !settings.noisy
}

/// Parameters of the kernel from smr's settings.
pub(crate) fn smr_params(settings: &Settings) -> SmrParams {
    let smr = settings.method.smr();
    let blocks = filter(settings) == Filter::Block;
    SmrParams {
        accumulate: smr.accumulate,
        // Rejecting coarse history costs little detail, so it must fit more strictly. Aliasing of blocks and noise need
        // averaging, and Gaussian blurs never agree with levels of history exactly.
        accumulate_tolerance: if settings.noisy || filter(settings) == Filter::Gauss {
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

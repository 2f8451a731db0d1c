//! Scale-matched reservoirs.

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
    shader: "smr_pass",
    // So that the next mip level of what the pass stores needs no second pass.
    #[cfg(feature = "gpu")]
    block_px: 2,
    #[cfg(feature = "gpu")]
    overrides: |settings, has_lod| {
        vec![
            ("HAS_LOD", u32::from(has_lod)),
            ("FILTER", filter(settings) as u32),
            ("RELIGHT_ON", u32::from(settings.smr.relight)),
        ]
    },
};

fn history(settings: &Settings) -> HistoryLayout {
    // Two levels beyond the candidate's: one for its contrast, one to blend with; blocks are compared one level coarser.
    let shift = match settings.foveation.filter {
        _ if settings.noisy => 2 + NOISY_LEVELS as u32,
        Filter::Block => 3,
        _ => 2,
    };
    HistoryLayout::Surfaces { levels: settings.foveation.max_level() + shift, noisy: settings.noisy }
}

fn history_traffic_bytes(settings: &Settings) -> u32 {
    // The mip chain, a third of the pixels at 8 bytes: read once by the pass, written, and read again but for its first level.
    let surfaces = 2 * 8 + 8;
    // The candidates' mip chain reads color and noise, and is written, read for its own levels and read by the pass like the other
    // one; noise itself, and 4 bytes of it stored.
    let noise = if settings.noisy { (8 + 4 + 8) + 4 + 2 * 4 } else { 0 };
    surfaces + noise
}

/// The filter as the pass sees it. Noise is more than what point samples alias.
fn filter(settings: &Settings) -> Filter {
    match settings.foveation.filter {
        Filter::Block if settings.noisy => Filter::Mip,
        filter => filter,
    }
}

/// The kernel's form of smr's tunables.
pub(crate) fn smr_params(settings: &Settings) -> SmrParams {
    let blocks = filter(settings) == Filter::Block;
    SmrParams {
        accumulate: settings.smr.accumulate,
        // Coarse history is only a mean, so a stricter fit costs little, but the noise of point samples needs the mean.
        accumulate_tolerance: if blocks { 1.0 } else { 0.5 },
        tolerance: settings.smr.tolerance,
        blocks,
        relight: settings.smr.relight,
        noisy: settings.noisy,
    }
}

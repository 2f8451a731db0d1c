//! No method: outputs the sanitized candidate.

use super::Pass;
use crate::image::Image;
use crate::kernel::debug_view::PixelTrace;
use crate::kernel::reproject::Verdict;
use crate::kernel::sanitize;
use crate::stats::FrameStats;
use glam::Vec3;

pub(super) fn run(pass: Pass<'_, '_>) -> FrameStats {
    let Pass { desc, frame, output, mut traces, .. } = pass;
    let mut stats = FrameStats::default();
    let [sx, sy] = desc.motion.to_internal(desc.size_px);
    for (i, (color, out)) in frame.color.iter().zip(output).enumerate() {
        for (src, dst) in color.pixels().iter().zip(out.pixels_mut()) {
            let (color, valid) = sanitize::color(Vec3::from(*src));
            *dst = color.to_array();
            stats.nonfinite += u64::from(!valid);
        }
        if let Some(traces) = &mut traces {
            // Without history the previous jitter counts as 0.
            let [dx, dy] = desc.motion.jitter_offset(frame.views[i].jitter_px, [0.0; 2]);
            traces[i] = match frame.motion {
                Some(motion) => {
                    motion[i].map(|m| PixelTrace { motion: [m[0] * sx + dx, m[1] * sy + dy], ..PixelTrace::default() })
                }
                None => Image::filled(desc.size_px, PixelTrace::default()),
            };
        }
        stats.pixels += color.pixels().len() as u64;
    }
    stats.verdicts[Verdict::Reset as usize] = stats.pixels;
    stats
}

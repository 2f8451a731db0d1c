//! No method: outputs the sanitized candidate.

use super::Pass;
use super::explain::of_view;
use super::inputs::Inputs;
use crate::image::Image;
use crate::kernel::debug_view::PixelTrace;
use crate::kernel::reproject::Verdict;
use crate::kernel::sanitize;
use crate::notes::{NoteStage, Notes, PixelNotes};
use crate::stats::FrameStats;
use glam::Vec3;

pub(super) fn run(pass: Pass<'_, '_>) -> FrameStats {
    let Pass { desc, history, frame, output, mut traces, mut noted, .. } = pass;
    let mut stats = FrameStats::default();
    for (i, (color, out)) in frame.color.iter().zip(output).enumerate() {
        for (src, dst) in color.pixels().iter().zip(out.pixels_mut()) {
            let (color, valid) = sanitize::color(Vec3::from(*src));
            *dst = color.to_array();
            stats.nonfinite += u64::from(!valid);
        }
        if let Some(traces) = &mut traces {
            let inputs = Inputs::new(desc, frame, i, &history.held_after(i, &frame.views[i]), false);
            let traced = |[x, y]: [u32; 2]| PixelTrace { motion: inputs.motion(x, y), ..PixelTrace::default() };
            traces[i] = Image::from_fn(desc.size_px, traced);
        }
        if let Some(PixelNotes { px: [x, y], notes, .. }) = of_view(&mut noted, i) {
            let (color, usable) = sanitize::color(Vec3::from(color.at(*x as usize, *y as usize)));
            notes.note(NoteStage::Candidate, "usable", usable, "");
            notes.note(NoteStage::Verdict, "history", "none: the method keeps no history", "");
            notes.note(NoteStage::Shown, "color", color, "linear light");
        }
        stats.pixels += color.pixels().len() as u64;
    }
    stats.verdicts[Verdict::Reset as usize] = stats.pixels;
    stats
}

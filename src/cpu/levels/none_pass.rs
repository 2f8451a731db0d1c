//! No method: outputs the sanitized candidate.

use crate::cpu::explain::of_view;
use crate::cpu::inputs::Inputs;
use crate::cpu::pass::Pass;
use crate::image::Image;
use crate::kernel::debug_view::PixelTrace;
use crate::kernel::reproject::Verdict;
use crate::notes::{NoteStage, Notes, PixelNotes};
use crate::stats::FrameStats;

pub(crate) fn run(pass: Pass<'_, '_>) -> FrameStats {
    let Pass { desc, history, frame, output, mut traces, mut noted, .. } = pass;
    let mut stats = FrameStats::default();
    for (i, out) in output.iter_mut().enumerate() {
        let inputs = Inputs::new(desc, frame, i, &history.state_after(i, frame), false);
        for (y, row) in (0..).zip(out.pixels_mut().chunks_mut(desc.size_px[0] as usize)) {
            for (x, shown) in (0..).zip(row) {
                let (color, usable) = inputs.candidate(x, y);
                *shown = inputs.unexposed(color).to_array();
                stats.nonfinite += u64::from(!usable);
            }
        }
        if let Some(traces) = &mut traces {
            let traced = |[x, y]: [u32; 2]| PixelTrace { motion: inputs.motion(x, y), ..PixelTrace::default() };
            traces[i] = Image::from_fn(desc.size_px, traced);
        }
        if let Some(PixelNotes { px: [x, y], notes, .. }) = of_view(&mut noted, i) {
            let (color, usable) = inputs.candidate(*x, *y);
            notes.note(NoteStage::Candidate, "usable", usable, "");
            notes.note(NoteStage::Verdict, "history", "none: the method keeps no history", "");
            let shown = inputs.unexposed(color);
            notes.note(NoteStage::Shown, "color", shown, "linear light, in the unit of the given colors");
        }
        stats.pixels += out.pixels().len() as u64;
    }
    stats.verdicts[Verdict::Reset as usize] = stats.pixels;
    stats
}

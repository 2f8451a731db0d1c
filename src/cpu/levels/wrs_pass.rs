//! Weighted reservoirs in one pass: sanitize, reproject, reject, expose, gate, bias, combine, store and output. Twin:
//! `shaders/levels/wrs_pass.wgsl`.
//!
//! Each pixel reads its color, motion, depth and one reservoir (and four more depths where the depth test needs the
//! slope), and writes one reservoir and one color. Memory traffic: 48 bytes a pixel with color and motion as halves.
//! Means (`Sampler::AChaoMean`) are read from twelve reservoirs where history lies between pixels. The gate's
//! references (`GateScale::Candidate`) take 8 more bytes.

use crate::cpu::explain::{note_taps, note_trace, of_view};
use crate::cpu::history::{NextView, PastView};
use crate::cpu::inputs::Inputs;
use crate::cpu::pass::Pass;
use crate::cpu::quads::Quads;
use crate::foveation::Foveation;
use crate::kernel::acuity;
use crate::kernel::color;
use crate::kernel::debug_view::PixelTrace;
use crate::kernel::lattice::place_weight;
use crate::kernel::mip_noise::sample_difference;
use crate::kernel::pack::{has_code, tap_codes};
use crate::kernel::reproject::Verdict;
use crate::kernel::resample::{Tap, gather_around, resolve, sharp_sum, taps_around};
use crate::kernel::rng;
use crate::kernel::stored_reservoir;
use crate::kernel::stored_reservoir::Stored;
use crate::kernel::surface::Surface;
use crate::kernel::wrs;
use crate::kernel::wrs::{Past, Reference, SamplerCode, WrsParams};
use crate::method::{has_references, inv_density_at_fovea, wrs_params};
use crate::notes::{NoNotes, Note, NoteStage, Notes, PixelNotes};
use crate::parallel::{ProcessRow, process_rows};
use crate::stats::FrameStats;
use glam::{Vec2, Vec3};

/// Inputs, history and constants of one view of a frame.
struct ViewPass<'a> {
    inputs: Inputs<'a>,
    past: PastView<'a>,
    params: WrsParams,
    weight_exponent: u32,
    rate_exponent: u32,
    /// Whether the gate compares at the candidate's scale.
    has_references: bool,
    foveation: Foveation,
    inv_density_at_fovea: f32,
    frame_low: u32,
    /// Shaded quads, of a planned frame: the weight of a candidate depends on the place of its sample.
    quads: Option<&'a Quads>,
}

#[derive(Clone, Copy)]
struct History {
    past: Past,
    /// Age of the sample, in frames.
    age: u32,
    reference: Reference,
}

impl History {
    const EMPTY: Self = Self { past: Past::EMPTY, age: 0, reference: Reference::NONE };
}

struct Pixel {
    output: Vec3,
    words: [u32; 3],
    log_key: f32,
    /// Packed reference of the gate; 0 if there is none.
    reference: u32,
    trace: PixelTrace,
}

impl Pixel {
    fn note(&self, notes: &mut Vec<Note>) {
        let Stored { color, disparity, w_sum, age } = stored_reservoir::unpack(self.words);
        note_trace(&self.trace, notes);
        notes.note(NoteStage::Shown, "color", self.output, "linear light, in the unit of the given colors");
        notes.note(NoteStage::Stored, "words", self.words, "");
        notes.note(NoteStage::Stored, "color", color, "linear light");
        notes.note(NoteStage::Stored, "disparity", disparity, "1/distance, below 0: unknown");
        notes.note(NoteStage::Stored, "weight sum", w_sum, "");
        notes.note(NoteStage::Stored, "age", age as f32, "frames");
        notes.note(NoteStage::Stored, "log key", self.log_key, "A-ES only");
        notes.note(NoteStage::Stored, "gate's reference", [self.reference], "weighted wrs only");
    }
}

struct Row<'a> {
    words: &'a mut [[u32; 3]],
    out: &'a mut [[f32; 3]],
    log_keys: Option<&'a mut [f32]>,
    references: Option<&'a mut [u32]>,
    trace: Option<&'a mut [PixelTrace]>,
}

pub(crate) fn run(pass: Pass<'_, '_>) -> FrameStats {
    let Pass { desc, history, frame, quads, output, mut traces, mut noted, .. } = pass;
    let settings = &desc.settings;
    let wrs = settings.method.wrs();
    let has_history = history.is_filled();
    let mut stats = FrameStats::default();
    for i in 0..frame.views.len() {
        let state = history.advance(i, frame);
        let (past, next) = history.split(i);
        let pass = ViewPass {
            inputs: Inputs::new(desc, frame, i, &state, has_history),
            past,
            params: wrs_params(settings),
            weight_exponent: wrs.weight_exponent,
            rate_exponent: wrs.rate_exponent,
            has_references: has_references(settings),
            inv_density_at_fovea: inv_density_at_fovea(settings),
            frame_low: frame.index as u32,
            quads: quads.get(i),
            foveation: settings.foveation,
        };
        let trace = traces.as_mut().map(|t| t[i].pixels_mut());
        let mut rows = split_rows(desc.size_px, next, output[i].pixels_mut(), trace);
        stats = stats.add(process_rows(&mut rows, &pass));
        if let Some(PixelNotes { px: [x, y], notes, .. }) = of_view(&mut noted, i) {
            pass.pixel(*x, *y, &mut FrameStats::default(), notes).note(notes);
        }
    }
    stats
}

fn split_rows<'a>(
    size: [u32; 2],
    next: NextView<'a>,
    out: &'a mut [[f32; 3]],
    trace: Option<&'a mut [PixelTrace]>,
) -> Vec<Row<'a>> {
    let width = size[0] as usize;
    let mut log_keys = next.log_keys.chunks_mut(width);
    let mut references = next.references.chunks_mut(width);
    let mut trace = trace.map(|t| t.chunks_mut(width));
    next.words
        .chunks_mut(width)
        .zip(out.chunks_mut(width))
        .map(|(words, out)| Row {
            words,
            out,
            log_keys: log_keys.next(),
            references: references.next(),
            trace: trace.as_mut().and_then(Iterator::next),
        })
        .collect()
}

impl ProcessRow<Row<'_>> for ViewPass<'_> {
    #[inline(always)]
    fn process(&self, y: u32, row: &mut Row<'_>) -> FrameStats {
        let mut stats = FrameStats::default();
        for x in 0..self.inputs.size[0] {
            let i = x as usize;
            let pixel = self.pixel(x, y, &mut stats, &mut NoNotes);
            row.out[i] = pixel.output.to_array();
            row.words[i] = pixel.words;
            if let Some(keys) = &mut row.log_keys {
                keys[i] = pixel.log_key;
            }
            if let Some(references) = &mut row.references {
                references[i] = pixel.reference;
            }
            if let Some(trace) = &mut row.trace {
                trace[i] = pixel.trace;
            }
        }
        stats
    }
}

impl ViewPass<'_> {
    #[inline(always)]
    fn pixel<N: Notes>(&self, x: u32, y: u32, stats: &mut FrameStats, notes: &mut N) -> Pixel {
        let inputs = &self.inputs;
        let (candidate, usable) = inputs.candidate(x, y);
        let ray = inputs.ray(x, y);
        let e_deg = inputs.region_angle_deg(ray);
        let mut weight = if usable { self.weight(e_deg) } else { 0.0 };
        let mut sample_px = [x, y];
        if let Some(quads) = self.quads {
            sample_px = quads.nearest_sample(sample_px).unwrap_or(sample_px);
            weight *= place_weight(Vec2::new(sample_px[0] as f32 - x as f32, sample_px[1] as f32 - y as f32));
        } else if usable && self.rate_exponent != 0 {
            weight = wrs::at_rate(weight, inputs.candidate_lod(&self.foveation, x, y, e_deg), self.rate_exponent);
        }
        let mut params = self.params;
        if let Some(noise) = inputs.noise(sample_px[0], sample_px[1]) {
            weight *= noise.samples;
            params.gate_offset += sample_difference(noise, color::luma(candidate));
        }
        let disparity = inputs.disparity(x, y);
        let motion = inputs.motion(x, y);
        notes.note(NoteStage::Candidate, "color", candidate, "linear light");
        notes.note(NoteStage::Candidate, "usable", usable, "");
        let (verdict, history) = match self.history([x, y], candidate, ray, motion, disparity, notes) {
            Ok(history) => (Verdict::Valid, history),
            Err(verdict) => (verdict, History::EMPTY),
        };
        let History { past, reference, .. } = history;
        let level = self.level(x, y, e_deg, sample_px == [x, y]);
        let compared = if self.has_references { wrs::compared(candidate, level, reference) } else { past.color };
        if N::ON {
            let difference = wrs::difference(candidate, compared, params.gate);
            notes.note(NoteStage::Comparison, "color that the gate compares", compared, "linear light");
            notes.note(NoteStage::Comparison, "difference", difference, "Delta E 94, or L*");
            notes.note(NoteStage::Comparison, "difference up to which the gate is 1", params.gate_offset, "the same");
        }
        let draw = rng::unit_draw(rng::bits(x, y, self.frame_low, inputs.uniforms.key));
        let decision = wrs::decide_sample(candidate, weight, Past { color: compared, ..past }, &params, draw);

        let color = wrs::combined(candidate, weight, past.color, &decision, params.sampler);
        let age = if decision.take { 0 } else { (history.age + 1).min(stored_reservoir::MAX_AGE) };
        let mut words = stored_reservoir::pack(Stored { color, disparity, w_sum: decision.w_sum, age });
        if self.params.sampler == SamplerCode::AChaoMean && decision.w_sum == 0.0 {
            words = stored_reservoir::EMPTY_WORDS;
        }
        let mut next = reference;
        if self.has_references && usable {
            next = wrs::next_reference(candidate, level, decision.take, reference);
        }
        inputs.count(x, y, usable, disparity, verdict, stats);
        stats.replaced += u64::from(verdict == Verdict::Valid && decision.take);
        notes.note(NoteStage::Decision, "random draw", draw, "");
        notes.note(NoteStage::Decision, "weight sum", decision.w_sum, "");
        let trace = PixelTrace {
            verdict,
            weight,
            quality: decision.w_sum * (1.0 / 16.0),
            age,
            history_share: if verdict == Verdict::Valid { decision.survival } else { 0.0 },
            agreement: decision.gate,
            is_replaced: decision.take,
            motion,
        };
        let reference = if self.has_references { wrs::pack_reference(next) } else { 0 };
        Pixel { output: inputs.unexposed(color), words, log_key: decision.log_key, reference, trace }
    }

    #[inline(always)]
    fn weight(&self, e_deg: f32) -> f32 {
        let weight = acuity::candidate_weight(e_deg, self.foveation.fovea_radius_deg(), self.inv_density_at_fovea);
        wrs::sharpen(weight, self.weight_exponent)
    }

    /// Code of the candidate's level of detail. `sampled`: whether the pixel has a sample of its own. On planned frames
    /// such a candidate is a full-rate one, and all others are interpolated.
    #[inline(always)]
    fn level(&self, x: u32, y: u32, e_deg: f32, sampled: bool) -> u32 {
        match self.quads {
            _ if !self.has_references => wrs::NO_LEVEL,
            Some(_) if sampled => 0,
            Some(_) => wrs::NO_LEVEL,
            None => wrs::level_code(self.inputs.candidate_lod(&self.foveation, x, y, e_deg)),
        }
    }

    /// History of the pixel's surface, or the verdict that rejects it.
    #[inline(always)]
    fn history(
        &self,
        [x, y]: [u32; 2],
        candidate: Vec3,
        ray: Vec3,
        motion: [f32; 2],
        disparity: f32,
        notes: &mut impl Notes,
    ) -> Result<History, Verdict> {
        let inputs = &self.inputs;
        let [qx, qy] = inputs.nearest(x, y, motion, notes)?;
        let at = qy as usize * inputs.size[0] as usize + qx as usize;
        let stored = stored_reservoir::unpack(self.past.words[at]);
        notes.note(NoteStage::Reprojection, "its weight sum", stored.w_sum, "0: empty");
        notes.note(NoteStage::Reprojection, "its disparity", stored.disparity, "1/distance");
        if stored.w_sum == 0.0 {
            return Err(Verdict::Empty);
        }
        let log_key = self.past.log_keys.get(at).copied().unwrap_or(f32::MIN);
        let mut past = Past { color: stored.color, w_sum: stored.w_sum, log_key };
        if let Some(trust) = inputs.trust(x, y) {
            past = wrs::scale_by_trust(past, trust, self.params.sampler);
            if past.w_sum == 0.0 {
                return Err(Verdict::Distrusted);
            }
        }
        let expected = inputs.previous_disparity(ray, disparity);
        notes.note(NoteStage::Reprojection, "expected disparity", expected, "1/distance");
        if inputs.tests_depth() && !inputs.same_surface(x, y, disparity, expected, stored.disparity) {
            return Err(Verdict::Disoccluded);
        }
        past.color = color::expose(past.color, inputs.exposure);
        if self.params.sampler == SamplerCode::AChaoMean {
            let previous_px = [x as f32 + motion[0], y as f32 + motion[1]];
            let mean = self.resampled(previous_px, expected, stored.color, notes);
            past.color = wrs::unspread(candidate, past.color, color::expose(mean, inputs.exposure));
        }
        let stored_reference = self.past.references.get(at).copied().map_or(Reference::NONE, wrs::unpack_reference);
        let reference = Reference { color: color::expose(stored_reference.color, inputs.exposure), ..stored_reference };
        notes.note(NoteStage::History, "color", past.color, "linear light");
        notes.note(NoteStage::History, "weight sum", past.w_sum, "");
        notes.note(NoteStage::History, "age", stored.age as f32, "frames");
        Ok(History { past, age: stored.age, reference })
    }

    /// Mean of history at a position, by Catmull-Rom weights. At the centre of a pixel it is exactly the color of
    /// `nearest`.
    #[inline(always)]
    fn resampled(&self, at: [f32; 2], expected: f32, nearest: Vec3, notes: &mut impl Notes) -> Vec3 {
        let whole = at.map(f32::floor);
        let [fx, fy] = [at[0] - whole[0], at[1] - whole[1]];
        if fx == 0.0 && fy == 0.0 {
            return nearest;
        }
        let taps = taps_around(whole.map(|v| v as i32), [fx, fy], self.inputs.size);
        let (codes, any_code) = (tap_codes(expected), !self.inputs.tests_depth());
        let width = self.inputs.size[0] as i32;
        let tap = |[x, y]: [i32; 2]| {
            let [colors, more, _] = self.past.words[(y * width + x) as usize];
            let (color, _, valid) = stored_reservoir::unpack_sample([colors, more]);
            Tap { color, lod: 0.0, same: valid && (any_code || has_code(more, codes)) }
        };
        let gathered = gather_around(&taps, tap);
        note_taps(&taps, tap, notes);
        let nearest = Surface { color: nearest, lod: 0.0, disparity: expected };
        resolve(gathered, sharp_sum(&taps), nearest).sharp
    }
}

//! Weighted reservoirs in one pass: sanitize, reproject, reject, expose, gate, bias, combine, store and output. Twin:
//! `shaders/pass/wrs_pass.wgsl`.
//!
//! Each pixel reads its color, motion, depth and one reservoir (and four more depths where the depth test needs the
//! slope), and writes one reservoir and one color. Memory traffic: 48 bytes a pixel with color and motion as halves.

use super::Pass;
use super::history::PastView;
use super::inputs::Inputs;
use crate::foveation::Filter;
use crate::kernel::acuity;
use crate::kernel::color;
use crate::kernel::debug_view::PixelTrace;
use crate::kernel::lattice::{nearest_point, place_weight, point_offset_px};
use crate::kernel::noise::sample_difference;
use crate::kernel::pack;
use crate::kernel::pack::Stored;
use crate::kernel::reproject;
use crate::kernel::reproject::Verdict;
use crate::kernel::rng;
use crate::kernel::wrs;
use crate::kernel::wrs::{Past, WrsParams};
use crate::method::{inv_density_at_fovea, wrs_params};
use crate::stats::FrameStats;
use crate::uniforms::LatticeUniforms;
use glam::Vec3;
use rayon::prelude::*;

/// Inputs, history and constants of one view of a frame.
struct ViewPass<'a> {
    inputs: Inputs<'a>,
    past: PastView<'a>,
    params: WrsParams,
    fovea_radius_deg: f32,
    inv_density_at_fovea: f32,
    frame_low: u32,
    /// Whether candidates count by the place of their sample, as in sparse frames.
    weighs_places: bool,
}

struct Row<'a> {
    words: &'a mut [[u32; 3]],
    out: &'a mut [[f32; 3]],
    log_keys: Option<&'a mut [f32]>,
    trace: Option<&'a mut [PixelTrace]>,
}

pub(super) fn run(pass: Pass<'_, '_>) -> FrameStats {
    let Pass { desc, history, frame, output, mut traces } = pass;
    let settings = &desc.settings;
    let has_history = history.is_filled();
    let mut stats = FrameStats::default();
    for i in 0..frame.views.len() {
        let held = history.hold(i, &frame.views[i]);
        let (past, words, log_keys) = history.split(i);
        let pass = ViewPass {
            inputs: Inputs::new(desc, frame, i, &held, has_history),
            past,
            params: wrs_params(settings),
            fovea_radius_deg: settings.foveation.fovea_radius_deg(),
            inv_density_at_fovea: inv_density_at_fovea(settings),
            frame_low: frame.index as u32,
            weighs_places: settings.foveation.filter == Filter::Sparse,
        };
        let trace = traces.as_mut().map(|t| t[i].pixels_mut());
        let mut rows = split_rows(desc.size_px, words, output[i].pixels_mut(), log_keys, trace);
        stats = stats.add(
            rows.par_iter_mut()
                .enumerate()
                .map(|(y, row)| pass.row(y as u32, row))
                .reduce(FrameStats::default, FrameStats::add),
        );
    }
    stats
}

fn split_rows<'a>(
    size: [u32; 2],
    words: &'a mut [[u32; 3]],
    out: &'a mut [[f32; 3]],
    log_keys: &'a mut [f32],
    trace: Option<&'a mut [PixelTrace]>,
) -> Vec<Row<'a>> {
    let width = size[0] as usize;
    let mut log_keys = log_keys.chunks_mut(width);
    let mut trace = trace.map(|t| t.chunks_mut(width));
    words
        .chunks_mut(width)
        .zip(out.chunks_mut(width))
        .map(|(words, out)| Row {
            words,
            out,
            log_keys: log_keys.next(),
            trace: trace.as_mut().and_then(Iterator::next),
        })
        .collect()
}

impl ViewPass<'_> {
    fn row(&self, y: u32, row: &mut Row<'_>) -> FrameStats {
        let mut stats = FrameStats::default();
        for x in 0..self.inputs.size[0] {
            self.pixel(x, y, row, &mut stats);
        }
        stats
    }

    #[inline(always)]
    fn pixel(&self, x: u32, y: u32, row: &mut Row<'_>, stats: &mut FrameStats) {
        let i = x as usize;
        let inputs = &self.inputs;
        let (candidate, usable) = inputs.candidate(x, y);
        let ray = inputs.ray(x, y);
        let mut weight = if usable { self.weight(ray) } else { 0.0 };
        let mut noise_px = [x, y];
        if self.weighs_places {
            let (sample_px, place) = self.place([x, y]);
            noise_px = sample_px;
            weight *= place;
        }
        let mut params = self.params;
        if let Some(noise) = inputs.noise(noise_px[0], noise_px[1]) {
            weight *= noise.samples;
            params.gate_offset += sample_difference(noise, color::luma(candidate));
        }
        let disparity = inputs.disparity(x, y);
        let motion = inputs.motion(x, y);
        let (verdict, past, past_age) = match self.history(x, y, ray, motion, disparity) {
            Ok((past, age)) => (Verdict::Valid, past, age),
            Err(verdict) => (verdict, Past::EMPTY, 0),
        };
        let draw = rng::unit_draw(rng::bits(x, y, self.frame_low, inputs.uniforms.key));
        let decision = wrs::step(candidate, weight, past, &params, draw);

        let (color, age) = if decision.take { (candidate, 0) } else { (past.color, (past_age + 1).min(pack::MAX_AGE)) };
        row.out[i] = color.to_array();
        row.words[i] = pack::pack(Stored { color, disparity, w_sum: decision.w_sum, age });
        if let Some(keys) = &mut row.log_keys {
            keys[i] = decision.log_key;
        }
        if let Some(trace) = &mut row.trace {
            trace[i] = PixelTrace {
                verdict,
                weight,
                quality: decision.w_sum * (1.0 / 16.0),
                age,
                survival: if verdict == Verdict::Valid { decision.survival } else { 0.0 },
                gate: decision.gate,
                take: decision.take,
                motion,
            };
        }
        inputs.count(x, y, usable, disparity, verdict, stats);
        stats.replaced += u64::from(verdict == Verdict::Valid && decision.take);
    }

    #[inline(always)]
    fn weight(&self, ray: Vec3) -> f32 {
        acuity::candidate_weight(self.inputs.eccentricity_deg(ray), self.fovea_radius_deg, self.inv_density_at_fovea)
    }

    /// Pixel of the sample nearest to a pixel, and the weight of its place. The pixel itself, and 1, without samples in
    /// the frame.
    #[inline(always)]
    fn place(&self, px: [u32; 2]) -> ([u32; 2], f32) {
        let lattice = &self.inputs.lattices[LatticeUniforms::index_at(&self.inputs.lattices, px)];
        if lattice.points.contains(&0) {
            return (px, 1.0);
        }
        let point = [0, 1]
            .map(|i| nearest_point(px[i], lattice.first_px[i], lattice.level).clamp(0, lattice.points[i] as i32 - 1));
        let offset_px = [0, 1].map(|i| point_offset_px(px[i], lattice.first_px[i], lattice.level, point[i]));
        (lattice.px_of(point.map(|v| v as u32)), place_weight(offset_px.into()))
    }

    /// Reservoir of the pixel's surface in the previous frame and age of its sample, or the verdict that rejects it.
    #[inline(always)]
    fn history(&self, x: u32, y: u32, ray: Vec3, motion: [f32; 2], disparity: f32) -> Result<(Past, u32), Verdict> {
        let inputs = &self.inputs;
        if inputs.reset {
            return Err(Verdict::Reset);
        }
        let [qx, qy] = reproject::nearest(x, y, motion, inputs.size)?;
        let at = qy as usize * inputs.size[0] as usize + qx as usize;
        let stored = pack::unpack(self.past.words[at]);
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
        if inputs.tests_depth() {
            let expected = inputs.previous_disparity(ray, disparity);
            if !inputs.same_surface(x, y, expected, stored.disparity) {
                return Err(Verdict::Disoccluded);
            }
        }
        past.color = wrs::expose(past.color, inputs.exposure);
        Ok((past, stored.age))
    }
}

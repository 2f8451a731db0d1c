//! The fused pass of weighted reservoirs: scrub, reproject, flush, expose, gate, bias, combine, store and show.
//!
//! Each pixel reads its colour, motion, depth and one reservoir (and four more depths where the depth test is close), and
//! writes one reservoir and one colour: 48 bytes with half-float colour and motion.

use super::history::{History, PastView};
use super::{CpuFrame, CpuView};
use crate::frame::{ContextDesc, Reset};
use crate::image::Image;
use crate::kernel::debug_view::PixelTrace;
use crate::kernel::depth::{self, DisparityMap};
use crate::kernel::pack::{self, Stored};
use crate::kernel::reproject::{self, Verdict};
use crate::kernel::rng;
use crate::kernel::wrs::{self, Past, WrsParams};
use crate::kernel::{acuity, scrub};
use crate::settings::{DepthTest, Settings};
use crate::stats::FrameStats;
use glam::Vec3;
use rayon::prelude::*;

/// Constants of one view of one frame.
struct ViewPass<'a> {
    view: &'a CpuView<'a>,
    past: PastView<'a>,
    size: [u32; 2],
    params: WrsParams,
    fovea_radius_deg: f32,
    inv_density_at_fovea: f32,
    gaze_ray: Vec3,
    motion_scale: [f32; 2],
    disparity_map: DisparityMap,
    /// Third row of the current-to-previous view transform.
    depth_row: [f32; 4],
    depth_test: Option<DepthTest>,
    /// Factor on stored colours.
    exposure: Option<f32>,
    reset: bool,
    frame_low: u32,
    key: u32,
}

struct Row<'a> {
    words: &'a mut [[u32; 3]],
    out: &'a mut [[f32; 3]],
    log_keys: Option<&'a mut [f32]>,
    trace: Option<&'a mut [PixelTrace]>,
}

pub(super) fn run(
    desc: &ContextDesc,
    settings: &Settings,
    history: &mut History,
    frame: &CpuFrame<'_>,
    output: &mut [Image<[f32; 3]>],
    mut trace: Option<&mut [Image<PixelTrace>]>,
) -> FrameStats {
    let reset = frame.reset == Reset::All || !history.is_filled();
    let mut stats = FrameStats::default();
    for (i, view) in frame.views.iter().enumerate() {
        let held = history.held_gaze(i);
        let constants = view.facts.constants(*held, settings, i, frame.index);
        *held = Some(constants.gaze_px);
        let (past, words, log_keys) = history.split(i);
        let pass = ViewPass {
            view,
            past,
            size: desc.size_px,
            params: settings.wrs_params(),
            fovea_radius_deg: 0.5 * settings.foveation.fovea_deg,
            inv_density_at_fovea: settings.inv_density_at_fovea(),
            gaze_ray: constants.gaze_ray,
            motion_scale: desc.motion.to_internal(desc.size_px),
            disparity_map: desc.depth.disparity_map(),
            depth_row: constants.depth_row,
            depth_test: settings.depth_test.filter(|_| view.depth.is_some()),
            exposure: frame.exposure.factor(),
            reset,
            frame_low: frame.index as u32,
            key: constants.key,
        };
        let trace = trace.as_mut().map(|t| t[i].pixels_mut());
        let mut rows = split_rows(pass.size, words, output[i].pixels_mut(), log_keys, trace);
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

/// A motion vector in the internal form.
#[inline(always)]
pub(super) fn scale(motion: [f32; 2], factors: [f32; 2]) -> [f32; 2] {
    [motion[0] * factors[0], motion[1] * factors[1]]
}

impl ViewPass<'_> {
    fn row(&self, y: u32, row: &mut Row<'_>) -> FrameStats {
        let mut stats = FrameStats { pixels: u64::from(self.size[0]), ..FrameStats::default() };
        for x in 0..self.size[0] {
            self.pixel(x, y, row, &mut stats);
        }
        stats
    }

    #[inline(always)]
    fn pixel(&self, x: u32, y: u32, row: &mut Row<'_>, stats: &mut FrameStats) {
        let i = x as usize;
        let (candidate, usable) = scrub::color(Vec3::from(self.view.color.at(i, y as usize)));
        let ray = self.view.facts.geometry.ray([x as f32, y as f32]);
        let weight = if usable { self.weight(ray) } else { 0.0 };
        let disparity = self.disparity(x, y);
        let motion = self.motion(x, y);
        let (verdict, past, past_age) = match self.history(x, y, ray, motion, disparity) {
            Ok((past, age)) => (Verdict::Valid, past, age),
            Err(verdict) => (verdict, Past::EMPTY, 0),
        };
        let draw = rng::unit_draw(rng::bits(x, y, self.frame_low, self.key));
        let decision = wrs::step(candidate, weight, past, &self.params, draw);

        let (color, age) = if decision.take { (candidate, 0) } else { (past.color, (past_age + 1).min(pack::MAX_AGE)) };
        row.out[i] = color.to_array();
        row.words[i] = pack::pack(Stored { color, disparity, w_sum: decision.w_sum, age });
        if let Some(keys) = &mut row.log_keys {
            keys[i] = decision.log_key;
        }
        if let Some(trace) = &mut row.trace {
            trace[i] = PixelTrace {
                weight,
                w_sum: decision.w_sum,
                age,
                survival: if verdict == Verdict::Valid { decision.survival } else { 0.0 },
                verdict,
                gate: decision.gate,
                take: decision.take,
                motion,
            };
        }
        stats.nonfinite += u64::from(!usable);
        stats.bad_depth += u64::from(self.view.depth.is_some() && disparity == depth::INVALID_DISPARITY);
        stats.bad_trust += u64::from(self.view.trust.is_some_and(|t| !scrub::is_finite(t.at(i, y as usize))));
        stats.verdicts[verdict as usize] += 1;
        stats.replaced += u64::from(verdict == Verdict::Valid && decision.take);
    }

    #[inline(always)]
    fn weight(&self, ray: Vec3) -> f32 {
        let e = acuity::eccentricity_deg(ray, self.gaze_ray);
        acuity::candidate_weight(e, self.fovea_radius_deg, self.inv_density_at_fovea)
    }

    #[inline(always)]
    fn disparity(&self, x: u32, y: u32) -> f32 {
        match self.view.depth {
            Some(depth) => depth::disparity(depth.at(x as usize, y as usize), self.disparity_map),
            None => depth::INVALID_DISPARITY,
        }
    }

    #[inline(always)]
    fn motion(&self, x: u32, y: u32) -> [f32; 2] {
        self.view.motion.map_or([0.0; 2], |m| scale(m.at(x as usize, y as usize), self.motion_scale))
    }

    /// The reservoir that pixel (x, y) continues and the age of its sample, or why it may not.
    #[inline(always)]
    fn history(&self, x: u32, y: u32, ray: Vec3, motion: [f32; 2], disparity: f32) -> Result<(Past, u32), Verdict> {
        if self.reset {
            return Err(Verdict::Reset);
        }
        let [qx, qy] = reproject::nearest(x, y, motion, self.size)?;
        let at = qy as usize * self.size[0] as usize + qx as usize;
        let stored = pack::unpack(self.past.words[at]);
        if stored.w_sum == 0.0 {
            return Err(Verdict::Empty);
        }
        let log_key = self.past.log_keys.get(at).copied().unwrap_or(f32::MIN);
        let mut past = Past { color: stored.color, w_sum: stored.w_sum, log_key };
        if let Some(trust) = self.view.trust {
            past = wrs::believe(past, trust.at(x as usize, y as usize), self.params.sampler);
            if past.w_sum == 0.0 {
                return Err(Verdict::Distrusted);
            }
        }
        if let Some(test) = self.depth_test
            && !self.same_surface(x, y, ray, disparity, stored.disparity, test)
        {
            return Err(Verdict::Disoccluded);
        }
        if let Some(ratio) = self.exposure {
            past.color = wrs::expose(past.color, ratio);
        }
        Ok((past, stored.age))
    }

    #[inline(always)]
    fn same_surface(&self, x: u32, y: u32, ray: Vec3, disparity: f32, stored: f32, test: DepthTest) -> bool {
        let [m20, m21, m22, shift] = self.depth_row;
        let stretch = m20 * ray.x + m21 * ray.y + m22;
        let expected = depth::previous_disparity(disparity, stretch, shift);
        depth::same_surface(expected, stored, test.relative, 0.0)
            || depth::same_surface(expected, stored, test.relative, test.slope_px * self.slope(x, y))
    }

    /// Read only where the plain test fails: few pixels pay for the four taps.
    #[cold]
    fn slope(&self, x: u32, y: u32) -> f32 {
        depth::slope(x, y, self.size, |x, y| self.disparity(x, y))
    }
}

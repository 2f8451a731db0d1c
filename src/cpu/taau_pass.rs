//! Temporal upsampling: sanitize, reproject, reject, resample, gather samples, clip, blend, store and output.
//! Twin: `shaders/pass/taau_pass.wgsl`.
//!
//! Each pixel reads its motion and depth, nine samples and twelve stored surfaces (neighbours share most of these
//! reads), and writes one surface and one color. Frames without lattices have a sample in every pixel.

use super::surface_history::SurfaceHistory;
use super::surface_pass::{Pixel, SurfaceMethod};
use crate::kernel::debug_view::PixelTrace;
use crate::kernel::lattice::{nearest_point, point_offset_px};
use crate::kernel::reproject::Verdict;
use crate::kernel::sanitize;
use crate::kernel::sanitize::MAX_HALF;
use crate::kernel::surface::{Surface, pack_surface};
use crate::kernel::taau;
use crate::kernel::taau::{Accumulated, SamplesAround};
use crate::stats::FrameStats;
use crate::uniforms::LatticeUniforms;
use glam::{Vec2, Vec3};

/// Temporal upsampling.
pub(super) struct Taau;

impl SurfaceMethod for Taau {
    #[inline(always)]
    fn pixel(&self, view: &SurfaceHistory<'_>, x: u32, y: u32, stats: &mut FrameStats) -> Pixel {
        let inputs = &view.inputs;
        let disparity = inputs.disparity(x, y);
        let motion = inputs.motion(x, y);
        let source = view.source(x, y, motion, disparity);
        let verdict = source.err().unwrap_or(Verdict::Valid);

        let (mut history, mut confidence, mut trust) = (Vec3::ZERO, 0.0, 0.0);
        if let Ok(source) = source {
            let resampled = view.resample(&source);
            history = view.expose(resampled.sharp);
            confidence = taau::confidence_of(resampled.lod).min(taau::confidence_limit(source.fraction));
            trust = source.trust;
        }
        let Samples { around, nearest, usable } = samples(view, [x, y], taau::tail(confidence * trust));
        inputs.count(x, y, usable, disparity, verdict, stats);

        let sampled = around.weights.y >= taau::LEAST_SAMPLE_WEIGHT;
        let mut result = Accumulated { color: history, confidence, share: 0.0, kept: 1.0 };
        if sampled && source.is_ok() {
            result = taau::accumulate(around, nearest, history, confidence, trust);
        } else if sampled {
            let color = taau::upsampled(around, nearest);
            result = Accumulated { color, confidence: around.weights.y, share: 1.0, kept: 1.0 };
        }
        // The overshoot of Catmull-Rom may exceed the largest half.
        let output = result.color.min(Vec3::splat(MAX_HALF));
        let lod = if sampled || source.is_ok() { taau::lod_of(result.confidence) } else { -1.0 };
        let trace = PixelTrace {
            verdict,
            weight: result.share,
            quality: (0.5 * result.confidence).min(1.0),
            age: 0,
            survival: if source.is_ok() { 1.0 - result.share } else { 0.0 },
            gate: result.kept,
            take: verdict != Verdict::Valid,
            motion,
        };
        Pixel { output, surface: pack_surface(Surface { color: output, lod, disparity }), noise: 0, trace }
    }
}

/// Samples around a pixel.
struct Samples {
    around: SamplesAround,
    /// Color of the nearest one, black if it is not usable.
    nearest: Vec3,
    /// Whether the nearest one is usable.
    usable: bool,
}

/// Nine samples around a pixel, of its lattice; at the lattice's border the last ones again, at places beyond it.
#[inline(always)]
fn samples(view: &SurfaceHistory<'_>, px: [u32; 2], tail: f32) -> Samples {
    let inputs = &view.inputs;
    let lattice = &inputs.lattices[LatticeUniforms::index_at(&inputs.lattices, px)];
    let (first, level) = (lattice.first_px, lattice.level);
    let middle = [0, 1].map(|i| nearest_point(px[i], first[i], level));
    let sample_at = |point: [i32; 2]| {
        let [x, y] = lattice.texel_of([0, 1].map(|i| point[i].clamp(0, lattice.points[i] as i32 - 1) as u32));
        sanitize::color(Vec3::from(inputs.color.at(x as usize, y as usize)))
    };
    let mut around = SamplesAround::default();
    if lattice.points.contains(&0) {
        return Samples { around, nearest: Vec3::ZERO, usable: false };
    }
    let (nearest, nearest_usable) = sample_at(middle);
    for tap in 0..9 {
        let point = [middle[0] + tap % 3 - 1, middle[1] + tap / 3 - 1];
        let (color, usable) = sample_at(point);
        if usable {
            // A sample shows what is at its pixel minus the jitter.
            let offset = [0, 1].map(|i| point_offset_px(px[i], first[i], level, point[i]));
            let offset = Vec2::from(offset) - Vec2::from(inputs.uniforms.jitter_px);
            around = taau::add_around(around, nearest, color, taau::sample_weights(offset, level, tail));
        }
    }
    Samples { around, nearest, usable: nearest_usable }
}

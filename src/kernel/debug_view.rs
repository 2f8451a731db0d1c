//! Decisions at a pixel, drawn as colors. Ramps and codes are defined sRGB-encoded, as they look on screen, and returned as linear light.

use super::color::srgb_decode;
use super::reproject::Verdict;
use super::sanitize::is_finite;
use glam::Vec3;

/// A picture of the decisions of a frame: [`record_view`](crate::gpu::Afterimage::record_view) draws it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[repr(u32)]
#[non_exhaustive]
pub enum DebugView {
    /// Quality of what is stored, by the method's measure: black 0, white 1. Of wrs the weight sum over 16; of smr the sharpness, where
    /// full rate is 1 and each level of detail halves it. taa has none: black.
    Quality = 1,
    /// Frames since the shown sample was shaded: black 0, white 255 or more, by square root. Only wrs stores it; black otherwise.
    Age = 2,
    /// Share of the history's weight that survived; of smr and taa history's share in what is shown: black none, white all.
    Survival = 3,
    /// Verdict on the history ([`Verdict`]): grey valid, blue reset, magenta bad motion, orange off screen, yellow empty, red
    /// disoccluded, cyan distrusted.
    Rejection = 4,
    /// Gate value; of smr how well history explains the candidate: white open, black shut. taa has none: white.
    Gate = 5,
    /// Motion: red right, cyan left, bright fast; grey none, 16 pixels are full color, green NaN or infinite.
    Motion = 6,
}

/// Decision at a pixel, from which debug views are drawn. [`process_traced`](crate::cpu::CpuAfterimage::process_traced) writes it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PixelTrace {
    /// Verdict on the history.
    pub verdict: Verdict,
    /// Weight of the candidate, in \[0, 1\].
    pub weight: f32,
    /// Quality of what is stored, by the method's measure ([`DebugView::Quality`]); 1 is good.
    pub quality: f32,
    /// Frames since the shown sample was shaded, up to 255.
    pub age: u32,
    /// Share of the history's weight that survived, in \[0, 1\]; 0 without history.
    pub survival: f32,
    /// Gate value in \[0, 1\]; 1: candidate and history look alike.
    pub gate: f32,
    /// Whether the candidate replaced the history.
    pub take: bool,
    /// Motion as it was read: previous minus current, in pixels, y down.
    pub motion: [f32; 2],
}

impl Default for PixelTrace {
    /// A pixel without history or weight.
    fn default() -> Self {
        Self {
            verdict: Verdict::Reset,
            weight: 0.0,
            quality: 0.0,
            age: 0,
            survival: 0.0,
            gate: 1.0,
            take: true,
            motion: [0.0; 2],
        }
    }
}

/// Color of NaN and infinity, which no ramp holds.
const NO_NUMBER: Vec3 = Vec3::new(0.0, 1.0, 0.0);

/// Stops of a ramp from black over violet and orange to white, of steadily rising lightness.
const STOPS: [Vec3; 6] = [
    Vec3::new(0.0, 0.0, 0.0),
    Vec3::new(0.23, 0.04, 0.42),
    Vec3::new(0.62, 0.13, 0.40),
    Vec3::new(0.93, 0.38, 0.18),
    Vec3::new(0.98, 0.75, 0.25),
    Vec3::new(1.0, 1.0, 0.95),
];

/// Color of a value in \[0, 1\], sRGB-encoded: from black over violet and orange to white. Pure green for what is NaN or
/// infinite.
#[inline]
pub fn heat(value: f32) -> Vec3 {
    if !is_finite(value) {
        return NO_NUMBER;
    }
    let position = 5.0 * value.clamp(0.0, 1.0);
    let i = (position as usize).min(4);
    let t = position - i as f32;
    STOPS[i] + (STOPS[i + 1] - STOPS[i]) * t
}

/// Color of a verdict, sRGB-encoded.
#[inline]
pub fn verdict_color(verdict: Verdict) -> Vec3 {
    match verdict {
        Verdict::Valid => Vec3::new(0.35, 0.35, 0.35),
        Verdict::Reset => Vec3::new(0.2, 0.4, 1.0),
        Verdict::BadMotion => Vec3::new(1.0, 0.2, 1.0),
        Verdict::OffScreen => Vec3::new(1.0, 0.55, 0.1),
        Verdict::Empty => Vec3::new(1.0, 1.0, 0.3),
        Verdict::Disoccluded => Vec3::new(1.0, 0.1, 0.1),
        Verdict::Distrusted => Vec3::new(0.1, 0.9, 0.9),
    }
}

/// Color of a motion vector in pixels, sRGB-encoded; as the surface moves, current minus previous.
#[inline]
pub fn motion_color(motion: [f32; 2]) -> Vec3 {
    if !(is_finite(motion[0]) && is_finite(motion[1])) {
        return NO_NUMBER;
    }
    let x = (-motion[0] / 16.0).clamp(-1.0, 1.0);
    let y = (-motion[1] / 16.0).clamp(-1.0, 1.0);
    let towards = 0.5 - 0.25 * x;
    let color = Vec3::new(0.5 + 0.5 * x, towards + 0.43 * y, towards - 0.43 * y);
    color.clamp(Vec3::ZERO, Vec3::ONE)
}

/// Linear color of a pixel in a view.
#[inline]
pub fn view_color(view: DebugView, trace: &PixelTrace) -> Vec3 {
    let encoded = match view {
        DebugView::Quality => heat(trace.quality),
        DebugView::Age => heat((trace.age as f32 / 255.0).sqrt()),
        DebugView::Survival => heat(trace.survival),
        DebugView::Rejection => verdict_color(trace.verdict),
        DebugView::Gate => Vec3::splat(trace.gate),
        DebugView::Motion => motion_color(trace.motion),
    };
    Vec3::new(srgb_decode(encoded.x), srgb_decode(encoded.y), srgb_decode(encoded.z))
}

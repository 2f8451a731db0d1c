//! Debug views: the decision at a pixel as a color. Ramps and codes are defined sRGB-encoded, as they look on screen;
//! views are returned as linear light.

use super::color::srgb_decode;
use super::reproject::{Verdict, verdict_color};
use super::sanitize::is_finite;
#[cfg(feature = "bevy-0-20")]
use bevy_reflect::Reflect;
use glam::Vec3;

/// Debug view: an image of one quantity of the decision at each pixel. `levels::Afterimage::record_view` draws it and
/// has an example.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "bevy-0-20", derive(Reflect))]
#[repr(u32)]
#[non_exhaustive]
pub enum DebugView {
    /// Quality of the stored sample: black 0, white 1. For wrs the weight sum divided by 16; for smr the sharpness,
    /// which is 1 at full rate and halves with each level of detail; for taau the confidence, 1 from two samples at the
    /// pixel on. Black for the other methods.
    Quality = 1,
    /// Frames since the shown sample was shaded: black 0, white 255 or more, on a square-root scale. wrs only; black
    /// for the other methods.
    Age = 2,
    /// History's share: black 0, white 1. For wrs the share of its weight sum that survived bias and gate; for smr, taa
    /// and taau its share in the output color.
    HistoryShare = 3,
    /// Verdict on the history, in the color that [`Verdict`] says.
    Rejection = 4,
    /// Agreement of history and candidate: white 1, black 0. For wrs the value of the color gate; for smr how well
    /// history explains the candidate; for taau the share of its confidence that history kept when clipped. White for
    /// the other methods.
    Agreement = 5,
    /// Motion of the surface: hue is the direction (red right, cyan left), saturation the length, full at 16 pixels;
    /// grey is no motion, green NaN or infinite.
    Motion = 6,
}

impl DebugView {
    /// All views, in the order of their numbers.
    pub const ALL: [Self; 6] =
        [Self::Quality, Self::Age, Self::HistoryShare, Self::Rejection, Self::Agreement, Self::Motion];
}

/// Decision at a pixel, from which debug views are drawn. `cpu::CpuAfterimage::process_traced` writes it:
///
/// ```
/// # #[cfg(feature = "cpu")]
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// use afterimage::cpu::{CpuAfterimage, Frame, PixelTrace};
/// use afterimage::internal::{ContextDesc, ViewFrame};
/// use afterimage::{Gaze, Image, Verdict, ViewGeometry};
///
/// let size = [8, 8];
/// let mut post = CpuAfterimage::new(&ContextDesc::new(size))?;
/// let color = Image::filled(size, [0.5; 3]);
/// let views = [ViewFrame::new(ViewGeometry::flat(size, 70.0)?, Gaze::Lost)];
/// let mut output = [Image::filled(size, [0.0; 3])];
/// let mut traces = [Image::filled(size, PixelTrace::default())];
/// post.process_traced(&Frame::new(&[&color], &views, 0), &mut output, &mut traces)?;
/// assert_eq!(traces[0].at(0, 0).verdict, Verdict::Reset);
/// # Ok(())
/// # }
/// # #[cfg(not(feature = "cpu"))]
/// # fn main() {}
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PixelTrace {
    /// Verdict on the history.
    pub verdict: Verdict,
    /// Weight of the candidate, in \[0, 1\].
    pub weight: f32,
    /// Quality of the stored sample ([`DebugView::Quality`]); 1 is full quality.
    pub quality: f32,
    /// Frames since the shown sample was shaded, up to 255 ([`DebugView::Age`]).
    pub age: u32,
    /// History's share, in \[0, 1\] ([`DebugView::HistoryShare`]); 0 without history.
    pub history_share: f32,
    /// Agreement of candidate and history, in \[0, 1\] ([`DebugView::Agreement`]); 1 if they look alike.
    pub agreement: f32,
    /// Whether the candidate replaced the history.
    pub is_replaced: bool,
    /// Motion vector: previous minus current position in pixels, y down.
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
            history_share: 0.0,
            agreement: 1.0,
            is_replaced: true,
            motion: [0.0; 2],
        }
    }
}

/// Color of NaN and infinity: pure green, which no ramp contains.
const NONFINITE: Vec3 = Vec3::new(0.0, 1.0, 0.0);

/// Stops of the heat ramp: black, violet, orange, white, with steadily rising lightness.
const STOPS: [Vec3; 6] = [
    Vec3::new(0.0, 0.0, 0.0),
    Vec3::new(0.23, 0.04, 0.42),
    Vec3::new(0.62, 0.13, 0.40),
    Vec3::new(0.93, 0.38, 0.18),
    Vec3::new(0.98, 0.75, 0.25),
    Vec3::new(1.0, 1.0, 0.95),
];

/// Heat-ramp color of a value in \[0, 1\], sRGB-encoded: black, violet, orange, white. Pure green for NaN and infinity.
#[inline]
pub fn heat(value: f32) -> Vec3 {
    if !is_finite(value) {
        return NONFINITE;
    }
    let position = 5.0 * value.clamp(0.0, 1.0);
    let i = (position as usize).min(4);
    let t = position - i as f32;
    STOPS[i] + (STOPS[i + 1] - STOPS[i]) * t
}

/// Color of a motion vector (previous minus current position, in pixels), sRGB-encoded. The hue shows the direction in
/// which the surface moves.
#[inline]
pub fn motion_color(motion: [f32; 2]) -> Vec3 {
    if !(is_finite(motion[0]) && is_finite(motion[1])) {
        return NONFINITE;
    }
    let x = (-motion[0] / 16.0).clamp(-1.0, 1.0);
    let y = (-motion[1] / 16.0).clamp(-1.0, 1.0);
    let towards = 0.5 - 0.25 * x;
    let color = Vec3::new(0.5 + 0.5 * x, towards + 0.43 * y, towards - 0.43 * y);
    color.clamp(Vec3::ZERO, Vec3::ONE)
}

/// Linear color of a pixel in a debug view.
#[inline]
pub fn view_color(view: DebugView, trace: &PixelTrace) -> Vec3 {
    let encoded = match view {
        DebugView::Quality => heat(trace.quality),
        DebugView::Age => heat((trace.age as f32 * (1.0 / 255.0)).sqrt()),
        DebugView::HistoryShare => heat(trace.history_share),
        DebugView::Rejection => verdict_color(trace.verdict),
        DebugView::Agreement => Vec3::splat(trace.agreement),
        DebugView::Motion => motion_color(trace.motion),
    };
    Vec3::new(srgb_decode(encoded.x), srgb_decode(encoded.y), srgb_decode(encoded.z))
}

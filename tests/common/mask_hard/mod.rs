//! Hard cases of masks of planned frames, H86 and up: pictures, and laws that hold on either executor. A law returns
//! what it measured, or `None` without an executor.

mod content;
mod cuts;
mod inputs;
mod offsets;
mod places;

pub use content::{fast_motion, sparkles, thin_lines};
pub use cuts::{announced_and_unannounced_cuts, restarts_of_the_order};
pub use inputs::{invalid_samples, light_trust_views_gaze_and_foveation};
pub use offsets::{offsets_off_by_one, repeated_offsets};
pub use places::{borders, degenerate_masks, starved_positions};

pub use crate::images::{pixel, pixels};

use crate::images::{Images, View, peak, planned, times};
use afterimage::cpu::{CpuAfterimage, Frame};
use afterimage::internal::{ContextDesc, Foveation, Method, Reset, Settings};
use afterimage::kernel::lattice::offset_px;
use afterimage::{Exposure, Gaze, Image};
use afterimage_testing::Draws;
use std::ops::{Deref, DerefMut};

/// The laws as tests of an executor. `$run_law` runs one, and returns what it measured.
macro_rules! mask_laws {
    ($side:ident, $run_law:ident) => {
        crate::laws::laws! { $side, $run_law,
            h86_positions_that_are_never_sampled_are_no_worse_than_foveated: "H86", starved_positions;
            h87_degenerate_masks_are_finite_and_show_their_samples: "H87", degenerate_masks;
            h88_a_reset_in_the_middle_of_the_order_equals_a_fresh_context: "H88", restarts_of_the_order;
            h89_the_fovea_is_the_candidate_and_borders_have_no_seam: "H89", borders;
            h90_a_line_of_one_pixel_is_rebuilt: "H90", thin_lines;
            h91_a_sparkle_is_gone_after_a_turn: "H91", sparkles;
            h92_fast_motion_is_no_worse_than_foveated: "H92", fast_motion;
            h93_cuts_leave_no_ghost: "H93", announced_and_unannounced_cuts;
            h95_an_invalid_sample_stays_near_its_pixel: "H95", invalid_samples;
            h96_repeated_offsets_do_no_harm: "H96", repeated_offsets;
            h97_offsets_off_by_one_cost_little: "H97", offsets_off_by_one;
            h98_light_trust_views_gaze_and_foveation: "H98", light_trust_views_gaze_and_foveation;
        }
    };
}
pub(crate) use mask_laws;

/// Neither side is a multiple of a step.
pub const SIZE: [u32; 2] = [94, 70];
/// Frames in which patterns of steps 2 and 4 visit every position.
pub const TURN: u64 = 16;
pub type Color = Image<[f32; 3]>;
pub type Mask = Image<bool>;

/// Distance of the samples of a [`pattern`] in pixels: 1 within 7 px of the gaze, 2 within 21 px, 4 beyond.
pub fn step_at(gaze_px: [f32; 2], px: [u32; 2]) -> u32 {
    match (px[0] as f32 - gaze_px[0]).hypot(px[1] as f32 - gaze_px[1]) {
        ..7.0 => 1,
        7.0..21.0 => 2,
        _ => 4,
    }
}

/// One pixel of each block, whose place moves from frame to frame, so that every pixel has its turn.
pub fn pattern(size: [u32; 2], gaze_px: [f32; 2], index: u64) -> Mask {
    placed(size, gaze_px, |step| offset_px(index, step))
}

/// The same with other places, given by the step.
pub fn placed(size: [u32; 2], gaze_px: [f32; 2], offset_px: impl Fn(u32) -> [u32; 2]) -> Mask {
    Image::from_fn(size, |px| {
        let step = step_at(gaze_px, px);
        px.map(|v| v % step) == offset_px(step).map(|v| v % step)
    })
}

/// One view of one frame, and the description of the frame.
#[derive(Clone)]
pub struct Shot {
    pub view: View,
    pub exposure: Exposure,
    pub reset: Reset,
}

impl Deref for Shot {
    type Target = View;

    fn deref(&self) -> &View {
        &self.view
    }
}

impl DerefMut for Shot {
    fn deref_mut(&mut self) -> &mut View {
        &mut self.view
    }
}

impl Shot {
    /// Without optional inputs. The color is a full-rate frame, of which only the pixels of the mask are read.
    pub fn masked(color: Color, mask: &Mask) -> Self {
        Self::planned(color, Gaze::Lost)
            .with(|view| view.mask = Some(mask.map(|chosen| if chosen { 1.0 } else { 0.0 })))
    }

    /// Without a mask: the frame is planned.
    pub fn planned(color: Color, gaze: Gaze) -> Self {
        let mut view = View::still(color, [0.0; 2]);
        view.facts.gaze = gaze;
        Self { view, exposure: Exposure::Same, reset: Reset::None }
    }

    /// With other images or facts.
    pub fn with(mut self, change: impl FnOnce(&mut View)) -> Self {
        change(&mut self.view);
        self
    }

    /// With the mask of a [`pattern`].
    pub fn foveated(color: Color, gaze_px: [f32; 2], index: u64) -> Self {
        let mask = pattern(color.size(), gaze_px, index);
        Self::masked(color, &mask)
    }

    /// In which everything moves by `speed_px` a frame.
    pub fn moving(self, speed_px: [f32; 2]) -> Self {
        Self { view: self.view.moving(speed_px), ..self }
    }

    /// Whether its mask has a pixel.
    pub fn samples(&self, px: [u32; 2]) -> bool {
        self.mask.as_ref().is_some_and(|mask| pixel(mask, px) > 0.5)
    }
}

/// An executor.
pub trait Shows {
    /// Outputs of a frame. Reset and exposure are those of the first view.
    fn show(&mut self, index: u64, shots: &[Shot]) -> Vec<Color>;

    /// Pixels of a frame of one view that would be shaded if it were planned now.
    fn plan(&self, index: u64, shot: &Shot) -> Mask;

    fn set_settings(&mut self, settings: Settings);

    /// Output of a frame of one view.
    fn one(&mut self, index: u64, shot: &Shot) -> Color {
        self.show(index, std::slice::from_ref(shot)).remove(0)
    }
}

/// Makes an executor, if there is one.
pub type Make<'a> = &'a dyn Fn(ContextDesc) -> Option<Box<dyn Shows>>;

impl Shows for CpuAfterimage {
    fn show(&mut self, index: u64, shots: &[Shot]) -> Vec<Color> {
        let mut out: Vec<_> = shots.iter().map(|shot| Image::filled(shot.facts.geometry.size_px(), [0.0; 3])).collect();
        let images = Images::of(shots.iter().map(|shot| &shot.view));
        let frame = Frame { reset: shots[0].reset, exposure: shots[0].exposure, ..images.frame(index) };
        planned(self, &frame);
        self.process(&frame, &mut out).unwrap();
        out
    }

    fn plan(&self, index: u64, shot: &Shot) -> Mask {
        let images = Images::of([&shot.view]);
        planned(&mut self.clone(), &Frame { reset: shot.reset, ..images.frame(index) }).remove(0)
    }

    fn set_settings(&mut self, settings: Settings) {
        CpuAfterimage::set_settings(self, settings).unwrap();
    }
}

pub fn on_cpu(desc: ContextDesc) -> Option<Box<dyn Shows>> {
    Some(Box::new(CpuAfterimage::new(&desc).unwrap()))
}

/// A fovea of 7 px and a middle region of 21 px around the gaze, if a frame is planned.
pub fn foveation() -> Foveation {
    let regions = Foveation { fovea_deg: 10.0, mid_deg: 30.0, budget: 0.0, ..Foveation::quads() };
    Foveation { rate_mid: 2, rate_far: 4, single_pixels: true, ..regions }
}

/// A context of one view for `smr`.
pub fn smr(size: [u32; 2]) -> ContextDesc {
    let settings = Settings { foveation: foveation(), ..Settings::steady() };
    ContextDesc { settings, ..ContextDesc::new(size) }
}

/// The foveated frame alone: the output without history.
pub fn none(shot: &Shot) -> Color {
    let desc = smr(shot.facts.geometry.size_px());
    let settings = Settings { method: Method::None, ..desc.settings };
    on_cpu(ContextDesc { settings, ..desc }).unwrap().one(0, &Shot { reset: Reset::None, ..shot.clone() })
}

/// Waves of 5 to 9 pixels at a position that may lie between pixels.
pub fn wave([x, y]: [f32; 2]) -> [f32; 3] {
    [(1.2 * x).sin(), (0.9 * y + 0.3 * x).cos(), (0.7 * x - 0.8 * y).sin()].map(|v| 0.5 + 0.3 * v)
}

/// The waves after a move by `shift_px`.
pub fn waves(size: [u32; 2], shift_px: [f32; 2]) -> Color {
    Image::from_fn(size, |[x, y]| wave([x as f32 - shift_px[0], y as f32 - shift_px[1]]))
}

/// Random colors from 1/8 to 7/8, independent of the neighbours' colors.
pub fn noise(size: [u32; 2], name: &str) -> Color {
    let mut draws = Draws::new(name);
    Image::from_fn(size, |_| [0; 3].map(|_| draws.range(0.125, 0.875)))
}

/// Colors of the pixels that `counts`.
fn pairs(a: &Color, b: &Color, counts: impl Fn([u32; 2]) -> bool) -> impl Iterator<Item = ([f32; 3], [f32; 3])> {
    pixels(a.size()).filter(move |&px| counts(px)).map(move |px| (pixel(a, px), pixel(b, px)))
}

/// Mean squared error over the pixels that `counts`.
pub fn squared_error(shown: &Color, full: &Color, counts: impl Fn([u32; 2]) -> bool) -> f64 {
    let (mut sum, mut count) = (0.0, 0);
    for (a, b) in pairs(shown, full, counts) {
        sum += (0..3).map(|c| f64::from(a[c] - b[c]).powi(2)).sum::<f64>() / 3.0;
        count += 1;
    }
    assert!(count > 0, "no pixel counts");
    sum / f64::from(count)
}

pub fn everywhere(_: [u32; 2]) -> bool {
    true
}

/// PSNR in dB for a peak of 1.
pub fn psnr(squared_error: f64) -> f64 {
    -10.0 * squared_error.max(1e-12).log10()
}

#[track_caller]
pub fn assert_finite(shown: &Color, at: &str) {
    assert!(shown.pixels().iter().flatten().all(|v| v.is_finite() && *v >= 0.0), "{at}: not finite");
}

/// Number of pixels that are off by more than the rounding of stored colors, 9 bits of the largest channel.
pub fn wrong(shown: &Color, full: &Color, counts: impl Fn([u32; 2]) -> bool) -> usize {
    let off = |(a, b): &([f32; 3], [f32; 3])| {
        let rounding = b.iter().fold(0.0_f32, |m, &v| m.max(v)) / 511.0;
        (0..3).any(|c| (a[c] - b[c]).abs() > rounding)
    };
    pairs(shown, full, counts).filter(off).count()
}

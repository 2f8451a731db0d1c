//! Errors in a description of frames, one at a time, and what must be said about each.

use super::clips::{Clip, Delivery, FORWARD, REVERSED, stored};
use afterimage::MotionUnit::Uv;
use afterimage::doctor::Fault::*;
use afterimage::doctor::{Check, Fault};
use afterimage::internal::{Foveation, FoveationKind};
use afterimage::kernel::color::srgb_encode;
use afterimage::{DepthConvention as Convention, Gaze, MotionConvention};

/// A planted error.
pub struct Planted {
    pub name: &'static str,
    pub fault: Fault,
    /// Part of the line that mends it.
    pub mend: &'static str,
    pub plant: fn(&Clip, &mut Delivery),
}

const fn planted(name: &'static str, fault: Fault, mend: &'static str, plant: fn(&Clip, &mut Delivery)) -> Planted {
    Planted { name, fault, mend, plant }
}

impl Planted {
    /// The check that is to find it.
    pub fn check(&self) -> Check {
        match self.fault {
            MotionDirection | MotionYAxis | MotionUnit | MotionScale | MotionAxes | MotionCamera => Check::Motion,
            MotionJitter => Check::Jitter,
            DepthConvention | DepthPlanes => Check::Depth,
            ColorEncoded => Check::Color,
            Fault::Gaze => Check::Gaze,
            NotFoveated | FoveationFilter | FoveationRegions | FoveationRates => Check::Foveation,
            _ => panic!("{:?} is of no check that is known here", self.fault),
        }
    }
}

fn vectors(delivery: &mut Delivery, change: impl Fn([f32; 2]) -> [f32; 2]) {
    for frame in &mut delivery.frames {
        frame.motion = frame.motion.as_ref().map(|m| m.map(&change));
    }
}

/// Stores the vectors in another convention, and describes them as `stated`.
fn convention(delivery: &mut Delivery, stored: MotionConvention, stated: MotionConvention) {
    let [x, y] = stored.to_internal(delivery.desc.size_px);
    vectors(delivery, |v| [v[0] / x, v[1] / y]);
    delivery.desc.motion = stated;
}

fn depths(clip: &Clip, delivery: &mut Delivery, as_stored: Convention, stated: Convention) {
    for (frame, full) in delivery.frames.iter_mut().zip(&clip.frames) {
        frame.depth = full.depth.as_ref().map(|d| d.map(|z| stored(as_stored, z)));
    }
    delivery.desc.depth = stated;
}

fn gazes(delivery: &mut Delivery, change: impl Fn([f32; 2], [f32; 2]) -> [f32; 2]) {
    let size = delivery.desc.size_px.map(|s| s as f32);
    for frame in &mut delivery.frames {
        let Gaze::At { px } = frame.view.gaze else { continue };
        frame.view.gaze = Gaze::At { px: change(px, size) };
    }
}

fn foveation(delivery: &mut Delivery) -> &mut Foveation {
    &mut delivery.desc.settings.foveation
}

/// Offsets of a projection, of a Halton sequence.
pub fn jitter(index: usize) -> [f32; 2] {
    let radical = |base: usize| {
        let (mut i, mut f, mut r) = (index + 1, 1.0, 0.0);
        while i > 0 {
            f /= base as f32;
            r += f * (i % base) as f32;
            i /= base;
        }
        r - 0.5
    };
    [radical(2), radical(3)]
}

/// Jitters the frames' projections; the vectors contain it.
pub fn contain_jitter(delivery: &mut Delivery) {
    for (i, frame) in delivery.frames.iter_mut().enumerate() {
        let [now, past] = [jitter(i + 1), jitter(i)];
        frame.view.jitter_px = now;
        let motion = frame.motion.as_ref();
        frame.motion = motion.map(|m| m.map(|v| [v[0] + past[0] - now[0], v[1] + past[1] - now[1]]));
    }
}

const PIXELS: MotionConvention = MotionConvention::FSR2;
const UV: MotionConvention = MotionConvention { unit: Uv, ..PIXELS };

/// Regions of the clips, which the description of the foveation must have.
const REGIONS: &str = "fovea_deg: 16.0, mid_deg: 40.0";
const NEAR: &str = "DepthConvention::Reversed { near: 0.1";
const OPPOSITE: &str = "{ direction: MotionDirection::CurrentMinusPrevious, ..";

fn near(near: f32) -> Convention {
    Convention::Reversed { near, far: f32::INFINITY }
}

fn halve_regions(f: &mut Foveation) {
    (f.fovea_deg, f.mid_deg) = (0.5 * f.fovea_deg, 0.5 * f.mid_deg);
}

fn double_rates(f: &mut Foveation) {
    (f.rate_mid, f.rate_far) = (f.rate_mid * 2, f.rate_far * 2);
}

fn change_filter(f: &mut Foveation) {
    f.kind = if f.kind == FoveationKind::Mip { FoveationKind::Block } else { FoveationKind::Mip };
}

fn state_jitter(delivery: &mut Delivery) {
    delivery.desc.motion.jittered = true;
    delivery.frames.iter_mut().enumerate().for_each(|(i, f)| f.view.jitter_px = jitter(i));
}

/// A clip without the camera's motion says that it stands still.
fn state_objects_alone(delivery: &mut Delivery) {
    delivery.desc.motion.without_camera = true;
    let still = std::array::from_fn(|i| std::array::from_fn(|j| f32::from(u8::from(i == j))));
    for frame in &mut delivery.frames {
        frame.view.previous_from_current = frame.view.previous_from_current.or(Some(still));
    }
}

/// Leaves the camera's motion out of the vectors, and says so. What moves by itself has no vectors.
pub fn leave_out_camera(delivery: &mut Delivery) {
    state_objects_alone(delivery);
    vectors(delivery, |_| [0.0; 2]);
}

fn encode(delivery: &mut Delivery) {
    delivery.frames.iter_mut().for_each(|f| f.color = f.color.map(|c| c.map(srgb_encode)));
}

fn show_full_rate(clip: &Clip, delivery: &mut Delivery) {
    for (frame, full) in delivery.frames.iter_mut().zip(&clip.frames) {
        frame.color = full.color.clone();
    }
}

pub const PLANTED: [Planted; 24] = [
    planted("vectors: current minus previous", MotionDirection, OPPOSITE, |_, d| vectors(d, |[x, y]| [-x, -y])),
    planted("vectors: y up", MotionYAxis, "{ y_axis: YAxis::Up, ..", |_, d| vectors(d, |[x, y]| [x, -y])),
    planted("vectors: UV, stated pixels", MotionUnit, "{ unit: MotionUnit::Uv, ..", |_, d| convention(d, UV, PIXELS)),
    planted("vectors: pixels, stated UV", MotionUnit, "{ unit: MotionUnit::Pixels, ..", |_, d| {
        convention(d, PIXELS, UV)
    }),
    planted("vectors: twice too long", MotionScale, "motion *= 0.5;", |_, d| vectors(d, |v| v.map(|v| 2.0 * v))),
    planted("vectors: x and y swapped", MotionAxes, "motion = motion.yx;", |_, d| vectors(d, |[x, y]| [y, x])),
    planted("vectors: of objects alone, stated complete", MotionCamera, "{ without_camera: true, ..", |_, d| {
        vectors(d, |_| [0.0; 2])
    }),
    planted("vectors: none, stated complete", MotionCamera, "{ without_camera: true, ..", |_, d| {
        d.frames.iter_mut().for_each(|f| f.motion = None)
    }),
    planted("vectors: complete, stated of objects alone", MotionCamera, "{ without_camera: false, ..", |_, d| {
        state_objects_alone(d)
    }),
    planted("vectors: with jitter", MotionJitter, "desc.motion.jittered = true;", |_, d| contain_jitter(d)),
    planted("vectors: without jitter, stated with it", MotionJitter, "desc.motion.jittered = false;", |_, d| {
        state_jitter(d)
    }),
    planted("depth: reversed, stated forward", DepthConvention, "DepthConvention::Reversed", |_, d| {
        d.desc.depth = FORWARD
    }),
    planted("depth: forward, stated reversed", DepthConvention, "DepthConvention::Forward", |clip, d| {
        depths(clip, d, FORWARD, REVERSED)
    }),
    planted("depth: near plane 4 times too far", DepthPlanes, NEAR, |_, d| d.desc.depth = near(0.4)),
    planted("depth: the same, vectors of objects alone", DepthPlanes, NEAR, |_, d| {
        leave_out_camera(d);
        d.desc.depth = near(0.4);
    }),
    planted("color: sRGB-encoded", ColorEncoded, "pow(", |_, d| encode(d)),
    planted("gaze: y up", Fault::Gaze, "[x, height - 1.0 - y]", |_, d| gazes(d, |[x, y], [_, h]| [x, h - 1.0 - y])),
    planted("gaze: UV", Fault::Gaze, "[x * width - 0.5, y * height - 0.5]", |_, d| {
        gazes(d, |[x, y], [w, h]| [(x + 0.5) / w, (y + 0.5) / h])
    }),
    planted("gaze: origin in the middle", Fault::Gaze, "[x + 0.5 * width, y + 0.5 * height]", |_, d| {
        gazes(d, |[x, y], [w, h]| [x - 0.5 * w, y - 0.5 * h])
    }),
    planted("foveation: stated off", FoveationFilter, "{ filter: Filter::", |_, d| {
        foveation(d).kind = FoveationKind::Off
    }),
    planted("foveation: another filter", FoveationFilter, "{ filter: Filter::", |_, d| change_filter(foveation(d))),
    planted("foveation: radii, stated as diameters", FoveationRegions, REGIONS, |_, d| halve_regions(foveation(d))),
    planted("foveation: blocks twice as large", FoveationRates, "rate_mid: ", |_, d| double_rates(foveation(d))),
    planted("foveation: none", NotFoveated, "{ filter: Filter::Off, ..", show_full_rate),
];

//! Errors in a description of frames, one at a time, and what must be said about each.

use super::clips::{Clip, Delivery, FORWARD, REVERSED, stored};
use afterimage::doctor::{Check, Fault};
use afterimage::kernel::color::srgb_encode;
use afterimage::{DepthConvention, Filter, Foveation, Gaze, MotionConvention, MotionDirection, MotionUnit, YAxis};

/// A planted error.
pub struct Planted {
    pub name: &'static str,
    pub check: Check,
    pub fault: Fault,
    /// Part of the line that mends it.
    pub mend: &'static str,
    pub plant: fn(&Clip, &mut Delivery),
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

fn depths(clip: &Clip, delivery: &mut Delivery, as_stored: DepthConvention, stated: DepthConvention) {
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

fn foveation(delivery: &mut Delivery, change: impl Fn(&mut Foveation)) {
    change(&mut delivery.desc.settings.foveation);
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

const PIXELS: MotionConvention = MotionConvention {
    unit: MotionUnit::Pixels,
    direction: MotionDirection::PreviousMinusCurrent,
    y_axis: YAxis::Down,
    jittered: false,
};
const UV: MotionConvention = MotionConvention { unit: MotionUnit::Uv, ..PIXELS };
const NDC: MotionConvention = MotionConvention { unit: MotionUnit::Ndc, ..PIXELS };

pub const PLANTED: [Planted; 32] = [
    Planted {
        name: "vectors: current minus previous",
        check: Check::Motion,
        fault: Fault::MotionDirection,
        mend: "{ direction: MotionDirection::CurrentMinusPrevious, ..",
        plant: |_, d| vectors(d, |[x, y]| [-x, -y]),
    },
    Planted {
        name: "vectors: y up",
        check: Check::Motion,
        fault: Fault::MotionYAxis,
        mend: "{ y_axis: YAxis::Up, ..",
        plant: |_, d| vectors(d, |[x, y]| [x, -y]),
    },
    Planted {
        name: "vectors: stated y up",
        check: Check::Motion,
        fault: Fault::MotionYAxis,
        mend: "{ y_axis: YAxis::Down, ..",
        plant: |_, d| d.desc.motion = MotionConvention::BLENDER,
    },
    Planted {
        name: "vectors: UV, stated pixels",
        check: Check::Motion,
        fault: Fault::MotionUnit,
        mend: "{ unit: MotionUnit::Uv, ..",
        plant: |_, d| convention(d, UV, PIXELS),
    },
    Planted {
        name: "vectors: NDC, stated pixels",
        check: Check::Motion,
        fault: Fault::MotionUnit,
        mend: "{ unit: MotionUnit::Ndc, ..",
        plant: |_, d| convention(d, NDC, PIXELS),
    },
    Planted {
        name: "vectors: pixels, stated UV",
        check: Check::Motion,
        fault: Fault::MotionUnit,
        mend: "{ unit: MotionUnit::Pixels, ..",
        plant: |_, d| convention(d, PIXELS, UV),
    },
    Planted {
        name: "vectors: UV, stated NDC",
        check: Check::Motion,
        fault: Fault::MotionUnit,
        mend: "{ unit: MotionUnit::Uv, ..",
        plant: |_, d| convention(d, UV, NDC),
    },
    Planted {
        name: "vectors: NDC, stated UV",
        check: Check::Motion,
        fault: Fault::MotionUnit,
        mend: "{ unit: MotionUnit::Ndc, ..",
        plant: |_, d| convention(d, NDC, UV),
    },
    Planted {
        name: "vectors: twice too long",
        check: Check::Motion,
        fault: Fault::MotionScale,
        mend: "motion *= 0.5;",
        plant: |_, d| vectors(d, |v| v.map(|v| 2.0 * v)),
    },
    Planted {
        name: "vectors: half as long",
        check: Check::Motion,
        fault: Fault::MotionScale,
        mend: "motion *= 2;",
        plant: |_, d| vectors(d, |v| v.map(|v| 0.5 * v)),
    },
    Planted {
        name: "vectors: x and y swapped",
        check: Check::Motion,
        fault: Fault::MotionAxes,
        mend: "motion = motion.yx;",
        plant: |_, d| vectors(d, |[x, y]| [y, x]),
    },
    Planted {
        name: "vectors: with jitter",
        check: Check::Jitter,
        fault: Fault::MotionJitter,
        mend: "desc.motion.jittered = true;",
        plant: |_, d| contain_jitter(d),
    },
    Planted {
        name: "vectors: without jitter, stated with it",
        check: Check::Jitter,
        fault: Fault::MotionJitter,
        mend: "desc.motion.jittered = false;",
        plant: |_, d| {
            d.desc.motion.jittered = true;
            d.frames.iter_mut().enumerate().for_each(|(i, f)| f.view.jitter_px = jitter(i));
        },
    },
    Planted {
        name: "depth: reversed, stated forward",
        check: Check::Depth,
        fault: Fault::DepthConvention,
        mend: "DepthConvention::Reversed",
        plant: |_, d| d.desc.depth = FORWARD,
    },
    Planted {
        name: "depth: reversed, stated linear",
        check: Check::Depth,
        fault: Fault::DepthConvention,
        mend: "DepthConvention::Reversed",
        plant: |_, d| d.desc.depth = DepthConvention::Linear,
    },
    Planted {
        name: "depth: linear, stated reversed",
        check: Check::Depth,
        fault: Fault::DepthConvention,
        mend: "DepthConvention::Linear",
        plant: |clip, d| depths(clip, d, DepthConvention::Linear, REVERSED),
    },
    Planted {
        name: "depth: forward, stated reversed",
        check: Check::Depth,
        fault: Fault::DepthConvention,
        mend: "DepthConvention::Forward",
        plant: |clip, d| depths(clip, d, FORWARD, REVERSED),
    },
    Planted {
        name: "depth: forward, stated linear",
        check: Check::Depth,
        fault: Fault::DepthConvention,
        mend: "DepthConvention::Forward",
        plant: |clip, d| depths(clip, d, FORWARD, DepthConvention::Linear),
    },
    Planted {
        name: "depth: near plane 4 times too far",
        check: Check::Depth,
        fault: Fault::DepthPlanes,
        mend: "DepthConvention::Reversed { near: 0.1",
        plant: |_, d| d.desc.depth = DepthConvention::Reversed { near: 0.4, far: f32::INFINITY },
    },
    Planted {
        name: "depth: near plane 4 times too near",
        check: Check::Depth,
        fault: Fault::DepthPlanes,
        mend: "DepthConvention::Reversed { near: 0.1",
        plant: |_, d| d.desc.depth = DepthConvention::Reversed { near: 0.025, far: f32::INFINITY },
    },
    Planted {
        name: "color: sRGB-encoded",
        check: Check::Color,
        fault: Fault::ColorEncoded,
        mend: "pow(",
        plant: |_, d| d.frames.iter_mut().for_each(|f| f.color = f.color.map(|c| c.map(srgb_encode))),
    },
    Planted {
        name: "gaze: y up",
        check: Check::Gaze,
        fault: Fault::Gaze,
        mend: "[x, height - 1.0 - y]",
        plant: |_, d| gazes(d, |[x, y], [_, h]| [x, h - 1.0 - y]),
    },
    Planted {
        name: "gaze: UV",
        check: Check::Gaze,
        fault: Fault::Gaze,
        mend: "[x * width - 0.5, y * height - 0.5]",
        plant: |_, d| gazes(d, |[x, y], [w, h]| [(x + 0.5) / w, (y + 0.5) / h]),
    },
    Planted {
        name: "gaze: origin in the middle",
        check: Check::Gaze,
        fault: Fault::Gaze,
        mend: "[x + 0.5 * width, y + 0.5 * height]",
        plant: |_, d| gazes(d, |[x, y], [w, h]| [x - 0.5 * w, y - 0.5 * h]),
    },
    Planted {
        name: "gaze: pixels of half the size",
        check: Check::Gaze,
        fault: Fault::Gaze,
        mend: "[2.0 * x, 2.0 * y]",
        plant: |_, d| gazes(d, |[x, y], _| [0.5 * x, 0.5 * y]),
    },
    Planted {
        name: "foveation: stated off",
        check: Check::Foveation,
        fault: Fault::FoveationFilter,
        mend: "{ filter: Filter::",
        plant: |_, d| foveation(d, |f| f.filter = Filter::Off),
    },
    Planted {
        name: "foveation: another filter",
        check: Check::Foveation,
        fault: Fault::FoveationFilter,
        mend: "{ filter: Filter::",
        plant: |_, d| foveation(d, |f| f.filter = if f.filter == Filter::Mip { Filter::Block } else { Filter::Mip }),
    },
    Planted {
        name: "foveation: radii, stated as diameters",
        check: Check::Foveation,
        fault: Fault::FoveationRegions,
        mend: "fovea_deg: 16.0, mid_deg: 40.0",
        plant: |_, d| {
            foveation(d, |f| {
                f.fovea_deg *= 0.5;
                f.mid_deg *= 0.5;
            });
        },
    },
    Planted {
        name: "foveation: regions twice too large",
        check: Check::Foveation,
        fault: Fault::FoveationRegions,
        mend: "fovea_deg: 16.0, mid_deg: 40.0",
        plant: |_, d| {
            foveation(d, |f| {
                f.fovea_deg *= 2.0;
                f.mid_deg *= 2.0;
            });
        },
    },
    Planted {
        name: "foveation: blocks half as large",
        check: Check::Foveation,
        fault: Fault::FoveationRates,
        mend: "rate_mid: ",
        plant: |_, d| {
            foveation(d, |f| {
                f.rate_mid /= 2;
                f.rate_far /= 2;
            });
        },
    },
    Planted {
        name: "foveation: blocks twice as large",
        check: Check::Foveation,
        fault: Fault::FoveationRates,
        mend: "rate_mid: ",
        plant: |_, d| {
            foveation(d, |f| {
                f.rate_mid *= 2;
                f.rate_far *= 2;
            });
        },
    },
    Planted {
        name: "foveation: none",
        check: Check::Foveation,
        fault: Fault::NotFoveated,
        mend: "{ filter: Filter::Off, ..",
        plant: |clip, d| {
            for (frame, full) in d.frames.iter_mut().zip(&clip.frames) {
                frame.color = full.color.clone();
            }
        },
    },
];

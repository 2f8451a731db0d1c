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

const fn planted(
    name: &'static str,
    check: Check,
    fault: Fault,
    mend: &'static str,
    plant: fn(&Clip, &mut Delivery),
) -> Planted {
    Planted { name, check, fault, mend, plant }
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
    planted(
        "vectors: current minus previous",
        Check::Motion,
        Fault::MotionDirection,
        "{ direction: MotionDirection::CurrentMinusPrevious, ..",
        |_, d| vectors(d, |[x, y]| [-x, -y]),
    ),
    planted("vectors: y up", Check::Motion, Fault::MotionYAxis, "{ y_axis: YAxis::Up, ..", |_, d| {
        vectors(d, |[x, y]| [x, -y])
    }),
    planted("vectors: stated y up", Check::Motion, Fault::MotionYAxis, "{ y_axis: YAxis::Down, ..", |_, d| {
        d.desc.motion = MotionConvention::BLENDER
    }),
    planted("vectors: UV, stated pixels", Check::Motion, Fault::MotionUnit, "{ unit: MotionUnit::Uv, ..", |_, d| {
        convention(d, UV, PIXELS)
    }),
    planted("vectors: NDC, stated pixels", Check::Motion, Fault::MotionUnit, "{ unit: MotionUnit::Ndc, ..", |_, d| {
        convention(d, NDC, PIXELS)
    }),
    planted(
        "vectors: pixels, stated UV",
        Check::Motion,
        Fault::MotionUnit,
        "{ unit: MotionUnit::Pixels, ..",
        |_, d| convention(d, PIXELS, UV),
    ),
    planted("vectors: UV, stated NDC", Check::Motion, Fault::MotionUnit, "{ unit: MotionUnit::Uv, ..", |_, d| {
        convention(d, UV, NDC)
    }),
    planted("vectors: NDC, stated UV", Check::Motion, Fault::MotionUnit, "{ unit: MotionUnit::Ndc, ..", |_, d| {
        convention(d, NDC, UV)
    }),
    planted("vectors: twice too long", Check::Motion, Fault::MotionScale, "motion *= 0.5;", |_, d| {
        vectors(d, |v| v.map(|v| 2.0 * v))
    }),
    planted("vectors: half as long", Check::Motion, Fault::MotionScale, "motion *= 2;", |_, d| {
        vectors(d, |v| v.map(|v| 0.5 * v))
    }),
    planted("vectors: x and y swapped", Check::Motion, Fault::MotionAxes, "motion = motion.yx;", |_, d| {
        vectors(d, |[x, y]| [y, x])
    }),
    planted("vectors: with jitter", Check::Jitter, Fault::MotionJitter, "desc.motion.jittered = true;", |_, d| {
        contain_jitter(d)
    }),
    planted(
        "vectors: without jitter, stated with it",
        Check::Jitter,
        Fault::MotionJitter,
        "desc.motion.jittered = false;",
        |_, d| {
            d.desc.motion.jittered = true;
            d.frames.iter_mut().enumerate().for_each(|(i, f)| f.view.jitter_px = jitter(i));
        },
    ),
    planted(
        "depth: reversed, stated forward",
        Check::Depth,
        Fault::DepthConvention,
        "DepthConvention::Reversed",
        |_, d| d.desc.depth = FORWARD,
    ),
    planted(
        "depth: reversed, stated linear",
        Check::Depth,
        Fault::DepthConvention,
        "DepthConvention::Reversed",
        |_, d| d.desc.depth = DepthConvention::Linear,
    ),
    planted(
        "depth: linear, stated reversed",
        Check::Depth,
        Fault::DepthConvention,
        "DepthConvention::Linear",
        |clip, d| depths(clip, d, DepthConvention::Linear, REVERSED),
    ),
    planted(
        "depth: forward, stated reversed",
        Check::Depth,
        Fault::DepthConvention,
        "DepthConvention::Forward",
        |clip, d| depths(clip, d, FORWARD, REVERSED),
    ),
    planted(
        "depth: forward, stated linear",
        Check::Depth,
        Fault::DepthConvention,
        "DepthConvention::Forward",
        |clip, d| depths(clip, d, FORWARD, DepthConvention::Linear),
    ),
    planted(
        "depth: near plane 4 times too far",
        Check::Depth,
        Fault::DepthPlanes,
        "DepthConvention::Reversed { near: 0.1",
        |_, d| d.desc.depth = DepthConvention::Reversed { near: 0.4, far: f32::INFINITY },
    ),
    planted(
        "depth: near plane 4 times too near",
        Check::Depth,
        Fault::DepthPlanes,
        "DepthConvention::Reversed { near: 0.1",
        |_, d| d.desc.depth = DepthConvention::Reversed { near: 0.025, far: f32::INFINITY },
    ),
    planted("color: sRGB-encoded", Check::Color, Fault::ColorEncoded, "pow(", |_, d| {
        d.frames.iter_mut().for_each(|f| f.color = f.color.map(|c| c.map(srgb_encode)))
    }),
    planted("gaze: y up", Check::Gaze, Fault::Gaze, "[x, height - 1.0 - y]", |_, d| {
        gazes(d, |[x, y], [_, h]| [x, h - 1.0 - y])
    }),
    planted("gaze: UV", Check::Gaze, Fault::Gaze, "[x * width - 0.5, y * height - 0.5]", |_, d| {
        gazes(d, |[x, y], [w, h]| [(x + 0.5) / w, (y + 0.5) / h])
    }),
    planted("gaze: origin in the middle", Check::Gaze, Fault::Gaze, "[x + 0.5 * width, y + 0.5 * height]", |_, d| {
        gazes(d, |[x, y], [w, h]| [x - 0.5 * w, y - 0.5 * h])
    }),
    planted("gaze: pixels of half the size", Check::Gaze, Fault::Gaze, "[2.0 * x, 2.0 * y]", |_, d| {
        gazes(d, |[x, y], _| [0.5 * x, 0.5 * y])
    }),
    planted("foveation: stated off", Check::Foveation, Fault::FoveationFilter, "{ filter: Filter::", |_, d| {
        foveation(d, |f| f.filter = Filter::Off)
    }),
    planted("foveation: another filter", Check::Foveation, Fault::FoveationFilter, "{ filter: Filter::", |_, d| {
        foveation(d, |f| f.filter = if f.filter == Filter::Mip { Filter::Block } else { Filter::Mip })
    }),
    planted(
        "foveation: radii, stated as diameters",
        Check::Foveation,
        Fault::FoveationRegions,
        "fovea_deg: 16.0, mid_deg: 40.0",
        |_, d| {
            foveation(d, |f| {
                f.fovea_deg *= 0.5;
                f.mid_deg *= 0.5;
            });
        },
    ),
    planted(
        "foveation: regions twice too large",
        Check::Foveation,
        Fault::FoveationRegions,
        "fovea_deg: 16.0, mid_deg: 40.0",
        |_, d| {
            foveation(d, |f| {
                f.fovea_deg *= 2.0;
                f.mid_deg *= 2.0;
            });
        },
    ),
    planted("foveation: blocks half as large", Check::Foveation, Fault::FoveationRates, "rate_mid: ", |_, d| {
        foveation(d, |f| {
            f.rate_mid /= 2;
            f.rate_far /= 2;
        });
    }),
    planted("foveation: blocks twice as large", Check::Foveation, Fault::FoveationRates, "rate_mid: ", |_, d| {
        foveation(d, |f| {
            f.rate_mid *= 2;
            f.rate_far *= 2;
        });
    }),
    planted("foveation: none", Check::Foveation, Fault::NotFoveated, "{ filter: Filter::Off, ..", |clip, d| {
        for (frame, full) in d.frames.iter_mut().zip(&clip.frames) {
            frame.color = full.color.clone();
        }
    }),
];

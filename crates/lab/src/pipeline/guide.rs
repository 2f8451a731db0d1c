//! Guided sampling: the noise of a run's history, reprojected to the next frame.

use crate::frame::{Guide, SourceFrame};
use crate::source::SamplingGuide;
use afterimage::kernel::color::luma;
use afterimage::kernel::noise::{Noise, root_slope};
use afterimage::kernel::reproject;
use afterimage::{Image, ViewGeometry};
use glam::Vec3;

/// Largest relative difference of distance within one surface: the least tolerance of the post-process's depth test.
const SAME_SURFACE: f32 = 0.02;

/// State after the last frame.
#[derive(Clone, Debug)]
pub(super) struct HistoryNoise {
    noise: Image<Noise>,
    /// Least weight of a new frame in the accumulated mean. Only this share of the history's samples counts, because
    /// the mean forgets old frames.
    new_share: f32,
    output: Image<[f32; 3]>,
    depth: Option<Image<f32>>,
    geometry: ViewGeometry,
}

impl HistoryNoise {
    /// State after `frame`: noise of the history, least weight of a new frame in its mean, and the method's output.
    pub fn new(
        noise: Image<Noise>,
        new_share: f32,
        output: Image<[f32; 3]>,
        frame: &SourceFrame,
        geometry: ViewGeometry,
    ) -> Self {
        Self { noise, new_share, output, depth: frame.depth.clone(), geometry }
    }

    /// Position of the pixel's surface in the previous frame; `None` if it was off the screen or fails the depth test.
    fn source(&self, frame: &SourceFrame, [x, y]: [u32; 2]) -> Option<[usize; 2]> {
        let (px, py) = (x as usize, y as usize);
        let motion = frame.motion.as_ref().map_or([0.0; 2], |m| m.at(px, py));
        let [qx, qy] = reproject::nearest(x, y, motion, self.noise.size()).ok()?.map(|v| v as usize);
        let (Some(now), Some(before)) = (&frame.depth, &self.depth) else { return Some([qx, qy]) };
        let (now, before) = (now.at(px, py), before.at(qx, qy));
        let point = (Vec3::from(self.geometry.ray([x as f32, y as f32])) * now).extend(1.0);
        let expected = frame.previous_from_current.map_or(now, |m| glam::Vec4::from(m[2]).dot(point));
        let is_background = |z: f32| z.is_nan() || z >= 1e9;
        let same = match (is_background(now), is_background(before)) {
            (false, false) => (expected - before).abs() <= SAME_SURFACE * expected.abs().max(before.abs()),
            (now, before) => now == before,
        };
        same.then_some([qx, qy])
    }
}

impl SamplingGuide for HistoryNoise {
    /// Guide for the next frame: for each pixel, the number of samples in its surface's history, and their standard
    /// deviation in square roots of luma, the unit in which smr compares colors. Disoccluded and off-screen surfaces
    /// have 0 samples and NaN. After a cut, nothing is known.
    fn guide(&self, frame: &SourceFrame) -> Option<Guide> {
        if frame.cut {
            return None;
        }
        let known = Image::from_fn_parallel(self.noise.size(), |pixel| match self.source(frame, pixel) {
            None => [0.0, f32::NAN],
            Some([x, y]) => {
                let (noise, luma) = (self.noise.at(x, y), luma(Vec3::from(self.output.at(x, y))));
                [noise.samples * self.new_share, noise.variance.sqrt() * root_slope(luma)]
            }
        });
        Some(Guide { known: known.map(|[samples, _]| samples), deviation: known.map(|[_, deviation]| deviation) })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIZE: [u32; 2] = [8, 4];

    fn frame(depth: f32, motion: [f32; 2]) -> SourceFrame {
        SourceFrame {
            color: Image::filled(SIZE, [0.25; 3]),
            depth: Some(Image::filled(SIZE, depth)),
            motion: Some(Image::filled(SIZE, motion)),
            trust: None,
            previous_from_current: None,
            cut: false,
            nonfinite: 0,
        }
    }

    fn guided(before: &SourceFrame, now: &SourceFrame) -> Guide {
        let noise = Image::from_fn(SIZE, |[x, y]| Noise { samples: (1 + x + 8 * y) as f32, variance: 0.01 });
        let geometry = ViewGeometry::flat(SIZE, 70.0).unwrap();
        HistoryNoise::new(noise, 0.5, before.color.clone(), before, geometry).guide(now).expect("it is no cut")
    }

    #[test]
    fn samples_follow_the_motion() {
        let guide = guided(&frame(2.0, [0.0; 2]), &frame(2.0, [-1.0, 1.0]));
        // Pixel (3, 1) was at (2, 2).
        assert_eq!(guide.known.at(3, 1), 9.5);
        assert_eq!((guide.known.at(0, 1), guide.known.at(3, 3)), (0.0, 0.0), "off the screen");
        let expected = 0.1 * 50.0 / 0.252_f32.sqrt();
        assert!((guide.deviation.at(3, 1) - expected).abs() < 1e-4 && guide.deviation.at(0, 1).is_nan());
    }

    #[test]
    fn disoccluded_surfaces_have_no_samples() {
        for (before, now, known) in [
            (2.0, 2.03, true),
            (2.0, 2.1, false),
            (1e10, f32::INFINITY, true),
            (1e10, 2.0, false),
            (f32::NAN, 2.0, false),
        ] {
            let guide = guided(&frame(before, [0.0; 2]), &frame(now, [0.0; 2]));
            assert_eq!(guide.known.at(4, 2) > 0.0, known, "{before} then {now}");
        }
    }
}

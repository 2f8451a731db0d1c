//! What a frame brings to the pixels of one view, in the internal form: read alike by all methods.

use super::{CpuFrame, CpuView};
use crate::frame::{ContextDesc, Reset, ViewConstants};
use crate::kernel::depth;
use crate::kernel::depth::DisparityMap;
use crate::kernel::noise::{Noise, candidate_noise};
use crate::kernel::reproject::Verdict;
use crate::kernel::{acuity, scrub};
use crate::settings::{DepthTest, Settings};
use crate::stats::FrameStats;
use glam::Vec3;

/// One view of one frame.
pub(super) struct Inputs<'a> {
    pub view: &'a CpuView<'a>,
    pub size: [u32; 2],
    pub gaze_ray: Vec3,
    /// Factor on stored colors.
    pub exposure: Option<f32>,
    /// There is no past.
    pub reset: bool,
    motion_scale: [f32; 2],
    disparity_map: DisparityMap,
    /// Third row of the current-to-previous view transform.
    depth_row: [f32; 4],
    depth_test: Option<DepthTest>,
}

impl<'a> Inputs<'a> {
    /// View `index` of `frame`; `is_filled`: there may be a past.
    pub fn new(
        desc: &ContextDesc,
        settings: &Settings,
        frame: &CpuFrame<'a>,
        index: usize,
        constants: &ViewConstants,
        is_filled: bool,
    ) -> Self {
        let view = &frame.views[index];
        Self {
            view,
            size: desc.size_px,
            gaze_ray: constants.gaze_ray,
            exposure: frame.exposure.factor(),
            reset: frame.reset == Reset::All || !is_filled,
            motion_scale: desc.motion.to_internal(desc.size_px),
            disparity_map: desc.depth.disparity_map(),
            depth_row: constants.depth_row,
            depth_test: settings.depth_test.filter(|_| view.depth.is_some()),
        }
    }

    /// The candidate, and whether it may be used.
    #[inline(always)]
    pub fn candidate(&self, x: u32, y: u32) -> (Vec3, bool) {
        scrub::color(Vec3::from(self.view.color.at(x as usize, y as usize)))
    }

    #[inline(always)]
    pub fn ray(&self, x: u32, y: u32) -> Vec3 {
        self.view.facts.geometry.ray([x as f32, y as f32])
    }

    #[inline(always)]
    pub fn eccentricity_deg(&self, ray: Vec3) -> f32 {
        acuity::eccentricity_deg(ray, self.gaze_ray)
    }

    #[inline(always)]
    pub fn disparity(&self, x: u32, y: u32) -> f32 {
        match self.view.depth {
            Some(depth) => depth::disparity(depth.at(x as usize, y as usize), self.disparity_map),
            None => depth::INVALID_DISPARITY,
        }
    }

    #[inline(always)]
    pub fn motion(&self, x: u32, y: u32) -> [f32; 2] {
        self.view.motion.map_or([0.0; 2], |m| {
            let v = m.at(x as usize, y as usize);
            [v[0] * self.motion_scale[0], v[1] * self.motion_scale[1]]
        })
    }

    /// The candidate's noise, if it has any.
    #[inline(always)]
    pub fn noise(&self, x: u32, y: u32) -> Option<Noise> {
        self.view.noise.map(|n| candidate_noise(n.at(x as usize, y as usize)))
    }

    /// As given, if it is.
    #[inline(always)]
    pub fn trust(&self, x: u32, y: u32) -> Option<f32> {
        self.view.trust.map(|t| t.at(x as usize, y as usize))
    }

    /// Whether depths are compared.
    #[inline(always)]
    pub fn tests_depth(&self) -> bool {
        self.depth_test.is_some()
    }

    /// Disparity that the surface of a pixel had in the previous frame.
    #[inline(always)]
    pub fn previous_disparity(&self, ray: Vec3, disparity: f32) -> f32 {
        let [m20, m21, m22, shift] = self.depth_row;
        depth::previous_disparity(disparity, m20 * ray.x + m21 * ray.y + m22, shift)
    }

    /// Whether pixel (x, y), `expected` at a disparity, is the surface that was `stored` with one. True without a depth test.
    #[inline(always)]
    pub fn same_surface(&self, x: u32, y: u32, expected: f32, stored: f32) -> bool {
        let Some(test) = self.depth_test else {
            return true;
        };
        depth::same_surface(expected, stored, test.relative, 0.0)
            || depth::same_surface(expected, stored, test.relative, test.slope_px * self.slope(x, y))
    }

    /// Read only where the plain test fails: few pixels pay for the four taps.
    #[cold]
    fn slope(&self, x: u32, y: u32) -> f32 {
        depth::slope(x, y, self.size, |x, y| self.disparity(x, y))
    }

    /// Counts a pixel.
    #[inline(always)]
    pub fn count(&self, x: u32, y: u32, usable: bool, disparity: f32, verdict: Verdict, stats: &mut FrameStats) {
        stats.pixels += 1;
        stats.nonfinite += u64::from(!usable);
        stats.bad_depth += u64::from(self.view.depth.is_some() && disparity == depth::INVALID_DISPARITY);
        stats.bad_trust += u64::from(self.trust(x, y).is_some_and(|t| !scrub::is_finite(t)));
        stats.verdicts[verdict as usize] += 1;
    }
}

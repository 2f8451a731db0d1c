//! Where a pixel was, and what is remembered of it there: what the methods that remember surfaces share.

use super::CpuView;
use crate::frame::{ContextDesc, ViewFrame};
use crate::image::Image;
use crate::kernel::depth::{self, DisparityMap};
use crate::kernel::reproject::{self, Verdict};
use crate::kernel::resample::{catmull_rom, split};
use crate::kernel::surface::{Surface, unpack_surface};
use crate::settings::DepthTest;
use glam::Vec3;

/// Constants of one view of one frame.
pub(super) struct Reprojection<'a> {
    pub facts: ViewFrame,
    pub depth: Option<&'a Image<f32>>,
    pub motion: Option<&'a Image<[f32; 2]>>,
    pub past: &'a [[u32; 2]],
    pub size: [u32; 2],
    pub motion_scale: [f32; 2],
    pub disparity_map: DisparityMap,
    pub depth_row: [f32; 4],
    pub depth_test: Option<DepthTest>,
    pub reset: bool,
}

/// Position in the previous frame, in pixels.
#[derive(Clone, Copy)]
pub(super) struct Source {
    pub at: [f32; 2],
    /// Expected disparity there.
    pub expected: f32,
    pub nearest: Surface,
}

/// What was read around a position.
#[derive(Clone, Copy)]
pub(super) struct Resampled {
    /// Catmull-Rom.
    pub sharp: Vec3,
    /// Bilinear.
    pub smooth: Vec3,
    /// Level of detail.
    pub lod: f32,
}

/// Disparity difference of taps that are read together.
const TAP_RELATIVE: f32 = 0.1;

impl<'a> Reprojection<'a> {
    pub fn new(
        desc: &ContextDesc,
        view: &CpuView<'a>,
        depth_row: [f32; 4],
        depth_test: Option<DepthTest>,
        past: &'a [[u32; 2]],
        reset: bool,
    ) -> Self {
        Self {
            facts: view.facts,
            depth: view.depth,
            motion: view.motion,
            past,
            size: desc.size_px,
            motion_scale: desc.motion.to_internal(desc.size_px),
            disparity_map: desc.depth.disparity_map(),
            depth_row,
            depth_test: depth_test.filter(|_| view.depth.is_some()),
            reset,
        }
    }

    pub fn disparity(&self, x: u32, y: u32) -> f32 {
        match self.depth {
            Some(depth) => depth::disparity(depth.at(x as usize, y as usize), self.disparity_map),
            None => depth::INVALID_DISPARITY,
        }
    }

    fn texel(&self, x: i32, y: i32) -> Surface {
        let x = x.clamp(0, self.size[0] as i32 - 1) as usize;
        let y = y.clamp(0, self.size[1] as i32 - 1) as usize;
        unpack_surface(self.past[y * self.size[0] as usize + x])
    }

    /// Where pixel (x, y) was, if something of it is remembered.
    pub fn source(&self, x: u32, y: u32, disparity: f32) -> Result<Source, Verdict> {
        if self.reset {
            return Err(Verdict::Reset);
        }
        let motion = self.motion.map_or([0.0; 2], |m| {
            let v = m.at(x as usize, y as usize);
            [v[0] * self.motion_scale[0], v[1] * self.motion_scale[1]]
        });
        let [qx, qy] = reproject::nearest(x, y, motion, self.size)?;
        let nearest = self.texel(qx as i32, qy as i32);
        if nearest.lod < 0.0 {
            return Err(Verdict::Empty);
        }
        let mut expected = depth::INVALID_DISPARITY;
        if let Some(test) = self.depth_test {
            let ray = self.facts.geometry.ray([x as f32, y as f32]);
            let [m20, m21, m22, shift] = self.depth_row;
            expected = depth::previous_disparity(disparity, m20 * ray.x + m21 * ray.y + m22, shift);
            let same = depth::same_surface(expected, nearest.disparity, test.relative, 0.0)
                || depth::same_surface(
                    expected,
                    nearest.disparity,
                    test.relative,
                    test.slope_px * depth::slope(x, y, self.size, |x, y| self.disparity(x, y)),
                );
            if !same {
                return Err(Verdict::Disoccluded);
            }
        }
        Ok(Source { at: [x as f32 + motion[0], y as f32 + motion[1]], expected, nearest })
    }

    /// Reads the past around `source`: Catmull-Rom over twelve texels where all of them show the same surface, else bilinear over
    /// those that do.
    pub fn resample(&self, source: &Source) -> Resampled {
        let (x0, fx) = split(source.at[0]);
        let (y0, fy) = split(source.at[1]);
        if fx == 0.0 && fy == 0.0 {
            let s = source.nearest;
            return Resampled { sharp: s.color, smooth: s.color, lod: s.lod };
        }
        let (wx, wy) = (catmull_rom(fx), catmull_rom(fy));
        let (bx, by) = ([0.0, 1.0 - fx, fx, 0.0], [0.0, 1.0 - fy, fy, 0.0]);
        let mut sharp = Vec3::ZERO;
        let mut sharp_w = 0.0;
        let mut smooth = Vec3::ZERO;
        let mut smooth_w = 0.0;
        let mut lod = 0.0;
        let mut whole = true;
        for j in 0..4 {
            for i in 0..4 {
                if (i == 0 || i == 3) && (j == 0 || j == 3) {
                    continue;
                }
                let tap = self.texel(x0 + i as i32 - 1, y0 + j as i32 - 1);
                let same = tap.lod >= 0.0
                    && (self.depth_test.is_none()
                        || depth::same_surface(source.expected, tap.disparity, TAP_RELATIVE, 0.0));
                if !same {
                    whole = false;
                    continue;
                }
                let w = wx[i] * wy[j];
                sharp += tap.color * w;
                sharp_w += w;
                let b = bx[i] * by[j];
                smooth += tap.color * b;
                lod += tap.lod * b;
                smooth_w += b;
            }
        }
        if smooth_w < 1e-3 {
            let s = source.nearest;
            return Resampled { sharp: s.color, smooth: s.color, lod: s.lod };
        }
        let smooth = smooth / smooth_w;
        let sharp = if whole { (sharp / sharp_w).max(Vec3::ZERO) } else { smooth };
        Resampled { sharp, smooth, lod: lod / smooth_w }
    }
}

//! Inputs of the pixels of one view, in internal conventions; shared by all methods. Twin:
//! `shaders/shared/inputs.wgsl`.

use super::frame::Frame;
use crate::context::ContextDesc;
use crate::convention::MotionConvention;
use crate::foveation::Foveation;
use crate::frame::Reset;
use crate::image::Image;
use crate::kernel::depth;
use crate::kernel::depth::DisparityMap;
use crate::kernel::lod::MAX_LOD;
use crate::kernel::noise::{Noise, candidate_noise};
use crate::kernel::reproject::{Verdict, camera_vector, has_no_vector, moves_alike, world_motion_px};
use crate::kernel::stored_sample::UNKNOWN_MOVED_PX;
use crate::kernel::{lens, reproject, sanitize};
use crate::notes::{NoteStage, Notes};
use crate::settings::DepthTest;
use crate::stats::FrameStats;
use crate::uniforms::{CameraUniforms, ViewState, ViewUniforms};
use glam::{Vec2, Vec3};

/// Previous position of a pixel's surface.
#[derive(Clone, Copy)]
pub(super) struct Previous {
    /// Position in pixels.
    pub at: [f32; 2],
    /// Disparity that the surface had.
    pub expected: f32,
    /// Confidence in history: above 0 and at most 1.
    pub trust: f32,
}

/// Inputs and constants of one view of a frame.
pub(super) struct Inputs<'a> {
    color: &'a Image<[f32; 3]>,
    lod: Option<&'a Image<f32>>,
    depth: Option<&'a Image<f32>>,
    motion: Option<&'a Image<[f32; 2]>>,
    trust: Option<&'a Image<f32>>,
    reactive: Option<&'a Image<f32>>,
    noise: Option<&'a Image<[f32; 2]>>,
    pub size: [u32; 2],
    pub uniforms: ViewUniforms,
    /// Factor on stored colors.
    pub exposure: f32,
    /// Colors of quads that are shaded in part, one a quad.
    half: Option<&'a Image<[f32; 3]>>,
    /// Factor on given colors.
    pub color_exposure: f32,
    /// Its inverse, a factor on shown colors.
    inverse_exposure: f32,
    /// Whether the view starts without history.
    pub reset: bool,
    motion_scale: [f32; 2],
    convention: MotionConvention,
    camera_uniforms: CameraUniforms,
    disparity_map: DisparityMap,
    depth_test: Option<DepthTest>,
}

impl<'a> Inputs<'a> {
    /// Inputs of view `index` of `frame`. `has_history`: whether a frame was processed before.
    pub fn new(desc: &ContextDesc, frame: &Frame<'a>, index: usize, state: &ViewState, has_history: bool) -> Self {
        let view = &frame.views[index];
        let uniforms = ViewUniforms::new(desc, view, state, index, frame.index);
        Self {
            color: frame.color[index],
            lod: frame.lod.map(|l| l[index]),
            depth: frame.depth.map(|d| d[index]),
            motion: frame.motion.map(|m| m[index]),
            trust: frame.trust.map(|t| t[index]),
            reactive: frame.reactive.map(|r| r[index]),
            noise: frame.noise.map(|n| n[index]),
            size: desc.size_px,
            uniforms,
            exposure: state.stored_exposure(frame),
            half: frame.half.map(|half| half[index]),
            color_exposure: frame.exposure.of_colors(),
            inverse_exposure: 1.0 / frame.exposure.of_colors(),
            reset: frame.reset != Reset::None || !has_history,
            motion_scale: desc.motion.to_internal(desc.size_px),
            convention: desc.motion,
            camera_uniforms: CameraUniforms::new(desc, view, state),
            disparity_map: view.depth_convention(desc).disparity_map(),
            depth_test: desc.settings.depth_test.filter(|_| frame.depth.is_some()),
        }
    }

    /// Whether the lens shows a pixel.
    #[inline(always)]
    pub fn is_visible(&self, x: u32, y: u32) -> bool {
        lens::is_visible(x, y, self.uniforms.lowest_px.into(), self.uniforms.highest_px.into())
    }

    /// Texel of history that is nearest to the previous position of the surface of pixel (x, y), or the verdict that
    /// rejects history whatever it holds.
    #[inline(always)]
    pub fn nearest(&self, x: u32, y: u32, motion: [f32; 2], notes: &mut impl Notes) -> Result<[u32; 2], Verdict> {
        if self.reset {
            return Err(Verdict::Reset);
        }
        notes.note(NoteStage::Reprojection, "previous position", [x as f32 + motion[0], y as f32 + motion[1]], "px");
        let nearest_px = reproject::nearest(x, y, motion, self.size)?;
        notes.note(NoteStage::Reprojection, "nearest texel", nearest_px.map(|v| v as f32), "px");
        Ok(nearest_px)
    }

    /// Previous position of the surface of pixel (x, y), and whether the nearest stored texel shows that surface.
    /// Returns the verdict instead if history is rejected regardless of the neighbouring texels. `stored` gives level
    /// of detail (negative: empty) and disparity of a stored texel.
    #[inline(always)]
    pub fn reprojected(
        &self,
        x: u32,
        y: u32,
        motion: [f32; 2],
        disparity: f32,
        stored: impl FnOnce([u32; 2]) -> [f32; 2],
        notes: &mut impl Notes,
    ) -> Result<(Previous, bool), Verdict> {
        let [lod, stored_disparity] = stored(self.nearest(x, y, motion, notes)?);
        notes.note(NoteStage::Reprojection, "its level of detail", lod, "log2 px, below 0: empty");
        notes.note(NoteStage::Reprojection, "its disparity", stored_disparity, "1/distance");
        if lod < 0.0 {
            return Err(Verdict::Empty);
        }
        let trust = self.trust(x, y).map_or(1.0, sanitize::trust);
        if trust == 0.0 {
            return Err(Verdict::Distrusted);
        }
        let expected = self.expected_disparity(x, y, disparity);
        let is_same = self.same_surface(x, y, disparity, expected, stored_disparity);
        notes.note(NoteStage::Reprojection, "expected disparity", expected, "1/distance");
        notes.note(NoteStage::Reprojection, "same surface", is_same, "");
        notes.note(NoteStage::Reprojection, "trust in history", trust, "");
        let at = [x as f32 + motion[0], y as f32 + motion[1]];
        Ok((Previous { at, expected, trust }, is_same))
    }

    /// Level of detail of the candidate at pixel (x, y), `e_deg` from the gaze: the frame's input, or by eccentricity.
    #[inline(always)]
    pub fn candidate_lod(&self, foveation: &Foveation, x: u32, y: u32, e_deg: f32) -> f32 {
        match self.lod {
            // max() turns NaN into 0.
            Some(lods) => lods.at(x as usize, y as usize).clamp(0.0, MAX_LOD).max(0.0),
            None => foveation.lod(e_deg),
        }
    }

    /// Whether a neighbour in the 2x2 block has the same motion as the pixel (x, y).
    #[inline(always)]
    pub fn is_coherent(&self, x: u32, y: u32, own: [f32; 2]) -> bool {
        if self.motion.is_none() && !self.convention.lacks_camera() {
            return true;
        }
        let [width, height] = self.size;
        // At an odd border the pixel is its own neighbour.
        let (across_x, across_y) = ((x ^ 1).min(width - 1), (y ^ 1).min(height - 1));
        moves_alike(own, self.motion(across_x, y)) || moves_alike(own, self.motion(x, across_y))
    }

    /// Color of a texel of the color input, in this frame's exposure, not sanitized.
    #[inline(always)]
    pub fn color_at(&self, [x, y]: [u32; 2]) -> Vec3 {
        Vec3::from(self.color.at(x as usize, y as usize)) * self.color_exposure
    }

    /// The same of a pixel of a quad that is shaded in part.
    #[inline(always)]
    pub fn partial_color_at(&self, px: [u32; 2]) -> Vec3 {
        let Some(half) = self.half else { return self.color_at(px) };
        let [x, y] = px.map(|v| v as usize / 2);
        Vec3::from(half.at(x, y)) * self.color_exposure
    }

    /// A color in this frame's exposure, in the unit of the color input.
    #[inline(always)]
    pub fn unexposed(&self, color: Vec3) -> Vec3 {
        color * self.inverse_exposure
    }

    /// Sanitized candidate, and whether it is usable.
    #[inline(always)]
    pub fn candidate(&self, x: u32, y: u32) -> (Vec3, bool) {
        sanitize::color(self.color_at([x, y]))
    }

    #[inline(always)]
    pub fn ray(&self, x: u32, y: u32) -> Vec3 {
        ray(&self.uniforms, x, y)
    }

    #[inline(always)]
    pub fn region_angle_deg(&self, ray: Vec3) -> f32 {
        self.uniforms.region_angle_deg(ray)
    }

    #[inline(always)]
    pub fn disparity(&self, x: u32, y: u32) -> f32 {
        match self.depth {
            Some(depth) => depth::disparity(depth.at(x as usize, y as usize), self.disparity_map),
            None => depth::INVALID_DISPARITY,
        }
    }

    /// Motion vector of a pixel: previous minus current position in pixels, y down, without jitter, with the camera's
    /// motion.
    #[inline(always)]
    pub fn motion(&self, x: u32, y: u32) -> [f32; 2] {
        let mut own = [0.0; 2];
        if let Some(motion) = self.motion {
            let given = motion.at(x as usize, y as usize);
            let [offset_x, offset_y] = self.uniforms.motion_offset;
            own = [given[0] * self.motion_scale[0] + offset_x, given[1] * self.motion_scale[1] + offset_y];
            if self.convention.no_vector.is_some() {
                let is_missing = has_no_vector(Vec2::from(given), self.camera_uniforms.no_vector.into());
                if !is_missing && !self.convention.without_camera {
                    return own;
                }
                own = if is_missing { [0.0; 2] } else { own };
            }
        }
        if !self.convention.lacks_camera() {
            return own;
        }
        self.with_camera([x, y], own)
    }

    /// An object's `own` motion and the camera's. The object's ends where the camera would have seen it without moving.
    fn with_camera(&self, px: [u32; 2], own: [f32; 2]) -> [f32; 2] {
        let own = Vec2::from(own);
        let at = Vec2::new(px[0] as f32, px[1] as f32) + own;
        let ray = at * Vec2::from(self.uniforms.ray_scale) + Vec2::from(self.uniforms.ray_offset);
        let disparity = self.disparity(px[0], px[1]);
        (own + camera_vector(ray, disparity, self.camera_uniforms.motion())).into()
    }

    /// Motion in the world of the surface of pixel (x, y), in pixels a frame; [`UNKNOWN_MOVED_PX`] if it is not known.
    #[inline(always)]
    pub fn moved_px(&self, [x, y]: [u32; 2], disparity: f32, motion: [f32; 2]) -> f32 {
        if self.camera_uniforms.is_known == 0 || disparity < 0.0 {
            return UNKNOWN_MOVED_PX;
        }
        let camera = camera_vector(self.ray(x, y).truncate(), disparity, self.camera_uniforms.motion());
        world_motion_px(Vec2::from(motion), camera)
    }

    /// Noise of the candidate; `None` without a noise input.
    #[inline(always)]
    pub fn noise(&self, x: u32, y: u32) -> Option<Noise> {
        let noise = self.noise?;
        let [error, samples] = noise.at(x as usize, y as usize);
        Some(candidate_noise([error * self.color_exposure, samples]))
    }

    /// Trust mask, not sanitized; `None` without a trust input and a reactive mask.
    #[inline(always)]
    pub fn trust(&self, x: u32, y: u32) -> Option<f32> {
        let [x, y] = [x as usize, y as usize];
        self.reactive.map(|r| 1.0 - r.at(x, y)).or_else(|| self.trust.map(|t| t.at(x, y)))
    }

    #[inline(always)]
    pub fn tests_depth(&self) -> bool {
        self.depth_test.is_some()
    }

    /// Disparity that the pixel's surface had in the previous frame.
    #[inline(always)]
    pub fn previous_disparity(&self, ray: Vec3, disparity: f32) -> f32 {
        let [m20, m21, m22, shift] = self.uniforms.depth_row;
        depth::previous_disparity(disparity, m20 * ray.x + m21 * ray.y + m22, shift)
    }

    /// Disparity in the previous frame of a surface at pixel (x, y).
    #[inline(always)]
    pub fn expected_disparity(&self, x: u32, y: u32, disparity: f32) -> f32 {
        self.previous_disparity(self.ray(x, y), disparity)
    }

    /// Depth test: whether the `stored` disparity belongs to the surface of pixel (x, y), which has the disparity `now`
    /// and had the disparity `expected`. True without a depth test.
    #[inline(always)]
    pub fn same_surface(&self, x: u32, y: u32, now: f32, expected: f32, stored: f32) -> bool {
        let Some(test) = self.depth_test else {
            return true;
        };
        depth::same_surface(expected, stored, test.relative, 0.0)
            || depth::same_surface(expected, stored, test.relative, test.slope_px * self.slope(x, y, now))
    }

    /// The depth test without the slope of the surface.
    #[inline(always)]
    pub fn same_disparity(&self, expected: f32, stored: f32) -> bool {
        self.depth_test.is_none_or(|test| depth::same_surface(expected, stored, test.relative, 0.0))
    }

    /// Slope of disparity at a pixel. It takes four taps, so it is computed only where the test without slope fails,
    /// which is at few pixels.
    #[cold]
    fn slope(&self, x: u32, y: u32, now: f32) -> f32 {
        depth::slope(x, y, self.size, |u, v| if [u, v] == [x, y] { now } else { self.disparity(u, v) })
    }

    /// Counts the unusable inputs of a pixel, and the verdict on its history.
    #[inline(always)]
    pub fn count(&self, x: u32, y: u32, usable: bool, disparity: f32, verdict: Verdict, stats: &mut FrameStats) {
        stats.pixels += 1;
        stats.nonfinite += u64::from(!usable);
        stats.bad_depth += u64::from(self.depth.is_some() && disparity == depth::INVALID_DISPARITY);
        stats.bad_trust += u64::from(self.trust(x, y).is_some_and(|t| !sanitize::is_finite(t)));
        stats.verdicts[verdict as usize] += 1;
    }
}

#[inline(always)]
fn ray(uniforms: &ViewUniforms, x: u32, y: u32) -> Vec3 {
    (Vec2::new(x as f32, y as f32) * Vec2::from(uniforms.ray_scale) + Vec2::from(uniforms.ray_offset)).extend(1.0)
}

//! Stored history of a pixel's surface, at its previous position; shared by the methods that store surfaces (smr, taa).
//! Twin: `shaders/levels/surface_history.wgsl`.

use crate::cpu::explain::note_taps;
use crate::cpu::history::PastSurfaces;
use crate::cpu::inputs::{Inputs, Previous};
use crate::cpu::quads::Quads;
use crate::kernel::color::expose;
use crate::kernel::foveate::{block_sample, block_sample_level, split};
use crate::kernel::noise::{Noise, expose_noise, unpack_noise};
use crate::kernel::pack::tap_codes;
use crate::kernel::reproject::Verdict;
use crate::kernel::resample::{
    Resampled, STAND_IN_WEIGHT, corner_weight, gather_around, resolve, second_corner, sharp_sum, surface_tap,
    taps_around,
};
use crate::kernel::smr::mip_bilinear;
use crate::kernel::surface::{Surface, mip_texel, unpack_surface};
use crate::kernel::taa::root_luma;
use crate::notes::{NoteStage, Notes};
use glam::Vec3;

/// Inputs and history of one view of a frame.
pub(crate) struct SurfaceHistory<'a> {
    pub inputs: Inputs<'a>,
    /// Shaded quads, of a frame shaded by quads.
    pub quads: Option<&'a Quads>,
    pub past: PastSurfaces<'a>,
}

/// Previous position of a pixel's surface, and its history there.
#[derive(Clone, Copy)]
pub(crate) struct Source {
    /// Whole part of the position.
    pub texel: [i32; 2],
    /// Fractional part of the position, each in \[0, 1).
    pub fraction: [f32; 2],
    /// Position in pixels.
    pub at: [f32; 2],
    /// Nearest stored texel, or the one that replaces it at a silhouette.
    pub nearest: Surface,
    /// Index of `nearest` in the stored view.
    pub index: usize,
    /// Disparity that the surface had in the previous frame.
    pub expected: f32,
    /// Confidence in history: above 0 and at most 1.
    pub trust: f32,
}

impl SurfaceHistory<'_> {
    /// Previous position of the surface of pixel (x, y), or the verdict that rejects its history.
    #[inline(always)]
    pub fn source(
        &self,
        x: u32,
        y: u32,
        motion: [f32; 2],
        disparity: f32,
        notes: &mut impl Notes,
    ) -> Result<Source, Verdict> {
        let mut nearest = Surface::EMPTY;
        let mut index = 0;
        let stored = |[qx, qy]: [u32; 2]| {
            index = qy as usize * self.inputs.size[0] as usize + qx as usize;
            nearest = unpack_surface(self.past.words[index]);
            [nearest.lod, nearest.disparity]
        };
        let (previous, is_same) = self.inputs.reprojected(x, y, motion, disparity, stored, notes)?;
        let Previous { at, expected, trust, .. } = previous;
        let whole = at.map(f32::floor);
        let (texel, fraction) = (whole.map(|v| v as i32), [at[0] - whole[0], at[1] - whole[1]]);
        if !is_same {
            let stand_in = self.stand_in(texel, fraction, expected);
            notes.note(NoteStage::Reprojection, "a neighbour replaces the nearest texel", stand_in.is_some(), "");
            (nearest, index) = stand_in.ok_or(Verdict::Disoccluded)?;
        }
        Ok(Source { texel, fraction, at, nearest, index, expected, trust })
    }

    /// The texel with the second largest weight around a position, and its index, if it has the expected disparity. It
    /// replaces the nearest texel, which may show the other surface at a silhouette.
    #[cold]
    fn stand_in(&self, texel: [i32; 2], fraction: [f32; 2], expected: f32) -> Option<(Surface, usize)> {
        let corner = second_corner(fraction);
        let [width, height] = self.inputs.size.map(|s| s as i32);
        let x = (texel[0] + (corner & 1) as i32).clamp(0, width - 1);
        let y = (texel[1] + (corner >> 1) as i32).clamp(0, height - 1);
        let stored = unpack_surface(self.past.words[(y * width + x) as usize]);
        let stands_in = corner_weight(corner, fraction) > STAND_IN_WEIGHT
            && stored.lod >= 0.0
            && self.inputs.same_disparity(expected, stored.disparity);
        stands_in.then_some((stored, (y * width + x) as usize))
    }

    /// Luma of history at `offset_px` from the texel nearest to a position, regardless of its surface.
    #[inline(always)]
    pub fn luma_beside(&self, source: &Source, offset_px: [i32; 2]) -> f32 {
        let [x, y] = [0, 1].map(|i| {
            let nearest = source.texel[i] + i32::from(source.fraction[i] >= 0.5);
            (nearest + offset_px[i]).clamp(0, self.inputs.size[i] as i32 - 1)
        });
        let words = self.past.words[(y * self.inputs.size[0] as i32 + x) as usize];
        root_luma(self.expose(unpack_surface(words).color))
    }

    /// History resampled at a position; a position exactly on a texel reads that texel.
    #[inline(always)]
    pub fn resample(&self, source: &Source, notes: &mut impl Notes) -> Resampled {
        let resampled = self.read(source, notes);
        notes.note(NoteStage::History, "color", self.expose(resampled.sharp), "linear light");
        resampled
    }

    #[inline(always)]
    fn read(&self, source: &Source, notes: &mut impl Notes) -> Resampled {
        let [fx, fy] = source.fraction;
        if fx == 0.0 && fy == 0.0 {
            let s = source.nearest;
            notes.note(NoteStage::History, "filter", "none: the position is the texel's centre", "");
            return Resampled { sharp: s.color, smooth: s.color, lod: s.lod };
        }
        let taps = taps_around(source.texel, source.fraction, self.inputs.size);
        let (codes, any_code) = (tap_codes(source.expected), !self.inputs.tests_depth());
        let width = self.inputs.size[0] as i32;
        let tap = |[x, y]: [i32; 2]| surface_tap(self.past.words[(y * width + x) as usize], codes, any_code);
        let gathered = gather_around(&taps, tap);
        note_taps(&taps, tap, notes);
        resolve(gathered, sharp_sum(&taps), source.nearest)
    }

    /// History at the sample position of the block of level of detail `lod` around pixel `px`, low-passed like that
    /// sample: the texel of history that corresponds to the texel that the block filter reads.
    #[inline(always)]
    pub fn sampled(&self, source: &Source, px: [u32; 2], lod: f32) -> Vec3 {
        let mip_chain = self.past.mip_chain.expect("smr stores a mip chain");
        let level = (lod + 0.5) as u32;
        let finer = block_sample_level(level).min(mip_chain.last_level());
        let texel_px = (1_u32 << finer) as f32;
        let at = [0, 1].map(|i| {
            let texel = block_sample(px[i] >> level, level, self.inputs.size[i]);
            source.at[i] + (((texel as f32 + 0.5) * texel_px - 0.5) - px[i] as f32)
        });
        if finer > 0 {
            return mip_chain.bilinear(at, finer);
        }
        let [width, height] = self.inputs.size;
        let (x, fx) = split(at[0], width);
        let (y, fy) = split(at[1], height);
        let texel =
            |x: u32, y: u32| mip_texel(self.past.words[(y.min(height - 1) * width + x.min(width - 1)) as usize]);
        mip_bilinear([texel(x, y), texel(x + 1, y)], [texel(x, y + 1), texel(x + 1, y + 1)], [fx, fy])
    }

    /// Noise of the nearest texel, scaled to this frame's exposure.
    #[inline(always)]
    pub fn noise(&self, source: &Source) -> Noise {
        expose_noise(unpack_noise(self.past.noise[source.index]), self.inputs.exposure)
    }

    /// Stored color scaled to this frame's exposure.
    #[inline(always)]
    pub fn expose(&self, color: Vec3) -> Vec3 {
        expose(color, self.inputs.exposure)
    }
}

//! Temporal antialiasing of the foveated frame.

use super::reprojection::Reprojection;
use crate::image::Image;
use crate::kernel::scrub;
use crate::kernel::surface::{Surface, pack_surface};
use crate::kernel::taa;
use glam::Vec3;
use rayon::prelude::*;

pub struct TaaParams {
    pub alpha: f32,
    pub gamma: f32,
}

pub(super) fn run(
    at: &Reprojection<'_>,
    color: &Image<[f32; 3]>,
    words: &mut [[u32; 2]],
    out: &mut Image<[f32; 3]>,
    p: &TaaParams,
) {
    let w = at.size[0] as usize;
    out.pixels_mut().par_chunks_mut(w).zip(words.par_chunks_mut(w)).enumerate().for_each(|(y, (out, words))| {
        for x in 0..w {
            let (xu, yu) = (x as u32, y as u32);
            let (c, _) = scrub::color(Vec3::from(color.at(x, y)));
            let disparity = at.disparity(xu, yu);
            let shown = match at.source(xu, yu, disparity) {
                Err(_) => c,
                Ok(source) => {
                    let h = at.resample(&source);
                    let (mut sum, mut squares) = (Vec3::ZERO, Vec3::ZERO);
                    for j in -1..=1_i32 {
                        for i in -1..=1_i32 {
                            let sx = (x as i32 + i).clamp(0, w as i32 - 1) as usize;
                            let sy = (y as i32 + j).clamp(0, at.size[1] as i32 - 1) as usize;
                            let v = taa::to_ycocg(scrub::color(Vec3::from(color.at(sx, sy))).0);
                            sum += v;
                            squares += v * v;
                        }
                    }
                    let mean = sum / 9.0;
                    let deviation = (squares / 9.0 - mean * mean).max(Vec3::ZERO).map(f32::sqrt);
                    let clipped = taa::clip(taa::to_ycocg(h.sharp), mean, deviation * p.gamma);
                    let now = taa::to_ycocg(c);
                    taa::from_ycocg(clipped + (now - clipped) * p.alpha)
                }
            };
            out[x] = shown.to_array();
            words[x] = pack_surface(Surface { color: shown, lod: 0.0, disparity });
        }
    });
}

//! The scale-matched reservoir.

use super::reprojection::Reprojection;
use crate::image::Image;
use crate::kernel::matched::{self, Evidence, SmrParams};
use crate::kernel::resample::split;
use crate::kernel::scrub;
use crate::kernel::surface::{Surface, pack_surface, unpack_surface};
use glam::Vec3;
use rayon::prelude::*;

/// Coarser levels of the past: level l at index l - 1.
#[derive(Clone, Debug, Default)]
pub(super) struct Chain {
    pub levels: Vec<Image<[f32; 4]>>,
}

impl Chain {
    pub fn build(size: [u32; 2], words: &[[u32; 2]], count: u32) -> Self {
        let base = Image::from_fn_parallel(size, |[x, y]| {
            let s = unpack_surface(words[(y * size[0] + x) as usize]);
            let w = if s.lod < 0.0 { 0.0 } else { 1.0 };
            (s.color * w).extend(w).to_array()
        });
        let mut levels: Vec<Image<[f32; 4]>> = vec![];
        for _ in 0..count {
            let fine = levels.last().unwrap_or(&base);
            let size = fine.size().map(|s| s.div_ceil(2));
            let next = Image::from_fn_parallel(size, |[x, y]| {
                let (x0, y0) = (2 * x as usize, 2 * y as usize);
                let (x1, y1) = ((x0 + 1).min(fine.width() - 1), (y0 + 1).min(fine.height() - 1));
                let at = |x, y| glam::Vec4::from(fine.at(x, y));
                ((at(x0, y0) + at(x1, y0) + at(x0, y1) + at(x1, y1)) * 0.25).to_array()
            });
            levels.push(next);
        }
        Self { levels }
    }

    fn bilinear(&self, at: [f32; 2], level: usize) -> Vec3 {
        let image = &self.levels[level - 1];
        let scale = 1.0 / (1_u32 << level) as f32;
        let [x, y] = at.map(|v| (v + 0.5) * scale - 0.5);
        let (x0, fx) = split(x.clamp(0.0, image.width() as f32 - 1.0));
        let (y0, fy) = split(y.clamp(0.0, image.height() as f32 - 1.0));
        let (x0, y0) = (x0 as usize, y0 as usize);
        let x1 = (x0 + 1).min(image.width() - 1);
        let y1 = (y0 + 1).min(image.height() - 1);
        let t = |x, y| glam::Vec4::from(image.at(x, y));
        let top = t(x0, y0) + (t(x1, y0) - t(x0, y0)) * fx;
        let bottom = t(x0, y1) + (t(x1, y1) - t(x0, y1)) * fx;
        let v = top + (bottom - top) * fy;
        v.truncate() / v.w.max(1e-6)
    }

    fn read(&self, at: [f32; 2], lod: f32, base: Vec3) -> Vec3 {
        let lod = lod.clamp(0.0, self.levels.len() as f32);
        let level = lod.floor();
        let fraction = lod - level;
        let level = level as usize;
        let fine = if level == 0 { base } else { self.bilinear(at, level) };
        if fraction == 0.0 {
            return fine;
        }
        let coarse = self.bilinear(at, level + 1);
        fine + (coarse - fine) * fraction
    }
}

pub(super) fn run(
    at: &Reprojection<'_>,
    color: &Image<[f32; 3]>,
    lods: &Image<f32>,
    chain: &Chain,
    words: &mut [[u32; 2]],
    out: &mut Image<[f32; 3]>,
    p: &SmrParams,
    block: bool,
) {
    let w = at.size[0] as usize;
    out.pixels_mut().par_chunks_mut(w).zip(words.par_chunks_mut(w)).enumerate().for_each(|(y, (out, words))| {
        for x in 0..w {
            let (xu, yu) = (x as u32, y as u32);
            let (c, _) = scrub::color(Vec3::from(color.at(x, y)));
            let disparity = at.disparity(xu, yu);
            let lod = lods.at(x, y);
            let mut shown = c;
            let mut shown_lod = lod;
            let env = |n: &str, d: f32| std::env::var(n).ok().and_then(|v| v.parse().ok()).unwrap_or(d);
            let need = env("EN", 0.0);
            let mut bad = false;
            if need > 0.0
                && let Some(m) = at.motion
            {
                let own = m.at(x, y);
                let t = env("ET", 0.5) + env("ETR", 0.1) * (own[0].abs() + own[1].abs());
                let agrees = |dx: i32, dy: i32| {
                    let o = m.at(
                        (x as i32 + dx).clamp(0, w as i32 - 1) as usize,
                        (y as i32 + dy).clamp(0, at.size[1] as i32 - 1) as usize,
                    );
                    if (o[0] - own[0]).abs() <= t && (o[1] - own[1]).abs() <= t { 1.0_f32 } else { 0.0 }
                };
                bad = agrees(1, 0) + agrees(-1, 0) + agrees(0, 1) + agrees(0, -1) < need;
            }
            if bad {
                shown_lod = shown_lod.max(env("EL", 8.0));
            }
            if lod > 0.0 && !(bad && env("ES", 1.0) > 0.0) {
                if let Ok(source) = at.source(xu, yu, disparity) {
                    let h = at.resample(&source);
                    if matched::wanted(lod, h.lod, p).1 > 0.0 {
                        let env = |n: &str, d: f32| std::env::var(n).ok().and_then(|v| v.parse().ok()).unwrap_or(d);
                        let up = if block { env("UP", 1.0) } else { 0.0 };
                        let r = 0.75 * lod.exp2();
                        let tap = |sx: f32, sy: f32| {
                            let px = ((x as f32 + sx * r).round().max(0.0) as usize).min(w - 1);
                            let py = ((y as f32 + sy * r).round().max(0.0) as usize).min(at.size[1] as usize - 1);
                            scrub::color(Vec3::from(color.at(px, py))).0
                        };
                        let coarse = (tap(-1., -1.) + tap(1., -1.) + tap(-1., 1.) + tap(1., 1.)) * 0.25;
                        let wide = if block {
                            (tap(-2., -2.)
                                + tap(2., -2.)
                                + tap(-2., 2.)
                                + tap(2., 2.)
                                + tap(0., 2.)
                                + tap(2., 0.)
                                + tap(0., -2.)
                                + tap(-2., 0.)
                                + tap(0., 0.))
                                * (1.0 / 9.0)
                        } else {
                            coarse
                        };
                        let e = Evidence {
                            candidate: c,
                            seen: if block { coarse } else { c },
                            lod,
                            history: h.sharp,
                            history_lod: h.lod,
                            matched: chain.read(source.at, lod + up, h.smooth),
                            coarser: chain.read(source.at, lod + 1.0 + up, h.smooth),
                        };
                        (shown, shown_lod, _) = matched::decide(&e, wide, p);
                    }
                }
            }
            out[x] = shown.to_array();
            words[x] = pack_surface(Surface { color: shown, lod: shown_lod, disparity });
        }
    });
}

//! Mip filter: mip levels of linear light, for any size, with bilinear and trilinear lookup.

use crate::image::Image;
use crate::kernel::{foveate, sanitize};
use glam::Vec3;

/// Mip levels of a full-rate frame: level 0 is the frame, a texel of each next level the mean of 2x2. Needs the feature
/// `cpu`.
///
/// Level l has `ceil(size / 2^l)` texels a side; texel i covers pixels `i * 2^l` to `(i + 1) * 2^l - 1`, without those
/// beyond the frame's edge.
///
/// ```
/// use afterimage::internal::{Foveation, Pyramid};
/// use afterimage::{Image, ViewGeometry};
///
/// let (size, gaze_px) = ([64, 36], [32.0, 18.0]);
/// let geometry = ViewGeometry::flat(size, 70.0)?;
/// let foveation = Foveation::default();
/// let full = Image::from_fn(size, |[x, _]| [(x % 2) as f32; 3]);
///
/// let lods = foveation.lod_map(&geometry, gaze_px);
/// let foveated = foveation.render(&Pyramid::new(full, foveation.max_level()), &lods);
/// assert_eq!(foveated.at(33, 18), [1.0; 3]);
/// assert_eq!(foveated.at(0, 0), [0.5; 3]);
/// # Ok::<(), afterimage::SettingsError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Pyramid {
    levels: Vec<Image<[f32; 3]>>,
}

impl Pyramid {
    /// Computes levels 0 to `max_level` of `full`. Non-finite pixels count as black in coarser levels, so that one
    /// non-finite pixel does not make a whole block non-finite.
    pub fn new(full: Image<[f32; 3]>, max_level: u32) -> Self {
        let mut levels = vec![full];
        for _ in 0..max_level {
            let next = halve(&levels[levels.len() - 1]);
            levels.push(next);
        }
        Self { levels }
    }

    /// Image of a level; 0 is the full-rate frame.
    ///
    /// # Panics
    /// If `level` is above the `max_level` of [`new`](Self::new).
    pub fn level(&self, level: usize) -> &Image<[f32; 3]> {
        &self.levels[level]
    }

    /// Bilinear lookup in `level` at position `px` in pixels of level 0, clamped at the borders.
    ///
    /// # Panics
    /// If `level` is above the `max_level` of [`new`](Self::new).
    pub fn bilinear(&self, px: [f32; 2], level: usize) -> [f32; 3] {
        let image = &self.levels[level];
        let axis = |i: usize| {
            let len = image.size()[i];
            let (near, fraction) = foveate::split(foveate::level_coordinate(px[i], level as u32), len);
            (near as usize, (near + 1).min(len - 1) as usize, fraction)
        };
        let ((x0, x1, fx), (y0, y1, fy)) = (axis(0), axis(1));
        let row = |y| [Vec3::from(image.at(x0, y)), Vec3::from(image.at(x1, y))];
        foveate::bilinear(row(y0), row(y1), [fx, fy]).to_array()
    }

    /// Trilinear lookup at the pixel `px` and level of detail `lod`: linear blend of bilinear lookups in the two levels
    /// around `lod`. Level 0 is returned bit for bit; in a blend with level 1 its non-finite pixels count as black.
    ///
    /// # Panics
    /// If `px` is outside the frame, for a `lod` below 1.
    pub fn trilinear(&self, px: [f32; 2], lod: f32) -> [f32; 3] {
        let (level, fraction) = foveate::split(lod, self.levels.len() as u32);
        let level = level as usize;
        let fine = if level == 0 {
            let full = self.levels[0].at(px[0] as usize, px[1] as usize);
            if fraction == 0.0 {
                return full;
            }
            sanitize::color(Vec3::from(full)).0
        } else {
            self.bilinear(px, level).into()
        };
        if fraction == 0.0 {
            return fine.to_array();
        }
        foveate::blend(fine, self.bilinear(px, level + 1).into(), fraction).to_array()
    }
}

/// Next mip level: means of 2x2 texels. At odd borders a missing texel is replaced by its neighbour, so that the result
/// is the mean of the existing texels.
fn halve(image: &Image<[f32; 3]>) -> Image<[f32; 3]> {
    let size = image.size();
    let texel = |x: u32, y: u32| {
        let at = image.at(x.min(size[0] - 1) as usize, y.min(size[1] - 1) as usize);
        sanitize::color(Vec3::from(at)).0
    };
    Image::from_fn_parallel(size.map(|s| foveate::level_len(s, 1)), |half| {
        let [x, y] = half.map(|v| 2 * v);
        foveate::mean_of_four(texel(x, y), texel(x + 1, y), texel(x, y + 1), texel(x + 1, y + 1)).to_array()
    })
}

//! Correspondence of pixels between frames, and surface points that were sampled at full rate: ground truth for
//! metrics, from the full-rate frames and independent of any method.

use crate::frame::SourceFrame;
use afterimage::internal::DepthTest;
use afterimage::kernel::{depth, reproject};
use afterimage::{DepthConvention, Image, ViewGeometry};

/// Level of detail below which a pixel counts as sampled at full rate.
const SHARP_LOD: f32 = 0.25;

/// Eccentricity in degrees beyond which retention is measured: outside the foveas of the common settings and their
/// blend zones.
pub(super) const RETAINED_FROM_DEG: f32 = 3.5;

/// Value in [`Tracked::past`] of a pixel that was not visible in the previous frame.
pub const NO_PAST: u32 = u32::MAX;

/// Correspondence of a frame to the previous one.
#[derive(Clone, Debug)]
pub struct Tracked {
    /// Index of each pixel's surface point in the previous frame, or [`NO_PAST`] if it was not visible.
    pub past: Image<u32>,
    /// Index of the pixel in the previous frame that the motion vector points to, without a depth test, or [`NO_PAST`]
    /// outside of the frame: the history fetch of a method that relies on motion vectors alone.
    pub fetched: Image<u32>,
    /// Retained pixels: beyond 3.5 degrees, with a surface point that was sampled at full rate earlier and has been
    /// visible since.
    pub retained: Image<bool>,
}

impl Tracked {
    /// A frame without correspondence.
    pub fn unknown(size: [u32; 2]) -> Self {
        let past = Image::filled(size, NO_PAST);
        Self { fetched: past.clone(), past, retained: Image::filled(size, false) }
    }
}

/// Tracks surface points from frame to frame.
#[derive(Clone, Debug, Default)]
pub struct Tracker {
    previous: Option<(Image<bool>, Option<Image<f32>>)>,
}

impl Tracker {
    /// Processes the next frame, given its eccentricities in degrees and levels of detail.
    pub fn advance(
        &mut self,
        frame: &SourceFrame,
        geometry: &ViewGeometry,
        ecc_deg: &Image<f32>,
        lods: &Image<f32>,
    ) -> Tracked {
        let size = frame.color.size();
        let map = DepthConvention::Linear.disparity_map();
        let disparity = frame.depth.as_ref().map(|d| d.map(|z| depth::disparity(z, map)));
        if frame.cut {
            self.previous = None;
        }
        let both = match &self.previous {
            None => Image::filled(size, [NO_PAST; 2]),
            Some((_, before)) => correspond(frame, geometry, disparity.as_ref(), before.as_ref()),
        };
        let (past, fetched) = (both.map(|b| b[0]), both.map(|b| b[1]));
        let mut seen = Image::filled(size, false);
        let mut retained = Image::filled(size, false);
        for i in 0..past.pixels().len() {
            let from = past.pixels()[i];
            let seen_before = match &self.previous {
                Some((seen, _)) if from != NO_PAST => seen.pixels()[from as usize],
                _ => false,
            };
            retained.pixels_mut()[i] = seen_before && ecc_deg.pixels()[i] > RETAINED_FROM_DEG;
            seen.pixels_mut()[i] = seen_before || lods.pixels()[i] < SHARP_LOD;
        }
        self.previous = Some((seen, disparity));
        Tracked { past, fetched, retained }
    }
}

/// For each pixel, its indices in [`Tracked::past`] and [`Tracked::fetched`].
fn correspond(
    frame: &SourceFrame,
    geometry: &ViewGeometry,
    now: Option<&Image<f32>>,
    before: Option<&Image<f32>>,
) -> Image<[u32; 2]> {
    let size = frame.color.size();
    if frame.motion.is_none() && frame.previous_from_current.is_none() {
        let mut index = 0;
        return Image::from_fn(size, |_| {
            index += 1;
            [index - 1; 2]
        });
    }
    let row = frame.previous_from_current.map_or([0.0, 0.0, 1.0, 0.0], |m| m[2]);
    let test = DepthTest::default();
    Image::from_fn(size, |[x, y]| {
        let (xi, yi) = (x as usize, y as usize);
        let motion = frame.motion.as_ref().map_or([0.0; 2], |m| m.at(xi, yi));
        let Ok([qx, qy]) = reproject::nearest(x, y, motion, size) else {
            return [NO_PAST; 2];
        };
        let index = qy * size[0] + qx;
        let (Some(now), Some(before)) = (now, before) else {
            return [index; 2];
        };
        let [ray_x, ray_y, _] = geometry.ray([x as f32, y as f32]);
        let stretch = row[0] * ray_x + row[1] * ray_y + row[2];
        let expected = depth::previous_disparity(now.at(xi, yi), stretch, row[3]);
        let slope = depth::slope(x, y, size, |x, y| now.at(x as usize, y as usize));
        let slope = test.slope_px * slope;
        let stored = before.at(qx as usize, qy as usize);
        let same = depth::same_surface(expected, stored, test.relative, slope);
        [if same { index } else { NO_PAST }, index]
    })
}

//! Which pixel was which in the previous frame, and which surface points the eye has seen sharp: ground truth for metrics,
//! from the full-rate frames, whatever a method does.

use crate::frame::SourceFrame;
use afterimage::kernel::{depth, reproject};
use afterimage::{DepthConvention, DepthTest, Image, ViewGeometry};

/// Level of detail below which a pixel counts as shown at full rate.
const SHARP_LOD: f32 = 0.25;

/// Eccentricity in degrees beyond which retention is judged: outside every fovea of the common settings and their blends.
pub(super) const RETAINED_FROM_DEG: f32 = 3.5;

/// Stands in [`Tracked::past`] for a pixel without a visible past.
pub const NO_PAST: u32 = u32::MAX;

/// What is known of one frame.
#[derive(Clone, Debug)]
pub struct Tracked {
    /// For each pixel the index of its pixel in the previous frame, or [`NO_PAST`].
    pub past: Image<u32>,
    /// The same whichever surface stands there: where a method that trusts motion alone fetches from.
    pub fetched: Image<u32>,
    /// Pixels beyond 3.5 degrees whose surface point was shown at full rate earlier and has stayed visible.
    pub retained: Image<bool>,
}

impl Tracked {
    /// Of a frame that stands alone.
    pub fn unknown(size: [u32; 2]) -> Self {
        let past = Image::filled(size, NO_PAST);
        Self { fetched: past.clone(), past, retained: Image::filled(size, false) }
    }
}

/// Follows surface points from frame to frame.
#[derive(Clone, Debug, Default)]
pub struct Tracker {
    previous: Option<(Image<bool>, Option<Image<f32>>)>,
}

impl Tracker {
    /// Takes the next frame, seen with the given eccentricities (degrees) and levels of detail.
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

/// For each pixel that of its surface, and the fetched one.
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

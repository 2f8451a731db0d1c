//! Full-rate reference frames, preprocessed once for all methods.

use super::Tracked;
use super::ghost::{Ghost, Ghosts};
use afterimage::Image;
use afterimage_metric::flip::{Filtered, Flip};
use afterimage_metric::strip::{self, Plane, strips};
use afterimage_metric::{ReferenceFrame, ReferenceVideo, Viewing};
use pulp::{Arch, Simd, WithSimd};
use rayon::prelude::*;
use std::ops::Range;

/// Preprocesses the reference frames of a clip in order.
#[derive(Clone, Debug, Default)]
pub struct References {
    flip: Option<Flip>,
    video: Option<ReferenceVideo>,
    ghosts: Ghosts,
}

/// A preprocessed full-rate frame.
#[derive(Clone, Debug)]
pub struct Reference<'a> {
    pub(super) encoded: &'a Image<[f32; 3]>,
    pub(super) flip: Option<&'a Flip>,
    pub(super) video: Option<ReferenceFrame>,
    pub(super) strips: Vec<Prepared>,
    pub(super) ghosts: Image<Ghost>,
}

/// Data for the metrics from a strip of an sRGB-encoded image.
#[derive(Clone, Debug)]
pub(super) struct Prepared {
    /// L\*a\*b\*.
    pub lab: [Plane; 3],
    pub flip: Option<Filtered>,
}

impl Prepared {
    #[inline(always)]
    pub fn new(encoded: &Image<[f32; 3]>, rows: Range<usize>, flip: Option<&Flip>) -> Self {
        let [width, height] = [encoded.width(), encoded.height()];
        let held = flip.map_or(rows.clone(), |flip| flip.rows_read(rows.clone(), height));
        let linear = strip::linear(encoded, held.clone());
        let own = (rows.start - held.start) * width..(rows.end - held.start) * width;
        #[expect(clippy::manual_map, reason = "closures need not be inlined into vector code")]
        let filtered = match flip {
            Some(flip) => Some(flip.filtered(&linear, width, held, rows)),
            None => None,
        };
        Self { lab: strip::lab(&linear, own), flip: filtered }
    }
}

/// Arguments of [`Prepared::new`].
struct Prepare<'a> {
    encoded: &'a Image<[f32; 3]>,
    rows: Range<usize>,
    flip: Option<&'a Flip>,
}

impl WithSimd for Prepare<'_> {
    type Output = Prepared;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> Prepared {
        Prepared::new(self.encoded, self.rows, self.flip)
    }
}

impl References {
    /// References with FLIP, which is slow.
    pub fn with_flip(flip: Flip) -> Self {
        Self { flip: Some(flip), ..Self::default() }
    }

    /// The references, with JOD too.
    pub fn with_jod(self, viewing: Viewing) -> Self {
        Self { video: Some(ReferenceVideo::new(viewing)), ..self }
    }

    /// Preprocesses the next frame, sRGB-encoded, with its correspondence to the previous one and the eccentricity of
    /// its pixels in degrees.
    pub fn next<'a>(
        &'a mut self,
        encoded: &'a Image<[f32; 3]>,
        tracked: &Tracked,
        ecc_deg: &Image<f32>,
    ) -> Reference<'a> {
        let video = self.video.as_mut().map(|video| video.push_at(encoded, ecc_deg.clone()));
        let flip = self.flip.as_ref();
        let prepared = |rows| Arch::new().dispatch(Prepare { encoded, rows, flip });
        Reference {
            strips: strips(encoded.height()).map(prepared).collect(),
            video,
            ghosts: self.ghosts.advance(encoded, tracked),
            flip,
            encoded,
        }
    }
}

impl Reference<'_> {
    /// The frame itself, sRGB-encoded.
    pub fn encoded(&self) -> &Image<[f32; 3]> {
        self.encoded
    }
}

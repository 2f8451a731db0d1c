//! Full-rate reference frames, preprocessed once for all methods.

use super::flip::{Flip, Preprocessed};
use super::ghost::{Ghost, Ghosts};
use super::{Tracked, lab_map};
use afterimage::Image;
use glam::Vec3;

/// Preprocesses the reference frames of a clip in order.
#[derive(Clone, Debug, Default)]
pub struct References {
    flip: Option<Flip>,
    ghosts: Ghosts,
}

/// A preprocessed full-rate frame.
#[derive(Clone, Debug)]
pub struct Reference<'a> {
    pub(super) encoded: &'a Image<[f32; 3]>,
    pub(super) lab: Image<Vec3>,
    pub(super) flip: Option<(&'a Flip, Preprocessed)>,
    pub(super) ghosts: Image<Ghost>,
}

impl References {
    /// References with FLIP, which is slow.
    pub fn with_flip(flip: Flip) -> Self {
        Self { flip: Some(flip), ..Self::default() }
    }

    /// Preprocesses the next frame, sRGB-encoded, with its correspondence to the previous one.
    pub fn next<'a>(&'a mut self, encoded: &'a Image<[f32; 3]>, tracked: &Tracked) -> Reference<'a> {
        Reference {
            lab: lab_map(encoded),
            ghosts: self.ghosts.advance(encoded, tracked),
            flip: self.flip.as_ref().map(|flip| (flip, flip.preprocess(encoded))),
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

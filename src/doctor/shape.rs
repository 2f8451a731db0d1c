//! Kinds of depth values.

use crate::convention::DepthConvention;

/// Relation of stored values to disparities.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Shape {
    Linear,
    Forward,
    Reversed,
}

impl Shape {
    pub const ALL: [Self; 3] = [Self::Linear, Self::Forward, Self::Reversed];

    pub fn of(convention: DepthConvention) -> Option<Self> {
        match convention {
            DepthConvention::Linear => Some(Self::Linear),
            DepthConvention::Forward { .. } => Some(Self::Forward),
            DepthConvention::Reversed { .. } => Some(Self::Reversed),
            DepthConvention::Orthographic { .. } => None,
        }
    }

    /// Disparity up to a factor, for an infinite far plane.
    pub fn disparity(self, stored: f64) -> f64 {
        match self {
            Self::Linear => 1.0 / stored,
            Self::Forward => 1.0 - stored,
            Self::Reversed => stored,
        }
    }
}

//! Bands of eccentricity.

/// Eccentricity bands of reports.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Band {
    /// Below 2.5 degrees.
    Fovea = 0,
    /// 2.5 to 7.5 degrees.
    Mid = 1,
    /// Beyond 7.5 degrees.
    Periphery = 2,
}

impl Band {
    /// All bands, from the gaze outwards.
    pub const ALL: [Self; 3] = [Self::Fovea, Self::Mid, Self::Periphery];

    /// Band of an eccentricity in degrees.
    #[inline]
    pub fn of(e_deg: f32) -> Self {
        if e_deg < 2.5 {
            Self::Fovea
        } else if e_deg <= 7.5 {
            Self::Mid
        } else {
            Self::Periphery
        }
    }
}

//! What a display shows: luminance of sRGB-encoded colors.

use afterimage::kernel::color;
use glam::Vec3;
use std::f32::consts::PI;

/// Share of the room's light that a screen reflects evenly: that of a matte monitor.
const REFLECTANCE: f32 = 0.005;

/// Photometry of a display.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Display {
    /// Luminance of white in cd/m2.
    pub peak_nits: f32,
    /// Luminance of white over that of black, at least 1.
    pub contrast: f32,
    /// Illuminance of the screen by the room in lux. It adds 0.5 % of it, over pi, to the luminance in cd/m2.
    pub ambient_lux: f32,
}

impl Default for Display {
    /// A desktop monitor in the dark: 250 cd/m2, 1000:1, 0 lux.
    fn default() -> Self {
        Self { peak_nits: 250.0, contrast: 1000.0, ambient_lux: 0.0 }
    }
}

impl Display {
    /// Luminance in cd/m2 of an sRGB-encoded color, with the reflected light of the room. Values outside \[0, 1\] are
    /// clamped; NaN is black.
    #[inline(always)]
    #[expect(clippy::manual_clamp, reason = "`clamp` would keep NaN")]
    pub fn luminance(&self, encoded: [f32; 3]) -> f32 {
        // `max` turns NaN into 0. No `map`: it keeps compilers from vector instructions.
        let linear = |v: f32| color::srgb_decode(v.max(0.0).min(1.0));
        let [r, g, b] = encoded;
        let black = self.peak_nits / self.contrast.max(1.0);
        let reflected = REFLECTANCE / PI * self.ambient_lux;
        reflected + black + (self.peak_nits - black) * color::luma(Vec3::new(linear(r), linear(g), linear(b)))
    }
}

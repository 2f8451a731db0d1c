//! View geometry: from a pixel to the ray through it, and the angle between two such rays.

use crate::error::SettingsError;
#[cfg(feature = "cpu")]
use crate::image::Image;
use crate::kernel::acuity;
use glam::Vec2;

/// A flat view: how pixels map to rays from the eye. Symmetric or off-axis (one eye of a headset).
///
/// Rays have x to the right, y **down** and z forward with length 1, so `ray.x` and `ray.y` are tangents of view angles.
/// They are affine in pixel coordinates: `ray.xy = px * scale + offset`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ViewGeometry {
    size_px: [u32; 2],
    scale: Vec2,
    offset: Vec2,
}

impl ViewGeometry {
    /// A view of `size_px` with the horizontal field of view `hfov_deg`, square pixels and the axis in the middle.
    ///
    /// # Errors
    /// If the field of view is not in (0, 180) degrees.
    pub fn flat(size_px: [u32; 2], hfov_deg: f32) -> Result<Self, SettingsError> {
        if !(hfov_deg > 0.0 && hfov_deg < 180.0) {
            return Err(SettingsError {
                setting: "hfov_deg",
                found: hfov_deg.to_string(),
                expected: "a horizontal field of view above 0 and below 180 degrees".into(),
            });
        }
        let half_width = (hfov_deg.to_radians() * 0.5).tan();
        let half_height = half_width * size_px[1].max(1) as f32 / size_px[0].max(1) as f32;
        Self::off_axis(size_px, [-half_width, half_width], [-half_height, half_height])
    }

    /// A view that spans the given tangents: `tan_x` from the left to the right edge, `tan_y` from the top to the bottom
    /// edge (y down, so the top is usually negative).
    ///
    /// # Errors
    /// If a range is empty, reversed or not finite.
    pub fn off_axis(size_px: [u32; 2], tan_x: [f32; 2], tan_y: [f32; 2]) -> Result<Self, SettingsError> {
        let span = |name, t: [f32; 2]| {
            if t[0].is_finite() && t[1].is_finite() && t[0] < t[1] {
                Ok(t[1] - t[0])
            } else {
                Err(SettingsError {
                    setting: name,
                    found: format!("{} to {}", t[0], t[1]),
                    expected: "finite tangents, the first below the second".into(),
                })
            }
        };
        let size = Vec2::new(size_px[0].max(1) as f32, size_px[1].max(1) as f32);
        let scale = Vec2::new(span("tan_x", tan_x)?, span("tan_y", tan_y)?) / size;
        let offset = Vec2::new(tan_x[0], tan_y[0]) + 0.5 * scale;
        Ok(Self { size_px, scale, offset })
    }

    /// Width and height in pixels.
    pub fn size_px(&self) -> [u32; 2] {
        self.size_px
    }

    /// The ray through `px`, with z = 1; pixel centres are integers.
    #[inline]
    pub fn ray(&self, px: [f32; 2]) -> [f32; 3] {
        (Vec2::from(px) * self.scale + self.offset).extend(1.0).to_array()
    }

    /// The pixel where a direction (x right, y down, z forward) meets the view plane. `None` unless z > 0.
    pub fn project(&self, direction: [f32; 3]) -> Option<[f32; 2]> {
        let [x, y, z] = direction;
        (z > 0.0).then(|| {
            let tangent = Vec2::new(x, y) / z;
            ((tangent - self.offset) / self.scale).to_array()
        })
    }

    /// Slope of the rays in x and y per pixel, and the ray through pixel (0, 0).
    pub fn scale_offset(&self) -> ([f32; 2], [f32; 2]) {
        (self.scale.to_array(), self.offset.to_array())
    }

    /// Horizontal field of view in degrees.
    pub fn hfov_deg(&self) -> f32 {
        let left = self.offset.x - 0.5 * self.scale.x;
        let right = left + self.scale.x * self.size_px[0] as f32;
        (right.atan() - left.atan()).to_degrees()
    }

    /// True visual angle in degrees between the rays through two pixels.
    pub fn eccentricity_deg(&self, px: [f32; 2], gaze_px: [f32; 2]) -> f32 {
        acuity::eccentricity_deg(self.ray(px).into(), self.ray(gaze_px).into())
    }

    #[cfg(feature = "cpu")]
    /// Eccentricity of every pixel in degrees for a gaze position in pixels.
    pub fn eccentricity_map(&self, gaze_px: [f32; 2]) -> Image<f32> {
        Image::from_fn_parallel(self.size_px, |[x, y]| self.eccentricity_deg([x as f32, y as f32], gaze_px))
    }
}

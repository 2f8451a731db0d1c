//! View geometry: rays through pixels, and angles between them.

use crate::camera::Projection;
use crate::error::SettingsError;
#[cfg(feature = "cpu")]
use crate::image::Image;
use crate::kernel::lens;
use glam::{Vec2, Vec3, Vec4};
use std::f32::consts::FRAC_PI_2;

/// Geometry of a view: the map from pixels to rays of a perspective camera, symmetric or off-axis (one eye of a
/// headset).
///
/// View space has x to the right, y **down** and z forward. Rays have z = 1, so that their x and y are tangents of view
/// angles, affine in pixel coordinates. Pixel centres have integer coordinates.
///
/// ```
/// use afterimage::ViewGeometry;
///
/// // A window with a horizontal field of view of 70 degrees.
/// let window = ViewGeometry::flat([1920, 1080], 70.0)?;
/// let middle = [959.5, 539.5];
/// assert!((window.eccentricity_deg([1919.5, 539.5], middle) - 35.0).abs() < 0.01);
///
/// // The left eye of a headset sees more to its left; where does it see a point 0.6 m ahead, 32 mm to its right?
/// let left_eye = ViewGeometry::off_axis([1440, 1600], [-1.2, 0.9], [-1.1, 1.1])?;
/// let px = left_eye.project([0.032, 0.0, 0.6]).expect("in front of the eye");
/// assert!(px[0] > 720.0);
/// # Ok::<(), afterimage::SettingsError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ViewGeometry {
    size_px: [u32; 2],
    scale: Vec2,
    offset: Vec2,
    is_oblique: bool,
}

impl ViewGeometry {
    /// A symmetric view of `size_px` with a horizontal field of view of `hfov_deg` degrees and square pixels.
    ///
    /// # Errors
    /// [`SettingsError`] unless the field of view is above 0 and below 180 degrees.
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

    /// The view at half the width and height, rounded up, whose pixel (x, y) shows the point that pixel (2x, 2y) +
    /// `place_px` of this view shows: for planned frames with one pixel of each quad, as after a cut. Its jitter is
    /// half of the frame's.
    ///
    /// ```
    /// use afterimage::ViewGeometry;
    ///
    /// let view = ViewGeometry::flat([64, 36], 70.0)?;
    /// let half = view.half([1, 0]);
    /// assert_eq!(half.size_px(), [32, 18]);
    /// let [small, full] = [half.ray([3.0, 2.0]), view.ray([7.0, 4.0])];
    /// assert!((small[0] - full[0]).abs() < 1e-6 && (small[1] - full[1]).abs() < 1e-6);
    /// # Ok::<(), afterimage::SettingsError>(())
    /// ```
    pub fn half(&self, place_px: [u32; 2]) -> Self {
        let offset = self.offset + Vec2::from(place_px.map(|v| v as f32)) * self.scale;
        Self { size_px: self.size_px.map(|side| side.div_ceil(2)), scale: 2.0 * self.scale, offset, ..*self }
    }

    /// A view of `size_px` from the tangents of the angles at its edges: `tan_x` left and right, `tan_y` top and
    /// bottom. y is down, so that the top is usually negative.
    ///
    /// # Errors
    /// [`SettingsError`] if a range is empty, reversed or not finite.
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
        Ok(Self { size_px, scale, offset, is_oblique: false })
    }

    /// A view of `size_px` from the angles at its edges in radians, as OpenXR gives an eye's field of view (`XrFovf`):
    /// left, right, up, down, measured from straight ahead; right and up are positive, so that the first and the last
    /// are usually negative.
    ///
    /// ```
    /// use afterimage::ViewGeometry;
    ///
    /// // The left eye of a headset: 50 degrees to the left, 43 to the right, 46 up, 48 down.
    /// let left_eye = ViewGeometry::from_angles([1440, 1600], [-50.0_f32, 43.0, 46.0, -48.0].map(f32::to_radians))?;
    /// assert!((left_eye.hfov_deg() - 93.0).abs() < 0.01);
    /// # Ok::<(), afterimage::SettingsError>(())
    /// ```
    ///
    /// # Errors
    /// [`SettingsError`] unless the angles lie within 90 degrees of straight ahead, left below right, down below up.
    pub fn from_angles(size_px: [u32; 2], angles_rad: [f32; 4]) -> Result<Self, SettingsError> {
        let [left, right, up, down] = angles_rad;
        if !(angles_rad.iter().all(|angle| angle.abs() < FRAC_PI_2) && left < right && down < up) {
            return Err(SettingsError {
                setting: "angles_rad",
                found: format!("left {left}, right {right}, up {up}, down {down}"),
                expected: "angles within 90 degrees of straight ahead, left below right, down below up".into(),
            });
        }
        Self::off_axis(size_px, [left.tan(), right.tan()], [-up.tan(), -down.tan()])
    }

    /// A view of `size_px` from an engine's projection matrix, without jitter: right-handed with y up and -z forward,
    /// stored by columns (`to_cols_array_2d` of glam). It may be symmetric or off-axis. The row of depth does not
    /// matter: 0 to 1 or -1 to 1, reversed, infinite, or with the oblique near plane of a mirror or a portal. The depth
    /// buffer of an oblique projection is refused later, because its values depend on x and y, too: give distances
    /// ([`DepthConvention::Linear`](crate::DepthConvention::Linear)) instead. What rounding leaves of a product with a
    /// view and its inverse is accepted.
    ///
    /// ```
    /// use afterimage::ViewGeometry;
    ///
    /// // Bevy's kind: infinite, reversed, near plane at 0.1; 90 degrees high.
    /// let clip_from_view = [[0.5625, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 0.0, -1.0], [0.0, 0.0, 0.1, 0.0]];
    /// let view = ViewGeometry::from_projection([1920, 1080], clip_from_view)?;
    /// assert!((view.hfov_deg() - 121.3).abs() < 0.1);
    /// # Ok::<(), afterimage::SettingsError>(())
    /// ```
    ///
    /// # Errors
    /// [`SettingsError`] if the matrix is no perspective camera's: orthographic, left-handed, y down or
    /// mirrored (negate the row or column that is flipped), rotated, not finite.
    pub fn from_projection(size_px: [u32; 2], clip_from_view: [[f32; 4]; 4]) -> Result<Self, SettingsError> {
        let Projection { scale, shift, is_oblique } = Projection::of(clip_from_view)?;
        // A ray (t, u, -1) has the clip coordinates (scale.x t - shift.x, scale.y u - shift.y), w = 1; both y are up.
        let tangent = |i: usize, clip: f64| ((clip + shift[i]) / scale[i]) as f32;
        let view = Self::off_axis(size_px, [tangent(0, -1.0), tangent(0, 1.0)], [-tangent(1, 1.0), -tangent(1, -1.0)])?;
        Ok(Self { is_oblique, ..view })
    }

    /// Whether depth values of the projection depend on x and y, too.
    pub(crate) fn is_oblique(&self) -> bool {
        self.is_oblique
    }

    /// Width and height in pixels.
    pub fn size_px(&self) -> [u32; 2] {
        self.size_px
    }

    /// Ray through the position `px` in pixels, with z = 1.
    #[inline]
    pub fn ray(&self, px: [f32; 2]) -> [f32; 3] {
        (Vec2::from(px) * self.scale + self.offset).extend(1.0).to_array()
    }

    /// Octagon around the area that a headset's lens shows, for
    /// [`ViewFrame::visible_px`](crate::levels::ViewFrame::visible_px). `outline`: points whose convex hull is the
    /// visible area, such as the vertices of OpenXR's visibility mask: x and y in the plane one unit ahead, y up. One
    /// pixel is added on every side. `None` without points, or if a point is not finite.
    ///
    /// ```
    /// use afterimage::ViewGeometry;
    ///
    /// let eye = ViewGeometry::from_angles([1440, 1600], [-0.88, 0.73, 0.85, -0.85])?;
    /// // A lens that shows a diamond.
    /// let [lowest, highest] = eye.visible_px([[-1.2, 0.0], [0.9, 0.0], [0.0, 1.1], [0.0, -1.1]]).expect("finite points");
    /// assert!(lowest[0] < highest[0] && lowest[2] > lowest[0] + lowest[1]);
    /// # Ok::<(), afterimage::SettingsError>(())
    /// ```
    pub fn visible_px(&self, outline: impl IntoIterator<Item = [f32; 2]>) -> Option<[[f32; 4]; 2]> {
        let mut bounds: Option<[Vec4; 2]> = None;
        for [x, y] in outline {
            let px = (Vec2::new(x, -y) - self.offset) / self.scale;
            let along = Vec4::new(px.x, px.y, px.x + px.y, px.x - px.y);
            if !along.is_finite() {
                return None;
            }
            bounds = Some(bounds.map_or([along; 2], |[lowest, highest]| [lowest.min(along), highest.max(along)]));
        }
        // Along a diagonal, a pixel's corner is twice as far from its centre as along an axis.
        let margin = Vec4::new(1.0, 1.0, 2.0, 2.0);
        bounds.map(|[lowest, highest]| [(lowest - margin).to_array(), (highest + margin).to_array()])
    }

    /// Position in pixels of a point or direction in view space (x right, y down, z forward). May lie outside the view.
    /// `None` unless z > 0.
    pub fn project(&self, direction: [f32; 3]) -> Option<[f32; 2]> {
        let [x, y, z] = direction;
        (z > 0.0).then(|| {
            let tangent = Vec2::new(x, y) / z;
            ((tangent - self.offset) / self.scale).to_array()
        })
    }

    /// Scale and offset of rays: `ray.xy = px * scale + offset`.
    pub fn scale_offset(&self) -> ([f32; 2], [f32; 2]) {
        (self.scale.to_array(), self.offset.to_array())
    }

    /// Horizontal field of view in degrees.
    pub fn hfov_deg(&self) -> f32 {
        let left = self.offset.x - 0.5 * self.scale.x;
        let right = left + self.scale.x * self.size_px[0] as f32;
        (right.atan() - left.atan()).to_degrees()
    }

    /// Eccentricity: true visual angle in degrees between the rays through `px` and `gaze_px`.
    pub fn eccentricity_deg(&self, px: [f32; 2], gaze_px: [f32; 2]) -> f32 {
        lens::eccentricity_deg(self.ray(px).into(), self.ray(gaze_px).into())
    }

    /// Smallest rectangle that contains all pixels within `radius_deg` of the gaze: first pixel, and pixel after the
    /// last. It is clamped to the view, and empty if it lies outside the view. For renderers that draw regions as views
    /// of their own.
    pub fn around_px(&self, gaze_px: [f32; 2], radius_deg: f32) -> [[u32; 2]; 2] {
        let gaze = Vec3::from(self.ray(gaze_px)).normalize();
        let edges = [0, 1].map(|axis| {
            // Planes through the other axis that touch the cone around the gaze ray.
            let angle = gaze[axis].atan2(gaze.z);
            let reach = (radius_deg.to_radians().sin() / gaze[axis].hypot(gaze.z)).min(1.0).asin();
            [-1.0, 1.0].map(|side| {
                let tangent = (angle + side * reach).clamp(-1.57, 1.57).tan();
                (tangent - self.offset[axis]) / self.scale[axis]
            })
        });
        let clamped = |px: f32, axis: usize| px.clamp(0.0, self.size_px[axis] as f32) as u32;
        let low = [0, 1].map(|axis| clamped((edges[axis][0] - 0.5).ceil(), axis));
        [low, [0, 1].map(|axis| clamped((edges[axis][1] + 0.5).floor() + 1.0, axis))]
    }

    /// Eccentricity of every pixel in degrees, for a gaze position in pixels. Needs the feature `cpu`.
    #[cfg(feature = "cpu")]
    pub fn eccentricity_map(&self, gaze_px: [f32; 2]) -> Image<f32> {
        Image::from_fn_parallel(self.size_px, |[x, y]| self.eccentricity_deg([x as f32, y as f32], gaze_px))
    }
}

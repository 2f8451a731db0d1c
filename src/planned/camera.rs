//! An engine's camera: a projection, a pose, and where the eye looks.

use crate::camera::Projection;
use crate::convention::DepthConvention;
use crate::error::SettingsError;
use crate::gaze::Gaze;
use crate::geometry::ViewGeometry;
use crate::view::ViewFrame;

/// Camera of a view, without jitter, and where the eye looks in it. Matrices are right-handed with y up and -z forward,
/// stored by columns (`to_cols_array_2d` of glam). Create it with [`new`](Self::new) and `..`:
///
/// ```
/// # let clip_from_view = [[1.0, 0.0, 0.0, 0.0], [0.0, 1.8, 0.0, 0.0], [0.0, 0.0, 0.0, -1.0], [0.0, 0.0, 0.1, 0.0]];
/// # let world_from_view = [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [0.0, 1.6, 0.0, 1.0]];
/// use afterimage::{Camera, Gaze};
///
/// let camera = Camera { gaze: Gaze::Uv { uv: [0.6, 0.5] }, ..Camera::new(clip_from_view, world_from_view) };
/// # let _ = camera;
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// A perspective projection; depth from 0 to 1, reversed or not, the far plane at infinity or not.
    pub clip_from_view: [[f64; 4]; 4],
    /// Pose: a rotation and a translation.
    pub world_from_view: [[f64; 4]; 4],
    /// Where the eye looks, for [`Shading::Gaze`](super::Shading::Gaze). Default [`Gaze::Lost`]: where it last did.
    pub gaze: Gaze,
    /// The part that a headset's lens shows, as in [`ViewFrame::visible_px`]. Pixels outside it are black. `None`, the
    /// default: every pixel is visible.
    pub visible_px: Option<[[f32; 4]; 2]>,
}

impl Camera {
    /// A camera of `f32` or `f64`, without a gaze. A float has steps of 0.06 at 1e6: far from the world's origin give
    /// `f64`.
    pub fn new<T: Copy + Into<f64>>(clip_from_view: [[T; 4]; 4], world_from_view: [[T; 4]; 4]) -> Self {
        let doubles = |columns: [[T; 4]; 4]| columns.map(|column| column.map(Into::into));
        let (clip_from_view, world_from_view) = (doubles(clip_from_view), doubles(world_from_view));
        Self { clip_from_view, world_from_view, gaze: Gaze::Lost, visible_px: None }
    }

    pub(super) fn projection(&self) -> [[f32; 4]; 4] {
        self.clip_from_view.map(|column| column.map(|v| v as f32))
    }

    pub(super) fn geometry(&self, size_px: [u32; 2]) -> Result<ViewGeometry, SettingsError> {
        ViewGeometry::from_projection(size_px, self.projection())
    }

    /// Whether the near plane's depth is 1: depth falls with distance.
    pub(super) fn is_reversed(&self) -> bool {
        // Depth at a distance d is b / d - a, of the matrix' row of depth.
        self.clip_from_view[3][2] / -self.clip_from_view[2][3] > 0.0
    }

    /// Convention of the depth buffer that the projection draws.
    pub(super) fn depth_convention(&self) -> Result<DepthConvention, SettingsError> {
        let Projection { is_oblique, .. } = Projection::of(self.clip_from_view)?;
        let w = -self.clip_from_view[2][3];
        let (a, b) = (self.clip_from_view[2][2] / w, self.clip_from_view[3][2] / w);
        // 0 and 1 of `b / d - a`.
        let (zero, one) = (b / a, b / (1.0 + a));
        let plane =
            |distance: f64| if distance.is_finite() && distance < 1e30 { distance as f32 } else { f32::INFINITY };
        let convention = match self.is_reversed() {
            true => DepthConvention::Reversed { near: one as f32, far: plane(zero) },
            false => DepthConvention::Forward { near: zero as f32, far: plane(one) },
        };
        if is_oblique || convention.validate().is_err() {
            return Err(SettingsError {
                setting: "clip_from_view",
                found: format!("{:?}", self.clip_from_view),
                expected:
                    "depth from 0 to 1 between two planes ahead, reversed or not; for an oblique near plane give \
                           distances (Desc::has_distances)"
                        .into(),
            });
        }
        Ok(convention)
    }

    /// `view`, with the motion from another camera to this one.
    pub(super) fn moved_from(&self, previous: &Self, view: ViewFrame) -> Result<ViewFrame, SettingsError> {
        view.posed(self.world_from_view, previous.world_from_view)
    }
}

/// A projection whose image is moved by `px` pixels; y down.
pub(super) fn shifted(mut clip_from_view: [[f32; 4]; 4], px: [f32; 2], size_px: [u32; 2]) -> [[f32; 4]; 4] {
    let w = clip_from_view[2][3];
    clip_from_view[2][0] += w * 2.0 * px[0] / size_px[0] as f32;
    clip_from_view[2][1] -= w * 2.0 * px[1] / size_px[1] as f32;
    clip_from_view
}

/// The projection of the view at half the width and height, rounded up, whose pixel (x, y) is the pixel (2x, 2y) +
/// `place_px` of a view of `size_px` with a jitter.
pub(super) fn halved(
    mut clip_from_view: [[f32; 4]; 4],
    jitter_px: [f32; 2],
    size_px: [u32; 2],
    place_px: [f32; 2],
) -> [[f32; 4]; 4] {
    let w = clip_from_view[2][3];
    for (i, up) in [(0, 1.0), (1, -1.0)] {
        // Position p of the full view has the clip coordinate 2 (p + 1/2) / full - 1, and is at (p + jitter - place) /
        // 2 in the small one.
        let (full, half) = (size_px[i] as f32, size_px[i].div_ceil(2) as f32);
        let scale = full / (2.0 * half);
        let shift = scale - 1.0 + (0.5 + jitter_px[i] - place_px[i]) / half;
        clip_from_view.iter_mut().for_each(|column| column[i] *= scale);
        clip_from_view[2][i] += w * up * shift;
    }
    clip_from_view
}

#[cfg(test)]
mod tests {
    use super::*;

    const OFF_AXIS: [[f32; 4]; 4] =
        [[0.9, 0.0, 0.0, 0.0], [0.0, 1.6, 0.0, 0.0], [0.1, -0.05, 0.0, -1.0], [0.0, 0.0, 0.1, 0.0]];

    /// The position at which a projection draws a point, in a view of a size.
    fn drawn(clip_from_view: [[f32; 4]; 4], size_px: [u32; 2], point: [f32; 3]) -> [f32; 2] {
        // View space of a geometry has y down and z forward.
        let [x, y, z] = point;
        ViewGeometry::from_projection(size_px, clip_from_view).unwrap().project([x, -y, -z]).unwrap()
    }

    #[test]
    fn jitter_moves_what_is_drawn_and_a_quarter_has_every_second_pixel() {
        let (size, jitter, point) = ([97, 64], [0.3, -0.2], [0.4, 0.7, -2.0]);
        let plain = drawn(OFF_AXIS, size, point);
        let moved = drawn(shifted(OFF_AXIS, jitter, size), size, point);
        let small = drawn(halved(OFF_AXIS, jitter, size, [1.0, 0.0]), [49, 32], point);
        for i in 0..2 {
            let place = [1.0, 0.0][i];
            assert!((moved[i] - plain[i] - jitter[i]).abs() < 1e-3, "{moved:?} from {plain:?}");
            assert!((2.0 * small[i] + place - moved[i]).abs() < 1e-3, "{small:?} for {moved:?}");
        }
    }

    #[test]
    fn planes_follow_from_the_projection() {
        let of = |a: f32, b: f32| {
            let matrix = [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, a, -1.0], [0.0, 0.0, b, 0.0]];
            let camera = Camera::new(matrix, matrix);
            (camera.depth_convention(), camera.is_reversed())
        };
        let (near, far) = (0.5_f32, 20.0_f32);
        let (convention, is_reversed) = of(-far / (far - near), -near * far / (far - near));
        assert!(!is_reversed);
        let Ok(DepthConvention::Forward { near: n, far: f }) = convention else { panic!("{convention:?}") };
        assert!((n - near).abs() < 1e-5 && (f - far).abs() < 1e-3, "{n} to {f}");
        let (convention, is_reversed) = of(near / (far - near), near * far / (far - near));
        assert!(is_reversed);
        let Ok(DepthConvention::Reversed { near: n, far: f }) = convention else { panic!("{convention:?}") };
        assert!((n - near).abs() < 1e-5 && (f - far).abs() < 1e-3, "{n} to {f}");
        assert_eq!(of(0.0, 0.1).0, Ok(DepthConvention::Reversed { near: 0.1, far: f32::INFINITY }));
        assert_eq!(of(-1.0, -0.1).0, Ok(DepthConvention::Forward { near: 0.1, far: f32::INFINITY }));
        assert!(of(0.0, 0.0).0.is_err());
    }
}

//! Description of a view of a frame.

use crate::camera::{ORTHOGRAPHIC_TURN, camera_motion, pose_motion};
use crate::context::ContextDesc;
use crate::convention::DepthConvention;
use crate::error::{FrameError, FrameValue, SettingsError};
use crate::gaze::Gaze;
use crate::geometry::ViewGeometry;
use std::fmt::Debug;

/// Largest accepted jitter of a projection along an axis, in pixels.
const MAX_JITTER_PX: f32 = 16.0;

/// Description of a view in a frame: geometry, gaze and camera motion of a screen or of one eye of a headset.
///
/// Create it with [`new`](Self::new) and `..`, so that later versions can add fields:
///
/// ```
/// # use afterimage::levels::ViewFrame;
/// # use afterimage::{Gaze, ViewGeometry};
/// # let camera_motion = [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.02], [0.0, 0.0, 0.0, 1.0]];
/// let geometry = ViewGeometry::flat([1920, 1080], 70.0)?;
/// let gaze = Gaze::At { px: [1200.0, 500.0] };
/// let view = ViewFrame { previous_from_current: Some(camera_motion), ..ViewFrame::new(geometry, gaze) };
/// # Ok::<(), afterimage::SettingsError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ViewFrame {
    /// Rays through the pixels.
    pub geometry: ViewGeometry,
    /// Gaze position.
    pub gaze: Gaze,
    /// Camera motion: the matrix that transforms a point from this frame's view space (x right, y down, z forward) to
    /// the previous frame's. Row-major, for column vectors. Lengths have the unit of depth. `None`: the depth test
    /// expects unchanged distances, so that history is rejected on surfaces that the camera approaches or leaves fast.
    /// [`moved`](Self::moved) and [`posed`](Self::posed) compute it from an engine's matrices.
    ///
    /// With [`DepthConvention::Orthographic`] only the motion along the view axis counts, and a camera that turns away
    /// is refused. If vectors lack the camera's motion
    /// ([`MotionConvention::without_camera`](crate::MotionConvention::without_camera),
    /// [`no_vector`](crate::MotionConvention::no_vector)), it is required, except in frames with
    /// [`Reset::All`](crate::levels::Reset::All).
    pub previous_from_current: Option<[[f32; 4]; 4]>,
    /// Jitter of the projection in pixels, for renderers that jitter it for antialiasing: a point that the projection
    /// without jitter puts at `p` is drawn at `p + jitter_px`; y down. (0, 0) without jitter.
    ///
    /// The jitter is removed from motion vectors that contain it
    /// ([`MotionConvention::jittered`](crate::MotionConvention::jittered)) and from the rays through the pixels, so
    /// that history stays in place while the camera is still. [`geometry`](Self::geometry) describes the projection
    /// without jitter. Temporal antialiasing runs after the post-process, with the same jitter.
    pub jitter_px: [f32; 2],
    /// Convention of this view's depth values in this frame. `None`: the context's. History
    /// stays valid when the near plane changes, because distances are stored.
    pub depth: Option<DepthConvention>,
    /// The part of the view that a headset's lens shows: an octagon, given by the lowest and the highest x, y, x + y
    /// and x - y of its pixels ([`ViewGeometry::visible_px`] computes it from a visibility mask). Planned
    /// frames are not processed outside it, and are black there; frames with levels of detail are processed at every
    /// pixel. `None`: every pixel is visible.
    pub visible_px: Option<[[f32; 4]; 2]>,
}

impl ViewFrame {
    /// A view with unknown camera motion and without jitter.
    pub fn new(geometry: ViewGeometry, gaze: Gaze) -> Self {
        Self { geometry, gaze, previous_from_current: None, jitter_px: [0.0; 2], depth: None, visible_px: None }
    }

    /// This view with the camera motion between two frames, from an engine's matrices: the projection
    /// `clip_from_view`, and projection times view (`clip_from_world`) of this frame and of the previous one, without
    /// jitter.
    ///
    /// The matrices are right-handed with y up and -z forward, stored by columns (`to_cols_array_2d` of glam), for any
    /// depth range, reversed and infinite ones, and oblique near planes, too. The previous frame may have another field
    /// of view. A mirror's view may mirror, in both frames. See [`ViewGeometry::from_projection`].
    ///
    /// `T` is `f32` or `f64`. A float has steps of 0.06 at 1e6, so that the motion of a frame is lost there: far from
    /// the world's origin give `f64`, or matrices whose world begins at a point near the camera, the same point for
    /// both.
    ///
    /// ```
    /// # use afterimage::levels::ViewFrame;
    /// # use afterimage::{Gaze, ViewGeometry};
    /// # let clip_from_view = [[1.0, 0.0, 0.0, 0.0], [0.0, 1.8, 0.0, 0.0], [0.0, 0.0, 0.0, -1.0], [0.0, 0.0, 0.1, 0.0]];
    /// # let (clip_from_world, previous_clip_from_world) = (clip_from_view, clip_from_view);
    /// let geometry = ViewGeometry::from_projection([1920, 1080], clip_from_view)?;
    /// let view = ViewFrame::new(geometry, Gaze::Uv { uv: [0.6, 0.5] })
    ///     .moved(clip_from_view, clip_from_world, previous_clip_from_world)?;
    /// # Ok::<(), afterimage::SettingsError>(())
    /// ```
    ///
    /// # Errors
    /// [`SettingsError`] if a matrix is no perspective camera's or is not finite, or if only one view mirrors.
    pub fn moved<T: Copy + Into<f64> + Debug + PartialEq>(
        self,
        clip_from_view: [[T; 4]; 4],
        clip_from_world: [[T; 4]; 4],
        previous_clip_from_world: [[T; 4]; 4],
    ) -> Result<Self, SettingsError> {
        let matrix = camera_motion(clip_from_view, clip_from_world, previous_clip_from_world)?;
        Ok(Self { previous_from_current: Some(matrix), ..self })
    }

    /// This view with the camera motion between two poses: the transforms `world_from_view` of this frame and of the
    /// previous one, each a rotation and a translation by columns; y up, -z forward, as in OpenXR. "Previous" is the
    /// last frame that was recorded, not the last one that was displayed.
    ///
    /// `T` is `f32` or `f64`. A float has steps of 0.06 at 1e6, so that the motion of a frame is lost there: far from
    /// the world's origin give `f64`, or poses relative to a point near the camera, the same point for both.
    ///
    /// ```
    /// # use afterimage::levels::ViewFrame;
    /// # use afterimage::{Gaze, ViewGeometry};
    /// # let at = |z| [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [0.0, 1.6, z, 1.0]];
    /// # let (pose, previous) = (at(0.0), at(0.1));
    /// let geometry = ViewGeometry::from_angles([1440, 1600], [-0.87, 0.75, 0.80, -0.84])?;
    /// let view = ViewFrame::new(geometry, Gaze::Lost).posed(pose, previous)?;
    /// // What is 2 m ahead was 2.1 m ahead: the head moved 0.1 m forward.
    /// assert!((view.previous_from_current.unwrap()[2][3] - 0.1).abs() < 1e-6);
    /// # Ok::<(), afterimage::SettingsError>(())
    /// ```
    ///
    /// # Errors
    /// [`SettingsError`] if a matrix is not a rotation and a translation of finite numbers, or mirrors.
    pub fn posed<T: Copy + Into<f64> + Debug + PartialEq>(
        self,
        world_from_view: [[T; 4]; 4],
        previous_world_from_view: [[T; 4]; 4],
    ) -> Result<Self, SettingsError> {
        let matrix = pose_motion(world_from_view, previous_world_from_view)?;
        Ok(Self { previous_from_current: Some(matrix), ..self })
    }

    /// This view with the jitter of a projection: that of [`geometry`](Self::geometry), moved by a part of a pixel, as
    /// the frame was drawn with. The matrix is as in [`ViewGeometry::from_projection`]. Jitter is exact to 1e-3 pixels.
    ///
    /// ```
    /// # use afterimage::levels::ViewFrame;
    /// # use afterimage::{Gaze, ViewGeometry};
    /// # let clip_from_view = [[1.0, 0.0, 0.0, 0.0], [0.0, 1.8, 0.0, 0.0], [0.0, 0.0, 0.0, -1.0], [0.0, 0.0, 0.1, 0.0]];
    /// let geometry = ViewGeometry::from_projection([1920, 1080], clip_from_view)?;
    /// // FSR2's recipe: a translation of clip space by (2 x / width, -2 y / height), here by (0.25, -0.375) pixels.
    /// let mut jittered = clip_from_view;
    /// jittered[2][0] -= 2.0 * 0.25 / 1920.0;
    /// jittered[2][1] -= -2.0 * -0.375 / 1080.0;
    /// let [x, y] = ViewFrame::new(geometry, Gaze::Lost).jittered(jittered)?.jitter_px;
    /// assert!((x - 0.25).abs() < 1e-3 && (y + 0.375).abs() < 1e-3);
    /// # Ok::<(), afterimage::SettingsError>(())
    /// ```
    ///
    /// # Errors
    /// [`SettingsError`] if the matrix is no perspective camera's, has another field of view, or is moved by
    /// more than 16 pixels.
    pub fn jittered(self, jittered_clip_from_view: [[f32; 4]; 4]) -> Result<Self, SettingsError> {
        let jittered = ViewGeometry::from_projection(self.geometry.size_px(), jittered_clip_from_view)?;
        let ((scale, plain), (other_scale, drawn)) = (self.geometry.scale_offset(), jittered.scale_offset());
        let is_same = [0, 1].iter().all(|&i| (other_scale[i] / scale[i] - 1.0).abs() < 1e-3);
        let jitter_px = [0, 1].map(|i| (plain[i] - drawn[i]) / scale[i]);
        if !is_same || jitter_px.iter().any(|px| px.abs() > MAX_JITTER_PX) {
            return Err(SettingsError {
                setting: "jittered_clip_from_view",
                found: format!("{jittered_clip_from_view:?}"),
                expected: format!("the projection of the geometry, moved by at most {MAX_JITTER_PX} pixels"),
            });
        }
        Ok(Self { jitter_px, ..self })
    }

    /// Third row of [`previous_from_current`](Self::previous_from_current), which gives the previous distance.
    pub(crate) fn depth_row(&self) -> [f32; 4] {
        self.previous_from_current.map_or([0.0, 0.0, 1.0, 0.0], |m| m[2])
    }

    /// Convention of depth values.
    pub(crate) fn depth_convention(&self, desc: &ContextDesc) -> DepthConvention {
        self.depth.unwrap_or(desc.depth)
    }

    /// Checks all fields against the context's description.
    pub(crate) fn check(&self, view: usize, desc: &ContextDesc) -> Result<(), FrameError> {
        let found = self.geometry.size_px();
        if found != desc.size_px {
            return Err(FrameError::Size { input: "geometry", view, found, expected: desc.size_px });
        }
        let refuse = |value, found, expected| Err(FrameError::Value { value, view, found, expected });
        if let Some(Err(error)) = self.depth.map(DepthConvention::validate) {
            let expected = "planes in the ranges that DepthConvention documents, or None for the context's convention";
            return refuse(FrameValue::DepthConvention, error.found, expected);
        }
        let [x, y] = self.jitter_px;
        if !(x.abs() <= MAX_JITTER_PX && y.abs() <= MAX_JITTER_PX) {
            return refuse(
                FrameValue::Jitter,
                format!("({x}, {y})"),
                "finite offsets of at most 16 pixels, usually below 1",
            );
        }
        if let Some([lowest, highest]) = self.visible_px
            && !(0..4).all(|i| lowest[i].is_finite() && highest[i].is_finite() && lowest[i] <= highest[i])
        {
            let expected = "finite bounds, the lowest first, or None if every pixel is seen";
            return refuse(FrameValue::VisibleBounds, format!("{lowest:?} to {highest:?}"), expected);
        }
        let Some(matrix) = self.previous_from_current else {
            return Ok(());
        };
        if let Some(v) = matrix.iter().flatten().find(|v| !v.is_finite()) {
            let expected = "finite numbers, or None if the camera's motion is not known";
            return refuse(FrameValue::CameraMotion, format!("a matrix that holds {v}"), expected);
        }
        let [x, y, z, _] = matrix[2];
        let turns = [x, y, z - 1.0].iter().any(|v| v.abs() > ORTHOGRAPHIC_TURN);
        if turns && matches!(self.depth_convention(desc), DepthConvention::Orthographic { .. }) {
            let expected = "a third row (0, 0, 1, shift) with orthographic depth: where a pixel lies across the view is \
                            not known in the unit of depth; or None";
            return refuse(FrameValue::CameraMotion, "that of a camera that turns away".into(), expected);
        }
        Ok(())
    }

    /// Checks what the context's motion convention and a depth input ask of a view. `is_cut`: whether no history is
    /// read.
    pub(crate) fn check_motion(
        &self,
        view: usize,
        desc: &ContextDesc,
        has_depth: bool,
        is_cut: bool,
    ) -> Result<(), FrameError> {
        let convention = self.depth_convention(desc);
        let refuse = |value, found, expected| Err(FrameError::Value { value, view, found, expected });
        let is_buffer = matches!(convention, DepthConvention::Forward { .. } | DepthConvention::Reversed { .. });
        if has_depth && is_buffer && self.geometry.is_oblique() {
            let expected = "Linear: a depth buffer holds other values beyond an oblique near plane; give distances, or \
                            no depth";
            return refuse(FrameValue::DepthConvention, format!("{convention:?}"), expected);
        }
        if !desc.motion.lacks_camera() || is_cut {
            return Ok(());
        }
        if !has_depth {
            let expected = "given: the camera's motion is added to vectors (Desc::motion), for which \
                            distances must be known";
            return refuse(FrameValue::Depth, "None".into(), expected);
        }
        if matches!(convention, DepthConvention::Orthographic { .. }) {
            let expected = "that of a perspective view, or complete vectors: the camera's motion is added to \
                            vectors (Desc::motion), and rays of an orthographic view are not known";
            return refuse(FrameValue::DepthConvention, format!("{convention:?}"), expected);
        }
        if self.previous_from_current.is_none() {
            let expected = "given, as by ViewFrame::moved or posed, because the camera's motion is added to vectors \
                            (Desc::motion); or Reset::All";
            return refuse(FrameValue::CameraMotion, "None".into(), expected);
        }
        Ok(())
    }
}

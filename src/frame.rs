//! Descriptions of a context, of a frame and of its views, for both executors.

use crate::camera::{ORTHOGRAPHIC_TURN, camera_motion, checked_pose, pose_motion};
use crate::convention::{DepthConvention, MotionConvention};
use crate::error::{FrameError, FrameValue, SettingsError, expected_size};
use crate::foveation::Filter;
use crate::geometry::ViewGeometry;
use crate::lattice::Lattices;
use crate::settings::Settings;
use glam::DVec3;
use std::fmt::Debug;

/// Largest accepted jitter of a projection along an axis, in pixels.
const MAX_JITTER_PX: f32 = 16.0;

/// Gaze: where the eye looks in a view. Default: [`Lost`](Self::Lost). Example: [`ViewFrame`].
///
/// A gaze that is not finite counts as lost.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub enum Gaze {
    /// Position in pixels, which may lie outside the view.
    At {
        /// (0, 0) is the centre of the top-left pixel, y down.
        px: [f32; 2],
    },
    /// Position in texture coordinates, which may lie outside the view.
    Uv {
        /// (0, 0) is the top-left corner of the view, (1, 1) its bottom-right corner.
        uv: [f32; 2],
    },
    /// Direction from the eye, as eye trackers deliver it. Counts as lost if it points backwards.
    Direction {
        /// Direction in view space, of any length: x right, y down, z forward. For view spaces with y up and z backward
        /// (OpenXR, glTF, Bevy) negate y and z.
        view: [f32; 3],
    },
    /// Unknown in this frame (blink, lost tracking): the last known position is used; before the first one, the middle
    /// of the view.
    #[default]
    Lost,
}

impl Gaze {
    /// This gaze if the eye tracker's `confidence`, 0 to 1, is at least `least`, otherwise [`Lost`](Self::Lost).
    /// Trackers report low confidence in blinks, when positions jump by many degrees; 0.5 suits most.
    ///
    /// ```
    /// use afterimage::Gaze;
    ///
    /// let gaze = Gaze::Uv { uv: [0.4, 0.6] };
    /// assert_eq!(gaze.if_confident(0.9, 0.5), gaze);
    /// assert_eq!(gaze.if_confident(0.1, 0.5), Gaze::Lost);
    /// ```
    pub fn if_confident(self, confidence: f32, least: f32) -> Self {
        // A NaN fails the comparison and counts as no confidence.
        if confidence >= least { self } else { Self::Lost }
    }

    /// The gaze of one eye, or of one view, from a ray in world space. A headset's eye tracker reports one combined
    /// ray; this gives each of the two views its own gaze. `distance`: how far along the ray the eyes look, in the
    /// units of `origin`. Use the distance of the surface under the gaze, or the distance at which the rays of the two
    /// eyes meet; infinite is allowed. `world_from_view`: pose of the view, a rotation and a translation by columns; y
    /// up, -z forward, as in OpenXR. A ray, a distance or a pose that is not finite or not in that form counts as
    /// [`Lost`](Self::Lost). `T` is `f32` or `f64`: far from the world's origin a float holds no centimetres.
    ///
    /// ```
    /// use afterimage::Gaze;
    ///
    /// // An eye 3 cm to the left of the tracker's origin sees a point 1 m ahead to its right.
    /// let left_eye = [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [-0.03, 0.0, 0.0, 1.0]];
    /// let near = Gaze::on_ray([0.0; 3], [0.0, 0.0, -1.0], 1.0, left_eye);
    /// assert_eq!(near, Gaze::Direction { view: [0.03, 0.0, 1.0] });
    /// let far = Gaze::on_ray([0.0; 3], [0.0, 0.0, -1.0], f32::INFINITY, left_eye);
    /// assert_eq!(far, Gaze::Direction { view: [0.0, 0.0, 1.0] });
    /// ```
    pub fn on_ray<T: Copy + Into<f64> + Debug>(
        origin: [T; 3],
        direction: [T; 3],
        distance: f32,
        world_from_view: [[T; 4]; 4],
    ) -> Self {
        let Ok(pose) = checked_pose("world_from_view", world_from_view) else { return Self::Lost };
        let double = |vector: [T; 3]| DVec3::from(vector.map(Into::into));
        let (origin, direction) = (double(origin), double(direction).normalize_or_zero());
        let view_from_world = pose.inverse();
        let seen = if distance == f32::INFINITY {
            view_from_world.transform_vector3(direction)
        } else {
            view_from_world.transform_point3(origin + f64::from(distance) * direction)
        };
        let is_known = seen.is_finite() && direction != DVec3::ZERO && distance >= 0.0;
        // y is down and z forward here.
        if is_known {
            Self::Direction { view: (seen * DVec3::new(1.0, -1.0, -1.0)).as_vec3().into() }
        } else {
            Self::Lost
        }
    }

    /// Position of the gaze in pixels of a view of `geometry`; `None` if the gaze is lost or not finite. Clamped to
    /// +-1e6 pixels, so that angles stay finite.
    pub(crate) fn known_px(self, geometry: &ViewGeometry) -> Option<[f32; 2]> {
        let px = match self {
            Self::At { px } => Some(px),
            Self::Uv { uv } => {
                let size = geometry.size_px();
                Some([uv[0] * size[0] as f32 - 0.5, uv[1] * size[1] as f32 - 0.5])
            }
            Self::Direction { view } => geometry.project(view),
            Self::Lost => None,
        };
        px.filter(|px| px[0].is_finite() && px[1].is_finite()).map(|px| px.map(|v| v.clamp(-1e6, 1e6)))
    }

    /// Position in pixels to use: this one if it is known, else `held`, else the middle of the view.
    pub fn resolve(self, held: Option<[f32; 2]>, geometry: &ViewGeometry) -> [f32; 2] {
        let middle = geometry.size_px().map(|s| 0.5 * s as f32 - 0.5);
        self.known_px(geometry).or(held).unwrap_or(middle)
    }
}

/// Description of a view in a frame: geometry, gaze and camera motion of a screen or of one eye of a headset.
///
/// Create it with [`new`](Self::new) and `..`, so that later versions can add fields:
///
/// ```
/// # use afterimage::{Gaze, ViewFrame, ViewGeometry};
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
    /// is refused. If vectors lack the camera's motion ([`MotionConvention::without_camera`],
    /// [`no_vector`](MotionConvention::no_vector)), it is required, except in frames with [`Reset::All`].
    pub previous_from_current: Option<[[f32; 4]; 4]>,
    /// Jitter of the projection in pixels, for renderers that jitter it for antialiasing: a point that the projection
    /// without jitter puts at `p` is drawn at `p + jitter_px`; y down. (0, 0) without jitter.
    ///
    /// The jitter is removed from motion vectors that contain it ([`MotionConvention::jittered`]) and from the rays
    /// through the pixels, so that history stays in place while the camera is still. [`geometry`](Self::geometry)
    /// describes the projection without jitter. Temporal antialiasing runs after the post-process, with the same
    /// jitter.
    pub jitter_px: [f32; 2],
    /// Convention of this view's depth values in this frame. `None`: the context's ([`ContextDesc::depth`]). History
    /// stays valid when the near plane changes, because distances are stored.
    pub depth: Option<DepthConvention>,
    /// The part of the view that a headset's lens shows: an octagon, given by the lowest and the highest x, y, x + y
    /// and x - y of its pixels ([`ViewGeometry::visible_px`] computes it from a visibility mask). On sparse frames smr
    /// does not process pixels outside it, and shows them black; other methods process every pixel. `None`: every pixel
    /// is visible.
    pub visible_px: Option<[[f32; 4]; 2]>,
    /// Where the samples of a sparse frame lie ([`Filter::Sparse`](crate::Filter::Sparse)): the lattices that the
    /// renderer drew, for the gaze that it used. The color input has the context's size, and only its samples are read;
    /// or it is an atlas ([`Lattice::atlas_texel`](crate::Lattice::atlas_texel)) of any size. Other inputs have the
    /// context's size. `None`: every pixel of the color input is a sample.
    pub lattices: Option<Lattices>,
}

impl ViewFrame {
    /// A view with unknown camera motion and without jitter.
    pub fn new(geometry: ViewGeometry, gaze: Gaze) -> Self {
        Self {
            geometry,
            gaze,
            previous_from_current: None,
            jitter_px: [0.0; 2],
            depth: None,
            visible_px: None,
            lattices: None,
        }
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
    /// # use afterimage::{Gaze, ViewFrame, ViewGeometry};
    /// # let clip_from_view = [[1.0, 0.0, 0.0, 0.0], [0.0, 1.8, 0.0, 0.0], [0.0, 0.0, 0.0, -1.0], [0.0, 0.0, 0.1, 0.0]];
    /// # let (clip_from_world, previous_clip_from_world) = (clip_from_view, clip_from_view);
    /// let geometry = ViewGeometry::from_projection([1920, 1080], clip_from_view)?;
    /// let view = ViewFrame::new(geometry, Gaze::Uv { uv: [0.6, 0.5] })
    ///     .moved(clip_from_view, clip_from_world, previous_clip_from_world)?;
    /// # Ok::<(), afterimage::SettingsError>(())
    /// ```
    ///
    /// # Errors
    /// [`SettingsError`] if a matrix is not that of a perspective camera or is not finite, or if only one view mirrors.
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
    /// # use afterimage::{Gaze, ViewFrame, ViewGeometry};
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
    /// # use afterimage::{Gaze, ViewFrame, ViewGeometry};
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
    /// [`SettingsError`] if the matrix is not that of a perspective camera, has another field of view, or is moved by
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

    /// Lattices whose samples lie in an atlas, if any.
    pub(crate) fn atlas(&self) -> Option<&Lattices> {
        self.lattices.as_ref().filter(|lattices| lattices.is_atlas())
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
        if let Some(lattices) = &self.lattices {
            lattices.check(view, desc.size_px)?;
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
    fn check_motion(&self, view: usize, desc: &ContextDesc, has_depth: bool, is_cut: bool) -> Result<(), FrameError> {
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
            let expected = "given: the camera's motion is added to vectors (ContextDesc::motion), for which \
                            distances must be known";
            return refuse(FrameValue::Depth, "None".into(), expected);
        }
        if matches!(convention, DepthConvention::Orthographic { .. }) {
            let expected = "that of a perspective view, or complete vectors: the camera's motion is added to \
                            vectors (ContextDesc::motion), and rays of an orthographic view are not known";
            return refuse(FrameValue::DepthConvention, format!("{convention:?}"), expected);
        }
        if self.previous_from_current.is_none() {
            let expected = "given, as by ViewFrame::moved or posed, because the camera's motion is added to vectors \
                            (ContextDesc::motion); or Reset::All";
            return refuse(FrameValue::CameraMotion, "None".into(), expected);
        }
        Ok(())
    }
}

/// Reset of history by a frame. Default: [`None`](Self::None). `examples/02_engine.rs` uses it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum Reset {
    /// History is valid.
    #[default]
    None,
    /// All history is invalid, as after a cut, a teleport or a pause. The frame is processed like the first one.
    All,
}

/// Exposure of a frame's colors. Stored colors follow its changes. Default: [`Same`](Self::Same).
/// `examples/02_engine.rs` uses it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub enum Exposure {
    /// Colors are multiplied by an exposure already, or need none: white is at about 1. It is unchanged.
    #[default]
    Same,
    /// The same, but the exposure has changed since the previous frame.
    Changed {
        /// This frame's exposure divided by the previous frame's: above 0 and finite.
        ratio: f32,
    },
    /// Colors are radiance in any unit, and are shown in it. The context knows the previous frame's exposure, which is
    /// 1 for [`Same`](Self::Same) and [`Changed`](Self::Changed), and follows its changes.
    Scene {
        /// Factor by which colors have white at about 1: 2^-40 to 2^40. Noise ([`FrameInputs::noise`]) has the unit of
        /// the colors, and is multiplied, too. On a GPU, frames with it have pipelines of their own
        /// (`gpu::Variant::exposure`).
        exposure: f32,
    },
}

impl Exposure {
    /// Largest exposure, and inverse of the smallest one: the range of [`expose`](crate::kernel::wrs::expose).
    const LIMIT: f32 = (1_u64 << 40) as f32;

    /// Rejects a ratio that is not above 0 and finite, and an exposure out of range.
    pub(crate) fn check(self) -> Result<(), FrameError> {
        let (found, expected) = match self {
            Self::Changed { ratio } if !(ratio.is_finite() && ratio > 0.0) => {
                (ratio, "a number above 0 and finite: this frame's exposure divided by the previous frame's")
            }
            Self::Scene { exposure } if !(1.0 / Self::LIMIT..=Self::LIMIT).contains(&exposure) => {
                (exposure, "a number from 2^-40 to 2^40 by which the colors have white at about 1")
            }
            _ => return Ok(()),
        };
        Err(FrameError::Value { value: FrameValue::Exposure, view: 0, found: found.to_string(), expected })
    }

    /// Factor on given colors.
    pub(crate) fn of_colors(self) -> f32 {
        match self {
            Self::Same | Self::Changed { .. } => 1.0,
            Self::Scene { exposure } => exposure,
        }
    }

    /// Factor on stored colors. `before`: [factor](Self::of_colors) on the colors of the previous frame, if any.
    pub(crate) fn of_stored(self, before: Option<f32>) -> f32 {
        let ratio = match self {
            Self::Changed { ratio } => ratio,
            Self::Same | Self::Scene { .. } => 1.0,
        };
        let now = self.of_colors();
        (ratio * (now / before.unwrap_or(now))).clamp(1.0 / Self::LIMIT, Self::LIMIT)
    }
}

/// Executor of the post-process: types of its input images.
///
/// Implemented by `gpu::Afterimage`, whose inputs are `gpu::Textures`, and by `cpu::CpuAfterimage`, whose inputs are
/// slices with one `Image` a view. It only makes [`FrameInputs`] generic: applications need neither implement nor name
/// it.
pub trait Executor {
    /// Images with three channels (color).
    type Colors<'a>: Copy + Debug;
    /// Images with one channel.
    type Scalars<'a>: Copy + Debug;
    /// Images with two channels.
    type Vectors<'a>: Copy + Debug;
}

/// A frame: its input images, all of the context's size, and descriptions of its views.
///
/// `gpu::Frame` and `cpu::Frame` are this type for either executor. Create it with [`new`](Self::new) and `..`, so that
/// later versions can add fields:
///
/// ```
/// # #[cfg(feature = "gpu")]
/// # use afterimage::wgpu;
/// # #[cfg(feature = "gpu")]
/// # fn example(color: &wgpu::Texture, depth: &wgpu::Texture, motion: &wgpu::Texture, views: &[afterimage::ViewFrame]) {
/// use afterimage::Reset;
/// use afterimage::gpu::Frame;
///
/// let (depth, motion) = (Some(depth.into()), Some(motion.into()));
/// let after_a_cut = Frame { depth, motion, reset: Reset::All, ..Frame::new(color, views, 0) };
/// # let _ = after_a_cut;
/// # }
/// ```
pub struct FrameInputs<'a, E: Executor> {
    /// Foveated frame: linear scene-referred color in Rec. 709 primaries, before tone mapping. Pixels that are NaN or
    /// infinite show their history, or black, and are counted. On a GPU any float format.
    ///
    /// Channels are 0 to 65504; larger ones are clamped, and smr, taa and taau store negative ones as 0. For smr the
    /// unit is free on frames that are neither sparse nor noisy: colors times a constant give the picture times it.
    /// This holds for channels from 2^-14 (6e-5) on; darker ones are stored with fewer digits, and light that changes
    /// there leaves ghosts. wrs, sparse frames and noise ([`Self::noise`]) compare colors by constants for white at
    /// about 1. Of colors in other units say the exposure ([`Exposure::Scene`]): then the range and these constants are
    /// for colors times it.
    pub color: E::Colors<'a>,
    /// Depth in the context's convention. On a GPU a depth format or `R32Float`. `None`: no depth test.
    pub depth: Option<E::Scalars<'a>>,
    /// Motion vectors in the context's convention. On a GPU `Rg16Float`, `Rg32Float` or wider. `None`: nothing moves,
    /// or only the camera ([`MotionConvention::without_camera`]).
    pub motion: Option<E::Vectors<'a>>,
    /// Trust mask: confidence in history, 0 to 1. 0 rejects history; use it for content that changes without motion
    /// vectors (video panels, particles, reflections). 1 minus `reactive`. Values beyond 0 and 1
    /// are clamped; NaN counts as 0. On a GPU any float or normalised format. `None`: 1 everywhere.
    pub trust: Option<E::Scalars<'a>>,
    /// Reactive mask as FSR2 has it: 0 to 1, 1 rejects history. The trust is 1 minus this mask, so that a frame with
    /// both is an error. Values beyond 0 and 1 are clamped; NaN counts as 1. On a GPU any float or normalised format.
    /// `None`: `trust` says it.
    pub reactive: Option<E::Scalars<'a>>,
    /// Level of detail of the foveated frame: log2 of the block edge in pixels. On a GPU any float format. `None`:
    /// computed from gaze and [`Settings::foveation`]. Sparse frames have the levels of their lattices instead, and no
    /// such input. `foveation.rate_far` must be the coarsest block edge even with this input, because history is not
    /// matched at coarser levels.
    pub lod: Option<E::Scalars<'a>>,
    /// Noise of the color: standard error of its luma (linear), and the number of samples that were averaged into the
    /// color, at its level of detail. On a GPU `Rg16Float`, `Rg32Float` or wider. Required if [`Settings::noisy`] is
    /// set, otherwise `None`. In sparse frames it is read only at the pixels of samples.
    pub noise: Option<E::Vectors<'a>>,
    /// Descriptions of the views, one for each view of the context.
    pub views: &'a [ViewFrame],
    /// Frame counter, which seeds the random numbers: the same index and [`Settings::seed`] give the same bytes.
    pub index: u64,
    /// Reset of history.
    pub reset: Reset,
    /// Exposure of the colors, or its change since the previous frame.
    pub exposure: Exposure,
}

// Not derived: a derived impl would require the executor itself to be `Copy`.
impl<E: Executor> Clone for FrameInputs<'_, E> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<E: Executor> Copy for FrameInputs<'_, E> {}

impl<E: Executor> Debug for FrameInputs<'_, E> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("FrameInputs")
            .field("color", &self.color)
            .field("depth", &self.depth)
            .field("motion", &self.motion)
            .field("trust", &self.trust)
            .field("reactive", &self.reactive)
            .field("lod", &self.lod)
            .field("noise", &self.noise)
            .field("views", &self.views)
            .field("index", &self.index)
            .field("reset", &self.reset)
            .field("exposure", &self.exposure)
            .finish()
    }
}

impl<'a, E: Executor> FrameInputs<'a, E> {
    /// Implementation of `new` of both executors.
    pub(crate) fn of_color(color: E::Colors<'a>, views: &'a [ViewFrame], index: u64) -> Self {
        Self {
            color,
            depth: None,
            motion: None,
            trust: None,
            reactive: None,
            lod: None,
            noise: None,
            views,
            index,
            reset: Reset::None,
            exposure: Exposure::Same,
        }
    }

    /// Checks all fields except the images.
    pub(crate) fn check(&self, desc: &ContextDesc) -> Result<(), FrameError> {
        self.check_facts(desc)?;
        self.check_noise(&desc.settings)
    }

    /// Checks the parts of a frame that are known before it is shaded.
    pub(crate) fn check_facts(&self, desc: &ContextDesc) -> Result<(), FrameError> {
        let (found, expected) = (self.views.len(), desc.view_count as usize);
        if found != expected {
            return Err(FrameError::ViewCount { found, expected });
        }
        for (i, view) in self.views.iter().enumerate() {
            view.check(i, desc)?;
            view.check_motion(i, desc, self.depth.is_some(), self.reset != Reset::None)?;
        }
        if self.trust.is_some() && self.reactive.is_some() {
            let expected = "None, because trust is given, and is 1 minus this mask";
            return Err(FrameError::Value { value: FrameValue::Reactive, view: 0, found: "given".into(), expected });
        }
        self.check_lattices(&desc.settings)?;
        self.exposure.check()
    }

    /// Rejects views without lattices if the settings require lattices, and views with lattices if they do not.
    fn check_lattices(&self, settings: &Settings) -> Result<(), FrameError> {
        let is_sparse = settings.foveation.filter == Filter::Sparse;
        for (view, facts) in self.views.iter().enumerate() {
            let (found, expected) = match (is_sparse, facts.lattices.is_some()) {
                (true, false) => ("None", "where the samples are, because the filter of the foveation is Sparse"),
                (false, true) => ("given", "None; or set Filter::Sparse in Settings::foveation"),
                _ => continue,
            };
            return Err(FrameError::Value { value: FrameValue::Lattices, view, found: found.into(), expected });
        }
        let at_samples = |view: &ViewFrame| view.lattices.is_some_and(|lattices| lattices.has_geometry_at_samples());
        if let Some(view) = (1..self.views.len()).find(|&i| at_samples(&self.views[i]) != at_samples(&self.views[0])) {
            let found = "given with depth and motion at samples for some views".into();
            let expected = "depth and motion at samples for all views, or at every pixel for all";
            return Err(FrameError::Value { value: FrameValue::Lattices, view, found, expected });
        }
        let is_sampled = is_sparse || settings.foveation.filter == Filter::Quads;
        if is_sampled && self.lod.is_some() {
            let (found, expected) = ("given".into(), "None: the places of the samples say how coarse the frame is");
            return Err(FrameError::Value { value: FrameValue::Lod, view: 0, found, expected });
        }
        Ok(())
    }

    /// Checks the values of a frame whose quads are to be planned.
    pub(crate) fn check_plan(&self, desc: &ContextDesc) -> Result<(), FrameError> {
        if desc.settings.foveation.filter != Filter::Quads {
            let (found, expected) = ("asked for".into(), "Filter::Quads in Settings::foveation");
            return Err(FrameError::Value { value: FrameValue::Plan, view: 0, found, expected });
        }
        self.check_facts(desc)
    }

    /// Rejects a frame shaded by quads that was not planned. `planned`: index of the frame that was planned.
    pub(crate) fn check_planned(&self, desc: &ContextDesc, planned: Option<u64>) -> Result<(), FrameError> {
        if desc.settings.foveation.filter == Filter::Quads && planned != Some(self.index) {
            let found = planned.map_or("missing".into(), |index| format!("that of frame {index}"));
            let expected = "the plan of this frame: call plan before the frame is shaded";
            return Err(FrameError::Value { value: FrameValue::Plan, view: 0, found, expected });
        }
        Ok(())
    }

    /// Rejects a missing noise input if the settings require one, and a noise input if they do not.
    fn check_noise(&self, settings: &Settings) -> Result<(), FrameError> {
        let (found, expected) = match (settings.noisy, self.noise.is_some()) {
            (true, false) => ("None", "a noise input, because Settings::noisy is set"),
            (false, true) => ("given", "None; or set Settings::noisy"),
            _ => return Ok(()),
        };
        Err(FrameError::Value { value: FrameValue::Noise, view: 0, found: found.into(), expected })
    }
}

/// Description of a context: size and number of views, conventions of its inputs, and settings. Size and settings can
/// be changed later (`resize` and `set_settings` of either executor).
///
/// Create it with [`new`](Self::new) and change fields, so that later versions can add fields:
///
/// ```
/// use afterimage::{ContextDesc, DepthConvention, MotionConvention};
///
/// let mut desc = ContextDesc::new([1920, 1080]);
/// desc.motion = MotionConvention::BLENDER;
/// desc.depth = DepthConvention::Reversed { near: 0.1, far: f32::INFINITY };
/// desc.settings.foveation.rate_far = 8;
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContextDesc {
    /// Width and height of each view in pixels, 1 to [`MAX_SIDE`](Self::MAX_SIDE) each.
    pub size_px: [u32; 2],
    /// Number of views: 1 for a screen, 2 for stereo; at most 4 on a GPU. Default 1.
    pub view_count: u32,
    /// Convention of motion vectors. Default: previous minus current position in pixels, y down.
    pub motion: MotionConvention,
    /// Convention of depth values, for views that do not state their own ([`ViewFrame::depth`]). Default: linear
    /// distance.
    pub depth: DepthConvention,
    /// Whether the output has the color input's alpha (1 where that is not finite) instead of 1. GPU only. Default
    /// true.
    pub keep_alpha: bool,
    /// Method, foveation and tunables. Default: [`Settings::steady`].
    pub settings: Settings,
}

impl ContextDesc {
    /// Largest accepted side of a view, in pixels.
    pub const MAX_SIDE: u32 = 16384;

    /// One view of `size_px` with default conventions and settings.
    pub fn new(size_px: [u32; 2]) -> Self {
        Self {
            size_px,
            view_count: 1,
            motion: MotionConvention::default(),
            depth: DepthConvention::default(),
            keep_alpha: true,
            settings: Settings::default(),
        }
    }

    /// Checks settings, size, number of views and planes.
    pub(crate) fn validate(&self) -> Result<(), SettingsError> {
        self.settings.validate()?;
        self.depth.validate()?;
        check_size(self.size_px).map_err(|_| SettingsError {
            setting: "size_px",
            found: format!("{}x{}", self.size_px[0], self.size_px[1]),
            expected: expected_size(self.size_px, Self::MAX_SIDE),
        })?;
        if self.view_count == 0 {
            return Err(SettingsError { setting: "view_count", found: "0".into(), expected: "at least 1 view".into() });
        }
        Ok(())
    }
}

/// Rejects sizes with a side of 0 or beyond [`ContextDesc::MAX_SIDE`].
pub(crate) fn check_size(size: [u32; 2]) -> Result<(), FrameError> {
    let max = ContextDesc::MAX_SIDE;
    if size.iter().all(|s| (1..=max).contains(s)) { Ok(()) } else { Err(FrameError::Extent { size, max }) }
}

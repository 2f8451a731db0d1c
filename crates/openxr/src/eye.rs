//! An eye in a frame: matrices and gaze.

use afterimage::internal::ViewFrame;
use afterimage::{Gaze, SettingsError, ViewGeometry};
use glam::{Mat4, Quat, Vec2, Vec3, Vec4};
use openxr as xr;

/// One eye in one frame. Matrices are stored by columns, for column vectors; the world has y up, in metres, and view
/// space looks along -z. Depth is reversed and infinite: 1 at the near plane, 0 far away.
#[derive(Clone, Copy, Debug)]
pub struct Eye {
    /// Layer of the eye in the targets: 0 left, 1 right.
    pub layer: u32,
    /// Rays through the pixels of the view.
    pub geometry: ViewGeometry,
    /// Pose of the eye.
    pub world_from_view: [[f32; 4]; 4],
    /// Projection with jitter: draw what is fixed to the view with it.
    pub jittered_clip_from_view: [[f32; 4]; 4],
    /// Projection with jitter times the inverse pose: draw the scene with it.
    pub jittered_clip_from_world: [[f32; 4]; 4],
    /// Projection without jitter.
    pub clip_from_view: [[f32; 4]; 4],
    /// Projection times the inverse pose, without jitter: for motion vectors.
    pub clip_from_world: [[f32; 4]; 4],
    /// The same in the last frame that was submitted; in the first one, and after resets, this frame's.
    pub previous_clip_from_world: [[f32; 4]; 4],
    /// Where the eye looks, in pixels of the view: held while the tracker is lost.
    pub gaze_px: [f32; 2],
    /// Jitter of the projections in pixels, y down: (0, 0) unless `Smr::antialias` is set.
    pub jitter_px: [f32; 2],
}

/// Pose and projection of a view of the runtime.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Posed {
    pub world_from_view: Mat4,
    pub clip_from_view: Mat4,
}

impl Posed {
    pub fn new(view: &xr::View, near_m: f32) -> Self {
        Self { world_from_view: matrix(view.pose), clip_from_view: projection(view.fov, near_m) }
    }

    pub fn clip_from_world(&self) -> Mat4 {
        self.clip_from_view * self.world_from_view.inverse()
    }
}

impl Eye {
    pub(crate) fn new(
        layer: u32,
        geometry: ViewGeometry,
        [now, before]: [&Posed; 2],
        gaze_px: [f32; 2],
        jitter_px: [f32; 2],
    ) -> Self {
        let [width, height] = geometry.size_px().map(|n| n as f32);
        // Adds `offset * w` to x and y of clip space, whose y is up.
        let offset = Vec3::new(2.0 * jitter_px[0] / width, -2.0 * jitter_px[1] / height, 0.0);
        let jitter = Mat4::from_translation(offset);
        let clip_from_world = now.clip_from_world();
        Self {
            layer,
            geometry,
            world_from_view: now.world_from_view.to_cols_array_2d(),
            jittered_clip_from_view: (jitter * now.clip_from_view).to_cols_array_2d(),
            jittered_clip_from_world: (jitter * clip_from_world).to_cols_array_2d(),
            clip_from_view: now.clip_from_view.to_cols_array_2d(),
            clip_from_world: clip_from_world.to_cols_array_2d(),
            previous_clip_from_world: before.clip_from_world().to_cols_array_2d(),
            gaze_px,
            jitter_px,
        }
    }

    /// The eye at half the width and height, whose pixel (x, y) shows what pixel (2x, 2y) + `place_px` of this eye
    /// shows.
    pub(crate) fn half(&self, place_px: [u32; 2]) -> Self {
        let geometry = self.geometry.half(place_px);
        let sides = |geometry: &ViewGeometry| Vec2::from(geometry.size_px().map(|side| side as f32));
        let (whole, half) = (sides(&self.geometry), sides(&geometry));
        let place = Vec2::from(place_px.map(|v| v as f32));
        let scale = 0.5 * whole / half;
        // Of the picture's middle, in clip space with y down.
        let offset = (0.5 * whole + 0.5 - place) / half - 1.0;
        let halved = Mat4::from_translation(Vec3::new(offset.x, -offset.y, 0.0)) * Mat4::from_scale(scale.extend(1.0));
        let clip = |matrix: [[f32; 4]; 4]| (halved * Mat4::from_cols_array_2d(&matrix)).to_cols_array_2d();
        Self {
            geometry,
            jittered_clip_from_view: clip(self.jittered_clip_from_view),
            jittered_clip_from_world: clip(self.jittered_clip_from_world),
            clip_from_view: clip(self.clip_from_view),
            clip_from_world: clip(self.clip_from_world),
            previous_clip_from_world: clip(self.previous_clip_from_world),
            gaze_px: (0.5 * (Vec2::from(self.gaze_px) - place)).to_array(),
            jitter_px: self.jitter_px.map(|v| 0.5 * v),
            ..*self
        }
    }

    /// Description for the post-process. `before`: pose in the last recorded frame, if history is of use.
    pub(crate) fn view_frame(
        &self,
        gaze: Gaze,
        before: Option<&Posed>,
        visible_px: Option<[[f32; 4]; 2]>,
    ) -> Result<ViewFrame, SettingsError> {
        let frame = ViewFrame { jitter_px: self.jitter_px, visible_px, ..ViewFrame::new(self.geometry, gaze) };
        match before {
            Some(before) => frame.posed(self.world_from_view, before.world_from_view.to_cols_array_2d()),
            None => Ok(frame),
        }
    }
}

pub(crate) fn rotation(q: xr::Quaternionf) -> Quat {
    Quat::from_xyzw(q.x, q.y, q.z, q.w).normalize()
}

pub(crate) fn position(v: xr::Vector3f) -> Vec3 {
    Vec3::new(v.x, v.y, v.z)
}

/// World from the space of the pose.
pub(crate) fn matrix(pose: xr::Posef) -> Mat4 {
    Mat4::from_rotation_translation(rotation(pose.orientation), position(pose.position))
}

/// Projection with reversed, infinite depth.
fn projection(fov: xr::Fovf, near_m: f32) -> Mat4 {
    let [left, right, up, down] = angles(fov).map(f32::tan);
    let (width, height) = (right - left, up - down);
    Mat4::from_cols(
        Vec4::new(2.0 / width, 0.0, 0.0, 0.0),
        Vec4::new(0.0, 2.0 / height, 0.0, 0.0),
        Vec4::new((right + left) / width, (up + down) / height, 0.0, -1.0),
        Vec4::new(0.0, 0.0, near_m, 0.0),
    )
}

/// Left, right, up and down in radians.
pub(crate) fn angles(fov: xr::Fovf) -> [f32; 4] {
    [fov.angle_left, fov.angle_right, fov.angle_up, fov.angle_down]
}

#[cfg(test)]
mod tests {
    use super::*;
    use afterimage::internal::Foveation;

    /// A point of the world lies, by either projection, at the pixel whose ray goes through it: moved by the jitter in
    /// what is drawn, and where it is in motion vectors. The same at half the width and height.
    #[test]
    fn points_lie_at_their_pixels_with_and_without_jitter() {
        let fov = xr::Fovf { angle_left: -0.9, angle_right: 0.7, angle_up: 0.8, angle_down: -0.85 };
        let pose = xr::Posef {
            orientation: xr::Quaternionf { x: 0.1, y: -0.2, z: 0.05, w: 0.97 },
            position: xr::Vector3f { x: 0.3, y: 1.6, z: -0.2 },
        };
        let posed = Posed::new(&xr::View { pose, fov }, 0.05);
        let geometry = ViewGeometry::from_angles([641, 720], angles(fov)).unwrap();
        for index in 0..32 {
            let whole = Eye::new(0, geometry, [&posed, &posed], [250.0, 400.0], Foveation::jitter_px(index / 2));
            // Of an odd width, which is rounded up.
            let eye = if index % 2 == 0 { whole } else { whole.half(Foveation::quarter_place_px(index / 2)) };
            let (geometry, jitter_px) = (eye.geometry, eye.jitter_px);
            let [width, height] = geometry.size_px().map(|side| side as f32);
            for px in [[0.0, 719.0], [240.0, 390.0], [251.5, 402.25], [640.0, 0.0]] {
                // y down and z forward there, the other way round here.
                let [x, y, z] = geometry.ray(px).map(|v| 1.7 * v);
                let view = Vec3::new(x, -y, -z);
                let world = posed.world_from_view.transform_point3(view);
                for (clip_from, point, jitter_px) in [
                    (eye.jittered_clip_from_world, world, jitter_px),
                    (eye.jittered_clip_from_view, view, jitter_px),
                    (eye.clip_from_world, world, [0.0; 2]),
                    (eye.clip_from_view, view, [0.0; 2]),
                    (eye.previous_clip_from_world, world, [0.0; 2]),
                ] {
                    let clip = Mat4::from_cols_array_2d(&clip_from) * point.extend(1.0);
                    assert!((clip.z / clip.w - 0.05 / 1.7).abs() < 1e-5);
                    // Pixels' centres are at halves.
                    let found =
                        [width * (0.5 + 0.5 * clip.x / clip.w) - 0.5, height * (0.5 - 0.5 * clip.y / clip.w) - 0.5];
                    for i in 0..2 {
                        let expected = px[i] + jitter_px[i];
                        assert!((found[i] - expected).abs() < 2e-3, "{found:?} instead of {expected}");
                    }
                }
            }
        }
    }
}

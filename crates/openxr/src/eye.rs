//! An eye in a frame: matrices, gaze, and what to draw.

use afterimage::{Foveation, Gaze, Lattice, Lattices, SettingsError, ViewFrame, ViewGeometry};
use glam::{Mat4, Quat, Vec2, Vec3, Vec4};
use openxr as xr;

/// One eye in one frame. Matrices are stored by columns, for column vectors; the world has y up, in metres, and view
/// space looks along -z. Depth is reversed and infinite: 1 at the near plane, 0 far away.
#[derive(Clone, Copy, Debug)]
pub struct Eye {
    /// Layer of the eye in the targets: 0 left, 1 right.
    pub layer: u32,
    /// Rays through the pixels of the whole view.
    pub geometry: ViewGeometry,
    /// Pose of the eye.
    pub world_from_view: [[f32; 4]; 4],
    /// Projection of the whole view, without jitter.
    pub clip_from_view: [[f32; 4]; 4],
    /// Projection of the whole view times the inverse pose, without jitter: for motion vectors.
    pub clip_from_world: [[f32; 4]; 4],
    /// The same in the last frame that was submitted; in the first one, and after resets, this frame's.
    pub previous_clip_from_world: [[f32; 4]; 4],
    /// Where the eye looks, in pixels of the view: held while the tracker is lost.
    pub gaze_px: [f32; 2],
    /// Jitter of the samples in pixels, y down: (0, 0) unless `Smr::antialias` is set. The draws contain it.
    pub jitter_px: [f32; 2],
    /// Lattices of the samples, in the atlas.
    pub lattices: Lattices,
}

/// A lattice of an eye: draw the scene once into this rectangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Draw {
    /// Viewport and scissor in texels of the atlas: x, y, width, height.
    pub viewport: [u32; 4],
    /// Clip space of the rectangle from the world, with jitter.
    pub clip_from_world: [[f32; 4]; 4],
    /// The same from the eye's view space, for what is fixed to the view.
    pub clip_from_view: [[f32; 4]; 4],
    /// Bias of textures' level of detail (`textureSampleBias`): a sample is worth one pixel of the whole view.
    pub lod_bias: f32,
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
    /// Draws of the eye, one for each lattice, finest first.
    pub fn draws(&self) -> impl Iterator<Item = Draw> + '_ {
        let size = Vec2::from(self.geometry.size_px().map(|n| n as f32));
        let jitter = Vec2::from(self.jitter_px) * Vec2::new(2.0, -2.0) / size;
        self.lattices.as_slice().iter().map(move |lattice| {
            let crop = crop(lattice, size) * translation(jitter);
            let ([x, y], [w, h]) = (lattice.atlas_texel.unwrap_or_default(), lattice.points);
            Draw {
                viewport: [x, y, w, h],
                clip_from_world: (crop * Mat4::from_cols_array_2d(&self.clip_from_world)).to_cols_array_2d(),
                clip_from_view: (crop * Mat4::from_cols_array_2d(&self.clip_from_view)).to_cols_array_2d(),
                lod_bias: -(lattice.step as f32).log2(),
            }
        })
    }

    pub(crate) fn new(
        layer: u32,
        geometry: ViewGeometry,
        [now, before]: [&Posed; 2],
        gaze_px: [f32; 2],
        foveation: &Foveation,
        (index, jitter_px): (u64, [f32; 2]),
    ) -> Self {
        Self {
            layer,
            geometry,
            world_from_view: now.world_from_view.to_cols_array_2d(),
            clip_from_view: now.clip_from_view.to_cols_array_2d(),
            clip_from_world: now.clip_from_world().to_cols_array_2d(),
            previous_clip_from_world: before.clip_from_world().to_cols_array_2d(),
            gaze_px,
            jitter_px,
            lattices: foveation.lattices(&geometry, gaze_px, index).in_atlas().0,
        }
    }

    /// Description for the post-process. `before`: pose in the last recorded frame, if history is of use.
    pub(crate) fn view_frame(
        &self,
        gaze: Gaze,
        before: Option<&Posed>,
        visible_px: Option<[[f32; 4]; 2]>,
    ) -> Result<ViewFrame, SettingsError> {
        let frame = ViewFrame {
            jitter_px: self.jitter_px,
            visible_px,
            lattices: Some(self.lattices.with_geometry_at_samples()),
            ..ViewFrame::new(self.geometry, gaze)
        };
        match before {
            Some(before) => frame.posed(self.world_from_view, before.world_from_view.to_cols_array_2d()),
            None => Ok(frame),
        }
    }
}

/// Clip space of a lattice's rectangle from that of the view (docs/integration.md of afterimage, "Rendering the samples
/// alone").
fn crop(lattice: &Lattice, size: Vec2) -> Mat4 {
    let step = lattice.step as f32;
    let covered = Vec2::from(lattice.points.map(|n| n as f32)) * step;
    let first = Vec2::from(lattice.first_px.map(|n| n as f32));
    let offset = (size - 1.0 - 2.0 * first + step) / covered - 1.0;
    // Clip space's y is up, pixels' is down.
    translation(offset * Vec2::new(1.0, -1.0)) * Mat4::from_scale((size / covered).extend(1.0))
}

/// Adds `offset * w` to x and y of clip space.
fn translation(offset: Vec2) -> Mat4 {
    Mat4::from_translation(offset.extend(0.0))
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
    use afterimage::Filter;

    /// A point of the world lies, by each draw, at the texel whose pixel of the whole view shows it.
    #[test]
    fn draws_put_points_at_the_texels_of_their_pixels() {
        let fov = xr::Fovf { angle_left: -0.9, angle_right: 0.7, angle_up: 0.8, angle_down: -0.85 };
        let view = xr::View {
            pose: xr::Posef {
                orientation: xr::Quaternionf { x: 0.1, y: -0.2, z: 0.05, w: 0.97 },
                position: xr::Vector3f { x: 0.3, y: 1.6, z: -0.2 },
            },
            fov,
        };
        let posed = Posed::new(&view, 0.05);
        let geometry = ViewGeometry::from_angles([640, 720], angles(fov)).unwrap();
        let foveation = Foveation { filter: Filter::Sparse, rate_mid: 2, rate_far: 4, ..Foveation::default() };
        for index in 0..16 {
            let jitter_px = Foveation::jitter_px(index);
            let eye = Eye::new(0, geometry, [&posed, &posed], [250.0, 400.0], &foveation, (index, jitter_px));
            for (lattice, draw) in eye.lattices.as_slice().iter().zip(eye.draws()) {
                for px in [[240.0, 390.0], [260.0, 410.0], [251.5, 402.25]] {
                    // y down and z forward there, the other way round here.
                    let [x, y, z] = geometry.ray(px).map(|v| 1.7 * v);
                    let world = posed.world_from_view.transform_point3(Vec3::new(x, -y, -z));
                    let clip = Mat4::from_cols_array_2d(&draw.clip_from_world) * world.extend(1.0);
                    assert!((clip.z / clip.w - 0.05 / 1.7).abs() < 1e-5);
                    let [vx, vy, w, h] = draw.viewport.map(|v| v as f32);
                    // Texels' centres are at halves.
                    let texel =
                        [vx + w * (0.5 + 0.5 * clip.x / clip.w) - 0.5, vy + h * (0.5 - 0.5 * clip.y / clip.w) - 0.5];
                    let origin = lattice.atlas_texel.unwrap();
                    for i in 0..2 {
                        let expected = origin[i] as f32
                            + (px[i] + jitter_px[i] - lattice.first_px[i] as f32) / lattice.step as f32;
                        assert!((texel[i] - expected).abs() < 2e-3, "{texel:?} instead of {expected}");
                    }
                }
            }
        }
    }
}

//! Camera view of a rendered frame.

mod lattice;

pub use lattice::Lattice;

use crate::scene::Camera;

use afterimage::{SettingsError, ViewGeometry};
use glam::{DMat4, DVec3, Vec3};

/// A camera pose, its pixels and angles, and optionally the lattice that is sampled.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    geometry: ViewGeometry,
    world_from_camera: DMat4,
    lattice: Option<Lattice>,
}

/// Rays of a view: `corner + right x + down y` passes through pixel (x, y). Pixel centres are at integers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ViewRays {
    /// Origin of all rays, metres.
    pub origin: Vec3,
    /// Direction through pixel (0, 0).
    pub corner: Vec3,
    /// Step from a pixel to its right neighbour.
    pub right: Vec3,
    /// Step from a pixel to the neighbour below.
    pub down: Vec3,
    /// Edge length in pixels of the square that samples are jittered over.
    pub jitter: f32,
}

impl View {
    /// A view with pixels and angles `geometry` and camera pose `world_from_camera` (rigid; x right, y up, looking
    /// along -z).
    pub fn new(geometry: ViewGeometry, world_from_camera: DMat4) -> Self {
        Self { geometry, world_from_camera, lattice: None }
    }

    /// View of a scene's camera at `size_px` pixels. Field of view: `hfov_deg` (horizontal, degrees), or the camera's
    /// own if `None`.
    ///
    /// # Errors
    /// If the field of view is not in (0, 180) degrees.
    pub fn of_camera(camera: &Camera, size_px: [u32; 2], hfov_deg: Option<f32>) -> Result<Self, SettingsError> {
        let geometry = match hfov_deg {
            Some(hfov_deg) => ViewGeometry::flat(size_px, hfov_deg)?,
            None => {
                let half = (camera.vfov_deg.to_radians() * 0.5).tan();
                let wide = half * size_px[0].max(1) as f32 / size_px[1].max(1) as f32;
                ViewGeometry::off_axis(size_px, [-wide, wide], [-half, half])?
            }
        };
        Ok(Self::new(geometry, camera.world_from_camera))
    }

    /// Pixels and angles of the view.
    pub fn geometry(&self) -> &ViewGeometry {
        &self.geometry
    }

    /// Transform from camera to world space.
    pub fn world_from_camera(&self) -> DMat4 {
        self.world_from_camera
    }

    /// Matrix from this view's space (x right, y down, z forward) to that of `previous`; row-major, for column vectors.
    pub fn previous_from_current(&self, previous: &Self) -> [[f32; 4]; 4] {
        let flip = DMat4::from_scale(DVec3::new(1.0, -1.0, -1.0));
        let matrix = flip * previous.world_from_camera.inverse() * self.world_from_camera * flip;
        matrix.transpose().to_cols_array_2d().map(|row| row.map(|v| v as f32))
    }

    /// This view with a jittered projection: a point at pixel `p` without jitter is at `p + jitter_px`.
    ///
    /// # Panics
    /// If the jitter is not finite.
    pub fn jittered(&self, jitter_px: [f32; 2]) -> Self {
        let [width, height] = self.geometry.size_px().map(|s| s as f32);
        let first = self.geometry.ray([-0.5 - jitter_px[0], -0.5 - jitter_px[1]]);
        let last = self.geometry.ray([width - 0.5 - jitter_px[0], height - 0.5 - jitter_px[1]]);
        let geometry = ViewGeometry::off_axis(self.geometry.size_px(), [first[0], last[0]], [first[1], last[1]]);
        Self { geometry: geometry.expect("finite tangents"), ..*self }
    }

    /// Views of the left and the right eye, shifted half of `ipd_m` (interpupillary distance, metres) to either side of
    /// this head view, with all its pixels.
    pub fn stereo(&self, ipd_m: f64) -> [Self; 2] {
        [-0.5, 0.5].map(|side| {
            let aside = DMat4::from_translation(DVec3::X * (side * ipd_m));
            Self::new(*self.geometry(), self.world_from_camera() * aside)
        })
    }

    /// This view restricted to the points of a lattice: pixel (x, y) becomes the lattice's point (x, y).
    pub fn on_lattice(&self, lattice: &Lattice) -> Self {
        Self { lattice: Some(*lattice), ..*self }
    }

    /// Camera rays.
    pub fn rays(&self) -> ViewRays {
        let (scale, offset) = self.geometry.scale_offset();
        let to_world = |x: f32, y: f32, z: f32| {
            // View space has y down and z forward; the camera has y up and z backward.
            let v = DVec3::new(f64::from(x), -f64::from(y), -f64::from(z));
            self.world_from_camera.transform_vector3(v).as_vec3()
        };
        let origin = self.world_from_camera.w_axis.truncate().as_vec3();
        let (first, step, jitter) =
            self.lattice.map_or(([0.0; 2], 1.0, 1.0), |l| (l.first_px, l.step as f32, l.footprint_px / l.step as f32));
        ViewRays {
            origin,
            corner: to_world(offset[0] + scale[0] * first[0], offset[1] + scale[1] * first[1], 1.0),
            right: to_world(scale[0] * step, 0.0, 0.0),
            down: to_world(0.0, scale[1] * step, 0.0),
            jitter,
        }
    }

    /// Projects a world-space point to its pixel and its distance along the view axis in metres; `None` behind the
    /// camera.
    pub fn project(&self, world: DVec3) -> Option<([f64; 2], f64)> {
        let c = self.world_from_camera.inverse().transform_point3(world);
        let depth = -c.z;
        self.pixel(c).map(|px| (px, depth))
    }

    /// Projects a world-space direction to its pixel; `None` behind the camera.
    pub fn project_direction(&self, world: DVec3) -> Option<[f64; 2]> {
        self.pixel(self.world_from_camera.inverse().transform_vector3(world))
    }

    fn pixel(&self, camera: DVec3) -> Option<[f64; 2]> {
        let (scale, offset) = self.geometry.scale_offset();
        let depth = -camera.z;
        (depth > 0.0).then(|| {
            let at = |v: f64, axis: usize| (v / depth - f64::from(offset[axis])) / f64::from(scale[axis]);
            [at(camera.x, 0), at(-camera.y, 1)]
        })
    }
}

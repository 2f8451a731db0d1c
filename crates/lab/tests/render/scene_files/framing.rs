//! Bounding boxes and the framing camera.

use super::builder::Gltf;
use afterimage_lab::scene::{Bounds, Camera};
use glam::{DVec3, Vec3};

/// Whether all corners of the box are in the frame, and the largest share of the frame's width or height that they
/// span.
fn coverage(camera: &Camera, bounds: Bounds, aspect: f64) -> f64 {
    let view = camera.world_from_camera.inverse();
    let tan = f64::from(camera.vfov_deg / 2.0).to_radians().tan();
    let (min, max) = (bounds.min.as_dvec3(), bounds.max.as_dvec3());
    (0..8)
        .map(|i| {
            let pick = |bit: usize| if i >> bit & 1 == 0 { min[bit] } else { max[bit] };
            let p = view.transform_point3(DVec3::new(pick(0), pick(1), pick(2)));
            assert!(p.z < 0.0, "behind the camera: {p}");
            (p.y / (-p.z * tan)).abs().max((p.x / (-p.z * tan * aspect)).abs())
        })
        .fold(0.0, f64::max)
}

#[test]
fn the_whole_box_is_in_view_at_every_size() {
    for size in [1e-4f32, 1.0, 1e5] {
        for aspect in [0.3f32, 1.0, 3.0] {
            let corners = [[0.0, 0.0, 0.0], [size, 0.0, 0.0], [0.0, size * 0.1, 4.0 * size]];
            let scene = Gltf::of(&corners).open();
            let bounds = scene.bounds().unwrap();
            assert_eq!((bounds.min, bounds.max), (Vec3::ZERO, Vec3::new(size, size * 0.1, 4.0 * size)));
            let camera = scene.framing_camera(aspect);
            let filled = coverage(&camera, bounds, aspect.into());
            // In view with a margin of 5 %, and no smaller than that.
            assert!((filled - 1.0 / 1.05).abs() < 1e-6, "{size} {aspect}: {filled}");
            // From above, looking down, with y up.
            let m = camera.world_from_camera;
            assert!(m.y_axis.y > 0.0 && m.z_axis.y > 0.0 && m.x_axis.y.abs() < 1e-12);
            // Planted error: a slightly closer camera does not see the whole box.
            let mut nearer = camera.clone();
            nearer.world_from_camera.w_axis = m.w_axis - m.z_axis * 0.2 * f64::from(size);
            assert!(coverage(&nearer, bounds, aspect.into()) > filled);
        }
    }
}

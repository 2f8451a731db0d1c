//! Conventions of depth.

use super::*;
use bevy::camera::CameraProjection;

/// A projection whose depth is 0 at `near` and 1 at `far`.
fn perspective(near: f32, far: f32) -> Mat4 {
    let depth = far / (near - far);
    Mat4::from_cols(Vec4::X, Vec4::Y, Vec4::new(0.0, 0.0, depth, -1.0), Vec4::new(0.0, 0.0, depth * near, 0.0))
}

#[test]
fn depth_is_that_of_bevys_projections() {
    let projection = PerspectiveProjection { near: 0.25, ..default() };
    let infinite = DepthConvention::Reversed { near: 0.25, far: f32::INFINITY };
    assert_eq!(depth_convention(projection.get_clip_from_view()), Ok(infinite));
    // Reversed, with a far plane: the planes are swapped.
    let finite = perspective(100.0, 0.25);
    let Ok(DepthConvention::Reversed { near, far }) = depth_convention(finite) else { panic!("not reversed") };
    assert!((near - 0.25).abs() < 1e-4 && (far - 100.0).abs() < 0.1, "{near} {far}");
    let forward = perspective(0.25, 100.0);
    assert!(depth_convention(forward).is_err_and(|problem| problem.contains("reversed")));
    // A mirror's.
    let [mirror, turned] = [-2.0, 2.0].map(|offset| {
        let near_clip_plane = Vec4::new(0.3, 0.1, -0.9, offset);
        depth_convention(PerspectiveProjection { near_clip_plane, ..default() }.get_clip_from_view())
    });
    assert_eq!(mirror, Ok(DepthConvention::Reversed { near: NEAR, far: f32::INFINITY }));
    assert!(turned.is_err_and(|problem| problem.contains("near_clip_plane")));
    let flat = OrthographicProjection::default_3d();
    assert!(depth_convention(flat.get_clip_from_view()).is_ok());
    let forward = OrthographicProjection { near: flat.far, far: flat.near, ..flat }.get_clip_from_view();
    assert!(depth_convention(forward).is_err_and(|problem| problem.contains("reversed")));
}

//! Depth of orthographic cameras that move.

use super::*;
use bevy::camera::{CameraProjection, OrthographicProjection};
use bevy::math::{Quat, Vec3};
use bevy::transform::components::Transform;

const SIZE: UVec2 = UVec2::new(320, 180);

/// Disparity of a point that a camera shows, and the pixel.
fn shown(clip_from_world: Mat4, point: Vec3) -> (f64, [f32; 2]) {
    let ndc = clip_from_world.project_point3(point);
    let px = (Vec2::new(ndc.x, -ndc.y) + 1.0) * 0.5 * SIZE.as_vec2() - 0.5;
    ((SPAN * (f64::from(ndc.z) - 0.5)).exp(), px.to_array())
}

#[test]
fn a_moving_cameras_depths_are_foretold() {
    let mut projection = OrthographicProjection { scale: 0.05, far: 200.0, ..OrthographicProjection::default_3d() };
    projection.update(SIZE.x as f32, SIZE.y as f32);
    let clip_from_view = projection.get_clip_from_view();
    assert!(is_orthographic(clip_from_view) && depth_convention(clip_from_view).is_ok());
    let place = Transform::from_xyz(20.0, 30.0, 40.0).looking_at(Vec3::ZERO, Vec3::Y);
    let mut panned = place;
    panned.translation += Vec3::new(0.4, 0.0, -0.7);
    let mut turned = place;
    turned.rotate_around(Vec3::ZERO, Quat::from_rotation_y(0.02));
    let mut tilted = place;
    tilted.rotate_local_x(0.01);
    for past in [place, panned, turned, tilted] {
        let [now, past] = [place, past].map(|place| clip_from_view * place.to_matrix().inverse());
        let view = view(SIZE, Gaze::Lost, now, Some(past)).expect("a view");
        let row = view.previous_from_current.expect("motion")[2];
        for point in [[0.0, 0.0, 0.0], [4.0, -2.0, 1.0], [-5.0, 3.0, -6.0]].map(Vec3::from) {
            let ((is, px), (was, _)) = (shown(now, point), shown(past, point));
            let ray = view.geometry.ray(px);
            let stretch: f32 = (0..3).map(|i| row[i] * ray[i]).sum();
            let foretold = is / f64::from(stretch);
            // A tenth of the depth test's tolerance.
            assert!((foretold / was - 1.0).abs() < 2e-3, "{foretold} {was}");
        }
    }
}

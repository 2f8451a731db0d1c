//! Depth of mirrors.

use super::*;
use bevy::camera::{CameraProjection, PerspectiveProjection};

#[test]
fn plain_depth_is_that_of_the_distance() {
    let near_clip_plane = Vec4::new(0.3, 0.1, -0.9, -2.0);
    let clip_from_view = PerspectiveProjection { near_clip_plane, ..Default::default() }.get_clip_from_view();
    assert!(is_oblique(clip_from_view) && !is_oblique(plain(clip_from_view)));
    let size = UVec2::new(320, 180);
    for jitter in [Vec2::ZERO, Vec2::new(0.3, -0.4)] {
        let [by_x, by_y, constant, factor] = plane(clip_from_view, size, jitter).to_array();
        for point in [Vec4::new(1.0, 0.5, -6.0, 1.0), Vec4::new(-4.0, 2.0, -40.0, 1.0)] {
            let clip = clip_from_view * point;
            let ndc = clip / clip.w;
            let at = (Vec2::new(ndc.x, -ndc.y) + 1.0) * 0.5 * size.as_vec2() + jitter;
            let depth = (ndc.z - (by_x * at.x + by_y * at.y + constant)) * factor;
            let expected = NEAR / -point.z;
            assert!((depth / expected - 1.0).abs() < 1e-3, "{depth} {expected}");
        }
    }
}

//! Stereo views and gaze targets.

use super::scenes::made;
use afterimage::{Gaze, ViewGeometry};
use afterimage_lab::scene::{Camera, Environment, Pose, Triangles};
use afterimage_lab::trace::effects::Effects;
use afterimage_lab::trace::stereo::GazePoint;
use afterimage_lab::trace::view::View;
use afterimage_lab::trace::world::World;
use glam::{DVec3, Vec3};

const IPD_M: f64 = 0.063;
const SIZE: [u32; 2] = [400, 300];

fn head(eye: DVec3, target: DVec3) -> View {
    let geometry = ViewGeometry::flat(SIZE, 80.0).unwrap();
    View::new(geometry, Camera::look_at(eye, target, 45.0).world_from_camera)
}

/// Focal length along x in pixels.
fn focal_px(view: &View) -> f64 {
    1.0 / f64::from(view.geometry().scale_offset().0[0])
}

/// A wall perpendicular to the axis of a head at the origin that looks along -z.
fn wall(distance_m: f32) -> World {
    let mut still = Triangles::default();
    let corner = |x: f32, y: f32| Vec3::new(x * 3.0, y * 3.0, -1.0) * distance_m;
    still.push_quad([corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)], 0);
    World::new(&made("wall", vec![Default::default()], still, Pose::default(), Environment::Constant([1.0; 3])))
}

#[test]
fn eyes_stand_to_the_left_and_right_of_a_head_turned_anyhow() {
    for (eye, target) in [
        (DVec3::ZERO, DVec3::NEG_Z),
        (DVec3::new(3.0, 1.6, -2.0), DVec3::new(0.0, 0.5, 4.0)),
        (DVec3::new(1.0, 9.0, 0.0), DVec3::new(1.0, 0.0, 0.1)),
    ] {
        let head = head(eye, target);
        let [left, right] = head.stereo(IPD_M);
        let at = |v: &View| v.world_from_camera().w_axis.truncate();
        let apart = at(&right) - at(&left);
        assert!((apart - head.world_from_camera().x_axis.truncate() * IPD_M).length() < 1e-12, "{apart}");
        assert!(((at(&right) + at(&left)) * 0.5 - eye).length() < 1e-12);
        for v in [&left, &right] {
            assert_eq!(v.geometry(), head.geometry());
            assert_eq!(v.world_from_camera().x_axis, head.world_from_camera().x_axis);
            assert_eq!(v.world_from_camera().z_axis, head.world_from_camera().z_axis);
        }
    }
}

#[test]
fn gazes_converge_as_ipd_f_over_z() {
    let head = head(DVec3::ZERO, DVec3::NEG_Z);
    let [left, right] = head.stereo(IPD_M);
    for distance_m in [0.2, 0.6, 1.5, 10.0, 300.0] {
        let world = wall(distance_m);
        for gaze in [[199.5, 149.5], [120.25, 80.75], [390.0, 10.0]] {
            let point = GazePoint::seen(&world, &head, gaze, Effects::all());
            let GazePoint::At(at) = point else { panic!("the wall is missed: {point:?}") };
            assert!((at.z + f64::from(distance_m)).abs() < 1e-5 * f64::from(distance_m), "{at}");
            let [l, r] = [&left, &right].map(|eye| point.px(eye).unwrap());
            let disparity = IPD_M * focal_px(&head) / f64::from(distance_m);
            // The left eye sees the point to the right and the right eye to the left by the same amount, at the same
            // height.
            for (px, side) in [(l, 0.5), (r, -0.5)] {
                let expected = [f64::from(gaze[0]) + side * disparity, f64::from(gaze[1])];
                let off = (f64::from(px[0]) - expected[0]).hypot(f64::from(px[1]) - expected[1]);
                assert!(off < 2e-3, "{distance_m} m, gaze {gaze:?}: {px:?}, expected {expected:?}");
            }
            // The drop-in says the same of one ray and the distance along it.
            for (px, eye) in [(l, &left), (r, &right)] {
                let pose = eye.world_from_camera().to_cols_array_2d().map(|column| column.map(|v| v as f32));
                let ray = at.normalize().as_vec3().to_array();
                let gaze = Gaze::on_ray([0.0; 3], ray, at.length() as f32, pose);
                let Gaze::Direction { view } = gaze else { panic!("{gaze:?}") };
                let of_ray = eye.geometry().project(view).unwrap();
                assert!((0..2).all(|i| (of_ray[i] - px[i]).abs() < 2e-3), "{distance_m} m: {of_ray:?} {px:?}");
            }
        }
    }
}

#[test]
fn behind_the_eyes_there_is_no_pixel() {
    let head = head(DVec3::ZERO, DVec3::NEG_Z);
    for eye in head.stereo(IPD_M) {
        for point in [DVec3::new(0.1, 0.2, 1.0), DVec3::new(5.0, 0.0, 0.0), DVec3::NAN] {
            assert_eq!(GazePoint::At(point).px(&eye), None, "{point}");
        }
        assert_eq!(GazePoint::Far(DVec3::Z).px(&eye), None);
        // So near that the pixel overflows.
        assert_eq!(GazePoint::At(DVec3::new(1.0, 0.0, -1e-300)).px(&eye), None);
    }
    // A gaze that is not finite means the centre of the frame.
    let world = wall(2.0);
    let middle = GazePoint::seen(&world, &head, [199.5, 149.5], Effects::all());
    for nowhere in [[f32::NAN, 3.0], [0.0, f32::INFINITY]] {
        assert_eq!(GazePoint::seen(&world, &head, nowhere, Effects::all()), middle);
    }
}

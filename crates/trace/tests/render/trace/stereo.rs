//! Stereo views and gaze targets.

use super::scenes::made;
use crate::given::builtin;
use afterimage::{Gaze, ViewGeometry};
use afterimage_lab::device::Backend;
use afterimage_lab::scene::effects::Effects;
use afterimage_lab::scene::{Camera, Environment, Pose, Triangles};
use afterimage_lab::view::View;
use afterimage_trace::Tracer;
use afterimage_trace::film::Film;
use afterimage_trace::sampling::{Layers, Sampling};
use afterimage_trace::settings::TraceSettings;
use afterimage_trace::stereo::GazePoint;
use afterimage_trace::surfaces::Surfaces;
use afterimage_trace::work::Spans;
use afterimage_trace::world::World;
use glam::{DVec3, Vec3};

const IPD_M: f64 = 0.063;
const SIZE: [u32; 2] = [400, 300];

fn head(eye: DVec3, target: DVec3) -> View {
    let geometry = ViewGeometry::flat(SIZE, 80.0).unwrap();
    View::new(geometry, Camera::look_at(eye, target, 45.0).world_from_camera)
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
    let focal_px = 1.0 / f64::from(head.geometry().scale_offset().0[0]);
    for distance_m in [0.2, 0.6, 1.5, 10.0, 300.0] {
        let world = wall(distance_m);
        for gaze in [[199.5, 149.5], [120.25, 80.75], [390.0, 10.0]] {
            let point = GazePoint::seen(&world, &head, gaze, Effects::all());
            let GazePoint::At(at) = point else { panic!("the wall is missed: {point:?}") };
            assert!((at.z + f64::from(distance_m)).abs() < 1e-5 * f64::from(distance_m), "{at}");
            let [l, r] = [&left, &right].map(|eye| point.px(eye).unwrap());
            let disparity = IPD_M * focal_px / f64::from(distance_m);
            // The left eye sees the point to the right and the right eye to the left by the same amount, at the same
            // height.
            for (px, side, eye) in [(l, 0.5, &left), (r, -0.5, &right)] {
                let expected = [f64::from(gaze[0]) + side * disparity, f64::from(gaze[1])];
                let off = (f64::from(px[0]) - expected[0]).hypot(f64::from(px[1]) - expected[1]);
                assert!(off < 2e-3, "{distance_m} m, gaze {gaze:?}: {px:?}, expected {expected:?}");
                // The drop-in says the same of one ray and the distance along it.
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
fn eyes_are_parallel_where_there_is_nothing() {
    let sky = Environment::Constant([1.0; 3]);
    let world = World::new(&made("nothing", vec![], Triangles::default(), Pose::default(), sky));
    let head = head(DVec3::new(1.0, 2.0, 3.0), DVec3::new(-4.0, 0.0, 1.0));
    for gaze in [[199.5, 149.5], [17.0, 260.5]] {
        let point = GazePoint::seen(&world, &head, gaze, Effects::all());
        assert!(matches!(point, GazePoint::Far(_)), "{point:?}");
        for eye in head.stereo(IPD_M) {
            let px = point.px(&eye).unwrap();
            assert!((px[0] - gaze[0]).abs() < 1e-3 && (px[1] - gaze[1]).abs() < 1e-3, "{px:?} for {gaze:?}");
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

#[test]
fn both_eyes_see_the_same_place_where_they_look() {
    let scene = builtin("courtyard");
    let camera = scene.pose(0.0).cameras.first().cloned().unwrap_or_else(|| scene.framing_camera(4.0 / 3.0));
    let world = World::new(&scene);
    let effects = world.needs;
    let head = View::of_camera(&camera, SIZE, None).unwrap();
    let (mut hits, mut seen_by_both) = (0, 0);
    for i in 0..400_u32 {
        let gaze = [(i * 97 % 4000) as f32 / 10.0, (i * 61 % 3000) as f32 / 10.0];
        let point = GazePoint::seen(&world, &head, gaze, effects);
        let GazePoint::At(at) = point else { continue };
        hits += 1;
        let mut both = true;
        for eye in head.stereo(IPD_M) {
            let px = point.px(&eye).unwrap();
            // The eye sees the point itself at that pixel, or a nearer surface that hides it.
            let GazePoint::At(seen) = GazePoint::seen(&world, &eye, px, effects) else { panic!("{px:?} sees nothing") };
            let [own, there] = [at, seen].map(|p| eye.project(p).unwrap().1);
            assert!(there < own * (1.0 + 1e-4), "{there} m behind {own} m");
            both &= (seen - at).length() < 1e-3 * own;
        }
        seen_by_both += u32::from(both);
    }
    println!("{hits} of 400 gazes meet something, both eyes see the same in {seen_by_both}");
    assert!(hits > 200 && seen_by_both * 10 > hits * 9);
}

#[test]
fn depth_and_color_agree_at_the_gazes() {
    // A matte wall under a constant sky: both eyes see the same depth, and the same color except for noise.
    let (head, world) = (head(DVec3::ZERO, DVec3::NEG_Z), wall(0.7));
    let tracer = Tracer::new(&Backend::Cpu, &world, TraceSettings::default()).unwrap();
    let point = GazePoint::seen(&world, &head, [150.0, 200.0], Effects::all());
    let seen = head.stereo(IPD_M).map(|eye| {
        let px = point.px(&eye).unwrap().map(|v| v.round() as u32);
        let depth = Surfaces::trace(&world, &eye, &eye, Effects::all()).depth.at(px[0] as usize, px[1] as usize);
        let mut film = Film::new(SIZE);
        tracer.trace(&world, &eye, 0, &Spans::new([px], 0..4096), &mut film);
        let m = film.moments.at(px[0] as usize, px[1] as usize);
        (depth, m.mean.y, m.variance_of_mean().y)
    });
    let [(depth, color, variance), (other_depth, other_color, other_variance)] = seen;
    assert!((depth - 0.7).abs() < 1e-5 && (other_depth - 0.7).abs() < 1e-5, "{seen:?}");
    let z = (color - other_color) / (variance + other_variance).sqrt().max(1e-6);
    afterimage_testing::accept("colors of both eyes", afterimage_testing::p_of_z(f64::from(z)));
    assert!(color > 0.1);
}

#[test]
fn the_lens_stays_where_it_is_while_the_eye_turns() {
    let scene = builtin("courtyard");
    let world = World::new(&scene);
    let tracer = Tracer::new(&Backend::Cpu, &world, TraceSettings { max_depth: 1, ..Default::default() }).unwrap();
    // An off-centre projection, as for one eye of a headset.
    let size = [120, 100];
    let geometry = ViewGeometry::off_axis(size, [-1.2, 0.8], [-0.9, 0.9]).unwrap();
    let camera = scene.pose(0.0).cameras[0].world_from_camera;
    let view = View::new(geometry, camera);
    let layers = Sampling::Layers(Layers { lens_deg: Some(35.0), ..Layers::default() });
    // The ray along the axis.
    let axis = [120.0 * 0.6 - 0.5, 49.5];
    let radius = f64::from(35.0_f32.to_radians().tan()) * 120.0 / 2.0;
    for gaze in [[60.0, 50.0], [100.0, 20.0], [5.0, 95.0]] {
        let done = layers.plan(&geometry, gaze, 1, 0).trace(&tracer, &world, &view, 0);
        let full = Sampling::Layers(Layers::default()).plan(&geometry, gaze, 1, 0).trace(&tracer, &world, &view, 0);
        // What lies outside is not traced.
        let [some, all] = [&done, &full].map(|frame| frame.samples.iter().sum::<u64>());
        assert!(8 * some < 7 * all, "{some} of {all}");
        for (x, y) in (0..size[1] as usize).flat_map(|y| (0..size[0] as usize).map(move |x| (x, y))) {
            let off = (x as f64 - axis[0]).hypot(y as f64 - axis[1]) - radius;
            if off.abs() > 0.01 {
                let expected = if off > 0.0 { [0.0; 3] } else { full.color.at(x, y) };
                assert_eq!(done.color.at(x, y), expected, "at {x}, {y}, {off} px outside, gaze {gaze:?}");
            }
        }
    }
}

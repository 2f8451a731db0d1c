//! Depth and motion at pixel centres, against explicit projection in f64 and brute-force intersection.

use super::scenes::{shared, staged};
use crate::builder::Gltf;
use crate::raster::rays::rays;
use afterimage_lab::scene::{Camera, Environment, Scene, Triangles};
use afterimage_lab::view::View;
use afterimage_trace::surfaces::Surfaces;
use glam::{DMat4, DVec3};

const SIZE: [u32; 2] = [48, 36];
/// Tolerance of motion in pixels. Rays and tangents are f32, whose 1e-7 is about 1e-5 pixels here; motion has the error
/// of two of them.
const MOTION_PX: f64 = 5e-4;
/// Additional tolerance for long motion: motion grows as one over the distance from the previous camera's plane, its
/// error with the square of that.
const LONG: f64 = 3e-6;
const DEPTH: f64 = 2e-5;

/// Independent implementation of a pinhole camera.
struct Pinhole {
    world_from_camera: DMat4,
    px_per_tangent: f64,
}

impl Pinhole {
    fn new(camera: &Camera) -> Self {
        let half = (f64::from(camera.vfov_deg) / 2.0).to_radians().tan();
        Self { world_from_camera: camera.world_from_camera, px_per_tangent: f64::from(SIZE[1]) / 2.0 / half }
    }

    /// Eye and ray direction, whose component along the axis is 1.
    fn ray(&self, x: u32, y: u32) -> (DVec3, DVec3) {
        let at = |i: u32, n: u32| (f64::from(i) - (f64::from(n) - 1.0) / 2.0) / self.px_per_tangent;
        let m = self.world_from_camera;
        let w = m.x_axis * at(x, SIZE[0]) - m.y_axis * at(y, SIZE[1]) - m.z_axis;
        (m.w_axis.truncate(), w.truncate())
    }

    /// Pixel of a point `p` (`w` = 1), or of a direction `p` at infinity (`w` = 0).
    fn pixel(&self, p: DVec3, w: f64) -> Option<[f64; 2]> {
        let c = self.world_from_camera.inverse() * p.extend(w);
        let at = |v: f64, n: u32| v / -c.z * self.px_per_tangent + (f64::from(n) - 1.0) / 2.0;
        (c.z < 0.0).then(|| [at(c.x, SIZE[0]), at(-c.y, SIZE[1])])
    }
}

/// Nearest triangle along a ray by brute force: index, distance, weights of the corners.
fn nearest(t: &Triangles, origin: DVec3, w: DVec3) -> Option<(usize, f64, [f64; 3])> {
    let mut best: Option<(usize, f64, [f64; 3])> = None;
    for (i, corners) in t.positions.iter().enumerate() {
        let [a, b, c] = corners.map(|p| p.as_dvec3());
        // Cramer's rule (Moeller and Trumbore 1997).
        let (e, f) = (b - a, c - a);
        let n = w.cross(f);
        let det = e.dot(n);
        if det.abs() < 1e-18 {
            continue;
        }
        let s = origin - a;
        let u = s.dot(n) / det;
        let q = s.cross(e);
        let v = w.dot(q) / det;
        let along = f.dot(q) / det;
        if u >= 0.0 && v >= 0.0 && u + v <= 1.0 && along > 1e-9 && best.is_none_or(|b| along < b.1) {
            best = Some((i, along, [1.0 - u - v, u, v]));
        }
    }
    best
}

fn joined(scene: &Scene, time_s: f64) -> Triangles {
    let mut all = scene.still().clone();
    all.extend(&scene.pose(time_s).moving);
    all
}

fn traced(scene: &Scene, cameras: [&Camera; 2], times: [f64; 2]) -> Surfaces {
    let views = cameras.map(|camera| View::of_camera(camera, SIZE, None).unwrap());
    rays(scene, views.each_ref(), times)
}

/// Compares every pixel; returns the number of pixels with a surface and the longest motion.
fn check(scene: &Scene, [now, before]: [&Camera; 2], [time_s, previous_s]: [f64; 2]) -> (usize, f64) {
    let got = traced(scene, [now, before], [time_s, previous_s]);
    let (here, there) = (Pinhole::new(now), Pinhole::new(before));
    let (triangles, were) = (joined(scene, time_s), joined(scene, previous_s));
    let (mut seen, mut longest, mut off) = (0, 0.0f64, 0);
    for (x, y) in (0..SIZE[1]).flat_map(|y| (0..SIZE[0]).map(move |x| (x, y))) {
        let (eye, w) = here.ray(x, y);
        let (depth, past) = match nearest(&triangles, eye, w) {
            Some((i, along, weights)) => {
                seen += 1;
                let corners = were.positions[i].map(|p| p.as_dvec3());
                let was = (0..3).map(|k| corners[k] * weights[k]).sum::<DVec3>();
                (along, there.pixel(was, 1.0))
            }
            None => (f64::INFINITY, there.pixel(w, 0.0)),
        };
        let d = f64::from(got.depth.at(x as usize, y as usize));
        let m = got.motion.at(x as usize, y as usize).map(f64::from);
        let same_depth = d == depth || (d / depth - 1.0).abs() < DEPTH;
        let same_motion = past.map_or(m == [1e6, 1e6], |p| {
            let expected = [p[0] - f64::from(x), p[1] - f64::from(y)];
            let length = expected[0].hypot(expected[1]);
            longest = longest.max(length);
            (0..2).all(|k| (m[k] - expected[k]).abs() < MOTION_PX + LONG * length * length)
        });
        if !(same_depth && same_motion) {
            println!("{}: ({x}, {y}): depth {d} for {depth}, motion {m:?}, was at {past:?}", scene.name);
            off += 1;
        }
    }
    println!("{}: {seen} pixels see a surface, motion up to {longest:.2} pixels, {off} are off", scene.name);
    assert_eq!(off, 0, "{}", scene.name);
    (seen, longest)
}

fn stage() -> Scene {
    staged("stage", Environment::Constant([1.0; 3]), |_| {})
}

#[test]
fn a_moving_camera_and_what_was_behind_it() {
    let scene = stage();
    let now = scene.pose(0.0).cameras[0].clone();
    for (eye, target) in [
        ([0.0, 1.8, 6.0], [0.0, 1.2, 0.0]),
        ([0.3, 1.9, 6.2], [0.1, 1.0, 0.0]),
        ([-2.0, 3.0, 4.0], [0.0, 1.0, -1.0]),
        // All of it was behind, and from the middle of the stage parts of it.
        ([0.0, 1.8, 6.0], [0.0, 1.2, 12.0]),
        ([0.0, 1.0, 0.5], [0.0, 1.0, -3.0]),
    ] {
        let before = Camera::look_at(DVec3::from(eye), DVec3::from(target), 45.0);
        let (seen, _) = check(&scene, [&now, &before], [0.0, 0.0]);
        assert!(seen > 500 && seen < 48 * 36);
    }
}

#[test]
fn the_sky_follows_rotation_and_nothing_else() {
    let scene = stage();
    // Looks away from everything.
    let up = Camera::look_at(DVec3::new(0.0, 2.0, 0.0), DVec3::new(0.3, 12.0, 9.0), 45.0);
    let turned = Camera { world_from_camera: up.world_from_camera * DMat4::from_rotation_y(0.1), ..up.clone() };
    let moved =
        Camera { world_from_camera: DMat4::from_translation(DVec3::splat(3.0)) * up.world_from_camera, ..up.clone() };
    let (seen, longest) = check(&scene, [&up, &turned], [0.0, 0.0]);
    assert!(seen == 0 && longest > 1.0);
    let (_, longest) = check(&scene, [&up, &moved], [0.0, 0.0]);
    assert!(longest < 1e-9);
}

#[test]
fn skinned_and_morphing_bodies() {
    for (name, times) in [
        ("fox/Fox.glb", [0.40, 0.30]),
        ("animated_morph_cube/AnimatedMorphCube.gltf", [0.9, 0.7]),
        ("animated_morph_cube/AnimatedMorphCube.gltf", [0.1, 0.9]),
    ] {
        let Some(scene) = shared(name) else { return };
        let camera = scene.framing_camera(4.0 / 3.0);
        let (seen, longest) = check(&scene, [&camera, &camera], times);
        assert!(seen > 50 && longest > 0.3, "{name}");
        // The camera moves as well.
        let before =
            Camera { world_from_camera: camera.world_from_camera * DMat4::from_rotation_z(0.05), ..camera.clone() };
        check(&scene, [&camera, &before], times);
    }
}

/// A glTF file with a square that turns a quarter about y and rises 2 m in one second.
fn turning_square() -> Scene {
    let half = std::f32::consts::FRAC_1_SQRT_2;
    let corners = [[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [1.0, 1.0, 0.0], [-1.0, 1.0, 0.0]];
    let mut file = Gltf::new();
    let node = file.soup(&[0, 1, 2, 0, 2, 3].map(|i: usize| corners[i]));
    file.animate(node, "rotation", "LINEAR", &[0.0, 1.0], &[[0.0, 0.0, 0.0, 1.0], [0.0, half, 0.0, half]]);
    file.animate(node, "translation", "LINEAR", &[0.0, 1.0], &[[0.0; 3], [0.0, 2.0, 0.0]]);
    file.join_animations();
    file.open()
}

#[test]
fn a_rigid_body_moves_as_its_matrix_says() {
    let scene = turning_square();
    let camera = Camera::look_at(DVec3::new(1.0, 1.5, 6.0), DVec3::Y, 50.0);
    let [now_s, before_s] = [0.5, 0.4];
    let (seen, longest) = check(&scene, [&camera, &camera], [now_s, before_s]);
    assert!(seen > 100 && longest > 1.0);
    // Explicit matrix, without the scene's poses: constant speed about and along y.
    let at =
        |t: f64| DMat4::from_translation(DVec3::Y * 2.0 * t) * DMat4::from_rotation_y(t * std::f64::consts::FRAC_PI_2);
    let got = traced(&scene, [&camera; 2], [now_s, before_s]);
    let pinhole = Pinhole::new(&camera);
    let mut compared = 0;
    for (i, &depth) in got.depth.pixels().iter().enumerate().filter(|(_, d)| d.is_finite()) {
        let (x, y) = (i as u32 % SIZE[0], i as u32 / SIZE[0]);
        let (eye, w) = pinhole.ray(x, y);
        let local = at(now_s).inverse().transform_point3(eye + w * f64::from(depth));
        assert!(local.z.abs() < 1e-4, "off the square by {}", local.z);
        let was = pinhole.pixel(at(before_s).transform_point3(local), 1.0).unwrap();
        let m = got.motion.pixels()[i].map(f64::from);
        // The pose's matrices are f32.
        assert!((m[0] - was[0] + f64::from(x)).abs() < 2e-3 && (m[1] - was[1] + f64::from(y)).abs() < 2e-3, "{m:?}");
        compared += 1;
    }
    assert_eq!(compared, seen);
    // Planted error: a forgotten pose.
    let moving = |s: &Surfaces| s.motion.pixels().iter().filter(|m| m[0].hypot(m[1]) > 0.5).count();
    assert!(moving(&got) > 100 && moving(&traced(&scene, [&camera; 2], [now_s; 2])) == 0);
}

//! Depth and motion against closed forms in f64, reimplemented from the documentation of the scenes.

use super::{FPS, SIZE, frames, geometry, pixels, source};
use afterimage_lab::source::FrameSource;
use glam::{DMat3, DVec2, DVec3};
use std::collections::BTreeMap;

/// A pinhole camera in f64, reimplemented from the definition of the field of view.
struct Pinhole {
    focal: f64,
    middle: DVec2,
}

impl Pinhole {
    fn new(size: [u32; 2], hfov_deg: f64) -> Self {
        let [w, h] = size.map(f64::from);
        Self { focal: 0.5 * w / (0.5 * hfov_deg).to_radians().tan(), middle: DVec2::new(0.5 * w - 0.5, 0.5 * h - 0.5) }
    }

    fn ray(&self, px: DVec2) -> DVec3 {
        ((px - self.middle) / self.focal).extend(1.0)
    }

    fn project(&self, p: DVec3) -> DVec2 {
        DVec2::new(p.x, p.y) / p.z * self.focal + self.middle
    }
}

/// Distance of two vectors in pixels.
fn apart(measured: [f32; 2], exact: DVec2) -> f64 {
    (DVec2::from(measured.map(f64::from)) - exact).length()
}

/// Tolerance of a motion vector in single precision, in pixels at a width of 640. Measured: 3e-4.
const MOTION_TOLERANCE_PX: f64 = 1e-3;

/// What a closed form says of the surface point at a pixel's ray and distance: the name of its object, and where it was
/// in the axes of the previous camera. The sky is infinitely far.
type Past<'a> = &'a dyn Fn(DVec3, f64) -> (&'static str, DVec3);

/// Checks the motion of every pixel of a frame against `past`. Returns the number of pixels of each object and its
/// fastest motion in pixels.
fn check_motion(name: &str, index: u64, past: Past<'_>) -> BTreeMap<&'static str, (u32, f64)> {
    let pinhole = Pinhole::new(SIZE, 70.0);
    let frame = source(name, SIZE).frame(index).unwrap();
    let (depth, motion) = geometry(&frame);
    let mut objects = BTreeMap::new();
    let mut worst = 0.0_f64;
    for (x, y) in pixels(SIZE) {
        let px = DVec2::new(x as f64, y as f64);
        let (object, view) = past(pinhole.ray(px), f64::from(depth.at(x, y)));
        let exact = pinhole.project(view) - px;
        worst = worst.max(apart(motion.at(x, y), exact));
        let (count, fastest) = objects.entry(object).or_insert((0, 0.0_f64));
        (*count, *fastest) = (*count + 1, fastest.max(exact.length()));
    }
    println!("{name} frame {index}: worst error {worst:.2e} px, pixels and fastest motion {objects:.2?}");
    assert!(worst < MOTION_TOLERANCE_PX, "{worst} px in frame {index} of {name}");
    objects
}

#[test]
fn lateral_motion_is_parallax() {
    let camera = |t: f64| 0.5 * (2.0 * t).sin();
    let mut fastest = 0.0_f64;
    for index in [0_u64, 7, 60, 100_000] {
        let now = index as f64 / FPS;
        let step = DVec3::X * (camera(now) - camera(now - 1.0 / FPS));
        let past = |ray: DVec3, z: f64| ("all", if z.is_finite() { ray * z + step } else { ray });
        fastest = fastest.max(check_motion("lateral", index, &past)["all"].1);
    }
    assert!(fastest > 5.0 && fastest < 9.0);
}

#[test]
fn a_walk_turns_and_approaches_as_it_says() {
    let tau = std::f64::consts::TAU;
    // The head, reimplemented: its place, and the rotation from its axes (right, down, forward) to the world's.
    let head = |t: f64| {
        let wave = |most: f64, hz: f64| most * (tau * hz * t).sin();
        let place = DVec3::new(wave(0.02, 1.0), -wave(0.03, 2.0), 0.9 * (t.abs() % 6.0).min(6.0 - t.abs() % 6.0));
        let [yaw, nod, roll] = [wave(45.0 / (0.5 * tau), 0.5), wave(4.5, 2.0), wave(5.0, 1.0)].map(f64::to_radians);
        (place, DMat3::from_rotation_y(-yaw) * DMat3::from_rotation_x(nod) * DMat3::from_rotation_z(-roll))
    };
    let fastest = [1_u64, 30, 62, 95, 250].map(|index| {
        let [(place, axes), (past_place, past_axes)] = [0.0, 1.0].map(|ago| head((index as f64 - ago) / FPS));
        let past = |ray: DVec3, z: f64| {
            let seen = axes * ray;
            let there = if z.is_finite() { seen * z + place - past_place } else { seen };
            ("all", past_axes.transpose() * there)
        };
        check_motion("walk", index, &past)["all"].1
    });
    // 17 px at 480x270.
    let fastest = fastest.into_iter().fold(0.0, f64::max);
    assert!(fastest > 17.0 && fastest < 30.0);
}

/// Camera and moving objects of `occluder`, reimplemented.
struct Occluder {
    camera: [(DVec3, DMat3); 2],
    fence: [f64; 2],
    balls: [MovingBall; 2],
}

struct MovingBall {
    name: &'static str,
    centre: [DVec3; 2],
    radius: f64,
    /// Rotation from this frame to the previous one.
    back: DMat3,
}

impl Occluder {
    fn at(index: u64) -> Self {
        let times = [index as f64 / FPS, (index as f64 - 1.0) / FPS];
        let tau = std::f64::consts::TAU;
        let rolled = times.map(|t| 1.5 * (tau * t / 5.0).cos());
        let back = DMat3::from_rotation_z((rolled[1] - rolled[0]) / 0.5);
        let tilt = DMat3::from_rotation_z(0.4);
        let turn = tilt * DMat3::from_rotation_y(-0.8 / FPS) * tilt.transpose();
        Self {
            camera: times.map(|t| {
                let swing = (tau * t / 6.0).sin();
                (DVec3::new(0.35 * swing, 0.0, 0.0), DMat3::from_rotation_y(-0.03 * swing))
            }),
            fence: times.map(|t| -1.7 * (tau * t / 6.0 + 0.6).cos()),
            balls: [
                MovingBall { name: "rolling ball", centre: rolled.map(|x| DVec3::new(x, 1.1, 3.3)), radius: 0.5, back },
                MovingBall { name: "globe", centre: [DVec3::new(-1.25, 0.28, 4.9); 2], radius: 0.42, back: turn },
            ],
        }
    }

    /// Name of the object at a pixel, identified by depth, and the previous position of its surface point. Static
    /// objects are "rest".
    fn previous(&self, ray: DVec3, depth: f64) -> (&'static str, DVec3) {
        let (origin, axes) = self.camera[0];
        let point = origin + axes * ray * depth;
        if (point.z - 2.0).abs() < 1e-4 && (point.x - self.fence[0]).abs() < 0.8 && point.y < 1.599 {
            let shift = DVec3::new(self.fence[1] - self.fence[0], 0.0, 0.0);
            return ("fence", point + shift);
        }
        for ball in &self.balls {
            let local = point - ball.centre[0];
            if (local.length() - ball.radius).abs() < 1e-4 {
                return (ball.name, ball.centre[1] + ball.back * local);
            }
        }
        ("rest", point)
    }
}

#[test]
fn occluder_motion_follows_objects_and_camera() {
    let mut counts = BTreeMap::<&str, u32>::new();
    for index in [0, 40, 75, 200] {
        let world = Occluder::at(index);
        let (before, axes) = world.camera[1];
        let past = |ray: DVec3, z: f64| {
            if z.is_infinite() {
                return ("sky", axes.transpose() * (world.camera[0].1 * ray));
            }
            let (object, previous) = world.previous(ray, z);
            (object, axes.transpose() * (previous - before))
        };
        for (object, (count, _)) in check_motion("occluder", index, &past) {
            *counts.entry(object).or_default() += count;
        }
    }
    assert_eq!(counts.len(), 5, "every moving thing was met: {counts:?}");
    assert!(counts.values().all(|&count| count > 1000), "{counts:?}");
}

#[test]
fn camera_matrix_agrees_with_motion_and_previous_depth() {
    let pinhole = Pinhole::new(SIZE, 70.0);
    for name in ["lateral", "turn", "walk", "occluder"] {
        let [before, now] = frames(name, [79, 80]);
        let (depth, motion) = geometry(&now);
        let (previous_depth, _) = geometry(&before);
        let matrix = now.previous_from_current.unwrap().map(|r| r.map(f64::from));
        assert_eq!(matrix[3], [0.0, 0.0, 0.0, 1.0]);
        let world = Occluder::at(80);
        let (mut agree, mut seen, mut worst) = (0, 0, 0.0_f64);
        for (x, y) in pixels(SIZE) {
            let z = f64::from(depth.at(x, y));
            let px = DVec2::new(x as f64, y as f64);
            let ray = pinhole.ray(px);
            if z.is_infinite() || (name == "occluder" && world.previous(ray, z).0 != "rest") {
                continue;
            }
            let p = (ray * z).extend(1.0).to_array();
            let row = |i: usize| (0..4).map(|k| matrix[i][k] * p[k]).sum::<f64>();
            let moved = DVec3::new(row(0), row(1), row(2));
            let target = pinhole.project(moved);
            worst = worst.max(apart(motion.at(x, y), target - px));
            let (tx, ty) = (target.x.round(), target.y.round());
            if (0.0..640.0).contains(&tx) && (0.0..360.0).contains(&ty) {
                seen += 1;
                let there = f64::from(previous_depth.at(tx as usize, ty as usize));
                agree += u32::from((there - moved.z).abs() < 0.03 * moved.z);
            }
        }
        let share = f64::from(agree) / f64::from(seen);
        println!("{name}: motion differs by {worst:.2e} px, previous depth agrees at {share:.4}");
        assert!(worst < MOTION_TOLERANCE_PX);
        assert!(share > 0.95, "the rest is disocclusion");
    }
}

#[test]
fn depth_is_that_of_planes_and_balls() {
    let pinhole = Pinhole::new(SIZE, 70.0);
    let frame = source("still", SIZE).frame(0).unwrap();
    let (depth, _) = geometry(&frame);
    let ball = DVec3::new(0.05, 1.22, 4.75);
    let (mut met, mut worst) = ([0; 3], [0.0_f64; 3]);
    for (x, y) in pixels(SIZE) {
        let ray = pinhole.ray(DVec2::new(x as f64, y as f64));
        let length2 = ray.length_squared();
        let along = ray.dot(ball) / length2;
        let chord2 = 0.38_f64.powi(2) - (ball - ray * along).length_squared();
        // Open floor between the balls and the notice board, bare bricks below the prints. The slope of the ball's
        // surface amplifies a lateral rounding error in depth.
        let (kind, exact, steep) = if chord2 > 1e-4 {
            (0, along - (chord2 / length2).sqrt(), 0.38 / chord2.sqrt())
        } else if chord2 > -1e-4 {
            continue;
        } else if (200..420).contains(&x) && y >= 345 && !(225..280).contains(&x) {
            (1, 1.6 / ray.y, 1.0)
        } else if (265..415).contains(&x) && (225..255).contains(&y) {
            (2, 8.0, 1.0)
        } else {
            continue;
        };
        met[kind] += 1;
        worst[kind] = worst[kind].max((f64::from(depth.at(x, y)) - exact).abs() / (exact * steep));
    }
    println!("ball, floor, wall: {met:?} pixels, worst relative errors {worst:?}");
    assert!(worst.iter().all(|&e| e < 1e-6), "{worst:?}");
    assert!(met.iter().all(|&n| n > 1000), "{met:?}");
    assert_eq!(depth.at(320, 5), f32::INFINITY);
}

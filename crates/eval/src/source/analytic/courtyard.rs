//! Objects of the courtyard, and of each scene set in it. Metres and seconds; the eye is 1.6 m above the floor.

use super::scene::{Camera, Object, Pose, Scene};
use super::shape::{Cutout, Shape};
use super::texture::Material;
use crate::source::gait::Head;
use glam::{DVec3, Mat3, Vec2, Vec3};
use std::f64::consts::TAU;

/// y of the floor; y points down.
pub(super) const FLOOR: f32 = 1.6;
/// x of the left and right walls, z of the back wall.
pub(super) const LEFT: f32 = -3.6;
pub(super) const RIGHT: f32 = 3.9;
pub(super) const BACK: f32 = 8.0;

fn fixed(shape: Shape, material: Material) -> Object {
    Object { shape, material, path: None }
}

fn rect(centre: [f32; 3], u: Vec3, v: Vec3, half: [f32; 2], material: Material) -> Object {
    let shape = Shape::Rect { centre: centre.into(), u, v, half: half.into(), cutout: Cutout::Solid };
    fixed(shape, material)
}

fn ball(centre: [f32; 3], radius: f32, material: Material) -> Object {
    let shape = Shape::Sphere { centre: centre.into(), radius };
    fixed(shape, material)
}

/// A post from the floor up to `top`.
fn post(x: f32, z: f32, radius: f32, top: f32, material: Material) -> Object {
    let shape = Shape::Post { centre: Vec3::new(x, 0.5 * (FLOOR + top), z), radius, half_height: 0.5 * (FLOOR - top) };
    fixed(shape, material)
}

fn block(centre: [f32; 3], half: [f32; 3], material: Material) -> Object {
    let shape = Shape::Block { centre: centre.into(), half: half.into(), axes: Mat3::IDENTITY };
    fixed(shape, material)
}

fn still_camera(_: f64) -> Camera {
    Camera::looking(Vec3::ZERO, 0.0, 0.0)
}

const STONE: Material = Material::Plaster([0.62, 0.57, 0.48]);

/// Floor, walls, and the pictures and rugs on them. The floor comes first.
fn walls() -> Vec<Object> {
    vec![
        rect([0.0, FLOOR, 5.0], Vec3::X, Vec3::Z, [14.0, 11.0], Material::Floor),
        rect([0.15, -0.1, BACK], Vec3::X, Vec3::Y, [3.75, 1.7], Material::Bricks),
        rect([LEFT, -0.1, 3.0], Vec3::Z, Vec3::Y, [5.0, 1.7], Material::Azulejo),
        rect([RIGHT, -0.1, 3.0], Vec3::NEG_Z, Vec3::Y, [5.0, 1.7], Material::Azulejo),
        block([0.15, -1.88, 8.1], [3.9, 0.08, 0.22], STONE),
        block([-3.72, -1.88, 3.0], [0.2, 0.08, 5.0], STONE),
        block([4.02, -1.88, 3.0], [0.2, 0.08, 5.0], STONE),
        rect([0.45, -0.35, 7.93], Vec3::X, Vec3::Y, [2.25, 1.05], Material::Gallery),
        rect([-3.57, -0.85, 6.2], Vec3::Z, Vec3::Y, [0.9, 0.62], Material::Rug),
        rect([3.87, -0.85, 6.0], Vec3::NEG_Z, Vec3::Y, [0.9, 0.62], Material::Rug),
    ]
}

/// Free-standing objects: columns, trees behind the wall, a bench, a globe on its pedestal, balls.
fn things() -> Vec<Object> {
    const OAK: [f32; 3] = [0.40, 0.24, 0.12];
    vec![
        post(-2.45, 7.2, 0.17, -1.8, STONE),
        post(3.1, 7.2, 0.17, -1.8, STONE),
        ball([-3.0, -2.5, 12.0], 1.6, Material::Foliage),
        ball([4.4, -3.0, 13.0], 2.2, Material::Foliage),
        ball([1.2, -2.2, 14.0], 1.5, Material::Foliage),
        block([-3.0, 1.12, 5.6], [0.28, 0.04, 1.0], Material::Planks(OAK)),
        block([-3.0, 1.38, 5.0], [0.22, 0.22, 0.08], STONE),
        block([-3.0, 1.38, 6.2], [0.22, 0.22, 0.08], STONE),
        block([-1.25, 1.15, 4.9], [0.27, 0.45, 0.27], STONE),
        ball([-1.25, 0.28, 4.9], 0.42, Material::Globe),
        ball([0.05, 1.22, 4.75], 0.38, Material::BeachBall),
        ball([-0.62, 1.38, 4.15], 0.22, Material::Chequer),
        ball([2.75, 1.1, 6.2], 0.5, Material::Marble),
    ]
}

/// A notice board on two legs, turned a little to the left.
fn notice() -> Vec<Object> {
    const OAK: Material = Material::Timber([0.30, 0.17, 0.08]);
    let (sin, cos) = 0.3_f32.sin_cos();
    let u = Vec3::new(cos, 0.0, -sin);
    let centre = Vec3::new(1.55, 0.42, 4.0);
    let half = [0.62, 0.44];
    let leg = |side: f32| {
        let foot = centre + u * (side * 0.56) + Vec3::new(0.02, 0.0, 0.05);
        post(foot.x, foot.z, 0.03, -0.1, OAK)
    };
    vec![rect(centre.to_array(), u, Vec3::Y, half, Material::Notice(half)), leg(-1.0), leg(1.0)]
}

fn scene(extra: Vec<Object>, camera: fn(f64) -> Camera) -> Scene {
    let mut objects = walls();
    objects.extend(things());
    objects.extend(extra);
    Scene { objects, camera, floor: 0, panel: None, ambient: 1.0 }
}

/// `still` and `light-step`.
pub(super) fn still() -> Scene {
    let mut extra = notice();
    extra.push(post(1.42, 2.3, 0.05, -3.0, Material::Spiral));
    scene(extra, still_camera)
}

/// `lateral`: the camera oscillates by half a metre to either side, 1 m/s at the middle, past posts 1 m to 2.4 m away.
pub(super) fn lateral() -> Scene {
    let mut extra = notice();
    for (x, z) in [(-0.6, 1.0), (0.36, 1.4), (1.25, 1.9), (-1.6, 2.4)] {
        extra.push(post(x, z, 0.05, -3.0, Material::Spiral));
    }
    scene(extra, |t| {
        let x = 0.5 * (2.0 * t).sin();
        Camera::looking(Vec3::new(x as f32, 0.0, 0.0), 0.0, 0.0)
    })
}

/// `turn`: the camera oscillates by 8 degrees to the left and right, and by 3 up and down.
pub(super) fn turn() -> Scene {
    scene(notice(), |t| {
        let (yaw, pitch) = (0.14 * (2.0 * t).sin(), 0.05 * (1.4 * t).sin());
        Camera::looking(Vec3::ZERO, yaw as f32, pitch as f32)
    })
}

/// `walk`: the head of a person who walks ahead, past posts 0.4 m to the side.
pub(super) fn walk() -> Scene {
    let mut extra = notice();
    for (x, z) in [(0.4, 1.3), (-0.4, 1.9), (0.6, 2.5), (-0.9, 3.2)] {
        extra.push(post(x, z, 0.05, -3.0, Material::Spiral));
    }
    scene(extra, |t| {
        let head = Head::at(t);
        let origin = DVec3::new(head.right_m, -head.up_m, head.ahead_m).as_vec3();
        let level = Camera::looking(origin, -head.yaw as f32, -head.nod as f32);
        Camera { axes: level.axes * Mat3::from_rotation_z(-head.roll as f32), ..level }
    })
}

/// `occluder`: a fence and a rolling ball pass in front of a camera that translates and rotates a little; the globe
/// spins.
pub(super) fn occluder() -> Scene {
    let mut extra = notice();
    extra.push(Object {
        shape: Shape::Rect {
            centre: Vec3::new(0.0, 0.95, 2.0),
            u: Vec3::X,
            v: Vec3::Y,
            half: Vec2::new(0.8, 0.65),
            cutout: Cutout::Pickets,
        },
        material: Material::Picket,
        path: Some(|t| Pose {
            offset: Vec3::new((-1.7 * (TAU * t / 6.0 + 0.6).cos()) as f32, 0.0, 0.0),
            spin: Mat3::IDENTITY,
        }),
    });
    const ROLLING: f32 = 0.5;
    extra.push(Object {
        path: Some(|t| {
            let x = 1.5 * (TAU * t / 5.0).cos();
            Pose {
                offset: Vec3::new(x as f32, 0.0, 0.0),
                spin: Mat3::from_rotation_z((x / f64::from(ROLLING)) as f32) * Mat3::from_rotation_x(1.2),
            }
        }),
        ..ball([0.0, FLOOR - ROLLING, 3.3], ROLLING, Material::BeachBall)
    });
    let mut scene = scene(extra, |t| {
        let swing = (TAU * t / 6.0).sin();
        Camera::looking(Vec3::new((0.35 * swing) as f32, 0.0, 0.0), (-0.03 * swing) as f32, 0.0)
    });
    for object in &mut scene.objects {
        if object.material == Material::Globe {
            object.path = Some(|t| Pose {
                offset: Vec3::ZERO,
                spin: Mat3::from_rotation_z(0.4) * Mat3::from_rotation_y((0.8 * t).rem_euclid(TAU) as f32),
            });
        }
    }
    scene
}

/// `spin`: a box turns in front of the wall and sways. Nearly all light comes from the sun, so each side comes out of
/// near-black shadow as it turns to the left.
pub(super) fn spin() -> Scene {
    let mut objects = walls();
    objects.push(Object {
        path: Some(|t| Pose {
            offset: Vec3::new((0.4 * t.sin()) as f32, (0.1 * (1.7 * t).sin()) as f32, 0.0),
            spin: Mat3::from_rotation_y((1.5 * t).rem_euclid(TAU) as f32) * Mat3::from_rotation_x(0.35),
        }),
        ..block([-0.2, 0.0, 6.4], [0.55; 3], Material::Gallery)
    });
    // Near the wall the roof of slats does not shade the box.
    let camera = |_: f64| Camera::looking(Vec3::new(0.0, 0.0, 2.9), 0.0, 0.0);
    Scene { objects, camera, floor: 0, panel: None, ambient: 0.02 }
}

/// Half size of the scrolling panel in metres, and its distance.
const PANEL_HALF: [f32; 2] = [0.72, 0.62];
const PANEL_Z: f32 = 3.4;

/// `scroll`: a panel that faces the camera shows a scrolling page. The panel is the last object.
pub(super) fn scroll() -> Scene {
    let panel =
        rect([1.05, 0.15, PANEL_Z], Vec3::X, Vec3::Y, PANEL_HALF, Material::Scroll { half: PANEL_HALF, shift: 0.0 });
    let legs = [0.4, 1.7].map(|x| post(x, PANEL_Z + 0.06, 0.03, -0.3, Material::Timber([0.05, 0.05, 0.06])));
    let mut scene = scene(legs.to_vec(), still_camera);
    scene.panel = Some(scene.objects.len());
    scene.objects.push(panel);
    scene
}

/// Metres on the panel that correspond to `px` pixels of a view with `tangent_per_px`.
pub(super) fn panel_metres(px: f64, tangent_per_px: f64) -> f64 {
    px * tangent_per_px * f64::from(PANEL_Z)
}

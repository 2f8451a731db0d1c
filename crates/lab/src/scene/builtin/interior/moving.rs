//! What moves: a camera, a fan, and a figure whose shadow the sun casts.

use super::lamps;
use super::materials::{FAN, METAL, SHIRT, SKIN, TROUSERS};
use super::rig::Rig;
use super::solids::{Rod, hoop, surface, wire};
use crate::scene::animated::Animated;
use crate::scene::builtin::shapes::Ellipsoid;
use crate::scene::{Camera, Triangles};
use glam::{DQuat, DVec3, Quat, Vec3};
use std::f64::consts::PI;

/// Vertical field of view of both cameras, degrees.
const VFOV_DEG: f32 = 58.0;

/// Middle of the fan's rotor, metres.
const FAN_HUB: [f32; 3] = [1.75, 1.2, -2.1];
/// Radius of the fan's cage, metres.
const CAGE_RADIUS_M: f32 = 0.26;
/// Turns of the rotor in the loop of 8 s. A blade's tip moves 3 cm in a frame of 1/60 s.
const ROTOR_TURNS: f64 = 10.0;

/// Middle and half axes of the ellipse on which the figure walks, metres.
const WAY_MIDDLE: [f64; 2] = [-0.15, -1.95];
const WAY_RADII: [f64; 2] = [1.15, 0.42];
/// Pairs of steps in the loop.
const STRIDES: f64 = 6.0;
/// Height of the hips, and lengths of thigh and upper arm, metres.
const HIP_M: f64 = 0.86;
const THIGH_M: f32 = 0.43;
const UPPER_ARM_M: f32 = 0.29;

/// Cameras, sun, fan and figure.
pub(super) fn animated() -> Animated {
    let mut rig = Rig::default();
    rig.sun(Vec3::new(-0.22, -0.72, 1.0), [13.0, 11.6, 9.2]);
    lamps::shine(&mut rig);
    add_cameras(&mut rig);
    add_rotor(&mut rig);
    add_figure(&mut rig);
    rig.finish()
}

fn add_cameras(rig: &mut Rig) {
    let still = rig.node(None, [0.9, 1.55, 2.9]);
    let pose = Camera::look_at(DVec3::new(0.9, 1.55, 2.9), DVec3::new(0.3, 1.0, -1.5), VFOV_DEG).world_from_camera;
    rig.set_rotation(still, DQuat::from_mat4(&pose));
    rig.camera(still, "still", VFOV_DEG);
    let walk = rig.node(None, [0.0; 3]);
    // It starts in the middle of its way, at full speed, so that short runs see it move.
    rig.shift(walk, |phase| DVec3::new(0.95, 1.5 + 0.012 * (14.0 * phase).sin(), 1.4 - 1.05 * phase.sin()));
    rig.turn(walk, |phase| {
        let yaw = -0.22 - 0.24 * (2.0 * phase).sin();
        DQuat::from_rotation_y(yaw) * DQuat::from_rotation_x(-0.16)
    });
    rig.camera(walk, "walk", VFOV_DEG);
}

/// Appends what stands still of the fan: foot, pole, motor, and a cage of wires.
pub(super) fn push_fan_stand(out: &mut Triangles) {
    let hub = Vec3::from(FAN_HUB);
    let behind = hub - Vec3::Z * 0.12;
    Rod { from: Vec3::new(hub.x, 0.0, behind.z), to: Vec3::new(hub.x, 0.03, behind.z), radii_m: [0.2, 0.16] }
        .push(48, FAN, out);
    Rod::even([hub.x, 0.03, behind.z], behind.to_array(), 0.014).push(24, METAL, out);
    Rod { from: behind - Vec3::Z * 0.08, to: hub - Vec3::Z * 0.02, radii_m: [0.05, 0.07] }.push(32, FAN, out);
    for z in [-0.05, 0.07] {
        hoop(hub + Vec3::Z * z, CAGE_RADIUS_M, 0.003, METAL, out);
        hoop(hub + Vec3::Z * z, 0.6 * CAGE_RADIUS_M, 0.0015, METAL, out);
        push_spokes(hub + Vec3::Z * z, out);
    }
}

fn push_spokes(middle: Vec3, out: &mut Triangles) {
    for spoke in 0..32 {
        let outwards = Quat::from_rotation_z(spoke as f32 / 32.0 * std::f32::consts::TAU) * Vec3::X;
        wire(middle + outwards * 0.05, middle + outwards * CAGE_RADIUS_M, 0.0015, METAL, out);
    }
}

fn add_rotor(rig: &mut Rig) {
    let node = rig.node(None, FAN_HUB.map(f64::from));
    rig.turn(node, |phase| DQuat::from_rotation_z(ROTOR_TURNS * phase));
    let mut rotor = Triangles::default();
    Rod::even([0.0, 0.0, -0.02], [0.0, 0.0, 0.04], 0.04).push(32, FAN, &mut rotor);
    for blade in 0..4 {
        let turned = Quat::from_rotation_z(blade as f32 * std::f32::consts::FRAC_PI_2);
        // Blades widen outwards and are pitched.
        surface(&mut rotor, [12, 6], FAN, |u, v| {
            let (along, across) = (0.035 + 0.2 * u, (v - 0.5) * (0.05 + 0.11 * u));
            turned * Vec3::new(along, across, 0.35 * across)
        });
    }
    rig.attach(node, &rotor);
}

fn add_figure(rig: &mut Rig) {
    let body = rig.node(None, [0.0; 3]);
    rig.shift(body, |phase| {
        let ([x, z], [a, b]) = (WAY_MIDDLE, WAY_RADII);
        let bob = 0.018 * (2.0 * STRIDES * phase).cos();
        DVec3::new(x + a * phase.cos(), HIP_M + bob, z + b * phase.sin())
    });
    // It looks along +z before it turns into the direction of its way.
    rig.turn(body, |phase| {
        let [a, b] = WAY_RADII;
        DQuat::from_rotation_y((-a * phase.sin()).atan2(b * phase.cos()))
    });
    rig.attach(body, &torso());
    for (side, begin) in [(-1.0, 0.0), (1.0, PI)] {
        add_leg(rig, body, side, begin);
        add_arm(rig, body, side, begin + PI);
    }
}

fn torso() -> Triangles {
    let mut out = Triangles::default();
    let mut part = |center: [f32; 3], radii: [f32; 3], material| {
        let (center, radii) = (Vec3::from(center), Vec3::from(radii));
        Ellipsoid { center, radii, rotation: Quat::IDENTITY, around: 48, rings: 32 }.push(material, &mut out);
    };
    part([0.0, 0.03, 0.0], [0.16, 0.14, 0.12], TROUSERS);
    part([0.0, 0.32, 0.0], [0.19, 0.3, 0.12], SHIRT);
    part([0.0, 0.64, 0.0], [0.05, 0.1, 0.05], SKIN);
    part([0.0, 0.78, 0.02], [0.085, 0.12, 0.1], SKIN);
    out
}

/// Thigh, shin and foot. The thigh swings about the hip, and the knee bends while the leg swings forwards.
fn add_leg(rig: &mut Rig, body: u32, side: f64, begin: f64) {
    let hip = rig.node(Some(body), [0.09 * side, 0.0, 0.0]);
    rig.turn(hip, |phase| DQuat::from_rotation_x(-0.42 * (STRIDES * phase + begin).sin()));
    rig.attach(hip, &limb(THIGH_M, [0.06, 0.085], TROUSERS));
    let knee = rig.node(Some(hip), [0.0, -f64::from(THIGH_M), 0.0]);
    rig.turn(knee, |phase| DQuat::from_rotation_x(0.12 + 0.75 * (STRIDES * phase + begin).cos().max(0.0)));
    let mut shin = limb(THIGH_M - 0.06, [0.04, 0.06], TROUSERS);
    let (center, radii) = (Vec3::new(0.0, -THIGH_M + 0.035, 0.06), Vec3::new(0.045, 0.04, 0.12));
    Ellipsoid { center, radii, rotation: Quat::IDENTITY, around: 32, rings: 20 }.push(FAN, &mut shin);
    rig.attach(knee, &shin);
}

fn add_arm(rig: &mut Rig, body: u32, side: f64, begin: f64) {
    let shoulder = rig.node(Some(body), [0.22 * side, 0.52, 0.0]);
    rig.turn(shoulder, |phase| DQuat::from_rotation_x(-0.5 * (STRIDES * phase + begin).sin()));
    rig.attach(shoulder, &limb(UPPER_ARM_M, [0.035, 0.05], SHIRT));
    let elbow = rig.node(Some(shoulder), [0.0, -f64::from(UPPER_ARM_M), 0.0]);
    rig.turn(elbow, |phase| DQuat::from_rotation_x(-0.4 - 0.2 * (STRIDES * phase + begin).sin()));
    rig.attach(elbow, &limb(0.27, [0.03, 0.036], SKIN));
}

/// A limb that hangs from the origin, with round ends.
fn limb(length_m: f32, radii_m: [f32; 2], material: u32) -> Triangles {
    let mut out = Triangles::default();
    let [end, start] = radii_m;
    let to = Vec3::ZERO;
    let from = Vec3::NEG_Y * length_m;
    Rod { from, to, radii_m }.push_side(32, material, &mut out);
    for (center, radius) in [(to, start), (from, end)] {
        let radii = Vec3::splat(radius);
        Ellipsoid { center, radii, rotation: Quat::IDENTITY, around: 32, rings: 20 }.push(material, &mut out);
    }
    out
}

//! Animation: nodes, skins and morph targets, and their pose at a time.

pub(crate) mod curve;
pub(crate) mod nodes;

use super::geometry::{Geometry, Posed};
use super::{Camera, Pose, PunctualLight, Triangles};
use curve::Curve;
use glam::{Affine3A, DAffine3, DMat4, DVec3};
use nodes::{Local, Nodes};
use rayon::prelude::*;
use std::collections::HashMap;
use std::sync::Arc;

/// The animated part of a scene. Meshes stay in local space; a pose transforms them.
#[derive(Clone, Debug, Default)]
pub(crate) struct Animated {
    pub nodes: Nodes,
    /// World transforms of the nodes without animation.
    pub rest_worlds: Vec<DAffine3>,
    /// Animated nodes and their descendants, parents first.
    pub moving_order: Vec<u32>,
    pub channels: Vec<Channel>,
    /// Time of the first key in seconds, at which the animation starts: before it, nothing moves.
    pub begin_s: f64,
    /// Duration of the animation from there, in seconds; 0 for a single pose.
    pub duration_s: f64,
    pub skins: Vec<Skin>,
    pub meshes: Vec<Mesh>,
    pub lights: Vec<Light>,
    pub cameras: Vec<View>,
}

/// A curve and the property that it animates.
#[derive(Clone, Debug)]
pub(crate) struct Channel {
    pub node: u32,
    pub property: Property,
    pub curve: Curve,
}

/// Animated property of a node.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Property {
    Translation,
    Rotation,
    Scale,
    Weights,
}

/// Joints of a skin.
#[derive(Clone, Debug)]
pub(crate) struct Skin {
    pub joints: Vec<u32>,
    /// Inverse bind matrices: from mesh space to each joint's space.
    pub inverse_bind: Vec<DAffine3>,
}

/// An instance of a mesh.
#[derive(Clone, Debug)]
pub(crate) struct Mesh {
    pub node: u32,
    /// Node whose weights it has: `node`, or the one of which that is an instance.
    pub owner: u32,
    pub geometry: Arc<Geometry>,
    /// Index into the skins. A skinned mesh ignores its node's transform.
    pub skin: Option<u32>,
    /// Morph target weights without animation.
    pub weights: Arc<[f32]>,
}

/// A light at the origin of its node, shining along -z.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Light {
    pub node: u32,
    pub light: PunctualLight,
}

/// A camera at the origin of its node.
#[derive(Clone, Debug)]
pub(crate) struct View {
    pub node: u32,
    pub name: String,
    pub vfov_deg: f32,
}

/// Node transforms, joint matrices and morph weights at a time.
pub(crate) struct AnimationState {
    pub worlds: Vec<DAffine3>,
    /// Joint matrices of each skin, from mesh space to world space.
    joints: Vec<Vec<Affine3A>>,
    /// Animated morph target weights, by node.
    weights: HashMap<u32, Vec<f32>>,
}

impl Animated {
    /// Triangles, lights and cameras `time_s` seconds into the animation, which loops.
    pub fn pose(&self, time_s: f64) -> Pose {
        let state = self.evaluate(time_s);
        let parts: Vec<Triangles> = self
            .meshes
            .par_iter()
            .map(|mesh| {
                let mut out = Triangles::default();
                mesh.geometry.push_triangles(&self.posed(mesh, &state), false, &mut out);
                out
            })
            .collect();
        let mut moving = Triangles::default();
        moving.reserve(parts.iter().map(Triangles::len).sum());
        for part in &parts {
            moving.extend(part);
        }
        let lights = self.lights.iter().map(|l| placed(l, &state.worlds)).collect();
        let cameras = self.cameras.iter().map(|c| c.placed(&state.worlds)).collect();
        Pose { moving, lights, cameras }
    }

    /// Vertices of a mesh in an animation state.
    pub fn posed(&self, mesh: &Mesh, state: &AnimationState) -> Posed {
        let weights = state.weights.get(&mesh.owner).map_or(&*mesh.weights, |w| w);
        match mesh.skin {
            Some(skin) => mesh.geometry.skinned(&state.joints[skin as usize], weights),
            None => mesh.geometry.transformed(&state.worlds[mesh.node as usize], weights),
        }
    }

    /// Evaluates all curves at a time, in seconds from the first key.
    pub fn evaluate(&self, time_s: f64) -> AnimationState {
        let time_s = self.begin_s
            + match time_s.rem_euclid(self.duration_s) {
                t if t.is_finite() => t,
                // The duration is 0, or the time is not finite.
                _ => 0.0,
            };
        let mut locals = None;
        let mut weights = HashMap::new();
        for channel in &self.channels {
            if channel.property == Property::Weights {
                let values = (0..channel.curve.width).map(|i| channel.curve.component(time_s, i) as f32);
                weights.insert(channel.node, values.collect());
            } else {
                let locals = locals.get_or_insert_with(|| self.nodes.locals.clone());
                channel.set(&mut locals[channel.node as usize], time_s);
            }
        }
        let mut worlds = self.rest_worlds.clone();
        if let Some(locals) = locals {
            self.nodes.refresh(&mut worlds, &locals, &self.moving_order);
        }
        let matrices = |skin: &Skin| {
            let joints = skin.joints.iter().zip(&skin.inverse_bind);
            joints.map(|(&joint, bind)| (worlds[joint as usize] * *bind).as_affine3a()).collect()
        };
        let joints = self.skins.iter().map(matrices).collect();
        AnimationState { joints, weights, worlds }
    }
}

impl Channel {
    fn set(&self, local: &mut Local, time_s: f64) {
        *local = local.into_parts();
        if let Local::Parts { translation, rotation, scale } = local {
            match self.property {
                Property::Translation => *translation = DVec3::from_array(self.curve.components(time_s)),
                Property::Rotation => *rotation = self.curve.rotation(time_s),
                Property::Scale => *scale = DVec3::from_array(self.curve.components(time_s)),
                Property::Weights => {}
            }
        }
    }
}

/// The light in world space. Scale of its node is ignored.
fn placed(light: &Light, worlds: &[DAffine3]) -> PunctualLight {
    let rigid = rigid(&worlds[light.node as usize]);
    PunctualLight {
        position: rigid.w_axis.truncate().as_vec3(),
        direction: -rigid.z_axis.truncate().as_vec3(),
        ..light.light
    }
}

impl View {
    fn placed(&self, worlds: &[DAffine3]) -> Camera {
        let world_from_camera = rigid(&worlds[self.node as usize]);
        Camera { name: self.name.clone(), world_from_camera, vfov_deg: self.vfov_deg }
    }
}

/// Rigid part of a transform: keeps the direction of z, and that of y as far as possible.
fn rigid(world: &DAffine3) -> DMat4 {
    let back = world.matrix3.z_axis.normalize_or(DVec3::Z);
    let up = world.matrix3.y_axis.reject_from_normalized(back);
    let up = up.try_normalize().unwrap_or_else(|| back.any_orthonormal_vector());
    let at = world.translation;
    let at = if at.as_vec3().is_finite() { at } else { DVec3::ZERO };
    DMat4::from_cols(up.cross(back).extend(0.0), up.extend(0.0), back.extend(0.0), at.extend(1.0))
}

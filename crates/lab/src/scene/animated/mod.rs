//! What moves in a scene: nodes, skins and morph targets, and the pose of all at a time.

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

/// A scene's moving half. Meshes are kept in local space; a pose transforms them.
#[derive(Clone, Debug, Default)]
pub(crate) struct Animated {
    pub nodes: Nodes,
    /// Where the nodes are while no curve is followed.
    pub rest_worlds: Vec<DAffine3>,
    /// Nodes that curves move and all below them, parents first.
    pub moving_order: Vec<u32>,
    pub channels: Vec<Channel>,
    /// Length of the animation in seconds; 0: one pose.
    pub duration_s: f64,
    pub skins: Vec<Skin>,
    pub meshes: Vec<Mesh>,
    pub lights: Vec<Light>,
    pub cameras: Vec<View>,
}

/// A curve and what it sets.
#[derive(Clone, Debug)]
pub(crate) struct Channel {
    pub node: u32,
    pub property: Property,
    pub curve: Curve,
}

/// What a curve sets of a node.
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
    /// From the mesh's space to each joint's.
    pub inverse_bind: Vec<DAffine3>,
}

/// A mesh that is in the world.
#[derive(Clone, Debug)]
pub(crate) struct Mesh {
    pub node: u32,
    pub geometry: Arc<Geometry>,
    /// Index into the skins; the node's own place does not count then.
    pub skin: Option<u32>,
    /// Of the morph targets, while no curve sets them.
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

/// Nodes and joints at a time.
pub(crate) struct AnimationState {
    pub worlds: Vec<DAffine3>,
    /// Of each skin, from the mesh's space to the world.
    joints: Vec<Vec<Affine3A>>,
    /// Weights that curves set, by node.
    weights: HashMap<u32, Vec<f32>>,
}

impl Animated {
    /// Everything that moves, `time_s` seconds into the animation, which starts over at its end.
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

    /// The vertices of a mesh at a time.
    pub fn posed(&self, mesh: &Mesh, state: &AnimationState) -> Posed {
        let weights = state.weights.get(&mesh.node).map_or(&*mesh.weights, |w| w);
        match mesh.skin {
            Some(skin) => mesh.geometry.skinned(&state.joints[skin as usize], weights),
            None => mesh.geometry.transformed(&state.worlds[mesh.node as usize], weights),
        }
    }

    pub fn evaluate(&self, time_s: f64) -> AnimationState {
        let time_s = match time_s.rem_euclid(self.duration_s) {
            t if t.is_finite() => t,
            // No length, or no time.
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

/// The light in the world. Scales do not touch it.
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

/// Without scale, shear and mirror: what is behind stays behind, above stays above as far as it can.
fn rigid(world: &DAffine3) -> DMat4 {
    let back = world.matrix3.z_axis.normalize_or(DVec3::Z);
    let up = world.matrix3.y_axis.reject_from_normalized(back);
    let up = up.try_normalize().unwrap_or_else(|| back.any_orthonormal_vector());
    let at = world.translation;
    let at = if at.as_vec3().is_finite() { at } else { DVec3::ZERO };
    DMat4::from_cols(up.cross(back).extend(0.0), up.extend(0.0), back.extend(0.0), at.extend(1.0))
}

//! Builds an animation of rigid parts from functions of time.

use crate::scene::animated::curve::{Curve, Interpolation};
use crate::scene::animated::nodes::Local;
use crate::scene::animated::{Animated, Channel, Light, Mesh, Property, View};
use crate::scene::geometry::Geometry;
use crate::scene::{PunctualKind, PunctualLight, Triangles};
use glam::{DQuat, DVec3, Vec3};
use std::collections::BTreeMap;
use std::f64::consts::TAU;
use std::sync::Arc;

/// Duration of the loop, seconds.
const DURATION_S: f64 = 8.0;
/// Keys of each curve per second: as many as frames, so that motion is smooth.
const KEYS_PER_S: u32 = 60;

/// An animation that is being built.
#[derive(Default)]
pub(super) struct Rig {
    animated: Animated,
}

impl Rig {
    /// Adds a node at `at` in its parent's space.
    pub fn node(&mut self, parent: Option<u32>, at: [f64; 3]) -> u32 {
        let nodes = &mut self.animated.nodes;
        let node = nodes.parents.len() as u32;
        nodes.parents.push(parent);
        let (rotation, scale) = (DQuat::IDENTITY, DVec3::ONE);
        nodes.locals.push(Local::Parts { translation: DVec3::from(at), rotation, scale });
        nodes.order.push(node);
        node
    }

    /// Moves a node. The function takes the angle of a periodic motion: `TAU` is the whole loop.
    pub fn shift(&mut self, node: u32, at: impl Fn(f64) -> DVec3) {
        self.animate(node, Property::Translation, 3, |phase| at(phase).to_array().to_vec());
    }

    /// Turns a node, like [`shift`](Self::shift).
    pub fn turn(&mut self, node: u32, rotation: impl Fn(f64) -> DQuat) {
        self.animate(node, Property::Rotation, 4, |phase| rotation(phase).to_array().to_vec());
    }

    fn animate(&mut self, node: u32, property: Property, width: usize, value: impl Fn(f64) -> Vec<f64>) {
        let last = (DURATION_S * f64::from(KEYS_PER_S)) as u32;
        let times = (0..=last).map(|key| key as f32 / KEYS_PER_S as f32).collect();
        let phases = (0..=last).map(|key| f64::from(key) / f64::from(last) * TAU);
        let values = phases.flat_map(value).map(|v| v as f32).collect();
        let curve = Curve { times, values, width, interpolation: Interpolation::Linear };
        self.animated.channels.push(Channel { node, property, curve });
    }

    /// Attaches triangles in the node's space.
    pub fn attach(&mut self, node: u32, part: &Triangles) {
        let mut geometries: BTreeMap<u32, Geometry> = BTreeMap::new();
        for i in 0..part.len() {
            let material = part.materials[i];
            let g = geometries.entry(material).or_insert_with(|| Geometry { material, ..Geometry::default() });
            let first = g.positions.len() as u32;
            g.indices.push([first, first + 1, first + 2]);
            g.positions.extend(part.positions[i]);
            g.normals.extend(part.normals[i]);
        }
        let mesh = |geometry| Mesh { node, owner: node, geometry: Arc::new(geometry), skin: None, weights: [].into() };
        self.animated.meshes.extend(geometries.into_values().map(mesh));
    }

    /// Puts a camera on a node.
    pub fn camera(&mut self, node: u32, name: &str, vfov_deg: f32) {
        self.animated.cameras.push(View { node, name: name.into(), vfov_deg });
    }

    /// Adds a sun.
    pub fn sun(&mut self, direction: Vec3, irradiance: [f32; 3]) {
        let node = self.node(None, [0.0; 3]);
        self.set_rotation(node, DQuat::from_rotation_arc(DVec3::NEG_Z, direction.as_dvec3().normalize()));
        self.animated.lights.push(Light { node, light: PunctualLight::sun(direction, irradiance) });
    }

    /// Adds a lamp that shines in all directions.
    pub fn lamp(&mut self, position: Vec3, intensity: [f32; 3]) {
        let node = self.node(None, position.as_dvec3().to_array());
        let (kind, direction, range) = (PunctualKind::Point, Vec3::NEG_Z, f32::INFINITY);
        self.animated.lights.push(Light { node, light: PunctualLight { kind, position, direction, intensity, range } });
    }

    /// Sets the rotation of a node that no curve turns.
    pub fn set_rotation(&mut self, node: u32, turned: DQuat) {
        if let Local::Parts { rotation, .. } = &mut self.animated.nodes.locals[node as usize] {
            *rotation = turned;
        }
    }

    /// The animation.
    pub fn finish(mut self) -> Animated {
        let moving = self.animated.nodes.moving(self.animated.channels.iter().map(|c| c.node));
        let order = self.animated.nodes.order.iter().copied();
        self.animated.moving_order = order.filter(|&node| moving[node as usize]).collect();
        self.animated.rest_worlds = self.animated.nodes.worlds();
        self.animated.duration_s = DURATION_S;
        self.animated
    }
}

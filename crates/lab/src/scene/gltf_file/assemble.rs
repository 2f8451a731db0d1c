//! Assembles a scene: static meshes become triangles in world space, animated ones are kept in local space to be posed.

use super::accessors::Accessors;
use super::container::Container;
use super::document::Document;
use super::images::Textures;
use super::mesh::Primitives;
use super::placed::Placed;
use super::warnings::Warnings;
use super::{animation, extensions, materials, nodes, origin, placed, skins, viewpoints};
use crate::error::InputError;
use crate::scene::animated::{Animated, AnimationState, Channel, Mesh, Property, Skin};
use crate::scene::geometry::{Geometry, MAX_COORDINATE};
use crate::scene::{Environment, Scene, Triangles};
use glam::DVec3;
use gltf::json::{self, Index};
use std::collections::HashMap;
use std::sync::Arc;

/// Time of a first key, in seconds, from which people are told: they may expect the time before it.
const LATE_S: f64 = 1.0;

pub(super) fn scene(document: &Document, file: &Container, clip: Option<&str>) -> Result<Scene, InputError> {
    let mut warnings = file.warnings.clone();
    extensions::warn_of_unsupported(&document.root.extensions_used, &mut warnings);
    let accessors = Accessors::new(document);
    let mut textures = Textures::new(document);
    let surfaces = materials::read(document, &mut textures, &mut warnings)?;
    let (mut nodes, shown) = nodes::tree(document, &mut warnings)?;
    let channels = animation::channels(document, &accessors, clip, &mut warnings)?;

    let set = channels.iter().filter(|c| c.property != Property::Weights).map(|c| c.node);
    let mut morphed = vec![false; shown.in_scene.len()];
    for channel in channels.iter().filter(|c| c.property == Property::Weights) {
        morphed[channel.node as usize] = true;
    }
    let (begin_s, duration_s) = span(&channels);
    if begin_s >= LATE_S {
        warnings.add(format!("the first key of its animation is at {begin_s} s; the animation starts there"));
    }
    let placed: Vec<Placed> = placed::placed(document, &accessors, &shown.visible, &mut nodes)?;
    nodes.origin = origin::origin(document, &nodes.worlds(), &placed, &shown.in_scene);
    let origin = nodes.origin;
    if origin != DVec3::ZERO {
        let [x, y, z] = origin.to_array();
        warnings.add(format!("it lies far from the origin; what is at ({x}, {y}, {z}) m is shown there instead"));
    }
    let (skins, skin_of) = used_skins(document, &accessors, &placed)?;
    let moving = nodes.moving(set);
    let animated = Animated {
        rest_worlds: nodes.worlds(),
        moving_order: nodes.order.iter().copied().filter(|&n| moving[n as usize]).collect(),
        nodes,
        channels,
        begin_s,
        duration_s,
        skins,
        ..Animated::default()
    };

    let default_surface = materials::default();
    let primitives = Primitives { document, accessors: &accessors, surfaces: &surfaces, default_surface };
    check_triangles(document, &primitives, &placed)?;
    let mut stage = Stage {
        state: animated.evaluate(0.0),
        animated,
        still: Triangles::default(),
        dropped: 0,
        moving: &moving,
        morphed: &morphed,
        skin_of: &skin_of,
    };
    let mut meshes = placed.chunk_by(|a, b| a.mesh == b.mesh);
    let mut decoded = None;
    // Other threads decode the images in the meantime.
    rayon::in_place_scope(|scope| {
        scope.spawn(|_| decoded = Some(textures.load(file)));
        meshes.try_for_each(|uses| stage.add_mesh(&primitives, uses, &mut warnings))
    })?;
    if stage.dropped > 0 {
        let what = format!("with corners that are not finite, or farther than {MAX_COORDINATE:e} m");
        warnings.add(format!("{} triangles {what}, are left out", stage.dropped));
    }
    let Stage { mut animated, still, .. } = stage;

    for place in (0..document.root.nodes.len()).filter(|&n| shown.in_scene[n]) {
        let (index, node) = (place as u32, &document.root.nodes[place]);
        if let Some(camera) = node.camera {
            animated.cameras.extend(viewpoints::camera(document, index, camera, &mut warnings)?);
        }
        let light = node.extensions.as_ref().and_then(|e| e.khr_lights_punctual.as_ref());
        if let Some(light) = light.filter(|_| shown.visible[place]) {
            animated.lights.extend(viewpoints::light(document, index, light.light, &mut warnings)?);
        }
    }
    let textures = decoded.expect("the scope waits for its tasks")?;
    let rest = animated.pose(0.0);
    let moves = !animated.channels.is_empty();
    Ok(Scene {
        name: document.subject.to_owned(),
        materials: surfaces.into_iter().chain([materials::default()]).map(|s| s.material).collect(),
        textures,
        environment: Environment::Constant([0.0; 3]),
        animations: document.root.animations.iter().map(|a| a.name.clone().unwrap_or_default()).collect(),
        warnings: warnings.into_lines(),
        still,
        rest,
        origin,
        animated: moves.then(|| Arc::new(animated)),
    })
}

/// Time of the first key in seconds, and time from it to the last one.
fn span(channels: &[Channel]) -> (f64, f64) {
    let begin_s = channels.iter().filter_map(|c| c.curve.times.first()).fold(f64::INFINITY, |a, &t| a.min(t.into()));
    let end_s = channels.iter().filter_map(|c| c.curve.times.last()).fold(0.0f64, |a, &t| a.max(t.into()));
    if begin_s.is_finite() { (begin_s, end_s.max(begin_s) - begin_s) } else { (0.0, 0.0) }
}

/// Skins in use, and a map from the file's skin indices to theirs.
fn used_skins(
    document: &Document,
    accessors: &Accessors,
    placed: &[Placed],
) -> Result<(Vec<Skin>, HashMap<usize, u32>), InputError> {
    let mut skins = Vec::new();
    let mut places = HashMap::new();
    for index in placed.iter().filter_map(|p| p.skin) {
        if let std::collections::hash_map::Entry::Vacant(entry) = places.entry(index) {
            entry.insert(skins.len() as u32);
            skins.push(skins::skin(document, accessors, index)?);
        }
    }
    Ok((skins, places))
}

/// Checks the number of triangles against the limit before any is built. A primitive counts as one triangle at least.
fn check_triangles(document: &Document, primitives: &Primitives, placed: &[Placed]) -> Result<(), InputError> {
    let mut total = 0u64;
    for uses in placed.chunk_by(|a, b| a.mesh == b.mesh) {
        let mut triangles = 0u64;
        for primitive in &document.root.meshes[uses[0].mesh].primitives {
            triangles = triangles.saturating_add(primitives.claimed_triangles(primitive)?.max(1));
        }
        total = total.saturating_add(triangles.saturating_mul(uses.len() as u64));
    }
    document.limits.check_triangles(document.subject, total)
}

/// Destination of meshes while the scene is assembled.
struct Stage<'a> {
    animated: Animated,
    /// Animation state at time 0.
    state: AnimationState,
    still: Triangles,
    dropped: u64,
    /// Flags of nodes whose world transform is animated.
    moving: &'a [bool],
    /// Flags of nodes whose morph target weights are animated.
    morphed: &'a [bool],
    skin_of: &'a HashMap<usize, u32>,
}

impl Stage<'_> {
    /// Reads a mesh, and adds it for each of its instances.
    fn add_mesh(
        &mut self,
        primitives: &Primitives,
        uses: &[Placed],
        warnings: &mut Warnings,
    ) -> Result<(), InputError> {
        let document = primitives.document;
        let index = uses[0].mesh;
        let mesh = &document.root.meshes[index];
        let skinned = uses.iter().any(|u| u.skin.is_some());
        for primitive in &mesh.primitives {
            let Some((geometry, left_out)) = primitives.geometry(index, primitive, skinned, warnings)? else {
                continue;
            };
            self.dropped += left_out;
            let geometry = Arc::new(geometry);
            for used in uses {
                self.add(document, used, &geometry, mesh)?;
            }
        }
        Ok(())
    }

    fn add(
        &mut self,
        document: &Document,
        used: &Placed,
        geometry: &Arc<Geometry>,
        mesh: &json::Mesh,
    ) -> Result<(), InputError> {
        let (node, owner) = (used.node as usize, used.owner as usize);
        let skin = used.skin.filter(|_| geometry.influences.per_vertex > 0).map(|s| self.skin_of[&s]);
        let mut moves = self.morphed[owner];
        if let Some(skin) = skin {
            let skin = &self.animated.skins[skin as usize];
            skins::check_joints(document, &geometry.influences, skin)?;
            moves |= skin.joints.iter().any(|&joint| self.moving[joint as usize]);
        } else {
            moves |= self.moving[node];
        }
        let own: &json::Node = document.look_up(&document.root.nodes, Index::new(used.owner), "node")?;
        let weights = own.weights.as_ref().or(mesh.weights.as_ref());
        let weights = weights.map_or(&[][..], Vec::as_slice);
        let placed =
            Mesh { node: used.node, owner: used.owner, geometry: geometry.clone(), skin, weights: weights.into() };
        if moves {
            self.animated.meshes.push(placed);
        } else {
            let posed = self.animated.posed(&placed, &self.state);
            self.dropped += geometry.push_triangles(&posed, true, &mut self.still);
        }
        Ok(())
    }
}

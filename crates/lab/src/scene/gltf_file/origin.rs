//! Scenes far from the origin of their file: 1e6 m away, neighbouring floats are 6 cm apart.

use super::document::Document;
use super::placed::Placed;
use crate::scene::geometry::MAX_COORDINATE;
use glam::{DAffine3, DVec3};
use gltf::json::mesh::Semantic;
use gltf::json::validation::Checked;
use serde_json::Value;

/// Distance in metres, and in radii of the scene, that floats resolve well enough.
const NEAR_M: f64 = 4096.0;
const NEAR_RADII: f64 = 1000.0;
/// Distance in metres up to which a scene of any size stays where it is.
const ALWAYS_NEAR_M: f64 = 100.0;

/// Point of the file's space that becomes the scene's origin, in whole metres: near the first camera, else in the
/// middle, if that is far away; else zero. The size of meshes is what their accessors state.
pub(super) fn origin(document: &Document, worlds: &[DAffine3], placed: &[Placed], shown: &[bool]) -> DVec3 {
    let usable = |p: &DVec3| p.is_finite() && p.abs().max_element() <= f64::from(MAX_COORDINATE);
    let corners = placed.iter().flat_map(|p| corners(document, worlds, p)).filter(usable);
    let bounds = corners.fold(None, |bounds: Option<(DVec3, DVec3)>, p| {
        let (low, high) = bounds.unwrap_or((p, p));
        Some((low.min(p), high.max(p)))
    });
    let Some((low, high)) = bounds else { return DVec3::ZERO };
    let cameras = document.root.nodes.iter().zip(worlds).zip(shown);
    let mut camera =
        cameras.filter(|((node, _), shown)| **shown && node.camera.is_some()).map(|((_, w), _)| w.translation);
    let focus = camera.find(usable).unwrap_or((low + high) * 0.5);
    let (distance, radius) = (focus.abs().max_element(), (high - low).length() * 0.5);
    // Without the extents of meshes the radius is 0 and says nothing.
    let is_far = distance > NEAR_M || radius > 0.0 && distance > ALWAYS_NEAR_M.max(NEAR_RADII * radius);
    if is_far { focus.round() } else { DVec3::ZERO }
}

/// Corners of the boxes of a mesh at rest; where nothing states them, the place of its node or first joint.
fn corners(document: &Document, worlds: &[DAffine3], placed: &Placed) -> Vec<DVec3> {
    let root = document.root;
    let joint = placed.skin.and_then(|skin| root.skins.get(skin)?.joints.first());
    if let Some(joint) = joint.and_then(|joint| worlds.get(joint.value())) {
        return vec![joint.translation];
    }
    let world = &worlds[placed.node as usize];
    let mut corners = Vec::new();
    for primitive in &root.meshes[placed.mesh].primitives {
        let positions = primitive.attributes.get(&Checked::Valid(Semantic::Positions));
        let accessor = positions.and_then(|index| root.accessors.get(index.value()));
        let ends = accessor.and_then(|a| Some([vector(a.min.as_ref()?)?, vector(a.max.as_ref()?)?]));
        if let Some(ends) = ends {
            let corner = |i: usize| DVec3::new(ends[i & 1].x, ends[i >> 1 & 1].y, ends[i >> 2 & 1].z);
            corners.extend((0..8).map(|i| world.transform_point3(corner(i))));
        }
    }
    if corners.is_empty() {
        corners.push(world.translation);
    }
    corners
}

fn vector(value: &Value) -> Option<DVec3> {
    let numbers: Option<Vec<f64>> = value.as_array()?.iter().map(Value::as_f64).collect();
    Some(DVec3::from_array(numbers?.try_into().ok()?))
}

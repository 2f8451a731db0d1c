//! EXT_mesh_gpu_instancing: a node that shows its mesh at several places. Each place becomes a node below it.

use super::accessors::Accessors;
use super::document::Document;
use crate::error::InputError;
use crate::scene::animated::curve::unit;
use crate::scene::animated::nodes::{Local, Nodes};
use glam::{DQuat, Vec3};
use gltf::json::{self, Index};

const NAME: &str = "EXT_mesh_gpu_instancing";

/// Adds a node for each place, and returns their range; `None` if a node has no places of its own.
pub(super) fn expand(
    document: &Document,
    accessors: &Accessors,
    node: u32,
    nodes: &mut Nodes,
) -> Result<Option<std::ops::Range<u32>>, InputError> {
    let of = &document.root.nodes[node as usize];
    let Some(extension) = of.extensions.as_ref().and_then(|e| e.others.get(NAME)) else { return Ok(None) };
    let attribute = |name: &str| -> Result<Option<Index<json::Accessor>>, InputError> {
        let Some(index) = extension.get("attributes").and_then(|a| a.get(name)) else { return Ok(None) };
        let index = index.as_u64().and_then(|i| u32::try_from(i).ok()).map(Index::new);
        index.map(Some).ok_or_else(|| document.damaged(format!("{NAME} of node {node} has no accessor for {name}")))
    };
    let [at, turn, scale] = [attribute("TRANSLATION")?, attribute("ROTATION")?, attribute("SCALE")?];
    let Some(first) = at.or(turn).or(scale) else { return Ok(None) };
    let count = usize::try_from(accessors.count(first)?).ok();
    // All that the file states is read, and its number checked, before anything of this number is made.
    let vectors = |index: Option<Index<json::Accessor>>, what| {
        index.map(|index| accessors.vectors::<3>(index, what, count)).transpose()
    };
    let (translations, scales) = (vectors(at, "translations of instances")?, vectors(scale, "scales of instances")?);
    let rotations = turn.map(|index| accessors.vectors::<4>(index, "rotations of instances", count)).transpose()?;
    let vector = |list: &Option<Vec<[f32; 3]>>, i: usize, default: f32| {
        Vec3::from_array(list.as_ref().map_or([default; 3], |list| list[i])).as_dvec3()
    };
    let start = nodes.parents.len() as u32;
    for i in 0..count.unwrap_or(0) {
        let rotation = rotations.as_ref().map_or(DQuat::IDENTITY, |list| DQuat::from_array(list[i].map(f64::from)));
        let local = Local::Parts {
            translation: vector(&translations, i, 0.0),
            rotation: unit(rotation),
            scale: vector(&scales, i, 1.0),
        };
        nodes.order.push(nodes.parents.len() as u32);
        nodes.parents.push(Some(node));
        nodes.locals.push(local);
    }
    Ok(Some(start..nodes.parents.len() as u32))
}

//! The node tree of a file.

use super::document::Document;
use super::warnings::Warnings;
use crate::error::InputError;
use crate::scene::animated::curve::unit;
use crate::scene::animated::nodes::{Local, Nodes};
use glam::{DAffine3, DQuat, DVec3, Mat4, Vec3};
use gltf::json;

/// Flags of nodes.
pub(super) struct Shown {
    /// Nodes of the loaded scene. Cameras of hidden ones can still be looked through.
    pub in_scene: Vec<bool>,
    /// Those of them whose meshes and lights are not hidden (KHR_node_visibility).
    pub visible: Vec<bool>,
}

/// All nodes of the file, and which of them are shown.
pub(super) fn tree(document: &Document, warnings: &mut Warnings) -> Result<(Nodes, Shown), InputError> {
    let nodes = &document.root.nodes;
    let mut parents = vec![None; nodes.len()];
    for (parent, node) in nodes.iter().enumerate() {
        for child in node.children.iter().flatten() {
            document.look_up(nodes, *child, "node")?;
            if parents[child.value()].replace(parent as u32).is_some() {
                let problem = format!("node {child} is the child of more than one node: nodes must form a tree");
                return Err(document.damaged(problem));
            }
        }
    }
    let roots: Vec<u32> = (0..nodes.len()).filter(|&n| parents[n].is_none()).map(|n| n as u32).collect();
    let order = below(nodes, roots.clone());
    if order.len() < nodes.len() {
        return Err(document.damaged("its nodes form a cycle: they must form a tree"));
    }
    let mut in_scene = vec![false; nodes.len()];
    for node in below(nodes, scene_roots(document, roots, warnings)?) {
        in_scene[node as usize] = true;
    }
    let hidden = (0..nodes.len()).filter(|&node| is_hidden(&nodes[node])).map(|node| node as u32).collect();
    let mut visible = in_scene.clone();
    for node in below(nodes, hidden) {
        visible[node as usize] = false;
    }
    let shown = Shown { in_scene, visible };
    let locals = nodes.iter().map(local).collect();
    Ok((Nodes { parents, locals, order, origin: DVec3::ZERO }, shown))
}

/// Whether a node hides itself and its descendants.
fn is_hidden(node: &json::Node) -> bool {
    let extension = node.extensions.as_ref().and_then(|e| e.others.get("KHR_node_visibility"));
    extension.and_then(|e| e.get("visible")).is_some_and(|visible| visible == false)
}

/// Nodes and all their descendants, each once. Parents come before children if no given node is a descendant of
/// another.
fn below(nodes: &[json::Node], mut found: Vec<u32>) -> Vec<u32> {
    let mut met = vec![false; nodes.len()];
    found.retain(|&node| !std::mem::replace(&mut met[node as usize], true));
    let mut next = 0;
    while next < found.len() {
        let children = nodes[found[next] as usize].children.iter().flatten().map(|child| child.value());
        found.extend(children.filter(|&child| !std::mem::replace(&mut met[child], true)).map(|child| child as u32));
        next += 1;
    }
    found
}

fn scene_roots(document: &Document, all: Vec<u32>, warnings: &mut Warnings) -> Result<Vec<u32>, InputError> {
    let root = document.root;
    let scene = match root.scene {
        Some(scene) => document.look_up(&root.scenes, scene, "scene")?,
        None => match root.scenes.first() {
            Some(scene) => scene,
            None => return Ok(all),
        },
    };
    if root.scenes.len() > 1 {
        let number = root.scene.map_or(0, |s| s.value());
        warnings.add(format!("scene {number} of {} is shown, the others are left out", root.scenes.len()));
    }
    let mut roots = Vec::new();
    for node in &scene.nodes {
        document.look_up(&root.nodes, *node, "node")?;
        roots.push(node.value() as u32);
    }
    Ok(roots)
}

fn local(node: &json::Node) -> Local {
    if let Some(matrix) = node.matrix {
        return Local::Matrix(DAffine3::from_mat4(Mat4::from_cols_array(&matrix).as_dmat4()));
    }
    let vector = |v: Option<[f32; 3]>, default| v.map_or(default, |v| Vec3::from_array(v).as_dvec3());
    Local::Parts {
        translation: vector(node.translation, DVec3::ZERO),
        rotation: unit(DQuat::from_array(node.rotation.unwrap_or_default().0.map(f64::from))),
        scale: vector(node.scale, DVec3::ONE),
    }
}

//! Instances of meshes.

use super::accessors::Accessors;
use super::document::Document;
use super::instances;
use crate::error::InputError;
use crate::scene::animated::nodes::Nodes;

/// An instance of a mesh: a node of the scene that refers to it.
pub(super) struct Placed {
    /// Node that places it.
    pub node: u32,
    /// Node of the file that has its weights: the same, or the one of which `node` is an instance.
    pub owner: u32,
    pub mesh: usize,
    pub skin: Option<usize>,
}

/// All mesh instances of the nodes that are `visible`, sorted by mesh.
pub(super) fn placed(
    document: &Document,
    accessors: &Accessors,
    visible: &[bool],
    nodes: &mut Nodes,
) -> Result<Vec<Placed>, InputError> {
    let root = document.root;
    let mut placed = Vec::new();
    for (i, node) in root.nodes.iter().enumerate().filter(|(i, _)| visible[*i]) {
        let Some(mesh) = node.mesh else { continue };
        document.look_up(&root.meshes, mesh, "mesh")?;
        if let Some(skin) = node.skin {
            document.look_up(&root.skins, skin, "skin")?;
        }
        let owner = i as u32;
        let places = instances::expand(document, accessors, owner, nodes)?.unwrap_or(owner..owner + 1);
        let skin = node.skin.map(|s| s.value());
        placed.extend(places.map(|node| Placed { node, owner, mesh: mesh.value(), skin }));
    }
    placed.sort_by_key(|p| p.mesh);
    Ok(placed)
}

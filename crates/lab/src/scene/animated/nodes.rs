//! The node tree and its world transforms.

use glam::{DAffine3, DQuat, DVec3};

/// A node tree of any depth, traversed without recursion.
#[derive(Clone, Debug, Default)]
pub(crate) struct Nodes {
    pub parents: Vec<Option<u32>>,
    pub locals: Vec<Local>,
    /// All nodes, parents before their children.
    pub order: Vec<u32>,
    /// Point that the world transforms take to zero.
    pub origin: DVec3,
}

/// Transform of a node relative to its parent.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Local {
    Matrix(DAffine3),
    Parts { translation: DVec3, rotation: DQuat, scale: DVec3 },
}

impl Local {
    pub fn affine(&self) -> DAffine3 {
        match *self {
            Self::Matrix(m) => m,
            Self::Parts { translation, rotation, scale } => {
                DAffine3::from_scale_rotation_translation(scale, rotation, translation)
            }
        }
    }

    /// Decomposed into translation, rotation and scale, which curves animate.
    pub fn into_parts(self) -> Self {
        match self {
            Self::Matrix(m) => {
                let (scale, rotation, translation) = m.to_scale_rotation_translation();
                Self::Parts { translation, rotation: super::curve::unit(rotation), scale }
            }
            parts => parts,
        }
    }
}

impl Nodes {
    /// World transforms of all nodes.
    pub fn worlds(&self) -> Vec<DAffine3> {
        let mut worlds = vec![DAffine3::IDENTITY; self.parents.len()];
        self.refresh(&mut worlds, &self.locals, &self.order);
        worlds
    }

    /// Updates the world transforms of `nodes`, which must list parents before children.
    pub fn refresh(&self, worlds: &mut [DAffine3], locals: &[Local], nodes: &[u32]) {
        for &node in nodes {
            let node = node as usize;
            let local = locals[node].affine();
            worlds[node] = match self.parents[node] {
                Some(parent) => worlds[parent as usize] * local,
                None => DAffine3 { translation: local.translation - self.origin, ..local },
            };
        }
    }

    /// Flags of the nodes in `moved` and all their descendants.
    pub fn moving(&self, moved: impl Iterator<Item = u32>) -> Vec<bool> {
        let mut moving = vec![false; self.parents.len()];
        for node in moved {
            moving[node as usize] = true;
        }
        for &node in &self.order {
            if let Some(parent) = self.parents[node as usize] {
                moving[node as usize] |= moving[parent as usize];
            }
        }
        moving
    }
}

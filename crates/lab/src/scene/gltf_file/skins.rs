//! Skins: joints, bind poses and vertex weights.

use super::accessors::{Accessors, attribute};
use super::document::Document;
use super::warnings::Warnings;
use crate::error::InputError;
use crate::scene::animated::Skin;
use crate::scene::geometry::Influences;
use glam::{DAffine3, Mat4};
use gltf::json;
use gltf::json::mesh::{Primitive, Semantic};

/// Deviation of a weight sum from 1 that causes a warning. Quantisation to bytes deviates less.
const WEIGHT_TOLERANCE: f32 = 0.02;

/// Joints and inverse bind matrices of a skin.
pub(super) fn skin(document: &Document, accessors: &Accessors, index: usize) -> Result<Skin, InputError> {
    let json: &json::Skin = &document.root.skins[index];
    for joint in &json.joints {
        document.look_up(&document.root.nodes, *joint, "node")?;
    }
    let joints: Vec<u32> = json.joints.iter().map(|joint| joint.value() as u32).collect();
    let mut inverse_bind = vec![DAffine3::IDENTITY; joints.len()];
    if let Some(matrices) = json.inverse_bind_matrices {
        let matrices = accessors.vectors::<16>(matrices, "inverse bind matrices", None)?;
        if matrices.len() < joints.len() {
            let problem = format!("skin {index} has {} joints and {} bind matrices", joints.len(), matrices.len());
            return Err(document.damaged(problem));
        }
        for (bind, matrix) in inverse_bind.iter_mut().zip(matrices) {
            *bind = DAffine3::from_mat4(Mat4::from_cols_array(&matrix).as_dmat4());
        }
    }
    Ok(Skin { joints, inverse_bind })
}

/// Joints and weights of a primitive from all sets. Weights are scaled to a sum of 1.
pub(super) fn influences(
    document: &Document,
    accessors: &Accessors,
    primitive: &Primitive,
    vertices: usize,
    warnings: &mut Warnings,
    name: &dyn Fn() -> String,
) -> Result<Influences, InputError> {
    let mut sets = Vec::new();
    for set in 0.. {
        let joints = attribute(primitive, Semantic::Joints(set));
        let weights = attribute(primitive, Semantic::Weights(set));
        let (Some(joints), Some(weights)) = (joints, weights) else { break };
        let joints = accessors.integers::<4>(joints, "joints", Some(vertices))?;
        sets.push((joints, accessors.vectors::<4>(weights, "weights of joints", Some(vertices))?));
    }
    let mut out = Influences { per_vertex: sets.len() * 4, ..Influences::default() };
    let mut odd = false;
    for vertex in 0..vertices {
        let start = out.weights.len();
        for (joints, weights) in &sets {
            for (&joint, &weight) in joints[vertex].iter().zip(&weights[vertex]) {
                let weight = if weight.is_finite() { weight.max(0.0) } else { 0.0 };
                // Joints with zero weight may be out of range.
                let joint = if weight > 0.0 { joint } else { 0 };
                let joint = u16::try_from(joint);
                out.joints.push(joint.map_err(|_| document.damaged(format!("{}: joint above 65535", name())))?);
                out.weights.push(weight);
            }
        }
        let own = &mut out.weights[start..];
        let sum: f32 = own.iter().sum();
        odd |= (sum - 1.0).abs() > WEIGHT_TOLERANCE && !own.is_empty();
        if sum > 0.0 && sum.is_finite() {
            own.iter_mut().for_each(|w| *w /= sum);
        } else if let [first, rest @ ..] = own {
            *first = 1.0;
            rest.fill(0.0);
            out.joints[start..].fill(0);
        }
    }
    if odd {
        warnings.about("weights of joints that do not sum to 1 are scaled", name);
    }
    Ok(out)
}

/// Checks that all joint indices of vertices exist in the skin.
pub(super) fn check_joints(document: &Document, influences: &Influences, skin: &Skin) -> Result<(), InputError> {
    match influences.joints.iter().find(|&&joint| usize::from(joint) >= skin.joints.len()) {
        Some(joint) => Err(document.damaged(format!("a vertex follows joint {joint} of {}", skin.joints.len()))),
        None => Ok(()),
    }
}

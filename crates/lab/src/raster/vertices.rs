//! Vertex buffers, with triangles grouped by material.

use crate::scene::{Alpha, Material, Triangles};
use bytemuck::{Pod, Zeroable};
use glam::{DVec3, Vec3};
use rayon::prelude::*;
use std::collections::BTreeMap;
use std::ops::Range;

/// A vertex of a triangle.
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub(super) struct Vertex {
    pub position: [f32; 3],
    normal: [f32; 3],
    tangent: [f32; 4],
    /// First and second texture coordinates.
    uvs: [f32; 4],
    /// Unsigned normalized.
    color: [u16; 4],
}

/// Bytes of a [`Vertex`].
pub(super) const STRIDE: u64 = size_of::<Vertex>() as u64;

/// Vertex buffer layouts: the current vertices, and the positions of the previous frame.
pub(super) const LAYOUTS: [wgpu::VertexBufferLayout<'static>; 2] = [
    wgpu::VertexBufferLayout {
        array_stride: STRIDE,
        step_mode: wgpu::VertexStepMode::Vertex,
        attributes: &wgpu::vertex_attr_array![
            0 => Float32x3, 1 => Float32x3, 2 => Float32x4, 3 => Float32x4, 4 => Unorm16x4
        ],
    },
    wgpu::VertexBufferLayout {
        array_stride: STRIDE,
        step_mode: wgpu::VertexStepMode::Vertex,
        attributes: &wgpu::vertex_attr_array![5 => Float32x3],
    },
];

/// Texture coordinates of a corner; zero where a triangle has no second ones.
fn uvs(triangles: &Triangles, i: usize, corner: usize) -> [f32; 4] {
    let [u, v] = triangles.uvs[i][corner].to_array();
    let [s, t] = triangles.second_uvs.get(i).map_or([0.0; 2], |uvs| uvs[corner].to_array());
    [u, v, s, t]
}

/// Alpha mode of a draw, in drawing order.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum AlphaKind {
    /// Opaque.
    Opaque,
    /// Alpha-tested.
    Mask,
    /// Blended by opacity, or transmissive.
    Blend,
}

impl AlphaKind {
    pub fn of(material: &Material) -> Self {
        match material.alpha {
            Alpha::Blend => Self::Blend,
            _ if material.transmission > 0.0 => Self::Blend,
            Alpha::Mask { .. } => Self::Mask,
            Alpha::Opaque => Self::Opaque,
        }
    }
}

/// Range of vertices drawn with one material.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct DrawRange {
    pub kind: AlphaKind,
    pub material: u32,
    pub vertices: Range<u32>,
}

/// Triangle order of a vertex buffer: by alpha mode, then material, then the original order.
#[derive(Clone, Debug, Default)]
pub(super) struct GroupedTriangles {
    order: Vec<u32>,
    pub parts: Vec<DrawRange>,
}

impl GroupedTriangles {
    pub fn new(triangles: &Triangles, materials: &[Material]) -> Self {
        let key = |i: u32| {
            let material = triangles.materials[i as usize];
            (materials.get(material as usize).map_or(AlphaKind::Opaque, AlphaKind::of), material)
        };
        let mut order: Vec<u32> = (0..triangles.len() as u32).collect();
        order.sort_by_key(|&i| key(i));
        let mut parts = vec![];
        let mut first = 0;
        for run in order.chunk_by(|&a, &b| key(a) == key(b)) {
            let (kind, material) = key(run[0]);
            let end = first + 3 * run.len() as u32;
            parts.push(DrawRange { kind, material, vertices: first..end });
            first = end;
        }
        Self { order, parts }
    }

    /// Vertices of `triangles`, in the grouped order. Their materials must be those from which the groups were built.
    pub fn vertices(&self, triangles: &Triangles) -> Vec<Vertex> {
        let mut vertices = vec![Vertex::default(); 3 * self.order.len()];
        vertices.par_chunks_mut(3).with_min_len(1024).zip(&self.order).for_each(|(vertices, &i)| {
            let i = i as usize;
            for (k, vertex) in vertices.iter_mut().enumerate() {
                *vertex = Vertex {
                    position: triangles.positions[i][k].to_array(),
                    normal: triangles.normals[i][k].to_array(),
                    tangent: triangles.tangents[i][k].to_array(),
                    uvs: uvs(triangles, i, k),
                    color: triangles.colors[i][k].to_array().map(|v| (v.clamp(0.0, 1.0) * 65535.0).round() as u16),
                };
            }
        });
        vertices
    }

    /// Blended triangles with centroid, first vertex and material.
    pub fn blended(&self, vertices: &[Vertex]) -> Vec<Blended> {
        let parts = self.parts.iter().filter(|p| p.kind == AlphaKind::Blend);
        parts
            .flat_map(|part| {
                part.vertices.clone().step_by(3).map(|first| {
                    let of = |k: u32| Vec3::from(vertices[(first + k) as usize].position);
                    Blended { first, material: part.material, middle: (of(0) + of(1) + of(2)) / 3.0 }
                })
            })
            .collect()
    }
}

/// Triangles of a chunk. A smaller number leaves out more triangles, but needs more draw calls and tests.
const CHUNK: u32 = 256;

/// Bounding boxes of successive triangles of a vertex buffer, for leaving out those outside a view.
#[derive(Clone, Debug, Default)]
pub(super) struct Chunks {
    /// By first vertex.
    boxes: BTreeMap<u32, [DVec3; 2]>,
}

impl Chunks {
    /// Boxes of the triangles of `parts`.
    pub fn new(parts: &[DrawRange], vertices: &[Vertex]) -> Self {
        let firsts: Vec<(u32, u32)> = parts
            .iter()
            .flat_map(|part| part.vertices.clone().step_by(3 * CHUNK as usize).map(|first| (first, part.vertices.end)))
            .collect();
        let bounds = |&(first, end): &(u32, u32)| {
            let of_chunk = &vertices[first as usize..end.min(first + 3 * CHUNK) as usize];
            let positions = of_chunk.iter().map(|v| Vec3::from(v.position).as_dvec3());
            // A position that is not finite makes its box non-finite, which Vec3::min alone would not do.
            let is_finite = positions.clone().all(|p| p.is_finite());
            let low = positions.clone().fold(DVec3::INFINITY, DVec3::min);
            let high = positions.fold(DVec3::NEG_INFINITY, DVec3::max);
            (first, if is_finite { [low, high] } else { [DVec3::NAN; 2] })
        };
        Self { boxes: firsts.par_iter().with_min_len(64).map(bounds).collect() }
    }

    /// Vertices and boxes of a part's chunks, in order.
    pub fn of(&self, part: &DrawRange) -> impl Iterator<Item = (Range<u32>, [DVec3; 2])> + '_ {
        let end = part.vertices.end;
        self.boxes
            .range(part.vertices.clone())
            .map(move |(&first, &bounds)| (first..end.min(first + 3 * CHUNK), bounds))
    }
}

/// A blended triangle.
#[derive(Clone, Copy, Debug)]
pub(super) struct Blended {
    pub first: u32,
    pub material: u32,
    pub middle: Vec3,
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::vec3;

    #[test]
    fn triangles_are_grouped_by_kind_then_material_and_keep_their_order() {
        let blend = Material { alpha: Alpha::Blend, ..Material::default() };
        let glass = Material { transmission: 1.0, ..Material::default() };
        let mask = Material { alpha: Alpha::Mask { cutoff: 0.5 }, ..Material::default() };
        let materials = [blend, Material::default(), mask, glass];
        let mut triangles = Triangles::default();
        for (i, m) in [3, 0, 1, 2, 1, 0].into_iter().enumerate() {
            triangles.push_flat([vec3(i as f32, 0.0, 0.0), vec3(i as f32, 1.0, 0.0), vec3(i as f32, 0.0, 1.0)], m);
        }
        let grouped = GroupedTriangles::new(&triangles, &materials);
        let kinds: Vec<_> = grouped.parts.iter().map(|p| (p.kind, p.material, p.vertices.clone())).collect();
        assert_eq!(
            kinds,
            [
                (AlphaKind::Opaque, 1, 0..6),
                (AlphaKind::Mask, 2, 6..9),
                (AlphaKind::Blend, 0, 9..15),
                (AlphaKind::Blend, 3, 15..18)
            ]
        );
        let vertices = grouped.vertices(&triangles);
        let x: Vec<f32> = vertices.iter().step_by(3).map(|c| c.position[0]).collect();
        assert_eq!(x, [2.0, 4.0, 3.0, 1.0, 5.0, 0.0]);
        assert_eq!(grouped.blended(&vertices).iter().map(|b| b.first).collect::<Vec<_>>(), [9, 12, 15]);
    }
}

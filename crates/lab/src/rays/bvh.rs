//! Eight-wide bounding volume hierarchy over triangles, and its traversal on the CPU.

use super::bvh2;
use super::node::NodeRay;
use super::triangle_records::{AttributeRecord, SecondUvRecord, TriangleFlags, TriangleRecord};
use crate::kernel::triangle::{Shear, intersect, shear};
use crate::scene::{Material, Triangles};
use glam::{Vec3, Vec3A};
use obvhs::aabb::Aabb;
use obvhs::cwbvh::bvh2_to_cwbvh::bvh2_to_cwbvh;
use obvhs::cwbvh::node::CwBvhNode;
use rayon::prelude::*;

/// Entries of the traversal stack, as in `trace/shaders/trace/traverse.wgsl`.
const STACK: usize = 32;

/// Triangles with larger coordinates (metres) are dropped: squares of coordinate differences would overflow f32.
const MAX_COORDINATE: f32 = 1e15;

/// A ray segment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// Metres. A ray whose origin is not finite hits nothing.
    pub origin: Vec3,
    /// Not zero. Length about 1; distances are in units of this length.
    pub direction: Vec3,
    /// Only hits nearer than this count. May be infinite.
    pub t_max: f32,
}

/// The nearest hit of a ray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// Triangle index: into the whole [`Geometry`](super::Geometry) for its queries, into [`Bvh::triangles`] for a
    /// [`Bvh`]'s.
    pub triangle: u32,
    /// Distance in units of the ray direction's length, above 0.
    pub t: f32,
    /// Barycentric weight of the second corner.
    pub u: f32,
    /// Barycentric weight of the third corner.
    pub v: f32,
}

impl Hit {
    /// Start value of a search: any triangle nearer than the ray's `t_max` replaces it.
    pub(super) const fn none(t_max: f32) -> Self {
        Self { triangle: 0, t: t_max, u: 0.0, v: 0.0 }
    }
}

/// A ray with everything precomputed that node and triangle tests need.
pub(super) struct PreparedRay {
    origin: Vec3A,
    shear: Shear,
    node_ray: NodeRay,
}

impl PreparedRay {
    /// `None` for rays that cannot hit anything.
    #[inline]
    pub fn new(ray: &Ray) -> Option<Self> {
        let usable = ray.origin.is_finite() && ray.direction.is_finite() && ray.direction != Vec3::ZERO;
        usable.then(|| Self {
            origin: Vec3A::from(ray.origin),
            shear: shear(ray.direction),
            node_ray: NodeRay::new(ray.origin, ray.direction),
        })
    }
}

/// The hierarchy, and its triangles in leaf order.
#[derive(Clone, Debug, Default)]
pub struct Bvh {
    pub(super) nodes: Vec<CwBvhNode>,
    pub(super) triangles: Vec<TriangleRecord>,
    attributes: Vec<AttributeRecord>,
    second_uvs: Option<Vec<SecondUvRecord>>,
    /// Corners in the previous frame, metres, in leaf order; empty if none were given.
    pub(super) previous: Vec<[Vec3; 3]>,
    dropped: u32,
}

impl Bvh {
    /// Builds the hierarchy over all triangles that have an area and finite corners within 1e15 m; rays cannot hit the
    /// others. `previous` holds the corners' positions in the previous frame, for triangles that move. Takes n log n
    /// steps for any input.
    pub fn build(triangles: &Triangles, previous: Option<&[[Vec3; 3]]>, materials: &[Material]) -> Self {
        let count = triangles.len().min(u32::MAX as usize) as u32;
        let sound = (0..count).into_par_iter().filter(|&i| is_sound(&triangles.positions[i as usize]));
        let sources: Vec<u32> = sound.collect();
        let boxes: Vec<Aabb> = sources.par_iter().map(|&i| bounds(&triangles.positions[i as usize])).collect();
        let (nodes, order) = hierarchy(&boxes);
        let sources: Vec<u32> = order.into_iter().map(|i| sources[i as usize]).collect();
        let previous = previous.map_or(vec![], |corners| {
            let corners = |i: u32| *corners.get(i as usize).unwrap_or(&triangles.positions[i as usize]);
            sources.par_iter().map(|&i| corners(i)).collect()
        });
        Self {
            nodes,
            triangles: sources.par_iter().map(|&i| TriangleRecord::new(triangles, i, materials)).collect(),
            attributes: sources.par_iter().map(|&i| AttributeRecord::new(triangles, i as usize)).collect(),
            second_uvs: (!triangles.second_uvs.is_empty())
                .then(|| sources.par_iter().map(|&i| SecondUvRecord::new(triangles, i as usize)).collect()),
            previous,
            dropped: count - sources.len() as u32,
        }
    }

    /// Triangles in leaf order, as [`Hit::triangle`] indexes them.
    pub fn triangles(&self) -> &[TriangleRecord] {
        &self.triangles
    }

    /// Shading attributes of the triangles, in leaf order.
    pub fn attributes(&self) -> &[AttributeRecord] {
        &self.attributes
    }

    /// Second texture coordinates, in leaf order; `None` if no input triangle has them.
    pub fn second_uvs(&self) -> Option<&[SecondUvRecord]> {
        self.second_uvs.as_deref()
    }

    /// Number of input triangles that were dropped: without area, not finite, or too far away.
    pub fn dropped(&self) -> u32 {
        self.dropped
    }

    /// Number of the 32 stack entries that the deepest traversal uses.
    pub fn stack_needed(&self) -> usize {
        stack_needed(&self.nodes)
    }

    /// The nodes, of 80 bytes each.
    #[doc(hidden)]
    pub fn nodes(&self) -> &[CwBvhNode] {
        &self.nodes
    }

    /// Number of nodes, of 80 bytes each.
    pub fn node_count(&self) -> usize {
        self.nodes.len()
    }

    /// Nearest hit; among equally near hits the lowest triangle index wins. `accept(triangle, u, v)` runs the alpha
    /// test on triangles flagged [`TriangleFlags::ALPHA`]. Its answer must not depend on the order of calls.
    pub fn closest(&self, ray: &Ray, mut accept: impl FnMut(u32, f32, f32) -> bool) -> Option<Hit> {
        let mut hit = Hit::none(ray.t_max);
        self.traverse::<false>(&PreparedRay::new(ray)?, 0, &mut hit, &mut accept).then_some(hit)
    }

    /// Whether the ray hits anything.
    pub fn occluded(&self, ray: &Ray, mut accept: impl FnMut(u32, f32, f32) -> bool) -> bool {
        let mut hit = Hit::none(ray.t_max);
        PreparedRay::new(ray).is_some_and(|p| self.traverse::<true>(&p, 0, &mut hit, &mut accept))
    }

    /// Replaces `hit` by the nearest hit of the ray if that is nearer than `hit`, and returns whether it replaced it.
    /// With `ANY`, stops at the first hit. Triangle indices start at `first`.
    #[inline]
    pub(super) fn traverse<const ANY: bool>(
        &self,
        ray: &PreparedRay,
        first: u32,
        hit: &mut Hit,
        accept: &mut impl FnMut(u32, f32, f32) -> bool,
    ) -> bool {
        if self.nodes.is_empty() {
            return false;
        }
        let octant = ray.node_ray.octant & 7;
        let mut met = false;
        let mut stack = [(0_u32, 0_u32); STACK];
        let mut depth = 0;
        // Children left to visit: index of the first child, then hit bits (24 to 31) above the mask of inner children.
        let mut group = (0_u32, 0x8000_0000_u32);
        loop {
            let bit = 31 - group.1.leading_zeros();
            group.1 &= !(1 << bit);
            if group.1 >= 1 << 24 {
                stack[depth] = group;
                depth += 1;
            }
            let slot = (bit - 24) ^ octant;
            let child = group.0 + (group.1 & !(u32::MAX << slot) & 0xff).count_ones();
            let node = &self.nodes[child as usize];
            let hits = ray.node_ray.hits(node, hit.t);
            group = (node.child_base_idx, hits & 0xff00_0000 | u32::from(node.imask));

            let mut leaves = hits & 0x00ff_ffff;
            while leaves != 0 {
                let index = node.primitive_base_idx + leaves.trailing_zeros();
                leaves &= leaves - 1;
                let triangle = &self.triangles[index as usize];
                let [v0, v1, v2] = triangle.corners();
                let intersection = intersect(ray.shear, ray.origin, v0, v1, v2);
                let index = first + index;
                let nearer = intersection.t < hit.t || intersection.t == hit.t && index < hit.triangle;
                if intersection.t > 0.0 && nearer && intersection.t < f32::INFINITY {
                    if triangle.has(TriangleFlags::ALPHA) && !accept(index, intersection.u, intersection.v) {
                        continue;
                    }
                    *hit = Hit { triangle: index, t: intersection.t, u: intersection.u, v: intersection.v };
                    met = true;
                    if ANY {
                        return true;
                    }
                }
            }
            if group.1 < 1 << 24 {
                if depth == 0 {
                    return met;
                }
                depth -= 1;
                group = stack[depth];
            }
        }
    }
}

fn is_sound(corners: &[Vec3; 3]) -> bool {
    let [a, b, c] = corners;
    // Also false for coordinates that are not finite.
    let near = corners.iter().all(|v| v.abs().max_element() <= MAX_COORDINATE);
    near && (b - a).as_dvec3().cross((c - a).as_dvec3()).length_squared() > 0.0
}

fn bounds(corners: &[Vec3; 3]) -> Aabb {
    let [a, b, c] = corners.map(Vec3A::from);
    Aabb::new(a.min(b).min(c), a.max(b).max(c))
}

/// Wide nodes, and box indices in leaf order. Falls back to halving by count if traversal of the SAH tree would
/// overflow the stack: halving has at most 32 levels, and the last level has no inner nodes, so its traversal always
/// fits. No known scene needs the fallback.
fn hierarchy(boxes: &[Aabb]) -> (Vec<CwBvhNode>, Vec<u32>) {
    for halve in [false, true] {
        let binary = bvh2::build(boxes, halve);
        let wide = bvh2_to_cwbvh(&binary, 3, true, false);
        if halve || wide.nodes.is_empty() || stack_needed(&wide.nodes) <= STACK {
            return (wide.nodes, wide.primitive_indices);
        }
    }
    unreachable!("the second round returns")
}

/// Stack entries of the deepest traversal: one for each node with two or more inner children. Children are stored after
/// their parents.
fn stack_needed(nodes: &[CwBvhNode]) -> usize {
    let mut needed = vec![0_usize; nodes.len()];
    for (i, node) in nodes.iter().enumerate().rev() {
        let inner = node.imask.count_ones() as usize;
        let first = node.child_base_idx as usize;
        let deepest = needed[first..first + inner].iter().max().copied().unwrap_or(0);
        needed[i] = deepest + usize::from(inner > 1);
    }
    needed.first().copied().unwrap_or(0)
}

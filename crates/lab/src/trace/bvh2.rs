//! Binary hierarchy by the surface area heuristic, which `obvhs` collapses into wide nodes.
//!
//! The builder of `obvhs` (PLOC) merges neighbours that are each other's cheapest partner. If all boxes are alike, or
//! grow along the curve, it merges one pair a sweep: a hundred thousand copies of a triangle take minutes, and the
//! resulting linear tree overflows the stack. Splitting top-down takes n log n steps for any input and is as fast.

use glam::Vec3A;
use obvhs::aabb::Aabb;
use obvhs::bvh2::Bvh2;
use obvhs::bvh2::node::Bvh2Node;

/// Candidate bins per axis for a node's split.
const BINS: usize = 16;

/// Levels that the heuristic splits; below, nodes are halved by count.
const MAX_DEPTH: u32 = 64;

/// A tree with one box per leaf. `halve` splits by count only, which gives the least depth.
pub(super) fn build(boxes: &[Aabb], halve: bool) -> Bvh2 {
    let mut bvh = Bvh2 { primitive_indices: (0..boxes.len() as u32).collect(), ..Bvh2::default() };
    if boxes.is_empty() {
        return bvh;
    }
    let mut boxes = boxes.to_vec();
    bvh.nodes = vec![Bvh2Node::default(); 2 * boxes.len() - 1];
    let mut used = 1;
    let max_depth = if halve { 0 } else { MAX_DEPTH };
    let mut open = vec![Open { node: 0, begin: 0, end: boxes.len(), depth: 0 }];
    while let Some(Open { node, begin, end, depth }) = open.pop() {
        let range = &mut boxes[begin..end];
        let bounds = bounds(range);
        if range.len() == 1 {
            bvh.nodes[node] = Bvh2Node::new(bounds, 1, begin as u32);
            continue;
        }
        let indices = &mut bvh.primitive_indices[begin..end];
        let split = if depth < max_depth { cheapest(range).map(|s| partition(range, indices, s)) } else { None };
        // All boxes share a centre, or rounding put them on one side: halve by count.
        let left = split.filter(|&n| n > 0 && n < range.len()).unwrap_or(range.len() / 2);
        bvh.nodes[node] = Bvh2Node::new(bounds, 0, used as u32);
        open.push(Open { node: used, begin, end: begin + left, depth: depth + 1 });
        open.push(Open { node: used + 1, begin: begin + left, end, depth: depth + 1 });
        used += 2;
    }
    bvh
}

/// A node still to be built from the boxes `begin..end`.
struct Open {
    node: usize,
    begin: usize,
    end: usize,
    depth: u32,
}

/// A split: boxes whose centre falls into a bin up to `last` go left.
#[derive(Clone, Copy)]
struct Split {
    binning: Binning,
    axis: usize,
    last: usize,
}

/// Map from twice a box's centre to its bin on each axis.
#[derive(Clone, Copy)]
struct Binning {
    low: Vec3A,
    scale: Vec3A,
    count: usize,
}

impl Binning {
    #[inline]
    fn bins(&self, of: &Aabb) -> [usize; 3] {
        let at = (of.min + of.max - self.low) * self.scale;
        let last = self.count - 1;
        [(at.x as usize).min(last), (at.y as usize).min(last), (at.z as usize).min(last)]
    }
}

fn bounds(boxes: &[Aabb]) -> Aabb {
    boxes.iter().fold(Aabb::INVALID, |a, b| Aabb::new(a.min.min(b.min), a.max.max(b.max)))
}

/// The cheapest split (Wald, "On fast Construction of SAH-based Bounding Volume Hierarchies", 2007); `None` if all
/// centres coincide.
fn cheapest(boxes: &[Aabb]) -> Option<Split> {
    let centers = boxes.iter().fold(Aabb::INVALID, |a, b| {
        let c = b.min + b.max;
        Aabb::new(a.min.min(c), a.max.max(c))
    });
    let extent = centers.max - centers.min;
    let count = boxes.len().clamp(4, BINS);
    // The factor just below 1 puts the largest centre into the last bin. An axis without extent has a single bin.
    let wide = extent.cmpgt(Vec3A::splat(f32::MIN_POSITIVE));
    let scale = Vec3A::select(wide, Vec3A::splat(count as f32 * 0.999_999) / extent, Vec3A::ZERO);
    let binning = Binning { low: centers.min, scale, count };

    let mut bins = [[(Aabb::INVALID, 0_u32); BINS]; 3];
    for b in boxes {
        for (axis, bin) in binning.bins(b).into_iter().enumerate() {
            let (bounds, n) = &mut bins[axis][bin];
            bounds.min = bounds.min.min(b.min);
            bounds.max = bounds.max.max(b.max);
            *n += 1;
        }
    }

    let mut best = (f32::INFINITY, None);
    for (axis, bins) in bins.iter().enumerate().filter(|&(axis, _)| scale[axis] > 0.0) {
        let mut left_cost = [f32::INFINITY; BINS];
        let mut left = (Aabb::INVALID, 0);
        for (cost, bin) in left_cost.iter_mut().zip(&bins[..count - 1]) {
            left = (left.0.union(&bin.0), left.1 + bin.1);
            if left.1 > 0 {
                *cost = left.0.half_area() * left.1 as f32;
            }
        }
        let mut right = (Aabb::INVALID, 0);
        for last in (0..count - 1).rev() {
            right = (right.0.union(&bins[last + 1].0), right.1 + bins[last + 1].1);
            if right.1 > 0 {
                let cost = left_cost[last] + right.0.half_area() * right.1 as f32;
                if cost < best.0 {
                    best = (cost, Some(Split { binning, axis, last }));
                }
            }
        }
    }
    best.1
}

/// Moves the boxes of the left side to the front; returns their number.
fn partition(boxes: &mut [Aabb], indices: &mut [u32], split: Split) -> usize {
    let (mut left, mut right) = (0, boxes.len());
    while left < right {
        if split.binning.bins(&boxes[left])[split.axis] <= split.last {
            left += 1;
        } else {
            right -= 1;
            boxes.swap(left, right);
            indices.swap(left, right);
        }
    }
    left
}

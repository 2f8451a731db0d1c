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

/// Boxes of a subtree from which its halves are built in parallel. Smaller ones are not worth a task.
const PARALLEL_BOXES: usize = 4096;

/// A tree with one box per leaf, the same for any number of threads. `halve` splits by count only, which gives the
/// least depth.
pub(super) fn build(boxes: &[Aabb], halve: bool) -> Bvh2 {
    let mut bvh = Bvh2 { primitive_indices: (0..boxes.len() as u32).collect(), ..Bvh2::default() };
    if boxes.is_empty() {
        return bvh;
    }
    let mut boxes = boxes.to_vec();
    bvh.nodes = vec![Bvh2Node::default(); 2 * boxes.len() - 1];
    let (root, descendants) = bvh.nodes.split_first_mut().expect("there is a node for each box");
    let indices = &mut bvh.primitive_indices;
    let max_depth = if halve { 0 } else { MAX_DEPTH };
    Subtree { root, descendants, first: 1, boxes: &mut boxes, indices, begin: 0 }.build(max_depth);
    bvh
}

/// A node to be built, and the parts of the tree's arrays for its subtree. Splits by the heuristic end at [`MAX_DEPTH`]
/// and halving takes at most 32 levels more, so recursion is shallow.
struct Subtree<'a> {
    root: &'a mut Bvh2Node,
    /// The other nodes: the two children, then the descendants of the left one, then those of the right one.
    descendants: &'a mut [Bvh2Node],
    /// Index of the first of these other nodes in the tree.
    first: usize,
    boxes: &'a mut [Aabb],
    indices: &'a mut [u32],
    /// Index of the first box in the tree's order.
    begin: usize,
}

impl Subtree<'_> {
    /// `levels`: how many levels the heuristic may still split.
    fn build(self, levels: u32) {
        let Self { root, descendants, first, boxes, indices, begin } = self;
        let bounds = bounds(boxes);
        let Some(([left_root, right_root], below)) = descendants.split_first_chunk_mut::<2>() else {
            *root = Bvh2Node::new(bounds, 1, begin as u32);
            return;
        };
        *root = Bvh2Node::new(bounds, 0, first as u32);
        let split = if levels > 0 { cheapest(boxes).map(|s| partition(boxes, indices, s)) } else { None };
        // All boxes share a centre, or rounding put them on one side: halve by count.
        let count = split.filter(|&n| n > 0 && n < boxes.len()).unwrap_or(boxes.len() / 2);
        let is_large = boxes.len() >= PARALLEL_BOXES;
        let (left_boxes, right_boxes) = boxes.split_at_mut(count);
        let (left_indices, right_indices) = indices.split_at_mut(count);
        let (left_below, right_below) = below.split_at_mut(2 * count - 2);
        let left = Subtree {
            root: left_root,
            descendants: left_below,
            first: first + 2,
            boxes: left_boxes,
            indices: left_indices,
            begin,
        };
        let right = Subtree {
            root: right_root,
            descendants: right_below,
            first: first + 2 * count,
            boxes: right_boxes,
            indices: right_indices,
            begin: begin + count,
        };
        let levels = levels.saturating_sub(1);
        if is_large {
            rayon::join(|| left.build(levels), || right.build(levels));
        } else {
            left.build(levels);
            right.build(levels);
        }
    }
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

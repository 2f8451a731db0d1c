//! Ray test against the eight quantized boxes of a node of an eight-wide hierarchy (CWBVH; Ylitie, Karras and Laine,
//! "Efficient Incoherent Ray Traversal on GPUs Through Compressed Wide BVHs", HPG 2017).
//!
//! The test in `obvhs` leaks rays: it rejects boxes nearer than 1e-4, clamps small direction components, and leaves no
//! margin for rounding. Here every box is widened by the largest possible rounding error (after Ize, "Robust BVH Ray
//! Traversal", JCGT 2(2), 2013), so a triangle that the watertight test accepts is never culled. Hits therefore do not
//! depend on this test, and the formulas in `trace/shaders/trace/traverse.wgsl` need not be bit-equal.

use glam::{Vec3, Vec3A, Vec4};
use obvhs::cwbvh::node::CwBvhNode;

/// Widening of boxes, as a share of the distance from the ray's origin to the node's far side. Rounding with u = 2^-24:
/// 4 u from the planes and their distances, 2 u from quantization, 7 u from the triangle test, whose shear moves a
/// vertex across the ray. The sum is 13 u. Vulkan's largest error of division (2.5 ulp) doubles it to 26 u. The
/// constant is 32 u.
const SLACK: f32 = 1.0 / 524_288.0;

/// Smallest magnitude of a direction component; smaller ones are raised to it, so that reciprocals and their products
/// stay finite.
const MIN_DIRECTION: f32 = 1.0 / (1_u64 << 60) as f32;

/// Per-ray constants of the node test.
#[derive(Clone, Copy, Debug)]
pub(super) struct NodeRay {
    origin: Vec3A,
    inverse: Vec3A,
    widening: Vec3A,
    backward: [bool; 3],
    /// Octant that is visited first, repeated in each byte.
    pub octant: u32,
}

impl NodeRay {
    pub fn new(origin: Vec3, direction: Vec3) -> Self {
        let direction = Vec3A::from(direction);
        let backward = direction.cmplt(Vec3A::ZERO);
        let size = direction.abs().max(Vec3A::splat(MIN_DIRECTION));
        let size_inverse = 1.0 / size;
        let inverse = Vec3A::select(backward, -size_inverse, size_inverse);
        let octant = [0x0404_0404, 0x0202_0202, 0x0101_0101].iter().enumerate();
        let backward = [0, 1, 2].map(|axis| backward.test(axis));
        let octant = octant.map(|(axis, bits)| if backward[axis] { 0 } else { *bits }).sum();
        Self { origin: Vec3A::from(origin), inverse, widening: size_inverse * SLACK, backward, octant }
    }

    /// Children that the ray hits nearer than `t_max`: inner children in bits 24 to 31, highest bit visited first, and
    /// leaf triangles in bits 0 to 23.
    #[inline(always)]
    pub fn hits(&self, node: &CwBvhNode, t_max: f32) -> u32 {
        let extent = node.compute_extent();
        let to_node = Vec3A::from(node.p) - self.origin;
        let step = extent * self.inverse;
        let first = to_node * self.inverse;
        let reach = (to_node.abs() + extent * 255.0).max_element();
        let near = first - self.widening * reach;
        let far = first + self.widening * reach;
        let (child_bits, bit_index) = node.get_child_and_index_bits(self.octant);

        let planes = |axis: usize, min: &[u8; 8], max: &[u8; 8], half: usize| {
            let (a, b) = if self.backward[axis] { (max, min) } else { (min, max) };
            (four(a, half) * step[axis] + near[axis], four(b, half) * step[axis] + far[axis])
        };
        let mut met = 0;
        for half in 0..2 {
            let (near_x, far_x) = planes(0, &node.child_min_x, &node.child_max_x, half);
            let (near_y, far_y) = planes(1, &node.child_min_y, &node.child_max_y, half);
            let (near_z, far_z) = planes(2, &node.child_min_z, &node.child_max_z, half);
            let near = near_x.max(near_y).max(near_z.max(Vec4::ZERO));
            let far = far_x.min(far_y).min(far_z.min(Vec4::splat(t_max)));
            met |= near.cmple(far).bitmask() << (4 * half);
        }
        let mut hits = 0;
        while met != 0 {
            let shift = 8 * met.trailing_zeros();
            met &= met - 1;
            hits |= ((child_bits >> shift) as u32 & 7) << ((bit_index >> shift) & 31);
        }
        hits
    }
}

#[inline(always)]
fn four(bytes: &[u8; 8], half: usize) -> Vec4 {
    let i = half * 4;
    Vec4::new(bytes[i] as f32, bytes[i + 1] as f32, bytes[i + 2] as f32, bytes[i + 3] as f32)
}

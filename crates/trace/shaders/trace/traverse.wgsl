//#use triangle
//#use hit
// Traversal of the hierarchies. Twin of rays/bvh.rs, node.rs and geometry.rs. Needs `load` (scene_texture or
// scene_storage) and `accept_hit` (accept_all or alpha_test).
//
// Elements of the scene buffer are vec4u. A node has five: corner, and exponents with the mask of inner children;
// first child, first triangle, meta bytes; then one byte per child for each of min x, max x, min y, max y, min z, max
// z. A triangle has three: a corner each, with flags, source and light.

// First elements of the static and the moving nodes.
override NODES: u32 = 0u;
override MOVING_NODES: u32 = 0u;
// Whether hits need an alpha test.
override ALPHA: bool = false;

const NODE_SLACK: f32 = 1.0 / 524288.0;
const MIN_DIRECTION: f32 = 1.0 / 1152921504606846976.0;
const FLAG_ALPHA: u32 = 0x1000000u;
const STACK: u32 = 32u;

struct Ray {
    origin: vec3f,
    direction: vec3f,
    t_max: f32,
}

// Nearest hit. `key` is passed on to `accept_hit`.
fn closest(ray: Ray, key: u32) -> Hit {
    let none = Hit(NO_TRIANGLE, ray.t_max, 0.0, 0.0);
    if !is_valid_ray(ray) {
        return none;
    }
    var hit = traverse(ray, key, NODES, TRIANGLES, 0u, none, false);
    if MOVES {
        hit = traverse(ray, key, MOVING_NODES, MOVING_TRIANGLES, FIRST_MOVING, hit, false);
    }
    return hit;
}

// Whether the ray hits anything.
fn occluded(ray: Ray, key: u32) -> bool {
    let none = Hit(NO_TRIANGLE, ray.t_max, 0.0, 0.0);
    if !is_valid_ray(ray) {
        return false;
    }
    if traverse(ray, key, NODES, TRIANGLES, 0u, none, true).triangle != NO_TRIANGLE {
        return true;
    }
    if MOVES {
        return traverse(ray, key, MOVING_NODES, MOVING_TRIANGLES, FIRST_MOVING, none, true).triangle != NO_TRIANGLE;
    }
    return false;
}

// Whether the ray can hit anything: finite origin, finite nonzero direction, limit not NaN.
fn is_valid_ray(ray: Ray) -> bool {
    let nowhere = (bitcast<vec3u>(ray.origin) & vec3u(0x7fffffffu)) >= vec3u(0x7f800000u);
    let direction = bitcast<vec3u>(ray.direction) & vec3u(0x7fffffffu);
    let wild = direction >= vec3u(0x7f800000u);
    let limit = bitcast<u32>(ray.t_max) & 0x7fffffffu;
    return !any(nowhere) && !any(wild) && any(direction != vec3u(0u)) && limit <= 0x7f800000u;
}

// Bvh::traverse. `first` is the index of the hierarchy's first triangle.
fn traverse(ray: Ray, key: u32, nodes: u32, triangles: u32, first: u32, start: Hit, any_hit: bool) -> Hit {
    let shear = shear(ray.direction);
    let size_inverse = 1.0 / max(abs(ray.direction), vec3f(MIN_DIRECTION));
    let backward = ray.direction < vec3f(0.0);
    let inverse = select(size_inverse, -size_inverse, backward);
    let widening = size_inverse * NODE_SLACK;
    let octant = select(4u, 0u, backward.x) | select(2u, 0u, backward.y) | select(1u, 0u, backward.z);
    let octants = octant * 0x01010101u;

    var hit = start;
    var stack: array<vec2u, STACK>;
    var depth = 0u;
    var group = vec2u(0u, 0x80000000u);
    loop {
        let bit = firstLeadingBit(group.y);
        group.y &= ~(1u << bit);
        if group.y >= 0x1000000u {
            stack[depth] = group;
            depth++;
        }
        let slot = (bit - 24u) ^ octant;
        let child = group.x + countOneBits(group.y & ~(0xffffffffu << slot) & 0xffu);

        let at = nodes + child * 5u;
        let n0 = load(at);
        let n1 = load(at + 1u);
        let n2 = load(at + 2u);
        let n3 = load(at + 3u);
        let n4 = load(at + 4u);
        let extent = bitcast<vec3f>(((vec3u(n0.w) >> vec3u(0u, 8u, 16u)) & vec3u(0xffu)) << vec3u(23u));
        let to_node = bitcast<vec3f>(n0.xyz) - ray.origin;
        let reach3 = abs(to_node) + extent * 255.0;
        let reach = max(reach3.x, max(reach3.y, reach3.z));
        let t_step = extent * inverse;
        let near = to_node * inverse - widening * reach;
        let far = to_node * inverse + widening * reach;

        // Near and far planes per axis for the ray's direction, eight bytes each.
        let first_x = select(n2.xy, n2.zw, backward.x);
        let last_x = select(n2.zw, n2.xy, backward.x);
        let first_y = select(n3.xy, n3.zw, backward.y);
        let last_y = select(n3.zw, n3.xy, backward.y);
        let first_z = select(n4.xy, n4.zw, backward.z);
        let last_z = select(n4.zw, n4.xy, backward.z);
        var hits = 0u;
        for (var half = 0u; half < 2u; half++) {
            let meta4 = select(n1.z, n1.w, half == 1u);
            // Inner children have both bits of 0x18 set. XOR with the octant puts the nearest children into the highest
            // bits.
            let inner = (meta4 & (meta4 << 1u)) & 0x10101010u;
            let bit_index = (meta4 ^ (octants & ((inner >> 4u) * 0xffu))) & 0x1f1f1f1fu;
            let child_bits = (meta4 >> 5u) & 0x07070707u;
            let t_first_x = bytes(select(first_x.x, first_x.y, half == 1u)) * t_step.x + near.x;
            let t_first_y = bytes(select(first_y.x, first_y.y, half == 1u)) * t_step.y + near.y;
            let t_first_z = bytes(select(first_z.x, first_z.y, half == 1u)) * t_step.z + near.z;
            let t_last_x = bytes(select(last_x.x, last_x.y, half == 1u)) * t_step.x + far.x;
            let t_last_y = bytes(select(last_y.x, last_y.y, half == 1u)) * t_step.y + far.y;
            let t_last_z = bytes(select(last_z.x, last_z.y, half == 1u)) * t_step.z + far.z;
            let t_first = max(max(t_first_x, t_first_y), max(t_first_z, vec4f(0.0)));
            let t_last = min(min(t_last_x, t_last_y), min(t_last_z, vec4f(hit.t)));
            let shifts = vec4u(0u, 8u, 16u, 24u);
            let bits8 = ((vec4u(child_bits) >> shifts) & vec4u(0xffu))
                << ((vec4u(bit_index) >> shifts) & vec4u(0x1fu));
            let met = select(vec4u(0u), bits8, t_first <= t_last);
            hits |= (met.x | met.y) | (met.z | met.w);
        }
        group = vec2u(n1.x, (hits & 0xff000000u) | (n0.w >> 24u));

        var leaves = hits & 0xffffffu;
        while leaves != 0u {
            let index = n1.y + firstTrailingBit(leaves);
            leaves &= leaves - 1u;
            let r0 = load(triangles + index * 3u);
            let r1 = load(triangles + index * 3u + 1u);
            let r2 = load(triangles + index * 3u + 2u);
            let intersection = intersect(
                shear, ray.origin, bitcast<vec3f>(r0.xyz), bitcast<vec3f>(r1.xyz), bitcast<vec3f>(r2.xyz));
            let number = first + index;
            // A hit at the ray's limit does not count; among equally near triangles the lower index wins.
            let tie = intersection.t == hit.t && hit.triangle != NO_TRIANGLE && number < hit.triangle;
            if intersection.t > 0.0 && (intersection.t < hit.t || tie) {
                if ALPHA {
                    if (r0.w & FLAG_ALPHA) != 0u && !accept_hit(number, intersection.u, intersection.v, key) {
                        continue;
                    }
                }
                hit = Hit(number, intersection.t, intersection.u, intersection.v);
                if any_hit {
                    return hit;
                }
            }
        }
        if group.y < 0x1000000u {
            if depth == 0u {
                break;
            }
            depth--;
            group = stack[depth];
        }
    }
    return hit;
}

// The four bytes of a word, lowest first.
fn bytes(word: u32) -> vec4f {
    return vec4f((vec4u(word) >> vec4u(0u, 8u, 16u, 24u)) & vec4u(0xffu));
}

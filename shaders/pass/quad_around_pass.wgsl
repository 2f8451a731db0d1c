//#use inputs
//#use quads
// Nearest shaded quads around each quad: of the eight octants around shaded quads, of the four quadrants around others.
// CPU twin: `search` in src/cpu/sparse_pass/quads.rs. One invocation a quad; z is the view.
//
// 26 reads and 1 write a quad: its mask, and 25 words of blocks; 8 bytes written.

@group(0) @binding(21) var mask: texture_2d_array<u32>;
@group(0) @binding(22) var blocks: texture_2d_array<u32>;
@group(0) @binding(23) var around_out: texture_storage_2d_array<rg32uint, write>;

// Codes of four neighbours in a word.
fn codes_of(best: vec4<u32>) -> u32 {
    let codes = select(best & vec4<u32>(255u), vec4<u32>(NOWHERE), best == vec4<u32>(0xffffffffu));
    return codes.x | (codes.y << 8u) | (codes.z << 16u) | (codes.w << 24u);
}

fn search(quad: vec2<u32>, view: u32, is_shaded: bool) -> vec2<u32> {
    let size = (frame.size + 1u) / 2u;
    let last = (size + BLOCK - 1u) / BLOCK;
    var best = array<u32, 8>(~0u, ~0u, ~0u, ~0u, ~0u, ~0u, ~0u, ~0u);
    for (var tap = 0u; tap < 25u; tap++) {
        let at = vec2<i32>(quad / BLOCK) + vec2<i32>(vec2<u32>(tap % 5u, tap / 5u)) - 2;
        var left = 0u;
        if all(at >= vec2<i32>(0)) && all(at < vec2<i32>(last)) {
            left = textureLoad(blocks, at, view, 0).x;
        }
        while left != 0u {
            let bit = firstTrailingBit(left);
            left &= left - 1u;
            let offset = at * i32(BLOCK) + vec2<i32>(vec2<u32>(bit % BLOCK, bit / BLOCK)) - vec2<i32>(quad);
            if any(offset != vec2<i32>(0)) {
                let sector = select(quadrant(offset.x, offset.y), octant(offset.x, offset.y), is_shaded);
                best[sector] = min(best[sector], neighbour(offset.x, offset.y));
            }
        }
    }
    let first = vec4<u32>(best[0], best[1], best[2], best[3]);
    return vec2<u32>(codes_of(first), codes_of(vec4<u32>(best[4], best[5], best[6], best[7])));
}

@compute @workgroup_size(64, 1)
fn main(@builtin(global_invocation_id) id: vec3<u32>, @builtin(workgroup_id) group: vec3<u32>) {
    let view = frame.first_view + group.z;
    if all(2u * id.xy < frame.size) {
        let is_shaded = (textureLoad(mask, id.xy, view, 0).x & 1u) != 0u;
        textureStore(around_out, id.xy, view, vec4<u32>(search(id.xy, view, is_shaded), 0u, 0u));
    }
}

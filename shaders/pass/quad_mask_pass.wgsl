//#use quad_list
//#use quad_state
// Shaded quads of a view: a mask, an unordered list, and a word for each block of 4x4 quads. CPU twin: `plan_quads` in
// src/cpu/sparse_pass/quad_plan.rs. One invocation a block.

struct QuadSize {
    // Number of quads along x and y.
    size: vec2<u32>,
    view: u32,
    unused: u32,
}

@group(0) @binding(0) var<uniform> quads: QuadSize;
@group(0) @binding(21) var keys: texture_2d_array<u32>;
@group(0) @binding(23) var mask_out: texture_storage_2d_array<r32uint, write>;
@group(0) @binding(24) var blocks_out: texture_storage_2d_array<r32uint, write>;

@compute @workgroup_size(64, 1)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let first = BLOCK * id.xy;
    if any(first >= quads.size) {
        return;
    }
    var shaded = 0u;
    for (var i = 0u; i < BLOCK * BLOCK; i++) {
        let quad = first + vec2<u32>(i % BLOCK, i / BLOCK);
        if all(quad < quads.size) {
            let word = textureLoad(keys, quad, quads.view, 0).x;
            let region_now = (word >> 16u) & 3u;
            let is_shaded = (word & 0x40000u) != 0u || (word & 0xffffu) >= state.threshold;
            shaded |= u32(is_shaded) << i;
            textureStore(mask_out, quad, quads.view, vec4<u32>(u32(is_shaded) | (region_now << 1u), 0u, 0u, 0u));
        }
    }
    textureStore(blocks_out, id.xy, quads.view, vec4<u32>(shaded, 0u, 0u, 0u));
    var place = atomicAdd(&state.listed, countOneBits(shaded));
    for (var left = shaded; left != 0u; left &= left - 1u) {
        let i = firstTrailingBit(left);
        let quad = first + vec2<u32>(i % BLOCK, i / BLOCK);
        list.quads[place] = quad.x | (quad.y << 16u);
        place++;
    }
}

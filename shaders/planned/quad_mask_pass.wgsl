//#use quad_list
//#use quad_state
// Shaded quads of a view: a mask, an unordered list, and a word for each run of 16 quads of a row. CPU twins:
// `plan_quads` in src/cpu/planned/quad_plan.rs, `runs` in src/cpu/quads.rs. One invocation a run.
//
// 2 reads and 1 write a quad: its key, for its own run and for one beside it; 4.25 bytes written.

struct QuadSize {
    // Number of quads along x and y.
    size: vec2u,
    view: u32,
    unused: u32,
}

@group(0) @binding(0) var<uniform> quads: QuadSize;
@group(0) @binding(21) var keys: texture_2d_array<u32>;
@group(0) @binding(23) var mask_out: texture_storage_2d_array<r32uint, write>;
@group(0) @binding(24) var runs_out: texture_storage_2d_array<r32uint, write>;

@compute @workgroup_size(16, 4)
fn main(@builtin(global_invocation_id) id: vec3u) {
    let first = vec2u(RUN_QUADS * id.x, id.y);
    if any(first >= quads.size) {
        return;
    }
    var shaded = 0u;
    for (var i = 0u; i < 2u * RUN_QUADS; i++) {
        // Wraps to a large number before the first column.
        let quad = vec2u(first.x + i - u32(REACH), first.y);
        if quad.x < quads.size.x {
            let word = textureLoad(keys, quad, quads.view, 0).x;
            let is_even = (word & 0x10000u) != 0u;
            let is_shaded = is_even || (word & 0x3fffu) >= state.threshold;
            shaded |= u32(is_shaded) << i;
            if is_own(i) {
                let pixels = select(0u, (word >> 17u) & 15u, is_shaded);
                let region_now = (word >> 14u) & 3u;
                let code = (word >> 21u) & 63u;
                let further = select(0u, (code << HASH_BITS) | (word & 255u), code > 0u);
                let count = paths(word & 0x3fffu, further, word >> 27u, is_even, state.threshold);
                textureStore(mask_out, quad, quads.view, vec4u(pixels | (region_now << 4u) | (count << 8u), 0u, 0u, 0u));
            }
        }
    }
    textureStore(runs_out, id.xy, quads.view, vec4u(shaded, 0u, 0u, 0u));
    var left = (shaded >> u32(REACH)) & 0xffffu;
    var place = atomicAdd(&state.listed, countOneBits(left));
    while left != 0u {
        list.quads[place] = (first.x + firstTrailingBit(left)) | (first.y << 16u);
        left &= left - 1u;
        place++;
    }
}

// Whether bit `i` of a run's word is one of its own quads.
fn is_own(i: u32) -> bool {
    return i - u32(REACH) < RUN_QUADS;
}

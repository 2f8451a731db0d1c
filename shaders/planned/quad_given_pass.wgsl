//#use inputs
//#use quad_state
// Quads of a frame whose pixels the renderer chose itself, in place of a key by need. CPU twin: `given_quads` in
// src/cpu/planned/quad_plan.rs. One invocation a quad of view `frame.first_view`.
//
// 4 reads and 1 write a quad; 1 atomic sum a workgroup.

@group(0) @binding(7) var mask_in: texture_2d_array<f32>;
@group(0) @binding(23) var keys_out: texture_storage_2d_array<r32uint, write>;

const MASK_IN: u32 = 7u;

fn mask_of(quad: vec2u, view: u32) -> u32 {
    var all_bits = 0u;
    var inside_bits = 0u;
    for (var place = 0u; place < 4u; place++) {
        let px = 2u * quad + vec2u(place & 1u, place >> 1u);
        let inside = all(px < frame.size);
        let at = texel_of(min(px, frame.size - 1u), view, MASK_IN);
        let chosen = !inside || textureLoad(mask_in, at, layer_of(view), 0).x > 0.5;
        all_bits |= u32(chosen) << place;
        inside_bits |= u32(inside) << place;
    }
    // A quad at the frame's edge is whole with its pixels inside.
    return select(all_bits & inside_bits, WHOLE, all_bits == WHOLE);
}

@compute @workgroup_size(64, 1)
fn main(@builtin(global_invocation_id) id: vec3u) {
    let view = frame.first_view;
    if any(2u * id.xy >= frame.size) {
        return;
    }
    let mask = mask_of(id.xy, view);
    let even = mask != 0u;
    if even {
        atomicAdd(&state.even, 1u);
    }
    textureStore(keys_out, id.xy, view, vec4u(key_word(0u, IN_PERIPHERY, even, mask), 0u, 0u, 0u));
}

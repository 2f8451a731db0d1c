//#use repair_list
//#use repair_state
// Quads of a view that a plan chose: a mask, and an unordered list. CPU twin: `plan` in src/cpu/sparse_pass/plan.rs.
// One invocation a quad of 2x2 pixels.

struct RepairQuads {
    // Number of quads along x and y.
    size: vec2<u32>,
    view: u32,
    unused: u32,
}

@group(0) @binding(0) var<uniform> quads: RepairQuads;
@group(0) @binding(21) var keys: texture_2d_array<u32>;
@group(0) @binding(23) var mask_out: texture_storage_2d_array<r32uint, write>;

@compute @workgroup_size(64, 1)
fn main(@builtin(global_invocation_id) quad: vec3<u32>) {
    if any(quad.xy >= quads.size) {
        return;
    }
    let chosen = textureLoad(keys, quad.xy, quads.view, 0).x >= state.threshold;
    if chosen {
        list.quads[atomicAdd(&state.listed, 1u)] = quad.x | (quad.y << 16u);
    }
    textureStore(mask_out, quad.xy, quads.view, vec4<u32>(u32(chosen), 0u, 0u, 0u));
}

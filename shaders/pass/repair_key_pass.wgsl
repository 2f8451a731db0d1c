//#use kept_history
//#use lattices
//#use repair_state
// How much the quads of a sparse frame want samples of their own, before it is shaded. CPU twin: `key` in
// src/cpu/sparse_pass/plan.rs. One invocation a quad of 2x2 pixels of view `frame.first_view`.
//
// 7 reads a pixel (depth, motion, trust, 4 stored samples; 9 more of depth and 5 more of stored samples with
// antialiasing), 1 write and 1 atomic sum a quad.

@group(0) @binding(18) var keys_out: texture_storage_2d_array<r32uint, write>;

// How much a pixel wants a sample of its own.
fn pixel_priority(px: vec2<u32>, view: u32) -> u32 {
    let lattice = lattice_at(px, view);
    let near = around(px, lattice);
    let is_sample = near.any && near.x.fraction == 0.0 && near.y.fraction == 0.0;
    let surface = surface_of(px, view, lattice.level);
    let source = kept_source(px, view, surface);
    let kept = kept_history(source, view, may_have_history(source.previous) && !is_sample);
    let e_deg = eccentricity_deg(ray_at(px, view), frame.views[view].gaze_ray.xyz);
    return select(priority(kept.found.lod, e_deg), 0u, is_sample);
}

@compute @workgroup_size(64, 1)
fn main(@builtin(global_invocation_id) quad: vec3<u32>) {
    let view = frame.first_view;
    if any(2u * quad.xy >= frame.size) {
        return;
    }
    var largest = 0u;
    for (var pixel = 0u; pixel < 4u; pixel++) {
        let px = 2u * quad.xy + vec2<u32>(pixel % 2u, pixel / 2u);
        if all(px < frame.size) {
            largest = max(largest, pixel_priority(px, view));
        }
    }
    let key = quad_key(largest, quad.x, quad.y, frame.frame_low, frame.views[view].key);
    if key > 0u {
        atomicAdd(&state.counts[key], 1u);
    }
    textureStore(keys_out, quad.xy, view, vec4<u32>(key, 0u, 0u, 0u));
}

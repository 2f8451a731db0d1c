//#use inputs
//#use output
// Moves the bytes of wrs_pass with depth and motion, and computes nothing: the time that benches hold the passes
// against. Bound in place of wrs_pass; the history that it leaves is worthless.

// wrs_pass's, which its pipelines set.
override SAMPLER: u32 = 0u;
override BIAS: u32 = 2u;
override GATE: u32 = 1u;
override WEIGHT_EXPONENT: u32 = 1u;
override RATE_EXPONENT: u32 = 0u;
override HAS_REFERENCES: u32 = 0u;
override HAS_LOD: u32 = 0u;
override FILTER: u32 = 0u;

@group(0) @binding(15) var past_colors: texture_2d_array<u32>;
@group(0) @binding(16) var past_weights: texture_2d_array<u32>;
@group(0) @binding(18) var next_colors: texture_storage_2d_array<rg32uint, write>;
@group(0) @binding(19) var next_weights: texture_storage_2d_array<r32uint, write>;

@compute @workgroup_size(64, 1)
fn main(@builtin(global_invocation_id) id: vec3u, @builtin(workgroup_id) group: vec3u) {
    let px = id.xy;
    let view = group.z;
    if px.x >= frame.size.x || px.y >= frame.size.y {
        return;
    }
    let candidate = color(color_at(px, view).xyz);
    let motion = textureLoad(motion_in, px, view, 0).xy;
    let depth = textureLoad(depth_in, px, view, 0).x;
    let words = textureLoad(past_colors, px, view, 0).xy;
    let weight_word = textureLoad(past_weights, px, view, 0).x;
    // Nothing that was read may be optimised away.
    let used = bitcast<u32>(motion.x) ^ bitcast<u32>(motion.y) ^ bitcast<u32>(depth);
    textureStore(next_colors, px, view, vec4u(words, 0u, 0u));
    textureStore(next_weights, px, view, vec4u(weight_word ^ used, 0u, 0u, 0u));
    textureStore(color_out, px, view, vec4f(candidate.color, 1.0));
}

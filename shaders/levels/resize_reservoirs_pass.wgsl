//#use resize_uniforms
// Reservoirs of history at another size. Each pixel takes the nearest reservoir, because samples are never mixed. CPU
// twin: src/cpu/resize.rs. One invocation a pixel; z is the view.

override HAS_EXTRAS: u32 = 0u;

@group(0) @binding(15) var past_colors: texture_2d_array<u32>;
@group(0) @binding(16) var past_weights: texture_2d_array<u32>;
@group(0) @binding(17) var past_extras: texture_2d_array<u32>;
@group(0) @binding(18) var next_colors: texture_storage_2d_array<rg32uint, write>;
@group(0) @binding(19) var next_weights: texture_storage_2d_array<r32uint, write>;
@group(0) @binding(20) var next_extras: texture_storage_2d_array<r32uint, write>;

@compute @workgroup_size(64, 1)
fn main(@builtin(global_invocation_id) id: vec3u, @builtin(workgroup_id) group: vec3u) {
    if any(id.xy >= resize.size_px) {
        return;
    }
    let at = nearest_to(old_position_of(id.xy));
    textureStore(next_colors, id.xy, group.z, textureLoad(past_colors, at, group.z, 0));
    textureStore(next_weights, id.xy, group.z, textureLoad(past_weights, at, group.z, 0));
    if HAS_EXTRAS != 0u {
        textureStore(next_extras, id.xy, group.z, textureLoad(past_extras, at, group.z, 0));
    }
}

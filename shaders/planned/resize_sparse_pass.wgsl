//#use antialias
//#use stored_sample
//#use resize_uniforms
// Stored samples of history at another size. Each pixel takes the nearest sample, which keeps its place. CPU twin:
// src/cpu/resize.rs. One invocation a pixel; z is the view.

@group(0) @binding(15) var past_stored: texture_2d_array<u32>;
@group(0) @binding(16) var past_noise: texture_2d_array<u32>;
@group(0) @binding(17) var past_extra: texture_2d_array<u32>;
@group(0) @binding(18) var next_stored: texture_storage_2d_array<rg32uint, write>;
@group(0) @binding(19) var next_noise: texture_storage_2d_array<r32uint, write>;
@group(0) @binding(20) var next_extra: texture_storage_2d_array<r32uint, write>;

override NOISY: u32 = 0u;
// Whether the stored samples are means of samples.
override MEANS: u32 = 0u;
// Whether they have alphas or albedos.
override HAS_EXTRA: u32 = 0u;

@compute @workgroup_size(64, 1)
fn main(@builtin(global_invocation_id) id: vec3u, @builtin(workgroup_id) group: vec3u) {
    if any(id.xy >= resize.size_px) {
        return;
    }
    let position = old_position_of(id.xy);
    let at = nearest_to(position);
    let old = textureLoad(past_stored, at, group.z, 0).xy;
    var stored = unpack_stored(old);
    var mean = mean_of(stored.lod);
    if MEANS != 0u {
        stored.lod = mean.lod;
    }
    var moved = moved_stored(stored, vec2f(at) - position, 1.0 / resize.ratio, resize.lod_shift);
    if MEANS != 0u {
        mean.lod = moved.lod;
        moved.lod = stored_lod(mean, vec2f(0.5));
    }
    textureStore(next_stored, id.xy, group.z, vec4u(resized_stored(old, moved), 0u, 0u));
    if NOISY != 0u {
        textureStore(next_noise, id.xy, group.z, textureLoad(past_noise, at, group.z, 0));
    }
    if HAS_EXTRA != 0u {
        textureStore(next_extra, id.xy, group.z, textureLoad(past_extra, at, group.z, 0));
    }
}

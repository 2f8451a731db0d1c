//#use noise
//#use origin
//#use surface
// First level of the mip chain of noisy candidates: means of 2x2 pixels without non-finite ones; at odd borders a
// missing pixel is replaced by its neighbour. CPU twin: MipChain::build_candidates in src/cpu/mip_chain.rs.
// mip_chain_pass computes the other levels. One invocation a texel of the level; z is the view.
//
// 4 reads of 12 bytes and 1 write of 8 a texel: 12 bytes a pixel read, 2 written.

// src/gpu/uniforms.rs: CandidateUniforms, which documents the fields
struct CandidateUniforms {
    size: vec2<u32>,
    color_origin: u32,
    noise_origin: u32,
    first_view: u32,
    unused_0: u32,
    unused_1: u32,
    unused_2: u32,
}

@group(0) @binding(0) var<uniform> frame: CandidateUniforms;
@group(0) @binding(1) var color_in: texture_2d_array<f32>;
@group(0) @binding(2) var noise_in: texture_2d_array<f32>;
@group(0) @binding(3) var coarse: texture_storage_2d_array<rgba16float, write>;

fn texel(at: vec2<u32>, layer: u32) -> vec4<f32> {
    let px = min(at, frame.size - 1u);
    let candidate = color(textureLoad(color_in, from_origin(px, frame.color_origin), layer, 0).xyz);
    let noise = candidate_noise(textureLoad(noise_in, from_origin(px, frame.noise_origin), layer, 0).xy);
    return candidate_texel(candidate.color, candidate.usable, noise);
}

@compute @workgroup_size(64, 1)
fn main(@builtin(global_invocation_id) id: vec3<u32>, @builtin(workgroup_id) group: vec3<u32>) {
    let first = 2u * id.xy;
    if any(first >= frame.size) {
        return;
    }
    let mean = candidate_mean(
        texel(first, group.z),
        texel(first + vec2<u32>(1u, 0u), group.z),
        texel(first + vec2<u32>(0u, 1u), group.z),
        texel(first + vec2<u32>(1u, 1u), group.z),
    );
    textureStore(coarse, id.xy, frame.first_view + group.z, round_mip(mean));
}

//#use inputs
//#use mip_noise
//#use surface
// First level of the mip chain of noisy candidates: means of 2x2 pixels without non-finite ones; at odd borders a
// missing pixel is replaced by its neighbour. CPU twin: MipChain::build_candidates in src/cpu/levels/mip_chain.rs.
// mip_chain_pass computes the other levels. One invocation a texel of the level; z is the view.
//
// 4 reads of 12 bytes and 1 write of 8 a texel: 12 bytes a pixel read, 2 written.

@group(0) @binding(23) var coarse: texture_storage_2d_array<rgba16float, write>;

fn texel(at: vec2u, view: u32) -> vec4f {
    let px = min(at, frame.size - 1u);
    let candidate = color(color_at(px, view).xyz);
    return candidate_texel(candidate.color, candidate.usable, noise_at(px, view));
}

@compute @workgroup_size(64, 1)
fn main(@builtin(global_invocation_id) id: vec3u, @builtin(workgroup_id) group: vec3u) {
    let first = 2u * id.xy;
    if any(first >= frame.size) {
        return;
    }
    let view = frame.first_view + group.z;
    let mean = candidate_mean(
        texel(first, view),
        texel(first + vec2u(1u, 0u), view),
        texel(first + vec2u(0u, 1u), view),
        texel(first + vec2u(1u, 1u), view),
    );
    textureStore(coarse, id.xy, view, round_mip(mean));
}

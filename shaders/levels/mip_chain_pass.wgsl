//#use smr
//#use mip_noise
//#use surface
// Next level of a mip chain of surfaces or noisy candidates: means of 2x2 texels; at odd borders a missing texel is
// replaced by its neighbour. CPU twin: MipChain::fill in src/cpu/levels/mip_chain.rs. One invocation a texel of the
// coarser level; z is the view.
//
// 4 reads and 1 write of 8 bytes a texel; all levels from the second on together read 2.7 bytes a pixel and write 0.7.

// 1: a mip chain of candidates; 0: of surfaces.
override CANDIDATES: u32 = 0u;

// Size of the finer level; its texture may be larger.
@group(0) @binding(0) var<uniform> fine_size: vec2u;
@group(0) @binding(21) var fine: texture_2d_array<f32>;
@group(0) @binding(23) var coarse: texture_storage_2d_array<rgba16float, write>;

fn texel(at: vec2u, view: u32) -> vec4f {
    return textureLoad(fine, min(at, fine_size - 1u), view, 0);
}

@compute @workgroup_size(64, 1)
fn main(@builtin(global_invocation_id) id: vec3u, @builtin(workgroup_id) group: vec3u) {
    let first = 2u * id.xy;
    if any(first >= fine_size) {
        return;
    }
    let a = texel(first, group.z);
    let b = texel(first + vec2u(1u, 0u), group.z);
    let c = texel(first + vec2u(0u, 1u), group.z);
    let d = texel(first + vec2u(1u, 1u), group.z);
    var mean = mip_mean(a, b, c, d);
    if CANDIDATES != 0u {
        mean = candidate_mean(a, b, c, d);
    }
    textureStore(coarse, id.xy, group.z, round_mip(mean));
}

//#use foveate
//#use sanitize
// Next mip level: means of 2x2 texels; non-finite texels count as black. At odd borders a missing texel is replaced by
// its neighbour. CPU twin: halve in src/simulator/mip.rs. One invocation a texel of the coarser level; z is the view.
//
// 4 reads and 1 write a texel. With a frame of 8 bytes a pixel and levels of 16 bytes a texel, all levels together read
// 8 + 4 + 1 + ... = 13.3 bytes a pixel and write 4 + 1 + ... = 5.3.

// Size of the finer level; its texture may be larger.
@group(0) @binding(0) var<uniform> fine_size: vec2u;
@group(0) @binding(1) var fine: texture_2d_array<f32>;
@group(0) @binding(2) var coarse: texture_storage_2d_array<rgba32float, write>;

fn texel(at: vec2u, view: u32) -> vec3f {
    return color(textureLoad(fine, min(at, fine_size - 1u), view, 0).xyz).color;
}

@compute @workgroup_size(64, 1)
fn main(@builtin(global_invocation_id) id: vec3u, @builtin(workgroup_id) group: vec3u) {
    if id.x >= level_len(fine_size.x, 1u) || id.y >= level_len(fine_size.y, 1u) {
        return;
    }
    let view = group.z;
    let at = 2u * id.xy;
    let mean = mean_of_four(
        texel(at, view),
        texel(at + vec2u(1u, 0u), view),
        texel(at + vec2u(0u, 1u), view),
        texel(at + vec2u(1u, 1u), view),
    );
    textureStore(coarse, id.xy, view, vec4f(mean, 1.0));
}

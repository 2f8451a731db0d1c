// The chosen pixels of a frame, as a mask with a texel for each: what another context is given in place of a plan.

@group(0) @binding(0) var quad_mask: texture_2d<u32>;
@group(0) @binding(1) var mask_out: texture_storage_2d<r32float, write>;

@compute @workgroup_size(8, 8)
fn pixels(@builtin(global_invocation_id) id: vec3u) {
    let bits = textureLoad(quad_mask, id.xy / 2u, 0).x;
    let place = (id.x & 1u) | ((id.y & 1u) << 1u);
    textureStore(mask_out, id.xy, vec4f(f32((bits >> place) & 1u)));
}

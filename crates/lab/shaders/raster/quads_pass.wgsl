//#use raster_frame
// Depth of chosen quads of 2x2 pixels: the far plane. The rest of the target is at the near plane, where the depth test
// rejects whatever is drawn then. Where a G-buffer has the opaque surfaces, the quads get their depth.

// The list of gpu::Afterimage::quad_list.
@group(1) @binding(0) var<storage, read> list: array<u32>;

@vertex
fn quad(@builtin(vertex_index) vertex: u32, @builtin(instance_index) instance: u32) -> @builtin(position) vec4f {
    // Corners of two triangles.
    let corner = vec2u(0x32u >> vertex, 0x2cu >> vertex) & vec2u(1u);
    let word = list[8u + instance];
    let px = vec2f(2u * (vec2u(word & 0xffffu, word >> 16u) + corner));
    let at = 2.0 * px / frame.size - vec2f(1.0);
    return vec4f(at.x, -at.y, 0.0, 1.0);
}

// Writes no color.
@fragment
fn nothing() {}

// Depth of the opaque surfaces.
@group(2) @binding(0) var opaque_map: texture_2d<f32>;

@fragment
fn opaque_depth(@builtin(position) position: vec4f) -> @builtin(frag_depth) f32 {
    return textureLoad(opaque_map, vec2u(position.xy), 0).x;
}

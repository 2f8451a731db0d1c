// Writes the depth of a prepass: of chosen quads of 2x2 pixels, or of the whole target.

@group(0) @binding(0) var depth: texture_depth_2d;
// The list of gpu::Afterimage::repair_quads.
@group(0) @binding(1) var<storage, read> list: array<u32>;
// Size of the view in pixels; the rest is unused.
@group(0) @binding(2) var<uniform> size: vec4<u32>;

@vertex
fn quad(
    @builtin(vertex_index) vertex: u32,
    @builtin(instance_index) instance: u32,
) -> @builtin(position) vec4<f32> {
    // Corners of two triangles.
    let corner = vec2<u32>(0x32u >> vertex, 0x2cu >> vertex) & vec2<u32>(1u);
    let word = list[8u + instance];
    let px = vec2<f32>(2u * (vec2<u32>(word & 0xffffu, word >> 16u) + corner));
    let at = 2.0 * px / vec2<f32>(size.xy) - vec2<f32>(1.0);
    return vec4<f32>(at.x, -at.y, 0.0, 1.0);
}

@vertex
fn all(@builtin(vertex_index) vertex: u32) -> @builtin(position) vec4<f32> {
    let corner = vec2(f32(vertex & 1u), f32(vertex >> 1u));
    return vec4(corner * 4.0 - 1.0, 0.0, 1.0);
}

@fragment
fn fragment(@builtin(position) position: vec4<f32>) -> @builtin(frag_depth) f32 {
    return textureLoad(depth, vec2<u32>(position.xy), 0);
}

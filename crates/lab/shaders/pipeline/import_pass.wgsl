//#use sanitize
// A rasterized frame in the pipeline's form: color without non-finite pixels, distance along the view axis. Twin on the
// CPU: RasterSource::frame in crates/lab/src/source/raster.rs. One invocation a pixel.
//
// Reads 8 + 4 bytes and writes 16 + 4 bytes a pixel.

// Distance of the near plane.
@group(0) @binding(0) var<uniform> near: f32;
@group(0) @binding(1) var color_in: texture_2d_array<f32>;
// Near plane over distance; 0 for pixels without a surface.
@group(0) @binding(2) var depth_in: texture_2d_array<f32>;
@group(0) @binding(3) var color_out: texture_storage_2d_array<rgba32float, write>;
@group(0) @binding(4) var distance_out: texture_storage_2d_array<r32float, write>;

@compute @workgroup_size(64, 1)
fn main(@builtin(global_invocation_id) id: vec3u) {
    let px = id.xy;
    let size = textureDimensions(color_in);
    if px.x >= size.x || px.y >= size.y {
        return;
    }
    let c = textureLoad(color_in, px, 0, 0).xyz;
    let usable = is_finite(c.x) && is_finite(c.y) && is_finite(c.z);
    textureStore(color_out, px, 0, vec4f(select(vec3f(0.0), c, usable), 1.0));
    let d = textureLoad(depth_in, px, 0, 0).x;
    // Infinity, which WGSL has no literal of.
    let infinity = bitcast<f32>(0x7f800000u);
    textureStore(distance_out, px, 0, vec4f(select(infinity, near / d, d > 0.0)));
}

//#use sanitize
// Composes quad views into a frame: each is enlarged bilinearly and laid over the coarser ones, with a linear blend
// around what it hides. Depth and motion are those of the nearest pixel of the finest view that shows at least half.
// One invocation a pixel.
//
// Reads up to 4 x 8 + 12 bytes a view and writes 16 + 4 + 4 + 8 bytes a pixel.

// QuadViewRecord in crates/lab/src/raster/compose.rs.
struct QuadView {
    // Rectangle of the frame in which it hides coarser views: first pixel, and pixel after the last.
    opaque_low: vec2f,
    opaque_high: vec2f,
    first: vec2f,
    points: vec2f,
    texel: vec2u,
    step: f32,
    lod: f32,
    blend_px: f32,
    unused: array<f32, 3>,
}

struct Composition {
    views: array<QuadView, 3>,
    count: u32,
    // Distance of the near plane.
    near: f32,
    unused: array<f32, 2>,
}

@group(0) @binding(0) var<storage, read> composition: Composition;
@group(0) @binding(1) var color_in: texture_2d_array<f32>;
// Near plane over distance; 0 for pixels without a surface.
@group(0) @binding(2) var depth_in: texture_2d_array<f32>;
@group(0) @binding(3) var motion_in: texture_2d_array<f32>;
@group(0) @binding(4) var color_out: texture_storage_2d_array<rgba32float, write>;
@group(0) @binding(5) var distance_out: texture_storage_2d_array<r32float, write>;
@group(0) @binding(6) var motion_out: texture_storage_2d_array<rg32float, write>;
@group(0) @binding(7) var lod_out: texture_storage_2d_array<r32float, write>;

// Color of an atlas texel; black where it is not finite.
fn texel_color(texel: vec2u) -> vec3f {
    let c = textureLoad(color_in, texel, 0, 0).xyz;
    return select(vec3f(0.0), c, is_finite(c.x) && is_finite(c.y) && is_finite(c.z));
}

// Share of a view in the pixel with this centre, 0 to 1. Corners of the frame's pixels are at integers here.
fn share(view: QuadView, center: vec2f) -> f32 {
    let outside = max(view.opaque_low - center, center - view.opaque_high);
    let away = max(outside.x, outside.y);
    if away <= 0.0 {
        return 1.0;
    }
    return max(1.0 - away / max(view.blend_px, 1e-6), 0.0);
}

@compute @workgroup_size(64, 1)
fn main(@builtin(global_invocation_id) id: vec3u) {
    let px = id.xy;
    let size = textureDimensions(color_out);
    if px.x >= size.x || px.y >= size.y {
        return;
    }
    let center = vec2f(px) + vec2f(0.5);
    var color = vec3f(0.0);
    var lod = 0.0;
    var nearest = vec2u(0u);
    for (var i = composition.count; i > 0u; i--) {
        let view = composition.views[i - 1u];
        let share = share(view, center);
        if share <= 0.0 {
            continue;
        }
        // In pixels of the view, whose centres are at integers.
        let at = clamp(center / view.step - view.first - vec2f(0.5), vec2f(0.0), view.points - vec2f(1.0));
        let low = floor(at);
        let part = at - low;
        let next = min(low + vec2f(1.0), view.points - vec2f(1.0));
        let a = view.texel + vec2u(low);
        let b = view.texel + vec2u(next);
        let above = mix(texel_color(a), texel_color(vec2u(b.x, a.y)), part.x);
        let below = mix(texel_color(vec2u(a.x, b.y)), texel_color(b), part.x);
        color = mix(color, mix(above, below, part.y), share);
        lod = mix(lod, view.lod, share);
        if share >= 0.5 {
            nearest = view.texel + vec2u(floor(at + vec2f(0.5)));
        }
    }
    textureStore(color_out, px, 0, vec4f(color, 1.0));
    textureStore(lod_out, px, 0, vec4f(lod));
    let d = textureLoad(depth_in, nearest, 0, 0).x;
    // Infinity, which WGSL has no literal of.
    let infinity = bitcast<f32>(0x7f800000u);
    textureStore(distance_out, px, 0, vec4f(select(infinity, composition.near / d, d > 0.0)));
    textureStore(motion_out, px, 0, textureLoad(motion_in, nearest, 0, 0));
}

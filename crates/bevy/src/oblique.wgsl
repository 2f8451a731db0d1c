// Turns depth into that of a plain projection: near plane over distance, 0 where nothing is. That of an orthographic
// one becomes an exponential, 1 at the near plane.

// Exponents from the far plane to the near one.
const SPAN: f32 = 40.0;

struct Oblique {
    /// Depth of what is infinitely far, by pixels to the right and down, and a constant; a factor on what is above it.
    plane: vec4f,
    /// First pixel of the viewport.
    origin_px: vec2u,
    is_orthographic: u32,
}

@group(0) @binding(0) var depth: texture_depth_2d;
@group(0) @binding(1) var plain: texture_storage_2d<r32float, write>;
@group(0) @binding(2) var<uniform> oblique: Oblique;

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3u) {
    let at = id.xy;
    if any(at >= textureDimensions(plain)) {
        return;
    }
    let found = textureLoad(depth, at + oblique.origin_px, 0);
    let far = dot(oblique.plane.xyz, vec3f(vec2f(at) + 0.5, 1.0));
    let near_over_distance = clamp((found - far) * oblique.plane.w, 0.0, 1.0);
    let mapped = select(near_over_distance, exp(SPAN * (found - 1.0)), oblique.is_orthographic == 1u);
    textureStore(plain, at, vec4f(select(mapped, 0.0, found == 0.0)));
}

// Depth that hides unshaded quads from later draws: a full-screen triangle, which is discarded at shaded quads and
// elsewhere has the depth of the near plane. It reads no depth and writes none of its own, so that it fits every depth
// format and leaves hierarchical depth on.

// Depth of the near plane.
override NEAR: f32 = 0.0;

struct PrimedView {
    // First pixel of the view in the target, and its size.
    origin: vec2u,
    size: vec2u,
    view: u32,
    // Whether quads that are shaded in part are closed, too.
    is_half: u32,
}

@group(0) @binding(0) var<uniform> primed: PrimedView;
@group(0) @binding(27) var mask: texture_2d_array<u32>;

@vertex
fn corner(@builtin(vertex_index) vertex: u32) -> @builtin(position) vec4f {
    let at = vec2f(f32(vertex & 1u), f32(vertex >> 1u));
    return vec4f(4.0 * at - vec2f(1.0), NEAR, 1.0);
}

@fragment
fn close(@builtin(position) position: vec4f) {
    let at = vec2u(position.xy) - primed.origin;
    // Some devices do not clip single samples at the scissor's edges.
    let place = (at.x & 1u) | ((at.y & 1u) << 1u);
    let pixels = textureLoad(mask, at >> vec2u(1u), primed.view, 0).x & 15u;
    let is_open = ((pixels >> place) & 1u) != 0u && (primed.is_half == 0u || pixels == 15u);
    if any(at >= primed.size) || is_open {
        discard;
    }
}

// Draws a frame to a camera's viewport, for main textures that compute shaders cannot write.

@group(0) @binding(0) var frame: texture_2d<f32>;

struct Corner {
    @builtin(position) position: vec4f,
    /// In the viewport, which has the frame's size.
    @location(0) at_px: vec2f,
}

@vertex
fn vertex(@builtin(vertex_index) index: u32) -> Corner {
    let at = 2.0 * vec2(f32(index & 1u), f32(index >> 1u));
    let position = vec4(2.0 * at.x - 1.0, 1.0 - 2.0 * at.y, 0.0, 1.0);
    return Corner(position, at * vec2f(textureDimensions(frame)));
}

@fragment
fn fragment(corner: Corner) -> @location(0) vec4f {
    return textureLoad(frame, vec2u(corner.at_px), 0);
}

// The scene buffer as a texture. On software Vulkan, textureLoad costs a fifth of a storage buffer read.

// Base-2 logarithm of the row width in elements.
override SCENE_WIDTH_LOG2: u32 = 10u;

@group(0) @binding(0) var scene_buffer: texture_2d<u32>;

// Element `i` of the scene buffer.
fn load(i: u32) -> vec4u {
    return textureLoad(scene_buffer, vec2u(i & ((1u << SCENE_WIDTH_LOG2) - 1u), i >> SCENE_WIDTH_LOG2), 0);
}

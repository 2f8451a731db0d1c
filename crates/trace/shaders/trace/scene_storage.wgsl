// The scene buffer as a storage buffer.

@group(0) @binding(0) var<storage, read> scene_buffer: array<vec4u>;

// Element `i` of the scene buffer.
fn load(i: u32) -> vec4u {
    return scene_buffer[i];
}

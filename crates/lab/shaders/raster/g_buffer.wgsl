//#use octahedral
//#use pack
//#use stored_sample
// Surfaces as the G-buffer has them. With depth (4 bytes) and motion (8 bytes) it takes 32 bytes a pixel:
//
// | target | format | contents |
// |---|---|---|
// | base | `Rgba8Unorm`, 4 bytes | square root of the base color; metalness |
// | words | `Rgba32Uint`, 16 bytes | normal; slopes of the depth; emitted radiance; roughness and material |
//
// Depth is linear on the frame within a triangle, so that its slopes, each over the depth, give the triangle's normal.

struct KeptSurface {
    base: vec3f,
    metalness: f32,
    roughness: f32,
    material: u32,
    // On the eye's side, as vertices and normal map have it.
    normal: vec3f,
    // Change of the depth to the right and lower neighbour, over the depth.
    slopes: vec2f,
    emitted: vec3f,
}

fn base_word(base: vec3f, metalness: f32) -> vec4f {
    return vec4f(sqrt(clamp(base, vec3f(0.0), vec3f(1.0))), metalness);
}

fn words_of(normal: vec3f, slopes: vec2f, emitted: vec3f, roughness: f32, material: u32) -> vec4u {
    let low = u32(clamp(roughness, 0.0, 1.0) * 65535.0 + 0.5);
    var light = 0u;
    if any(emitted > vec3f(0.0)) {
        light = pack_color(emitted);
    }
    return vec4u(encode_direction(normal), half_bits(slopes.x) | (half_bits(slopes.y) << 16u), light, low | (material << 16u));
}

fn kept_surface(base: vec4f, words: vec4u) -> KeptSurface {
    let roughness = f32(words.w & 0xffffu) * (1.0f / 65535.0);
    return KeptSurface(
        base.xyz * base.xyz,
        base.w,
        roughness,
        words.w >> 16u,
        decode_direction(words.x),
        vec2f(half_value(words.y), half_value(words.y >> 16u)),
        unpack_color(words.z),
    );
}

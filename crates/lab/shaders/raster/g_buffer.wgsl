//#use octahedral
//#use stored_sample
// Surfaces as the G-buffer has them. With depth (4 bytes) and motion (8 bytes) it takes 32 bytes a pixel:
//
// | target | format | contents |
// |---|---|---|
// | base | `Rgba8UnormSrgb`, 4 bytes | base color; metalness |
// | words | `Rgba32Uint`, 16 bytes | shading normal, triangle's normal, emitted radiance (9 bits a channel, an exponent), roughness and material (16 bits each) |

struct KeptSurface {
    base: vec3f,
    metalness: f32,
    roughness: f32,
    material: u32,
    // Of the triangle, on the eye's side.
    geometric: vec3f,
    normal: vec3f,
    emitted: vec3f,
}

fn words_of(normal: vec3f, geometric: vec3f, emitted: vec3f, roughness: f32, material: u32) -> vec4u {
    let low = u32(clamp(roughness, 0.0, 1.0) * 65535.0 + 0.5);
    let codes = vec2u(encode_direction(normal), encode_direction(geometric));
    return vec4u(codes, pack_color(emitted), low | (material << 16u));
}

fn kept_surface(base: vec4f, words: vec4u) -> KeptSurface {
    let roughness = f32(words.w & 0xffffu) * (1.0f / 65535.0);
    return KeptSurface(
        base.xyz,
        base.w,
        roughness,
        words.w >> 16u,
        decode_direction(words.y),
        decode_direction(words.x),
        unpack_color(words.z),
    );
}

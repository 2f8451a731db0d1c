// Twin of src/kernel/texel.rs.

const WRAP_REPEAT: u32 = 0u;
const WRAP_MIRROR: u32 = 1u;
const WRAP_CLAMP: u32 = 2u;

fn wrap_coordinate(u: f32, wrap: u32) -> f32 {
    switch wrap {
        case WRAP_REPEAT: { return u - floor(u); }
        case WRAP_MIRROR: { return u - 2.0 * floor(u * 0.5); }
        default: { return clamp(u, 0.0, 1.0); }
    }
}

fn wrap_texel(i: i32, size: u32, wrap: u32) -> u32 {
    let n = i32(size);
    if wrap == WRAP_REPEAT {
        return u32((i + n) % n);
    }
    if wrap == WRAP_MIRROR {
        if i < 0 || i >= 2 * n {
            return 0u;
        }
        return u32(select(i, 2 * n - 1 - i, i >= n));
    }
    return u32(clamp(i, 0, n - 1));
}

fn texel_value(bits: u32) -> vec4f {
    let bytes = (vec4u(bits) >> vec4u(0u, 8u, 16u, 24u)) & vec4u(255u);
    return vec4f(bytes) * (1.0f / 255.0);
}

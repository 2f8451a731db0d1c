// Twin of src/kernel/octahedral.rs: directions in 32 bits.

const DIRECTION_STEPS: f32 = 32767.0;

fn folded(x: f32, y: f32) -> f32 {
    return select(1.0 - abs(y), abs(y) - 1.0, x < 0.0);
}

fn fraction_bits(x: f32) -> u32 {
    return u32(i32(floor(x * DIRECTION_STEPS + 0.5))) & 0xffffu;
}

fn fraction(bits: u32) -> f32 {
    return f32(bitcast<i32>(bits << 16u) >> 16u) * (1.0f / DIRECTION_STEPS);
}

fn encode_direction(n: vec3f) -> u32 {
    let sum = abs(n.x) + (abs(n.y) + abs(n.z));
    let x = n.x / sum;
    let y = n.y / sum;
    if n.z < 0.0 {
        return fraction_bits(folded(x, y)) | (fraction_bits(folded(y, x)) << 16u);
    }
    return fraction_bits(x) | (fraction_bits(y) << 16u);
}

fn decode_direction(code: u32) -> vec3f {
    let x = fraction(code);
    let y = fraction(code >> 16u);
    let z = (1.0 - abs(x)) - abs(y);
    var n = vec3f(x, y, z);
    if z < 0.0 {
        n = vec3f(folded(x, y), folded(y, x), z);
    }
    return n / sqrt(n.x * n.x + (n.y * n.y + n.z * n.z));
}

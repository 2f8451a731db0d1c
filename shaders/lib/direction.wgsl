// Twin of src/kernel/direction.rs.

const OCT_STEPS: f32 = 32767.0;

// direction::unit
fn unit(v: vec3<f32>) -> vec3<f32> {
    let m = max(max(abs(v.x), abs(v.y)), abs(v.z));
    if m >= 1e-30 && m <= 1e30 {
        let s = v / m;
        return s / sqrt(dot(s, s));
    }
    return vec3<f32>(0.0, 0.0, 1.0);
}

// direction::basis, two vectors: the columns.
fn basis(n: vec3<f32>) -> mat2x3<f32> {
    let sign = select(-1.0, 1.0, n.z >= 0.0);
    let a = -1.0 / (sign + n.z);
    let b = (n.x * a) * n.y;
    let x = n.x * a;
    let y = n.y * a;
    return mat2x3<f32>(
        vec3<f32>(1.0 + sign * (x * n.x), sign * b, -sign * n.x),
        vec3<f32>(b, sign + y * n.y, -n.y),
    );
}

// direction::to_local
fn to_local(v: vec3<f32>, x: vec3<f32>, y: vec3<f32>, z: vec3<f32>) -> vec3<f32> {
    return vec3<f32>(dot(v, x), dot(v, y), dot(v, z));
}

// direction::to_world
fn to_world(v: vec3<f32>, x: vec3<f32>, y: vec3<f32>, z: vec3<f32>) -> vec3<f32> {
    return vec3<f32>(
        v.x * x.x + v.y * y.x + v.z * z.x,
        v.x * x.y + v.y * y.y + v.z * z.y,
        v.x * x.z + v.y * y.z + v.z * z.z,
    );
}

// direction::oct_fold
fn oct_fold(p: vec2<f32>) -> vec2<f32> {
    let x = select(abs(p.y) - 1.0, 1.0 - abs(p.y), p.x >= 0.0);
    let y = select(abs(p.x) - 1.0, 1.0 - abs(p.x), p.y >= 0.0);
    return vec2<f32>(x, y);
}

// direction::oct_encode
fn oct_encode(v: vec3<f32>) -> u32 {
    let sum = (abs(v.x) + abs(v.y)) + abs(v.z);
    let p = vec2<f32>(v.x / sum, v.y / sum);
    let q = select(oct_fold(p), p, v.z >= 0.0);
    let x = u32(clamp(floor(q.x * OCT_STEPS + 32767.5), 0.0, 65534.0));
    let y = u32(clamp(floor(q.y * OCT_STEPS + 32767.5), 0.0, 65534.0));
    return x | (y << 16u);
}

// direction::oct_decode
fn oct_decode(word: u32) -> vec3<f32> {
    let x = (f32(word & 0xffffu) - OCT_STEPS) / OCT_STEPS;
    let y = (f32(word >> 16u) - OCT_STEPS) / OCT_STEPS;
    let z = (1.0 - abs(x)) - abs(y);
    let p = vec2<f32>(x, y);
    let q = select(oct_fold(p), p, z >= 0.0);
    return unit(vec3<f32>(q.x, q.y, z));
}

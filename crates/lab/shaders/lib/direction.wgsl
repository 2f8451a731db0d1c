// Twin of src/kernel/direction.rs.

fn unit(v: vec3f) -> vec3f {
    let m = max(max(abs(v.x), abs(v.y)), abs(v.z));
    if m >= 1e-30 && m <= 1e30 {
        let s = v / m;
        return s / sqrt(dot(s, s));
    }
    return vec3f(0.0, 0.0, 1.0);
}

// direction::basis; the two vectors are the columns.
fn basis(n: vec3f) -> mat2x3f {
    let side = select(-1.0, 1.0, n.z >= 0.0);
    let a = -1.0 / (side + n.z);
    let b = (n.x * a) * n.y;
    let x = n.x * a;
    let y = n.y * a;
    return mat2x3f(vec3f(1.0 + side * (x * n.x), side * b, -side * n.x), vec3f(b, side + y * n.y, -n.y));
}

fn to_local(v: vec3f, x: vec3f, y: vec3f, z: vec3f) -> vec3f {
    return vec3f(dot(v, x), dot(v, y), dot(v, z));
}

fn to_world(v: vec3f, x: vec3f, y: vec3f, z: vec3f) -> vec3f {
    return vec3f(
        v.x * x.x + v.y * y.x + v.z * z.x,
        v.x * x.y + v.y * y.y + v.z * z.y,
        v.x * x.z + v.y * y.z + v.z * z.z,
    );
}

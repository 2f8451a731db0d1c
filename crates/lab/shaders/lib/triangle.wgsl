// Twin of src/kernel/triangle.rs: watertight ray/triangle intersection (Woop, Benthin and Wald, JCGT 2(1), 2013).

const ORIGIN_OFFSET: f32 = 1.0 / 262144.0;
const MIN_DET: f32 = 1e-36;

struct Shear {
    x: vec3f,
    y: vec3f,
    z: vec3f,
}

// t is 0 without an intersection.
struct Intersection {
    t: f32,
    u: f32,
    v: f32,
}

fn shear(direction: vec3f) -> Shear {
    let size = abs(direction);
    if size.x >= size.y && size.x >= size.z {
        let inv = 1.0 / direction.x;
        let image = vec3f(-(direction.y / direction.x), -(direction.z / direction.x), inv);
        return Shear(image, vec3f(1.0, 0.0, 0.0), vec3f(0.0, 1.0, 0.0));
    }
    if size.y >= size.z {
        let inv = 1.0 / direction.y;
        let image = vec3f(-(direction.z / direction.y), -(direction.x / direction.y), inv);
        return Shear(vec3f(0.0, 1.0, 0.0), image, vec3f(1.0, 0.0, 0.0));
    }
    let inv = 1.0 / direction.z;
    let image = vec3f(-(direction.x / direction.z), -(direction.y / direction.z), inv);
    return Shear(vec3f(1.0, 0.0, 0.0), vec3f(0.0, 1.0, 0.0), image);
}

fn sheared(shear: Shear, from_origin: vec3f) -> vec3f {
    return shear.x * from_origin.x + shear.y * from_origin.y + shear.z * from_origin.z;
}

// triangle::edge, with the two vertices in a fixed order. The order has no effect where products are rounded. On a
// device that fuses one product into the difference, the two triangles at an edge would otherwise get different answers
// and leave a gap.
fn edge(a: vec3f, b: vec3f) -> f32 {
    let swapped = a.x > b.x || (a.x == b.x && a.y > b.y);
    let p = select(a.xy, b.xy, swapped);
    let q = select(b.xy, a.xy, swapped);
    let area = p.x * q.y - p.y * q.x;
    return select(area, -area, swapped);
}

fn intersect(shear: Shear, origin: vec3f, v0: vec3f, v1: vec3f, v2: vec3f) -> Intersection {
    let miss = Intersection(0.0, 0.0, 0.0);
    let a = sheared(shear, v0 - origin);
    let b = sheared(shear, v1 - origin);
    let c = sheared(shear, v2 - origin);
    let low = min(a, min(b, c));
    let high = max(a, max(b, c));
    if low.x > 0.0 || high.x < 0.0 || low.y > 0.0 || high.y < 0.0 || high.z < 0.0 {
        return miss;
    }
    let e0 = edge(c, b);
    let e1 = edge(a, c);
    let e2 = edge(b, a);
    if min(e0, min(e1, e2)) < 0.0 && max(e0, max(e1, e2)) > 0.0 {
        return miss;
    }
    let det = e0 + (e1 + e2);
    if abs(det) < MIN_DET {
        return miss;
    }
    let u = abs(e1 / det);
    let v = abs(e2 / det);
    return Intersection((a.z + u * (b.z - a.z)) + v * (c.z - a.z), u, v);
}

fn point_at(v0: vec3f, v1: vec3f, v2: vec3f, u: f32, v: f32) -> vec3f {
    return (v0 + (v1 - v0) * u) + (v2 - v0) * v;
}

fn magnitude(v0: vec3f, v1: vec3f, v2: vec3f) -> f32 {
    let largest = max(max(abs(v0), abs(v1)), abs(v2));
    return max(largest.x, max(largest.y, largest.z));
}

fn offset_ray(point: vec3f, normal: vec3f, magnitude: f32) -> vec3f {
    return point + normal * (magnitude * ORIGIN_OFFSET);
}

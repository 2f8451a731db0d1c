//#use traverse
// Hits for a list of rays: for tests, and for measuring traversal without shading. Needs `load` and `accept_hit`, as
// `traverse` does.

// Two elements per ray: origin and limit; direction and an unused word.
@group(0) @binding(1) var<storage, read> rays: array<vec4f>;
// Triangle, distance and barycentric weights per ray. `any_hits` writes only the first word: 1 for a hit.
@group(0) @binding(2) var<storage, read_write> hits: array<vec4u>;

override WORKGROUP: u32 = 64u;

fn ray_at(i: u32) -> Ray {
    let a = rays[2u * i];
    let b = rays[2u * i + 1u];
    return Ray(a.xyz, b.xyz, a.w);
}

@compute @workgroup_size(WORKGROUP)
fn closest_hits(@builtin(global_invocation_id) id: vec3u) {
    if id.x < arrayLength(&hits) {
        let hit = closest(ray_at(id.x), id.x);
        hits[id.x] = vec4u(hit.triangle, bitcast<u32>(hit.t), bitcast<u32>(hit.u), bitcast<u32>(hit.v));
    }
}

@compute @workgroup_size(WORKGROUP)
fn any_hits(@builtin(global_invocation_id) id: vec3u) {
    if id.x < arrayLength(&hits) {
        hits[id.x] = vec4u(select(0u, 1u, occluded(ray_at(id.x), id.x)), 0u, 0u, 0u);
    }
}

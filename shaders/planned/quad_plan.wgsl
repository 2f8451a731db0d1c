//#use quads
// List of the shaded quads, for passes over samples.

// `QuadList`, to read.
struct PlannedList {
    draw: vec4u,
    dispatch: vec4u,
    quads: array<u32>,
}

@group(0) @binding(26) var<storage, read> list: PlannedList;

// Number of shaded quads.
fn quad_count() -> u32 {
    return list.dispatch.w;
}

// Quad `i` of the list.
fn listed_quad(i: u32) -> vec2u {
    let word = list.quads[i];
    return vec2u(word & 0xffffu, word >> 16u);
}

// Number of an invocation of a dispatch whose size the plan computed.
fn invocation_of(group: vec3u, invocation: u32) -> u32 {
    return 64u * (group.y * GROUPS_PER_ROW + group.x) + invocation;
}

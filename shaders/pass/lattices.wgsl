//#use inputs
//#use lattice
// Lattices of a sparse frame: which one a pixel belongs to, and the samples around it. CPU twin: LatticeUniforms in
// src/uniforms.rs.

// src/uniforms.rs: LatticeUniforms, which documents the fields
struct LatticeUniforms {
    low_px: vec2<u32>,
    high_px: vec2<u32>,
    first_px: vec2<u32>,
    points: vec2<u32>,
    texel: vec2<u32>,
    level: u32,
    stride: u32,
    results: vec2<u32>,
    unused_0: u32,
    unused_1: u32,
}

// src/gpu/uniforms.rs: SparseUniforms, which documents the fields
struct SparseUniforms {
    missing: u32,
    unused_0: u32,
    unused_1: u32,
    unused_2: u32,
    views: array<array<LatticeUniforms, 4>, 4>,
}

@group(0) @binding(17) var<uniform> sparse: SparseUniforms;

const LATTICES: u32 = 4u;

// Number of the first lattice that covers a pixel.
fn lattice_at(px: vec2<u32>, view: u32) -> u32 {
    for (var i = 0u; i < LATTICES - 1u; i++) {
        if all(px >= sparse.views[view][i].low_px) && all(px < sparse.views[view][i].high_px) {
            return i;
        }
    }
    return LATTICES - 1u;
}

// Samples around a pixel along both axes. Without samples in the frame (`any` is false) the others are not valid.
struct Around {
    x: Between,
    y: Between,
    any: bool,
}

fn around(px: vec2<u32>, lattice: u32, view: u32) -> Around {
    let first = sparse.views[view][lattice].first_px;
    let level = sparse.views[view][lattice].level;
    let points = sparse.views[view][lattice].points;
    return Around(
        between(px.x, first.x, level, points.x),
        between(px.y, first.y, level, points.y),
        all(points > vec2<u32>(0u)),
    );
}

// Color and alpha of sample `point`, as the renderer wrote them.
fn sample_at(point: vec2<u32>, lattice: u32, view: u32) -> vec4<f32> {
    let texel = sparse.views[view][lattice].texel + point * sparse.views[view][lattice].stride;
    return textureLoad(color_in, texel_of(texel, frame.views[view].color_origin), layer_of(view), 0);
}

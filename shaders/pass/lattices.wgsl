//#use inputs
//#use lattice
// Lattices of a sparse frame: which one a pixel belongs to, and the samples around it. CPU twin: LatticeUniforms in
// src/uniforms.rs.

// src/uniforms.rs: LatticeUniforms, which documents the fields
struct LatticeUniforms {
    low_px: vec2u,
    high_px: vec2u,
    first_px: vec2u,
    points: vec2u,
    texel: vec2u,
    level: u32,
    texel_level: u32,
    results: vec2u,
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

@group(0) @binding(13) var<uniform> sparse: SparseUniforms;

const LATTICES: u32 = 4u;

// Index of the first lattice that covers a pixel.
fn lattice_index_at(px: vec2u, view: u32) -> u32 {
    var index = 0u;
    while index < LATTICES - 1u
        && !(all(px >= sparse.views[view][index].low_px) && all(px < sparse.views[view][index].high_px)) {
        index++;
    }
    return index;
}

// The first lattice that covers a pixel.
fn lattice_at(px: vec2u, view: u32) -> LatticeUniforms {
    return sparse.views[view][lattice_index_at(px, view)];
}

// Samples around a pixel along both axes. Without samples in the frame (`any` is false) the other fields are not valid.
struct Around {
    x: Between,
    y: Between,
    any: bool,
}

fn around(px: vec2u, lattice: LatticeUniforms) -> Around {
    return Around(
        between(px.x, lattice.first_px.x, lattice.level, lattice.points.x),
        between(px.y, lattice.first_px.y, lattice.level, lattice.points.y),
        all(lattice.points > vec2u(0u)),
    );
}

// Pixel of a sample.
fn px_of_point(point: vec2u, lattice: LatticeUniforms) -> vec2u {
    return lattice.first_px + (point << vec2u(lattice.level));
}

// Texel of a sample in the view's color input.
fn texel_of_point(point: vec2u, lattice: LatticeUniforms) -> vec2u {
    return lattice.texel + (point << vec2u(lattice.texel_level));
}

// Color, in this frame's exposure, and alpha of sample `point`.
fn sample_at(point: vec2u, lattice: LatticeUniforms, view: u32) -> vec4f {
    return color_at(texel_of_point(point, lattice), view);
}

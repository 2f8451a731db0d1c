//#use lattices
//#use sparse_smr
// Samples of a sparse frame, and places of their results. CPU twin: src/cpu/sparse_pass/mod.rs.

// Pixel of a sample.
fn px_of(point: vec2u, lattice: LatticeUniforms) -> vec2u {
    return lattice.first_px + vec2u(point.x << lattice.level, point.y << lattice.level);
}

// Whether two disparities of this frame can belong to one surface.
fn alike(a: f32, b: f32, relative: f32) -> bool {
    return DEPTH_TEST == 0u || same_surface(a, b, relative, 0.0);
}

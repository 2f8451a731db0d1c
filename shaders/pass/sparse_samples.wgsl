//#use lattices
//#use sparse
// Samples of a sparse frame, and where the results for them lie. CPU twin: src/cpu/sparse_pass/mod.rs.

// Relative difference of disparity within which neighbouring samples share an estimate of light.
const LIGHT_RELATIVE: f32 = 0.1;
// Relative difference of disparity within which a sample is interpolated for a pixel.
const SAMPLE_RELATIVE: f32 = 0.05;
// Weight of a sample of another surface. It is so small that such a sample counts only where no sample near the pixel
// shows the pixel's own surface.
const OTHER_SURFACE: f32 = 1e-3;
// Factor on the weight of a sample's gain and fit if they come from its neighbours only, because the sample itself was
// not compared with history.
const BY_NEIGHBOURS: f32 = 1e-3;
// Least weight of one of the four samples around a pixel.
const LEAST_SHARE: f32 = 1e-4;

// Pixel of a sample.
fn px_of(point: vec2<u32>, lattice: LatticeUniforms) -> vec2<u32> {
    return lattice.first_px + vec2<u32>(point.x << lattice.level, point.y << lattice.level);
}

// Whether two disparities of this frame can belong to one surface.
fn alike(a: f32, b: f32, relative: f32) -> bool {
    return DEPTH_TEST == 0u || same_surface(a, b, relative, 0.0);
}

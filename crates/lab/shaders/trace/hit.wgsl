// Where triangles are in the scene buffer, and hits on them.

// First elements of the triangles at rest and in motion.
override TRIANGLES: u32 = 0u;
override MOVING_TRIANGLES: u32 = 0u;
// Number of triangles at rest, which is the index of the first that moves.
override FIRST_MOVING: u32 = 0u;
// Whether any triangle moves.
override MOVES: bool = false;

const NO_TRIANGLE: u32 = 0xffffffffu;

// `triangle` is NO_TRIANGLE where nothing was hit.
struct Hit {
    triangle: u32,
    t: f32,
    u: f32,
    v: f32,
}

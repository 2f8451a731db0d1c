// Hits, and triangles in the scene buffer.

// First elements of the static and the moving triangles.
override TRIANGLES: u32 = 0u;
override MOVING_TRIANGLES: u32 = 0u;
// Number of static triangles, which is the index of the first moving one.
override FIRST_MOVING: u32 = 0u;
// Whether the scene has moving triangles.
override MOVES: bool = false;

const NO_TRIANGLE: u32 = 0xffffffffu;

// `triangle` is NO_TRIANGLE if nothing was hit.
struct Hit {
    triangle: u32,
    t: f32,
    u: f32,
    v: f32,
}

//#use inputs
//#use quads
// Rows of shaded quads, and words of the nearest ones. CPU twin: src/cpu/quads.rs.

@group(0) @binding(22) var runs: texture_2d_array<u32>;

const NONE: vec4u = vec4u(0xffffffffu);

// The shaded quads within reach of a quad in the row that is `y` below.
fn window_at(quad: vec2u, view: u32, y: i32) -> u32 {
    let row = i32(quad.y) + y;
    if y >= REACH || row < 0 || row >= i32((frame.size.y + 1u) / 2u) {
        return 0u;
    }
    return window(textureLoad(runs, vec2i(i32(quad.x / RUN_QUADS), row), view, 0).x, quad.x);
}

// Whether rows that are `rows` away may have nearer quads than the best ones, given by their codes.
fn may_improve(best: vec4u, rows: i32) -> bool {
    return any((best >> vec4u(8u)) >= vec4u(u32(rows * rows)));
}

// A word of the codes of four neighbours.
fn codes(best: vec4u) -> u32 {
    let code = select(best & vec4u(255u), vec4u(NOWHERE), best == NONE);
    return code.x | (code.y << 8u) | (code.z << 16u) | (code.w << 24u);
}

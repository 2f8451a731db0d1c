//#use quad_plan
//#use quad_runs
// Nearest shaded quads around each shaded quad, of the eight octants; in place of those of quadrants. Shaded quads are
// few: beside others they would delay them. CPU twin: `octants` in src/cpu/quads.rs. One invocation a
// shaded quad.
//
// Up to 16 reads and 1 write a shaded quad, as in quad_around_pass, and its place in the list; 8 bytes written.

@group(0) @binding(23) var around_out: texture_storage_2d_array<rg32uint, write>;

fn octants(quad: vec2u, view: u32) -> vec2u {
    let own = window_at(quad, view, 0);
    var first = vec4u(first_of(own, 1, 7, 0), ~0u, ~0u, ~0u);
    var second = vec4u(last_of(own, -8, -1, 0), ~0u, ~0u, ~0u);
    for (var rows = 1; rows <= REACH && (may_improve(first, rows) || may_improve(second, rows)); rows++) {
        let limits = octant_offsets(rows);
        for (var side = 0; side < 2; side++) {
            let y = select(rows, -rows, side == 1);
            let row = window_at(quad, view, y);
            let right = first_of(row, limits.x + 1, min(limits.y - 1, 7), y);
            let middle = min(first_of(row, 0, limits.x, y), last_of(row, -limits.x, 0, y));
            let left = last_of(row, max(1 - limits.y, -8), -limits.x - 1, y);
            let found = vec3u(right, middle, left);
            first.x = min(first.x, first_of(row, limits.y, 7, y));
            second.x = min(second.x, last_of(row, -8, -limits.y, y));
            if side == 0 {
                first = vec4u(first.x, min(first.yzw, found));
            } else {
                second = vec4u(second.x, min(second.yzw, found.zyx));
            }
        }
    }
    return vec2u(codes(first), codes(second));
}

@compute @workgroup_size(64, 1)
fn main(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) invocation: u32) {
    let view = frame.first_view;
    let i = invocation_of(group, invocation);
    if i < quad_count() {
        let quad = listed_quad(i);
        textureStore(around_out, quad, view, vec4u(octants(quad, view), 0u, 0u));
    }
}

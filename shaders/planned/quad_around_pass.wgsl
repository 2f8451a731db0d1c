//#use quad_runs
// Nearest shaded quads around each quad, of the four quadrants. CPU twin: `quadrants` in src/cpu/quads.rs.
// One invocation a quad; z is the view.
//
// Up to 16 reads and 1 write a quad: words of rows, from the nearest on until none can be nearer; 8 bytes written.

@group(0) @binding(23) var around_out: texture_storage_2d_array<rg32uint, write>;

fn quadrants(quad: vec2u, view: u32) -> vec2u {
    let own = window_at(quad, view, 0);
    var best = vec4u(first_of(own, 1, 7, 0), ~0u, last_of(own, -8, -1, 0), ~0u);
    for (var rows = 1; rows <= REACH && may_improve(best, rows); rows++) {
        let below = window_at(quad, view, rows);
        let above = window_at(quad, view, -rows);
        best = min(best, vec4u(
            first_of(below, 1, 7, rows),
            last_of(below, -8, 0, rows),
            last_of(above, -8, -1, -rows),
            first_of(above, 0, 7, -rows),
        ));
    }
    return vec2u(codes(best), codes(NONE));
}

@compute @workgroup_size(64, 1)
fn main(@builtin(global_invocation_id) id: vec3u, @builtin(workgroup_id) group: vec3u) {
    let view = frame.first_view + group.z;
    if any(2u * id.xy >= frame.size) {
        return;
    }
    textureStore(around_out, id.xy, view, vec4u(quadrants(id.xy, view), 0u, 0u));
}

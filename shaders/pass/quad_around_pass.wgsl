//#use inputs
//#use quads
// Nearest shaded quads around each quad: of the eight octants around shaded quads, of the four quadrants around others.
// CPU twin: `quadrants` and `octants` in src/cpu/sparse_pass/quads.rs. One invocation a quad; z is the view.
//
// Up to 17 reads and 1 write a quad: its mask, and 16 words of rows, from the nearest on until none can be nearer; 8
// bytes written.

@group(0) @binding(21) var mask: texture_2d_array<u32>;
@group(0) @binding(22) var runs: texture_2d_array<u32>;
@group(0) @binding(23) var around_out: texture_storage_2d_array<rg32uint, write>;

const NONE: vec4<u32> = vec4<u32>(0xffffffffu);

// The shaded quads within reach of a quad in the row that is `y` below.
fn window_at(quad: vec2<u32>, view: u32, y: i32) -> u32 {
    let row = i32(quad.y) + y;
    if y >= REACH || row < 0 || row >= i32((frame.size.y + 1u) / 2u) {
        return 0u;
    }
    return window(textureLoad(runs, vec2<i32>(i32(quad.x / RUN_QUADS), row), view, 0).x, quad.x);
}

// Whether rows that are `rows` away may have nearer quads than the best ones, given by their codes.
fn may_improve(best: vec4<u32>, rows: i32) -> bool {
    return any((best >> vec4<u32>(8u)) >= vec4<u32>(u32(rows * rows)));
}

// A word of the codes of four neighbours.
fn codes(best: vec4<u32>) -> u32 {
    let code = select(best & vec4<u32>(255u), vec4<u32>(NOWHERE), best == NONE);
    return code.x | (code.y << 8u) | (code.z << 16u) | (code.w << 24u);
}

fn quadrants(quad: vec2<u32>, view: u32) -> vec2<u32> {
    let own = window_at(quad, view, 0);
    var best = vec4<u32>(first_of(own, 1, 7, 0), ~0u, last_of(own, -8, -1, 0), ~0u);
    for (var rows = 1; rows <= REACH && may_improve(best, rows); rows++) {
        let below = window_at(quad, view, rows);
        let above = window_at(quad, view, -rows);
        best = min(best, vec4<u32>(
            first_of(below, 1, 7, rows),
            last_of(below, -8, 0, rows),
            last_of(above, -8, -1, -rows),
            first_of(above, 0, 7, -rows),
        ));
    }
    return vec2<u32>(codes(best), codes(NONE));
}

fn octants(quad: vec2<u32>, view: u32) -> vec2<u32> {
    let own = window_at(quad, view, 0);
    var first = vec4<u32>(first_of(own, 1, 7, 0), ~0u, ~0u, ~0u);
    var second = vec4<u32>(last_of(own, -8, -1, 0), ~0u, ~0u, ~0u);
    for (var rows = 1; rows <= REACH && (may_improve(first, rows) || may_improve(second, rows)); rows++) {
        let limits = octant_offsets(rows);
        for (var side = 0; side < 2; side++) {
            let y = select(rows, -rows, side == 1);
            let row = window_at(quad, view, y);
            let right = first_of(row, limits.x + 1, min(limits.y - 1, 7), y);
            let middle = min(first_of(row, 0, limits.x, y), last_of(row, -limits.x, 0, y));
            let left = last_of(row, max(1 - limits.y, -8), -limits.x - 1, y);
            let found = vec3<u32>(right, middle, left);
            first.x = min(first.x, first_of(row, limits.y, 7, y));
            second.x = min(second.x, last_of(row, -8, -limits.y, y));
            if side == 0 {
                first = vec4<u32>(first.x, min(first.yzw, found));
            } else {
                second = vec4<u32>(second.x, min(second.yzw, found.zyx));
            }
        }
    }
    return vec2<u32>(codes(first), codes(second));
}

@compute @workgroup_size(64, 1)
fn main(@builtin(global_invocation_id) id: vec3<u32>, @builtin(workgroup_id) group: vec3<u32>) {
    let view = frame.first_view + group.z;
    if any(2u * id.xy >= frame.size) {
        return;
    }
    var around: vec2<u32>;
    if (textureLoad(mask, id.xy, view, 0).x & 1u) != 0u {
        around = octants(id.xy, view);
    } else {
        around = quadrants(id.xy, view);
    }
    textureStore(around_out, id.xy, view, vec4<u32>(around, 0u, 0u));
}

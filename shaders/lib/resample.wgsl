//#use surface
// Twin of src/kernel/resample.rs.

const STAND_IN_WEIGHT: f32 = 0.1;
const ROUNDS: u32 = 3u;

// Number of the texel (as for `corner_weight`) that has the second largest bilinear weight at the fractions of a
// position.
fn second_corner(fraction: vec2f) -> u32 {
    let nearest = select(0u, 1u, fraction.x >= 0.5) + 2u * select(0u, 1u, fraction.y >= 0.5);
    let along_x = abs(fraction.x - 0.5) <= abs(fraction.y - 0.5);
    return nearest ^ select(2u, 1u, along_x);
}

// Bilinear weight of texel number `corner` (top left, top right, bottom left, bottom right) at the fractions of a
// position.
fn corner_weight(corner: u32, fraction: vec2f) -> f32 {
    let x = select(1.0 - fraction.x, fraction.x, (corner & 1u) == 1u);
    let y = select(1.0 - fraction.y, fraction.y, corner >= 2u);
    return x * y;
}

// Catmull-Rom weights of four texels around a position at distance `t` in [0, 1) after the second.
fn catmull_rom(t: f32) -> vec4f {
    let t2 = t * t;
    return vec4f(
        ((1.0 - 0.5 * t) * t - 0.5) * t,
        (1.5 * t - 2.5) * t2 + 1.0,
        ((2.0 - 1.5 * t) * t + 0.5) * t,
        (0.5 * t - 0.5) * t2,
    );
}

// Shared values of the taps around a position: the position, and Catmull-Rom weights of columns and rows.
struct TapsAround {
    texel: vec2i,
    last: vec2i,
    fraction: vec2f,
    sharp_x: vec4f,
    sharp_y: vec4f,
}

// The taps around a position: a `fraction` of a texel, in [0, 1), after `texel`.
fn taps_around(texel: vec2i, fraction: vec2f, size: vec2u) -> TapsAround {
    return TapsAround(texel, vec2i(size) - 1, fraction, catmull_rom(fraction.x), catmull_rom(fraction.y));
}

// Texels of four taps, and their weights: products of a column's and a row's. `sharp_rows`: weights of the row of the
// first two and of the last two taps. Linear weights belong to `b` and `c`; those of the other taps are 0.
struct FourTaps {
    a: vec2i,
    b: vec2i,
    c: vec2i,
    d: vec2i,
    sharp_x: vec4f,
    sharp_rows: vec2f,
    linear_x: vec2f,
    linear_row: f32,
}

// The taps of round `index`.
fn taps_of(around: TapsAround, index: u32) -> FourTaps {
    let below = index == 1u;
    let outside = index == 2u;
    let columns = select(vec4i(-1, 0, 1, 2), vec4i(0, 1, 0, 1), outside);
    let rows = select(vec2i(select(0, 1, below)), vec2i(-1, 2), outside);
    let x = clamp(around.texel.x + columns, vec4i(0), vec4i(around.last.x));
    let y = clamp(around.texel.y + rows, vec2i(0), vec2i(around.last.y));
    let sharp_row = vec2f(select(around.sharp_y.y, around.sharp_y.z, below));
    let linear_row = select(1.0 - around.fraction.y, around.fraction.y, below);
    return FourTaps(
        vec2i(x.x, y.x),
        vec2i(x.y, y.x),
        vec2i(x.z, y.y),
        vec2i(x.w, y.y),
        select(around.sharp_x, around.sharp_x.yzyz, outside),
        select(sharp_row, around.sharp_y.xw, outside),
        vec2f(1.0 - around.fraction.x, around.fraction.x),
        select(linear_row, 0.0, outside),
    );
}

// Sum of the taps' Catmull-Rom weights, the corners left out.
fn sharp_sum(around: TapsAround) -> f32 {
    return 1.0 - (around.sharp_x.x + around.sharp_x.w) * (around.sharp_y.x + around.sharp_y.w);
}

struct Tap {
    color: vec3f,
    lod: f32,
    same: bool,
}

// Tap of a packed surface.
fn surface_tap(words: vec2u, codes: vec2u, any_code: bool) -> Tap {
    let code = lod_code(words);
    return Tap(surface_color(words), lod_value(code), select(has_code(words.y, codes), code != EMPTY_LOD, any_code));
}

struct Gathered {
    sharp: vec3f,
    smooth_color: vec3f,
    smooth_sum: f32,
    lod: f32,
    complete: bool,
}

// Sums over no taps.
fn nothing_gathered() -> Gathered {
    return Gathered(vec3f(0.0), vec3f(0.0), 0.0, 0.0, true);
}

// Adds four taps with their weights.
fn gather(g: Gathered, a: Tap, b: Tap, c: Tap, d: Tap, four: FourTaps) -> Gathered {
    let x = four.sharp_x;
    let first = a.color * x.x + b.color * x.y;
    let last = c.color * x.z + d.color * x.w;
    let inner = select(vec2f(0.0), four.linear_x, vec2<bool>(b.same, c.same));
    return Gathered(
        first * four.sharp_rows.x + (last * four.sharp_rows.y + g.sharp),
        g.smooth_color + (b.color * inner.x + c.color * inner.y) * four.linear_row,
        g.smooth_sum + (inner.x + inner.y) * four.linear_row,
        g.lod + (b.lod * inner.x + c.lod * inner.y) * four.linear_row,
        g.complete && a.same && b.same && c.same && d.same,
    );
}

struct Resampled {
    sharp: vec3f,
    smooth_color: vec3f,
    lod: f32,
}

// Result of the sums.
fn resolve(g: Gathered, weights: f32, nearest: Surface) -> Resampled {
    if g.smooth_sum < 0.01 {
        return Resampled(nearest.color, nearest.color, nearest.lod);
    }
    let inverse = 1.0 / g.smooth_sum;
    let smooth_color = g.smooth_color * inverse;
    let sharp = select(smooth_color, max(g.sharp * (1.0 / weights), vec3f(0.0)), g.complete);
    return Resampled(sharp, smooth_color, g.lod * inverse);
}

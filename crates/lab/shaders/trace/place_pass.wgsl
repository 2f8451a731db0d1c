//#use color
// Samples of a lattice from film to pixels. Twin of SparsePlan::trace and Film::noise_at. One invocation a point.
//
// Reads 16 bytes and the film, and writes 16 + 8 + 4 + 8 bytes a point.

// Points along x of a dispatch; twin of place::COLUMNS.
const COLUMNS: u32 = 4096u;

struct Placement {
    // Corner and size of the film, in points of the lattice.
    film_first: vec2u,
    film_size: vec2u,
    // Pixel of the lattice's point (0, 0).
    first_px: vec2u,
    step: u32,
    // Number of points.
    count: u32,
    // NaN, which WGSL cannot write: color of points without samples.
    missing: u32,
    unused: u32,
}

@group(0) @binding(0) var<uniform> placement: Placement;
// Of each point: x and y in 16 bits each; the bits of distance and of motion.
@group(0) @binding(1) var<storage, read> points: array<vec4u>;
// As in resolve_pass.
@group(0) @binding(2) var<storage, read> film: array<vec4f>;
@group(0) @binding(3) var color_out: texture_storage_2d_array<rgba32float, write>;
@group(0) @binding(4) var noise_out: texture_storage_2d_array<rg32float, write>;
@group(0) @binding(5) var depth_out: texture_storage_2d_array<r32float, write>;
@group(0) @binding(6) var motion_out: texture_storage_2d_array<rg32float, write>;

// Mean and number of samples of a point, 0 beyond the film; or the squared deviations with row 1.
fn film_row(point: vec2u, row: u32) -> vec4f {
    // Coordinates left of or above the film wrap to large numbers.
    let at = point - placement.film_first;
    if at.x >= placement.film_size.x || at.y >= placement.film_size.y {
        return vec4f(0.0);
    }
    return film[2u * (at.y * placement.film_size.x + at.x) + row];
}

// Film::spread
fn spread(point: vec2u) -> f32 {
    var mean = 0.0;
    var squares = 0.0;
    var count = 0.0;
    for (var i = 0u; i < 9u; i++) {
        let near = film_row(point + vec2u(i % 3u, i / 3u) - vec2u(1u), 0u);
        if near.w > 0.0 {
            let sample = luma(near.xyz);
            count += 1.0;
            let off = sample - mean;
            mean += off / count;
            squares += off * (sample - mean);
        }
    }
    if count < 2.0 {
        return mean;
    }
    return sqrt(squares / (count - 1.0));
}

// Film::noise_at
fn noise_at(point: vec2u) -> vec2f {
    let count = film_row(point, 0u).w;
    if count == 0.0 {
        return vec2f(0.0);
    }
    if count == 1.0 {
        return vec2f(spread(point), count);
    }
    let variance = film_row(point, 1u).xyz / (count * (count - 1.0));
    return vec2f(luma(sqrt(variance)), count);
}

@compute @workgroup_size(64, 1)
fn main(@builtin(global_invocation_id) id: vec3u) {
    let index = id.y * COLUMNS + id.x;
    if index >= placement.count {
        return;
    }
    let words = points[index];
    let point = vec2u(words.x & 0xffffu, words.x >> 16u);
    let px = placement.first_px + point * placement.step;
    let own = film_row(point, 0u);
    let missing = vec4f(bitcast<f32>(placement.missing));
    textureStore(color_out, px, 0, select(missing, vec4f(own.xyz, 1.0), own.w > 0.0));
    textureStore(noise_out, px, 0, vec4f(noise_at(point), 0.0, 0.0));
    textureStore(depth_out, px, 0, vec4f(bitcast<f32>(words.y)));
    textureStore(motion_out, px, 0, vec4f(bitcast<vec2f>(words.zw), 0.0, 0.0));
}

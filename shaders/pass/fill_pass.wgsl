//#use lattices
// Colors between samples, for methods that read whole frames: samples stay unchanged, and pixels between them are
// linear interpolations of the finite samples, in the unit of the color input. CPU twin: src/cpu/fill.rs. One
// invocation a pixel; z is the view.
//
// Up to 4 reads and 1 write a pixel: the samples, and 16 bytes a pixel written.

@group(0) @binding(23) var filled: texture_storage_2d_array<rgba32float, write>;

fn pixel(px: vec2u, view: u32) -> vec4f {
    let lattice = lattice_at(px, view);
    let near = around(px, lattice);
    if near.any && near.x.fraction == 0.0 && near.y.fraction == 0.0 {
        return given_at(texel_of_point(vec2u(near.x.points.x, near.y.points.x), lattice), view);
    }
    var mean = SampleMean(vec4f(0.0), 0.0);
    // A variable count on purpose: Mesa would unroll a constant one and reorder its sums of products.
    let taps = select(0u, 4u, near.any);
    for (var tap = 0u; tap < taps; tap++) {
        let right = tap & 1u;
        let below = tap >> 1u;
        let point = vec2u(near.x.points[right], near.y.points[below]);
        let given = sample_at(point, lattice, view);
        let sampled = color(given.xyz);
        let alpha = select(1.0, given.w, is_finite(given.w));
        let share = point_weight(near.x.fraction, right) * point_weight(near.y.fraction, below);
        mean = add_sample(mean, vec4f(sampled.color, alpha), sampled.usable, share);
    }
    if mean.weight == 0.0 {
        return vec4f(bitcast<f32>(sparse.missing));
    }
    let filled_color = sample_mean(mean);
    return vec4f(unexposed(filled_color.xyz), filled_color.w);
}

@compute @workgroup_size(64, 1)
fn main(@builtin(global_invocation_id) id: vec3u, @builtin(workgroup_id) group: vec3u) {
    if id.x < frame.size.x && id.y < frame.size.y {
        let view = frame.first_view + group.z;
        textureStore(filled, id.xy, view, pixel(id.xy, view));
    }
}

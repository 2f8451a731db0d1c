//#use candidate
//#use inputs
//#use quad_samples
// Colors between shaded quads, for methods that read whole frames: shaded pixels stay unchanged, and others are means
// of the shaded quads around them by the inverse squared distance. All are in the unit of the color input. CPU twin:
// `filled` in src/cpu/quads.rs. One invocation a pixel; z is the view.
//
// Up to 6 reads and 1 write a pixel: mask, neighbours and samples; 16 bytes written.

@group(0) @binding(23) var filled: texture_storage_2d_array<rgba32float, write>;

fn pixel(px: vec2u, view: u32) -> vec4f {
    let mask_word = mask_at(px, view);
    if is_shaded(mask_word, px) {
        return given_sample(px, view);
    }
    let around = around_pixel(px, view, mask_word);
    var sum = vec4f(0.0);
    var weight = 0.0;
    for (var i = 0u; i < 4u; i++) {
        let sample = sample_tap(around, i, px, view);
        let at = min(sample.at, frame.size - 1u);
        let given = sample_at(at, view);
        let sampled = color(given.xyz);
        if sample.is_there && sampled.usable {
            let x = f32(at.x) - f32(px.x);
            let y = f32(at.y) - f32(px.y);
            let w = distance_weight(x * x + y * y);
            let alpha = usable_alpha(given.w);
            sum += vec4f(sampled.color, alpha) * w;
            weight += w;
        }
    }
    if weight == 0.0 {
        return vec4f(bitcast<f32>(frame.missing));
    }
    let mean = sum * (1.0 / weight);
    return vec4f(unexposed(mean.xyz), mean.w);
}

@compute @workgroup_size(64, 1)
fn main(@builtin(global_invocation_id) id: vec3u, @builtin(workgroup_id) group: vec3u) {
    if id.x < frame.size.x && id.y < frame.size.y {
        let view = frame.first_view + group.z;
        textureStore(filled, id.xy, view, pixel(id.xy, view));
    }
}

//#use sanitize
//#use frame
// Adds a batch's samples to their pixels: film::Moments::add. The invocation of a pixel's first item adds all its
// samples.

// Two rows per pixel: mean and count; squared deviations.
@group(2) @binding(0) var<storage, read_write> film: array<vec4f>;

@compute @workgroup_size(WORKGROUP)
fn resolve(@builtin(global_invocation_id) id: vec3u) {
    if id.x >= frame.items {
        return;
    }
    let pixel = work[id.x].x;
    if id.x > 0u && work[id.x - 1u].x == pixel {
        return;
    }
    let at = 2u * ((pixel >> 16u) * frame.width + (pixel & 0xffffu) - frame.film_base);
    let before = film[at];
    var mean = before.xyz;
    var count = before.w;
    var squares = film[at + 1u].xyz;
    for (var i = id.x; i < frame.items && work[i].x == pixel; i++) {
        var sample = path_row(i, PATH_RADIANCE).xyz;
        if !(is_finite(sample.x) && is_finite(sample.y) && is_finite(sample.z)) {
            sample = vec3f(0.0);
            atomicAdd(&counters[NONFINITE], 1u);
        }
        count += 1.0;
        let off = sample - mean;
        mean += off / count;
        squares += off * (sample - mean);
    }
    film[at] = vec4f(mean, count);
    film[at + 1u] = vec4f(squares, 0.0);
}

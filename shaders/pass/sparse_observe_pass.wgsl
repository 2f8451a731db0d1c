//#use kept_history
//#use sparse_samples
// Comparison of the samples of a sparse frame with history at their pixels. CPU twin: `observe` in
// src/cpu/sparse_pass.rs. One invocation a sample of lattice `frame.lattice`; z is the view.
//
// 16 reads and 1 write a sample: color, depth, motion of itself and two neighbours, trust, 5 stored samples and 5 more
// for their contrast; 8 bytes written.

@group(0) @binding(18) var observed_out: texture_storage_2d_array<rg32uint, write>;

// Mean difference of a stored texel from its four neighbours, in this frame's exposure; 0 unless `needed`.
fn contrast_at(texel: vec2<u32>, view: u32, needed: bool) -> f32 {
    let at = vec2<i32>(texel);
    let own = expose(kept_at(at, view).color, frame.exposure);
    // Left, right, up, down.
    var differences = vec4<f32>(0.0);
    let taps = select(0u, 4u, needed);
    for (var i = 0u; i < taps; i++) {
        let axis = select(vec2<i32>(0, 1), vec2<i32>(1, 0), i < 2u);
        let near = expose(kept_at(at + select(-axis, axis, (i & 1u) == 1u), view).color, frame.exposure);
        differences[i] = root_difference(near, own);
    }
    return ((differences.x + differences.y) + (differences.z + differences.w)) * 0.25;
}

fn observe(point: vec2<u32>, lattice: u32, view: u32) -> vec2<u32> {
    let nothing = vec2<u32>(0u, half_bits(-1.0));
    let px = px_of(point, lattice, view);
    let motion = motion_at(px, view);
    let previous = kept_source(px, view, motion, disparity_at(px, view));
    let needed = previous.verdict == VERDICT_VALID && color(sample_at(point, lattice, view).xyz).usable;
    let history = kept_history(previous, view, needed);
    let contrast = contrast_at(previous.nearest_at, view, needed && history.lod >= 0.0);
    if !needed || history.lod < 0.0 {
        return nothing;
    }
    let error = expected_error(history.lod, contrast, has_moved(motion, history.nearest.place_px));
    return vec2<u32>(pack_color(history.color), half_bits(error) | (half_bits(sureness(history.lod)) << 16u));
}

@compute @workgroup_size(64, 1)
fn main(@builtin(global_invocation_id) id: vec3<u32>, @builtin(workgroup_id) group: vec3<u32>) {
    let view = frame.first_view + group.z;
    if all(id.xy < points_of(frame.lattice, view)) {
        let words = observe(id.xy, frame.lattice, view);
        textureStore(observed_out, result_texel(id.xy, frame.lattice, view), view, vec4<u32>(words, 0u, 0u));
    }
}

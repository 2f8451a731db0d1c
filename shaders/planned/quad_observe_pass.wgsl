//#use sparse_history
//#use sparse_noise
//#use quad_plan
//#use quad_samples
// Comparison of shaded quads with history. CPU twin: `observe_quads` in src/cpu/planned/quad_samples.rs. One
// invocation a pixel of a shaded quad; where single pixels are shaded, one a quad, because three of four invocations
// would be idle. Quads of the fovea are not compared.
//
// With ANTIALIAS 30 reads and 1 write a sample: color, 9 of depth, 3 of motion, trust, 10 stored samples, list, and
// the mask twice; 8 bytes written.

@group(0) @binding(23) var observed_out: texture_storage_2d_array<rg32uint, write>;

fn observe(px: vec2u, view: u32) -> vec2u {
    let nothing = pack_observation(no_observation());
    let mask_word = mask_at(px, view);
    let level = level_of(mask_word);
    if level == 0u || !is_shaded(mask_word, px) {
        return nothing;
    }
    let surface = surface_of(px, view, level);
    var source = sparse_source(px, view, surface);
    if ANTIALIAS != 0u {
        // History is read at the sample's place in its pixel.
        source.previous.at -= frame.views[view].jitter_px;
    }
    // At a silhouette the difference does not say whether anything changed.
    let sampled = color(sample_at(px, view).xyz);
    let comparable = sampled.usable && !surface.is_silhouette;
    let needed = may_have_history(source.previous) && comparable;
    let found = sparse_history(source, view, needed, past_albedos(px, view));
    var history = found.interpolated;
    if !needed || history.lod < 0.0 {
        return nothing;
    }
    if HAS_ALBEDO {
        // History is compared with the texture of the sample.
        let of_own = with_change(sample_albedos(px, view), true, true).albedo;
        let at_edge = surface.is_edge;
        let texture = pixel_texture(px, view, level, at_edge, found.albedos, history, true, sampled.color, of_own);
        history = of_history(of_sample(texture), history);
    }
    let contrast = root_difference(history.lowest, history.highest);
    let compared = comparison(found, contrast, surface.motion);
    var error = compared.error;
    var confidence = lod_confidence(history.lod);
    if NOISY != 0u {
        let past = stored_noise(found.texel, view);
        error += expected_noise(past, noise_at(px, view), luma(history.color));
        confidence = noisy_lod_confidence(history.lod, past, luma(history.color));
    }
    return pack_observation(Observation(vec3f(0.0), history.color, error, confidence, compared.deviation));
}

// Writes a pixel's comparison, if the pixel is in the frame.
fn store(px: vec2u, view: u32, observation: vec2u) {
    if all(px < frame.size) {
        textureStore(observed_out, px, view, vec4u(observation, 0u, 0u));
    }
}

@compute @workgroup_size(64, 1)
fn main(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) invocation: u32) {
    let view = frame.first_view;
    let i = invocation_of(group, invocation);
    let is_single = frame.single_pixels != 0u;
    let listed = i >> select(2u, 0u, is_single);
    if listed >= quad_count() {
        return;
    }
    let quad = listed_quad(listed);
    let shaded = textureLoad(quad_mask, quad, view, 0).x & 15u;
    // `left`: a bit for each pixel of the quad that is still to do. Pixels without a sample have no comparison.
    for (var left = select(0u, 15u & ~shaded, is_single); left != 0u; left &= left - 1u) {
        store(px_of_quad(quad, firstTrailingBit(left)), view, pack_observation(no_observation()));
    }
    for (var left = select(1u << (i & 3u), shaded, is_single); left != 0u; left &= left - 1u) {
        let px = px_of_quad(quad, firstTrailingBit(left));
        store(px, view, observe(px, view));
    }
}

//#use sparse_history
//#use sparse_noise
//#use sparse_samples
// Comparison of the samples of a sparse frame with history. CPU twin: `observe` in src/cpu/sparse_pass/observe.rs. One
// invocation a sample of lattice `frame.lattice`; z is the view.
//
// 9 reads and 1 write a sample: color, depth, motion, trust, 5 stored samples; 8 bytes written. With noise, 2 more
// reads.

@group(0) @binding(23) var observed_out: texture_storage_2d_array<rg32uint, write>;

fn observe(point: vec2u, lattice: LatticeUniforms, view: u32) -> vec2u {
    let px = px_of(point, lattice);
    let surface = surface_of(px, view, lattice.level);
    let nothing = vec2u(0u, half_bits(select(-1.0, DOUBTFUL, surface.is_doubtful)));
    let motion = surface.motion;
    var source = sparse_source(px, view, surface);
    if ANTIALIAS != 0u {
        // History is read at the sample's place in its pixel.
        source.previous.at -= frame.views[view].jitter_px;
    }
    let usable = color(sample_at(point, lattice, view).xyz).usable && !surface.is_doubtful;
    let needed = may_have_history(source.previous) && usable;
    let found = sparse_history(source, view, needed);
    let history = found.found;
    if !needed || history.lod < 0.0 {
        return nothing;
    }
    let contrast = root_difference(history.lowest, history.highest);
    let compared = comparison(found, contrast, motion);
    var error = compared.error;
    var confidence = lod_confidence(history.lod);
    if NOISY != 0u {
        let past = stored_noise(found.texel, view);
        error += expected_noise(past, noise_at(px, view), luma(history.color));
        confidence = noisy_lod_confidence(history.lod, past, luma(history.color));
    }
    return vec2u(pack_color(history.color), half_bits(error) | (pack_known(confidence, compared.deviation) << 16u));
}

@compute @workgroup_size(64, 1)
fn main(@builtin(global_invocation_id) id: vec3u, @builtin(workgroup_id) group: vec3u) {
    let view = frame.first_view + group.z;
    let lattice = sparse.views[view][frame.lattice];
    if all(id.xy < lattice.points) {
        let words = observe(id.xy, lattice, view);
        textureStore(observed_out, lattice.results + id.xy, view, vec4u(words, 0u, 0u));
    }
}

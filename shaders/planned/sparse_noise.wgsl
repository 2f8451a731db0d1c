//#use inputs
// Noise of the stored samples of planned frames. CPU twin: src/cpu/planned/sparse_history.rs.

@group(0) @binding(16) var past_noise: texture_2d_array<u32>;

// Noise of a stored sample, in this frame's exposure; valid only if NOISY is set.
fn stored_noise(texel: vec2i, view: u32) -> Noise {
    let at = clamp(texel, vec2i(0), vec2i(frame.size) - 1);
    return expose_noise(unpack_noise(textureLoad(past_noise, at, view, 0).x), frame.exposure);
}

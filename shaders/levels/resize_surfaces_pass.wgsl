//#use smr
//#use resample
//#use resize_uniforms
//#use sanitize
// Surfaces of history, and their first mip level, at another size. CPU twin: src/cpu/resize.rs. One invocation a block
// of 2x2 pixels; z is the view.

override NOISY: u32 = 0u;
override HAS_MIPS: u32 = 1u;

@group(0) @binding(15) var past_surfaces: texture_2d_array<u32>;
@group(0) @binding(17) var past_noise: texture_2d_array<u32>;
@group(0) @binding(18) var next_surfaces: texture_storage_2d_array<rg32uint, write>;
@group(0) @binding(19) var next_mips: texture_storage_2d_array<rgba16float, write>;
@group(0) @binding(20) var next_noise: texture_storage_2d_array<r32uint, write>;

fn surface_at(texel: vec2i, view: u32) -> Surface {
    let at = clamp(texel, vec2i(0), vec2i(resize.old_size_px) - 1);
    return unpack_surface(textureLoad(past_surfaces, at, view, 0).xy);
}

fn tap(texel: vec2i, view: u32, codes: vec2u, any_code: bool) -> Tap {
    return surface_tap(textureLoad(past_surfaces, texel, view, 0).xy, codes, any_code);
}

// Resizes a pixel; returns the stored words.
fn pixel(px: vec2u, view: u32) -> vec2u {
    let position = old_position_of(px);
    let nearest_at = nearest_to(position);
    let nearest = surface_at(vec2i(nearest_at), view);
    let whole = floor(position);
    let taps = taps_around(vec2i(whole), position - whole, resize.old_size_px);
    let codes = tap_codes(nearest.disparity);
    let any_code = nearest.disparity < 0.0;
    var gathered = nothing_gathered();
    let rounds = select(0u, ROUNDS, nearest.lod >= 0.0);
    for (var i = 0u; i < rounds; i++) {
        let four = taps_of(taps, i);
        gathered = gather(
            gathered,
            tap(four.a, view, codes, any_code),
            tap(four.b, view, codes, any_code),
            tap(four.c, view, codes, any_code),
            tap(four.d, view, codes, any_code),
            four,
        );
    }
    let resampled = resolve(gathered, sharp_sum(taps), nearest);
    var lod = -1.0;
    if nearest.lod >= 0.0 {
        lod = resized_lod(resampled.lod, resize.lod_shift);
    }
    let words = pack_surface(Surface(min(resampled.sharp, vec3f(MAX_HALF)), lod, nearest.disparity));
    textureStore(next_surfaces, px, view, vec4u(words, 0u, 0u));
    if NOISY != 0u {
        textureStore(next_noise, px, view, textureLoad(past_noise, nearest_at, view, 0));
    }
    return words;
}

@compute @workgroup_size(64, 1)
fn main(@builtin(global_invocation_id) id: vec3u, @builtin(workgroup_id) group: vec3u) {
    let first = 2u * id.xy;
    if any(first >= resize.size_px) {
        return;
    }
    var texels: array<vec4f, 4>;
    for (var i = 0u; i < 4u; i++) {
        // At an odd border the neighbour counts twice.
        let px = min(first + vec2u(i & 1u, i >> 1u), resize.size_px - 1u);
        texels[i] = mip_texel(pixel(px, group.z));
    }
    if HAS_MIPS != 0u {
        textureStore(next_mips, id.xy, group.z, round_mip(mip_mean(texels[0], texels[1], texels[2], texels[3])));
    }
}

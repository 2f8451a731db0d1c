//#use depth
//#use matched
//#use resample
//#use resize_uniforms
//#use sanitize
// Surfaces of history resampled to another size, with the first level of their mip chain. CPU twin: src/cpu/resize.rs.
// One invocation a block of 2x2 pixels; z is the view.

override NOISY: u32 = 0u;
override HAS_MIPS: u32 = 1u;

@group(0) @binding(1) var past_surfaces: texture_2d_array<u32>;
@group(0) @binding(2) var past_noise: texture_2d_array<u32>;
@group(0) @binding(3) var next_surfaces: texture_storage_2d_array<rg32uint, write>;
@group(0) @binding(4) var next_mips: texture_storage_2d_array<rgba16float, write>;
@group(0) @binding(5) var next_noise: texture_storage_2d_array<r32uint, write>;

fn surface_at(texel: vec2<i32>, view: u32) -> Surface {
    let at = clamp(texel, vec2<i32>(0), vec2<i32>(resize.old_size) - 1);
    return unpack_surface(textureLoad(past_surfaces, at, view, 0).xy);
}

fn component(v: vec4<f32>, i: u32) -> f32 {
    return select(select(v.x, v.y, i == 1u), select(v.z, v.w, i == 3u), i > 1u);
}

// Resizes a pixel; returns the stored words.
fn pixel(px: vec2<u32>, view: u32) -> vec2<u32> {
    let position = old_position_of(px);
    let nearest_at = nearest_to(position);
    let nearest = surface_at(vec2<i32>(nearest_at), view);
    let whole = floor(position);
    let fraction = position - whole;
    let sharp_x = catmull_rom(fraction.x);
    let sharp_y = catmull_rom(fraction.y);
    let smooth_x = linear_weights(fraction.x);
    let smooth_y = linear_weights(fraction.y);
    var gathered = Gathered(vec3<f32>(0.0), 0.0, vec3<f32>(0.0), 0.0, 0.0, 0u);
    let taps = select(0u, TAPS, nearest.lod >= 0.0);
    for (var tap = 0u; tap < taps; tap++) {
        let at = tap_at(tap);
        let s = surface_at(vec2<i32>(whole) + vec2<i32>(at) - 1, view);
        let alike = nearest.disparity < 0.0 || same_surface(nearest.disparity, s.disparity, TAP_RELATIVE, 0.0);
        let sharp = component(sharp_x, at.x) * component(sharp_y, at.y);
        let smooth_w = component(smooth_x, at.x) * component(smooth_y, at.y);
        gathered = gather(gathered, s, s.lod >= 0.0 && alike, sharp, smooth_w);
    }
    let resampled = resolve(gathered, nearest);
    var lod = -1.0;
    if nearest.lod >= 0.0 {
        lod = resized_lod(resampled.lod, resize.lod_shift);
    }
    let words = pack_surface(Surface(min(resampled.sharp, vec3<f32>(MAX_HALF)), lod, nearest.disparity));
    textureStore(next_surfaces, px, view, vec4<u32>(words, 0u, 0u));
    if NOISY != 0u {
        textureStore(next_noise, px, view, textureLoad(past_noise, nearest_at, view, 0));
    }
    return words;
}

@compute @workgroup_size(64, 1)
fn main(@builtin(global_invocation_id) id: vec3<u32>, @builtin(workgroup_id) group: vec3<u32>) {
    let first = 2u * id.xy;
    if any(first >= resize.size) {
        return;
    }
    var texels: array<vec4<f32>, 4>;
    for (var i = 0u; i < 4u; i++) {
        // At an odd border the neighbour counts twice.
        let px = min(first + vec2<u32>(i & 1u, i >> 1u), resize.size - 1u);
        texels[i] = mip_texel(pixel(px, group.z));
    }
    if HAS_MIPS != 0u {
        textureStore(next_mips, id.xy, group.z, round_mip(mip_mean(texels[0], texels[1], texels[2], texels[3])));
    }
}

//#use demodulation
//#use inputs
//#use rng
//#use reconstruction
// Albedo in the pass of planned frames: of the samples around a pixel, of history's texels, and of the result. Takes
// the place of no_albedo. CPU twin: src/cpu/planned/albedo.rs.

const HAS_ALBEDO: bool = true;

@group(0) @binding(13) var albedo_in: texture_2d_array<f32>;

// Albedo of a pixel.
fn albedo_at(px: vec2u, view: u32) -> vec4f {
    return given_albedo(textureLoad(albedo_in, texel_of(px, view, ALBEDO_IN), layer_of(view), 0).xyz);
}

// Albedos of the samples around a pixel with the albedo `own`, and what they change in its candidate.
struct SampleAlbedos {
    own: vec4f,
    sums: AlbedoSums,
    albedo: vec3f,
    factor: vec3f,
}

// Albedos of no sample.
fn sample_albedos(px: vec2u, view: u32) -> SampleAlbedos {
    let own = albedo_at(px, view);
    return SampleAlbedos(own, no_albedos(own.xyz), vec3f(0.0), vec3f(1.0));
}

// Adds the sample at a pixel.
fn with_sample(a: SampleAlbedos, at: vec2u, view: u32, c: vec3f, weight: f32) -> SampleAlbedos {
    var next = a;
    next.sums = add_albedo(a.sums, a.own, albedo_at(at, view), c, weight);
    return next;
}

// With what they change. `is_own`: whether the candidate is the pixel's own sample.
fn with_change(a: SampleAlbedos, is_own: bool, has_surface: bool) -> SampleAlbedos {
    var next = a;
    next.albedo = a.own.xyz;
    if !is_own {
        let change = candidate_change(a.sums, a.own, has_surface);
        next.albedo = change.albedo;
        next.factor = change.factor;
    }
    return next;
}

// Albedo of a pixel, and the smallest and largest of it and the four beside it.
fn own_albedo(px: vec2u, view: u32, own: vec3f) -> OwnAlbedo {
    var around = OwnAlbedo(own, own, own);
    for (var tap = 0u; tap < 4u; tap++) {
        let offset = select(vec2u(2u * tap, 1u), vec2u(1u, 2u * (tap - 2u)), tap > 1u);
        let at = clamp(px + offset, vec2u(1u), frame.size) - 1u;
        let given = textureLoad(albedo_in, texel_of(at, view, ALBEDO_IN), layer_of(view), 0).xyz;
        let there = limited_albedo(given);
        around.lowest = min(around.lowest, there);
        around.highest = max(around.highest, there);
    }
    return around;
}

// Sums over the texels of history around a position, by their albedo.
struct PastAlbedos {
    // Albedo of the pixel.
    own: vec4f,
    // Of the texels' albedos, as `AroundStored` has them of their colors.
    sum: vec3f,
    sum_x: vec3f,
    sum_y: vec3f,
    lumas: LumaRanges,
    // Packed albedo of the sample to keep.
    kept: u32,
    // Whether all albedos are known.
    is_known: bool,
    // Albedo at the position.
    shown: vec3f,
}

// Sums over no texel.
fn past_albedos(px: vec2u, view: u32) -> PastAlbedos {
    let zero = vec3f(0.0);
    let own = albedo_at(px, view);
    return PastAlbedos(own, zero, zero, zero, no_lumas(own.xyz), 0u, true, zero);
}

// Adds a texel with the albedo `word`, whose sample has a weight and a place. `same`: whether it is on the pixel's
// surface; `is_nearest`: whether it is the one to keep so far.
fn with_texel(
    a: PastAlbedos,
    word: u32,
    c: vec3f,
    weight: f32,
    place: vec2f,
    same: bool,
    is_nearest: bool,
) -> PastAlbedos {
    if !same {
        return a;
    }
    let there = unpack_albedo(word).xyz;
    return PastAlbedos(
        a.own,
        a.sum + there * weight,
        a.sum_x + there * (weight * place.x),
        a.sum_y + there * (weight * place.y),
        with_luma(a.lumas, c, there),
        select(a.kept, word, is_nearest),
        a.is_known && word != 0u,
        a.shown,
    );
}

// With the albedo at the position. `around`: sums over the colors of the same texels.
fn with_shown(a: PastAlbedos, around: AroundStored) -> PastAlbedos {
    var albedos = around;
    albedos.color = a.sum;
    albedos.color_x = a.sum_x;
    albedos.color_y = a.sum_y;
    albedos.nearest.color = unpack_albedo(a.kept).xyz;
    var next = a;
    next.shown = interpolate(albedos).color;
    return next;
}

// The texture of a pixel's colors, and the albedos that they had before.
struct PixelTexture {
    texture: Texture,
    // Albedo of the sample or candidate.
    of_sample: vec3f,
    // Of history.
    past: PastAlbedo,
    // Whether the pixel's albedo is known.
    is_known: bool,
}

// The texture of a pixel's colors. `at_edge`: whether it is at an edge of a surface; `is_usable`, `c`, `of_sample`:
// whether this frame has a color for it, that color, and its albedo.
fn pixel_texture(
    px: vec2u,
    view: u32,
    level: u32,
    at_edge: bool,
    past: PastAlbedos,
    history: Interpolated,
    is_usable: bool,
    c: vec3f,
    of_sample: vec3f,
) -> PixelTexture {
    let is_known = past.is_known && past.own.w > 0.0;
    let own = own_albedo(px, view, past.own.xyz);
    let kept = unpack_albedo(past.kept);
    var lumas = exposed_lumas(past.lumas, frame.exposure);
    if is_usable {
        lumas = with_luma(lumas, c, of_sample);
    }
    // At an edge history mixes surfaces, and one albedo does not explain the colors of several.
    let is_explained = level > 0u && history.lod >= 0.0 && is_known && !at_edge;
    let of_past = past_albedo(own, past.shown, kept.xyz, select(0.0, explained(lumas), is_explained));
    let texture = texture_of(own, of_past, kept_albedos(kept.w, history.nearest.place_px));
    return PixelTexture(texture, of_sample, of_past, past.own.w > 0.0);
}

// With the texture of the sample as it is.
fn of_sample(given: PixelTexture) -> PixelTexture {
    var next = given;
    next.texture.albedo = given.of_sample;
    return next;
}

// History with a texture.
fn of_history(given: PixelTexture, history: Interpolated) -> Interpolated {
    let factor = textured(given.texture, given.past.shown);
    var next = history;
    next.color *= factor;
    next.lowest *= factor;
    next.highest *= factor;
    next.nearest.color *= textured(given.texture, given.past.kept);
    return next;
}

// Factor on the sample or candidate.
fn on_sample(given: PixelTexture) -> vec3f {
    return textured(given.texture, given.of_sample);
}

// What the texture changes in the color that the pixel stores. `is_new`: whether the pixel has no history or is in the
// fovea; its albedo is then a mean of as many as it has `samples`.
fn retexture(
    px: vec2u,
    view: u32,
    given: PixelTexture,
    result: Reconstructed,
    is_new: bool,
    samples: f32,
) -> Retextured {
    let old = select(given.past.shown, given.past.kept, result.keeps_nearest);
    let of_color = between(given.of_sample, old, result.stored_share);
    let count = select(0.0, select(given.texture.kept + 1.0, samples, is_new), given.is_known);
    let up = unit_draw(bits(px.x, px.y, frame.frame_low, frame.views[view].key));
    return retextured(given.texture, of_color, count, up);
}

//#use color
//#use sanitize
// Twin of src/kernel/demodulation.rs, which documents the functions and the layout.

const ALBEDO_STEPS: f32 = 512.0;
const LARGEST_ALBEDO: f32 = 511.0f / ALBEDO_STEPS;
const ALBEDO_FLOOR: f32 = 0.04;
const MOST_QUOTIENT: f32 = 4.0;
const MOST_ALBEDOS: vec2f = vec2f(29.0, 3.0);
const ALBEDO_CLIP_COST: f32 = 4.0;
const EXPLAINED: vec2f = vec2f(0.5, 0.1);

// Albedo of a pixel as the renderer wrote it, limited to what is stored; 0 for NaN.
fn limited_albedo(given: vec3f) -> vec3f {
    return select(vec3f(0.0), min(given, vec3f(LARGEST_ALBEDO)), given > vec3f(0.0));
}

// The same, and 1; or 0 if it is unknown, because a channel, or their sum, is NaN or infinite.
fn given_albedo(given: vec3f) -> vec4f {
    return vec4f(limited_albedo(given), select(0.0, 1.0, is_finite((given.x + given.y) + given.z)));
}

// Factor on a color whose albedo changes.
fn quotient(to: vec3f, origin: vec3f) -> vec3f {
    // The limit keeps compilers from adding the floor to an earlier term.
    let largest = vec3f(LARGEST_ALBEDO);
    let factor = (min(to, largest) + ALBEDO_FLOOR) / (min(origin, largest) + ALBEDO_FLOOR);
    return clamp(factor, vec3f(1.0f / MOST_QUOTIENT), vec3f(MOST_QUOTIENT));
}

// Luma of an albedo, and the floor.
fn raised_luma(albedo: vec3f) -> f32 {
    return min(luma(albedo), LARGEST_ALBEDO) + ALBEDO_FLOOR;
}

// Smallest and largest luma of some colors, and the same if all had one albedo, whose luma and floor are `own`.
struct LumaRanges {
    own: f32,
    color: vec2f,
    lit: vec2f,
}

// Ranges of no color around a pixel with the albedo `own`.
fn no_lumas(own: vec3f) -> LumaRanges {
    return LumaRanges(raised_luma(own), vec2f(MAX_HALF, 0.0), vec2f(MAX_HALF, 0.0));
}

// With a color of the albedo `there`.
fn with_luma(a: LumaRanges, c: vec3f, there: vec3f) -> LumaRanges {
    let light = luma(c);
    let lit = light * clamp(a.own / raised_luma(there), 1.0f / MOST_QUOTIENT, MOST_QUOTIENT);
    return LumaRanges(
        a.own,
        vec2f(min(a.color.x, light), max(a.color.y, light)),
        vec2f(min(a.lit.x, lit), max(a.lit.y, lit)),
    );
}

// Ranges of colors that get an exposure.
fn exposed_lumas(a: LumaRanges, exposure: f32) -> LumaRanges {
    return LumaRanges(a.own, a.color * exposure, a.lit * exposure);
}

// Degree to which albedo explains the contrast of some colors, in [0, 1].
fn explained(a: LumaRanges) -> f32 {
    let roots = sqrt(max(vec4f(a.color, a.lit), vec4f(0.0)));
    let contrast = (roots.y - roots.x) * 100.0;
    let left = (roots.w - roots.z) * 100.0;
    return clamp((contrast - left) / (contrast * EXPLAINED.x + EXPLAINED.y), 0.0, 1.0);
}

// The part of a factor that is explained.
fn part(factor: vec3f, share: f32) -> vec3f {
    return factor * share + vec3f(1.0 - share);
}

// Albedo between two.
fn between(origin: vec3f, to: vec3f, share: f32) -> vec3f {
    return origin + (to - origin) * share;
}

struct AlbedoSums {
    sum: vec4f,
    lumas: LumaRanges,
}

// Sums over no sample around a pixel with the albedo `own`.
fn no_albedos(own: vec3f) -> AlbedoSums {
    return AlbedoSums(vec4f(0.0), no_lumas(own));
}

// Adds a sample with its albedo `there` around a pixel with the albedo `own`.
fn add_albedo(sums: AlbedoSums, own: vec4f, there: vec4f, c: vec3f, weight: f32) -> AlbedoSums {
    let known = select(own.xyz, there.xyz, there.w > 0.0);
    return AlbedoSums(sums.sum + vec4f(known * weight, weight), with_luma(sums.lumas, c, known));
}

struct AlbedoChange {
    albedo: vec3f,
    factor: vec3f,
}

// What the albedo `own` of a pixel between samples changes in its candidate.
fn candidate_change(sums: AlbedoSums, own: vec4f, has_surface: bool) -> AlbedoChange {
    let mean = sums.sum.xyz * (1.0 / sums.sum.w);
    let share = select(0.0, explained(sums.lumas), has_surface && own.w > 0.0);
    return AlbedoChange(between(mean, own.xyz, share), part(quotient(own.xyz, mean), share));
}

struct OwnAlbedo {
    albedo: vec3f,
    lowest: vec3f,
    highest: vec3f,
}

struct PastAlbedo {
    shown: vec3f,
    kept: vec3f,
    explained: f32,
}

// Albedos of history, and the degree `share` to which the pixel's own explains its contrast.
fn past_albedo(own: OwnAlbedo, shown: vec3f, kept: vec3f, share: f32) -> PastAlbedo {
    let lowest = min(own.lowest, kept);
    let highest = max(own.highest, kept);
    let difference = highest - lowest;
    let differs = max(max(difference.x, difference.y), difference.z) > 1.0f / ALBEDO_STEPS;
    return PastAlbedo(min(max(shown, lowest), highest), kept, select(0.0, share, differs));
}

// Number of albedos that a mean keeps.
fn kept_albedos(count: f32, place_px: vec2f) -> f32 {
    let away = min(max(abs(place_px.x), abs(place_px.y)) * 4.0, 1.0);
    return min(count, MOST_ALBEDOS.x + (MOST_ALBEDOS.y - MOST_ALBEDOS.x) * away);
}

// Mean of `kept` albedos of history, as far as this frame has such, and of the pixel's own.
fn mean_albedo(past: vec3f, own: OwnAlbedo, kept: f32) -> vec3f {
    let clipped = min(max(past, own.lowest), own.highest);
    return clipped + (own.albedo - clipped) * (1.0 / (kept + 1.0));
}

// The one texture that a pixel's colors get before they are compared and blended.
struct Texture {
    albedo: vec3f,
    stored: vec3f,
    explained: f32,
    kept: f32,
}

// The mean of this texture in all frames. `count`: number of albedos in history's mean.
fn texture_of(own: OwnAlbedo, past: PastAlbedo, count: f32) -> Texture {
    let outside = abs(past.kept - min(max(past.kept, own.lowest), own.highest));
    let kept = count * (1.0 - min(max(max(outside.x, outside.y), outside.z) * ALBEDO_CLIP_COST, 1.0));
    return Texture(mean_albedo(past.shown, own, kept), mean_albedo(past.kept, own, kept), past.explained, kept);
}

// Factor on a color of the albedo `of_color` that gets a texture.
fn textured(texture: Texture, of_color: vec3f) -> vec3f {
    return part(quotient(texture.albedo, of_color), texture.explained);
}

// What a pixel's texture changes in the color that it stores.
struct Retextured {
    factor: vec3f,
    place_share: f32,
    word: u32,
}

// The color to store, whose albedo was `of_color` before it got the texture.
fn retextured(texture: Texture, of_color: vec3f, count: f32, up: f32) -> Retextured {
    let goal = between(of_color, texture.stored, texture.explained);
    let word = pack_albedo(goal, count, up);
    // The color follows the rounding of its albedo.
    let stored = texture.stored + (unpack_albedo(word).xyz - goal);
    return Retextured(
        part(quotient(stored, texture.albedo), texture.explained),
        texture.explained * (1.0 / (texture.kept + 1.0)),
        word,
    );
}

// Packs an albedo, of which there are `count`; 0: unknown. It is rounded stochastically by `up`, uniform in [0, 1).
fn pack_albedo(a: vec3f, count: f32, up: f32) -> u32 {
    let steps = vec3u(clamp(a, vec3f(0.0), vec3f(LARGEST_ALBEDO)) * ALBEDO_STEPS + up);
    let word = steps.x | (steps.y << 9u) | (steps.z << 18u) | (u32(clamp(count, 0.0, 31.0) + 0.5) << 27u);
    return select(0u, word, count > 0.0);
}

// Albedo of a packed word, and the number of albedos in it.
fn unpack_albedo(word: u32) -> vec4f {
    let steps = vec3f(f32(word & 511u), f32((word >> 9u) & 511u), f32((word >> 18u) & 511u));
    return vec4f(steps * (1.0f / ALBEDO_STEPS), f32(word >> 27u));
}

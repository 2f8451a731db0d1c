//#use inputs
//#use quads
// Shaded quads and their samples. CPU twin: src/cpu/quads.rs.

// Bits 0 to 3: the pixels of a quad that are shaded; bits 4 and 5: its region; bits 8 to 12: paths of each pixel.
@group(0) @binding(9) var half_in: texture_2d_array<f32>;
@group(0) @binding(27) var quad_mask: texture_2d_array<u32>;
@group(0) @binding(28) var quad_around: texture_2d_array<u32>;

// Whether quads may be shaded in part: single pixels, own masks, and frames after a cut.
override PARTIAL: u32 = 1u;

fn mask_at(px: vec2u, view: u32) -> u32 {
    return textureLoad(quad_mask, px >> vec2u(1u), view, 0).x;
}

// Color and alpha of a shaded pixel, as the renderer wrote them.
fn given_sample(px: vec2u, view: u32) -> vec4f {
    if PARTIAL != 0u && frame.has_half != 0u && (mask_at(px, view) & 15u) != WHOLE {
        return textureLoad(half_in, texel_of(px >> vec2u(1u), view, HALF_IN), layer_of(view), 0);
    }
    return given_at(px, view);
}

// Alpha of a sample: 1 where the renderer wrote none.
fn usable_alpha(given: f32) -> f32 {
    return select(1.0, given, is_finite(given));
}

// The same with the color in this frame's exposure.
fn sample_at(px: vec2u, view: u32) -> vec4f {
    return in_exposure(given_sample(px, view));
}

// Whether a pixel is shaded, by the word of its quad.
fn is_shaded(mask_word: u32, px: vec2u) -> bool {
    return ((mask_word >> place_in_quad(px)) & 1u) != 0u;
}

// log2 of the distance of the pattern's samples in pixels, where a pixel lies; 0 in the fovea. Noisy samples are
// compared with history in the fovea, too.
fn level_of(mask_word: u32) -> u32 {
    let region_now = (mask_word >> 4u) & 3u;
    let outside = u32(select(frame.lod_far, frame.lod_mid, region_now == IN_MIDDLE));
    return select(outside, NOISY, region_now == IN_FOVEA);
}

// Code of neighbour `i` of a quad: words of `quad_around`.
fn code_of(around: vec2u, i: u32) -> u32 {
    return (select(around.x, around.y, i >= 4u) >> (8u * (i & 3u))) & 255u;
}

// Pixel `i` of a quad.
fn px_of_quad(quad: vec2u, i: u32) -> vec2u {
    return 2u * quad + vec2u(i & 1u, i >> 1u);
}

// The shaded pixel that is nearest to a pixel, of a quad with shaded pixels.
fn nearest_of(quad: vec2u, px: vec2u, view: u32) -> vec2u {
    if PARTIAL != 0u {
        let mask = textureLoad(quad_mask, quad, view, 0).x & 15u;
        if mask != WHOLE {
            return nearest_px(mask, quad, px);
        }
    }
    return min(clamp(px, 2u * quad, 2u * quad + 1u), frame.size - 1u);
}

// Samples that stand for a pixel; CPU twin: `samples_around` in src/cpu/quads.rs.
struct AroundPixel {
    // Shaded pixels of its quad.
    mask: u32,
    // Quads around it.
    quads: vec2u,
    // In a quad with some samples: codes of the nearest sample of each quadrant.
    codes: vec4u,
    is_own: bool,
    // Number of taps.
    count: u32,
}

fn around_pixel(px: vec2u, view: u32, mask_word: u32) -> AroundPixel {
    let quad = px >> vec2u(1u);
    let mask = mask_word & 15u;
    let quads = textureLoad(quad_around, quad, view, 0).xy;
    var codes = vec4u(0xffffffffu);
    let is_partial = PARTIAL != 0u && mask != WHOLE && mask != 0u;
    // Its own quad's pixels, then the quads around.
    let taps = select(0u, 12u, is_partial);
    for (var tap = 0u; tap < taps; tap++) {
        let code = code_of(quads, max(tap, 4u) - 4u);
        let is_there = select(code != NOWHERE, ((mask >> tap) & 1u) == 1u, tap < 4u);
        if is_there {
            var at = px_of_quad(quad, tap & 3u);
            if tap >= 4u {
                at = nearest_of(vec2u(vec2i(quad) + neighbour_offset(code)), px, view);
            }
            let offset = vec2i(at) - vec2i(px);
            if any(offset != vec2i(0)) {
                let quadrant = quadrant_of(offset.x, offset.y);
                // Not `codes[quadrant] = ...`: FXC, which wgpu has on Windows without another compiler, cannot write
                // vectors so.
                let nearer = min(codes, vec4u(sample_code(offset.x, offset.y)));
                codes = select(codes, nearer, vec4u(0u, 1u, 2u, 3u) == vec4u(quadrant));
            }
        }
    }
    let is_own = is_partial && is_shaded(mask_word, px);
    return AroundPixel(mask, quads, codes, is_own, select(4u, 5u, is_own));
}

// Pixel of sample `tap`, and whether there is one.
struct SampleTap {
    at: vec2u,
    is_there: bool,
}

fn sample_tap(around: AroundPixel, tap: u32, px: vec2u, view: u32) -> SampleTap {
    let quad = px >> vec2u(1u);
    if around.mask == WHOLE {
        let at = px_of_quad(quad, tap);
        return SampleTap(at, all(at < frame.size));
    }
    if around.mask == 0u || PARTIAL == 0u {
        let code = code_of(around.quads, tap);
        let other = vec2u(vec2i(quad) + neighbour_offset(code));
        if code == NOWHERE {
            return SampleTap(px, false);
        }
        return SampleTap(nearest_of(other, px, view), true);
    }
    let code = around.codes[tap & 3u];
    let at = vec2u(vec2i(px) + sample_offset(code));
    return SampleTap(select(at, px, tap == 4u), tap == 4u || code != 0xffffffffu);
}

// Sample `tap` of 12 that stand for a noisy pixel; CPU twin: `all_samples_around` in src/cpu/quads.rs.
fn noisy_tap(around: AroundPixel, tap: u32, px: vec2u, view: u32) -> SampleTap {
    let quad = px >> vec2u(1u);
    if tap < 4u {
        let at = px_of_quad(quad, tap);
        return SampleTap(at, ((around.mask >> tap) & 1u) == 1u && all(at < frame.size));
    }
    let code = code_of(around.quads, tap - 4u);
    if code == NOWHERE {
        return SampleTap(px, false);
    }
    return SampleTap(nearest_of(vec2u(vec2i(quad) + neighbour_offset(code)), px, view), true);
}

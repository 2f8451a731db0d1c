//#use antialias
//#use no_albedo
//#use previous
//#use pack
//#use reconstruction
//#use color
// Stored samples around the previous position of a pixel's surface. CPU twin: src/cpu/planned/sparse_history.rs.

// Whether frames are jittered and history stores means of samples.
override ANTIALIAS: u32 = 0u;

// Whether history has alpha.
override HAS_ALPHA: u32 = 0u;

@group(0) @binding(15) var past_stored: texture_2d_array<u32>;
// Alphas of the stored samples, as floats; or their packed albedos.
@group(0) @binding(17) var past_extra: texture_2d_array<u32>;

fn extra_word(texel: vec2i, view: u32) -> u32 {
    return textureLoad(past_extra, clamp(texel, vec2i(0), vec2i(frame.size) - 1), view, 0).x;
}

fn stored_words(texel: vec2i, view: u32) -> vec2u {
    return textureLoad(past_stored, clamp(texel, vec2i(0), vec2i(frame.size) - 1), view, 0).xy;
}

// Whether a stored sample may show a surface whose history has one of `codes`, and which moved by `moved_px` in the
// world.
fn is_reusable(words: vec2u, codes: vec2u, moved_px: f32) -> bool {
    return DEPTH_TEST == 0u || (has_code(code_word(words), codes) && moved_alike(words, moved_px));
}

// Motion in the world of the surface of a pixel, in pixels a frame; UNKNOWN_MOVED_PX if it is not known.
fn moved_px_at(px: vec2u, view: u32, disparity: f32, motion: vec2f) -> f32 {
    if frame.cameras[view].is_known == 0u || disparity < 0.0 {
        return UNKNOWN_MOVED_PX;
    }
    return world_motion_px(motion, camera_vector(ray_at(px, view).xy, disparity, frame.cameras[view].motion));
}

// Disparity and motion of the surface whose history a pixel continues.
struct PixelSurface {
    disparity: f32,
    motion: vec2f,
    // Disparity to store with the pixel.
    stored_disparity: f32,
    // Motion in the world, in pixels a frame.
    moved_px: f32,
    // Disparities of the farthest and the nearest surface that history may show.
    farthest: f32,
    nearest: f32,
    mixes: bool,
    // Whether history is the mean of several surfaces, of which a sample shows one.
    is_silhouette: bool,
    // Whether the pixel is at an edge of a surface.
    is_edge: bool,
    // Whether that edge moves, and is outside the fovea.
    is_moving_edge: bool,
}

// The surface whose history a pixel continues: with ANTIALIAS the nearest surface around it if `is_in_front` is true,
// otherwise its own. `level`: of its region.
fn surface_of(px: vec2u, view: u32, level: u32) -> PixelSurface {
    let own = disparity_at(px, view);
    let own_motion = motion_at(px, view);
    let own_moved_px = moved_px_at(px, view, own, own_motion);
    if ANTIALIAS == 0u || DEPTH_TEST == 0u {
        return PixelSurface(own, own_motion, own, own_moved_px, own, own, false, false, false, false);
    }
    var nearest_disparity = own;
    var farthest_disparity = own;
    var nearest_at = px;
    var farthest_at = px;
    var thin = false;
    var silhouette = false;
    var edge = false;
    for (var pair = 0u; pair < 4u; pair++) {
        var disparities = vec2f(own);
        for (var side = 0u; side < 2u; side++) {
            let tap = select(pair, 8u - pair, side == 1u);
            let offset = vec2u(tap % 3u, tap / 3u);
            let texel = clamp(px + offset, vec2u(1u), frame.size) - 1u;
            let near = disparity_at(texel, view);
            let is_farther = near >= 0.0 && near < farthest_disparity;
            nearest_at = select(nearest_at, texel, near > nearest_disparity);
            farthest_at = select(farthest_at, texel, is_farther);
            nearest_disparity = max(near, nearest_disparity);
            farthest_disparity = select(farthest_disparity, near, is_farther);
            disparities = select(vec2f(disparities.x, near), vec2f(near, disparities.y), side == 0u);
        }
        thin = thin || is_thin(own, disparities.x, disparities.y);
        silhouette = silhouette || is_silhouette(own, disparities.x, disparities.y);
        edge = edge || is_edge(own, disparities.x, disparities.y);
    }
    let motion = motion_at(nearest_at, view);
    let is_moving = edge && level > 0u && has_moved(own_motion, motion);
    var surface = PixelSurface(own, own_motion, own, own_moved_px, own, own, false, false, edge, is_moving);
    if is_in_front(own, nearest_disparity, own_motion, motion, level == 0u) {
        let moved_px = moved_px_at(nearest_at, view, nearest_disparity, motion);
        surface = PixelSurface(nearest_disparity, motion, nearest_disparity, moved_px, own, own, false, false, edge, is_moving);
    }
    if own >= 0.0 && move_together(own_motion, motion, motion_at(farthest_at, view)) {
        surface.stored_disparity = select(own, farthest_disparity, thin);
        surface.farthest = farthest_disparity;
        surface.nearest = nearest_disparity;
        surface.mixes = true;
        surface.is_silhouette = silhouette;
    }
    return surface;
}

// Previous position of a pixel's surface, and the disparities that its history may have.
struct SparseSource {
    previous: Previous,
    // Codes of these disparities, as `tap_codes` gives them.
    codes: vec2u,
    // Motion of the surface in the world, in pixels a frame.
    moved_px: f32,
}

fn sparse_source(px: vec2u, view: u32, surface: PixelSurface) -> SparseSource {
    let at = reprojected(px, view, surface.motion);
    let words = stored_words(vec2i(at.at), view);
    let stored = unpack_stored(words);
    let alike = DEPTH_TEST == 0u || moved_alike(words, surface.moved_px);
    var previous = previous_of(px, view, surface.motion, surface.disparity, at, stored.lod, stored.disparity);
    if ANTIALIAS == 0u || !surface.mixes {
        if previous.verdict == VERDICT_VALID && !alike {
            previous.verdict = VERDICT_DISOCCLUDED;
        }
        return SparseSource(previous, tap_codes(previous.expected), surface.moved_px);
    }
    let ray = ray_at(px, view);
    let farthest = expected_disparity(view, ray, surface.farthest);
    let nearest_expected = expected_disparity(view, ray, surface.nearest);
    if may_have_history(previous) {
        let is_same = previous.verdict == VERDICT_VALID || is_of_surfaces(stored.disparity, farthest, nearest_expected);
        previous.verdict = select(VERDICT_DISOCCLUDED, VERDICT_VALID, alike && is_same);
    }
    return SparseSource(previous, tap_codes_between(farthest, nearest_expected), surface.moved_px);
}

// Whether a previous position may have history.
fn may_have_history(previous: Previous) -> bool {
    return previous.verdict == VERDICT_VALID || previous.verdict == VERDICT_DISOCCLUDED;
}

// History, the texel of the sample to keep, and the samples in it.
struct SparseHistory {
    interpolated: Interpolated,
    texel: vec2i,
    mean: Mean,
    // Alpha at the position, and of the sample to keep.
    alpha: vec2f,
    albedos: PastAlbedos,
}

// History at a previous position, in this frame's exposure. At a silhouette the nearest stored sample may belong to
// another surface. Samples beside it then replace it if they are near enough. Where `needed` is false the loop has zero
// iterations: software Vulkan runs the body of an `if` for all pixels. `no_texels`: sums over the albedos of none.
fn sparse_history(source: SparseSource, view: u32, needed: bool, no_texels: PastAlbedos) -> SparseHistory {
    let previous = source.previous;
    var around = nothing_around();
    // The same samples with their alpha in place of their color.
    var alphas = nothing_around();
    var albedos = no_texels;
    // The place of a mean may lie anywhere around its texel's centre, so that the eight texels around the nearest one
    // also count.
    var columns = 2u;
    var first = vec2i(floor(previous.at));
    var inverse_reach = INVERSE_REACH;
    if ANTIALIAS != 0u {
        columns = 3u;
        first = vec2i(floor(previous.at + 0.5)) - 1;
        inverse_reach = INVERSE_MEAN_REACH;
    }
    var nearest_texel = first;
    var kept_lod = ONE_SAMPLE_LOD;
    let taps = select(0u, columns * columns, needed);
    for (var tap = 0u; tap < taps; tap++) {
        let texel = first + vec2i(vec2u(tap % columns, tap / columns));
        let words = stored_words(texel, view);
        let same = !is_empty(words) && is_reusable(words, source.codes, source.moved_px);
        let cost = around.cost;
        var stored = unpack_full(words);
        let lod = stored.lod;
        if ANTIALIAS != 0u {
            stored.lod = mean_lod(lod);
        }
        // Before `add_stored`, which has the same: compilers find it once.
        let place = (vec2f(texel) - previous.at) + stored.place_px;
        let weight = stored_weight(place.x * place.x + place.y * place.y, inverse_reach);
        around = add_stored(around, stored, vec2f(texel) - previous.at, same, inverse_reach);
        let is_nearest = around.cost < cost;
        if HAS_ALBEDO {
            let word = extra_word(texel, view);
            albedos = with_texel(albedos, word, stored.color, weight, place, same, is_nearest);
        }
        if HAS_ALPHA != 0u {
            stored.color = vec3f(bitcast<f32>(extra_word(texel, view)));
            alphas = add_stored(alphas, stored, vec2f(texel) - previous.at, same, inverse_reach);
        }
        nearest_texel = select(nearest_texel, texel, is_nearest);
        kept_lod = select(kept_lod, lod, is_nearest);
    }
    if previous.verdict == VERDICT_DISOCCLUDED && !can_replace(around) {
        around = nothing_around();
    }
    if HAS_ALBEDO {
        albedos = with_shown(albedos, around);
    }
    var found = interpolate(around);
    found.color = expose(found.color, frame.exposure);
    found.lowest = expose(found.lowest, frame.exposure);
    found.highest = expose(found.highest, frame.exposure);
    found.nearest.color = expose(found.nearest.color, frame.exposure);
    var alpha = vec2f(1.0);
    if HAS_ALPHA != 0u {
        // A plane through samples may exceed them; an alpha may not.
        let shown = interpolate(alphas);
        alpha = vec2f(clamp(shown.color.x, shown.lowest.x, shown.highest.x), shown.nearest.color.x);
    }
    return SparseHistory(found, nearest_texel, mean_of(kept_lod), alpha, albedos);
}

// Expected difference of a sample from history with the local contrast `contrast`, and deviation of a still mean.
struct Comparison {
    error: f32,
    deviation: f32,
}

fn comparison(history: SparseHistory, contrast: f32, motion: vec2f) -> Comparison {
    let found = history.interpolated;
    if ANTIALIAS == 0u {
        return Comparison(expected_error(found.lod, contrast, has_moved(motion, found.nearest.place_px)), 0.0);
    }
    let moved = has_moved(motion, vec2f(0.0));
    let mean = Mean(found.lod, history.mean.samples, history.mean.deviation, history.mean.run);
    return Comparison(expected_mean_error(mean, contrast, moved), select(history.mean.deviation, 0.0, moved));
}

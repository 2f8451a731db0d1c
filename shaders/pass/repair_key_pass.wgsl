//#use kept_history
//#use lattices
//#use repair_state
// Keys by which the quads of a sparse frame are chosen for repair, before the frame is shaded. CPU twin: `key` in
// src/cpu/sparse_pass/plan.rs. One invocation a quad of 2x2 pixels of view `frame.first_view`.
//
// 8 reads and 1 write a quad: depth, motion, trust and a stored sample of two pixels. A pixel that is not settled needs
// up to 14 more reads of depth and motion and 9 more of stored samples, and its quad 1 atomic sum.

@group(0) @binding(23) var keys_out: texture_storage_2d_array<r32uint, write>;

// Whether the stored sample nearest to a pixel's previous position is fine and belongs to the pixel's surface.
fn is_settled(px: vec2<u32>, view: u32) -> bool {
    let at = reprojected(px, motion_at(px, view));
    let stored = kept_at(vec2<i32>(at.at), view);
    var lod = stored.lod;
    if ANTIALIAS != 0u {
        lod = mean_of(lod).lod;
    }
    var same = true;
    if DEPTH_TEST != 0u {
        let expected = expected_disparity(view, ray_at(px, view), disparity_at(px, view));
        same = same_surface(expected, stored.disparity, frame.depth_relative, 0.0);
    }
    if HAS_TRUST != 0u {
        same = same && trust(trust_at(px, view)) > 0.0;
    }
    return same && at.verdict == VERDICT_VALID && lod >= 0.0 && lod < WANTED_LOD;
}

// Priority, for a sample of its own, of a pixel that is not settled.
fn pixel_priority(px: vec2<u32>, view: u32) -> u32 {
    let lattice = lattice_at(px, view);
    let near = around(px, lattice);
    let is_sample = near.any && near.x.fraction == 0.0 && near.y.fraction == 0.0;
    let surface = surface_of(px, view, lattice.level);
    let source = kept_source(px, view, surface);
    let kept = kept_history(source, view, may_have_history(source.previous) && !is_sample);
    let e_deg = eccentricity_deg(ray_at(px, view), frame.views[view].gaze_ray.xyz);
    return select(priority(kept.found.lod, e_deg), 0u, is_sample);
}

@compute @workgroup_size(64, 1)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let view = frame.first_view;
    let quad = id.xy;
    if any(2u * quad >= frame.size) {
        return;
    }
    // Pixels that are not settled, as bits. They are few, and the second loop ends at once for the others.
    var left = 0u;
    for (var i = 0u; i < 2u; i++) {
        let px = asked_px(i, quad.x, quad.y, frame.frame_low);
        left |= select(0u, 1u << i, all(px < frame.size) && is_seen(px, view) && !is_settled(px, view));
    }
    var largest = 0u;
    while left != 0u {
        let px = asked_px(firstTrailingBit(left), quad.x, quad.y, frame.frame_low);
        largest = max(largest, pixel_priority(px, view));
        left &= left - 1u;
    }
    let key = quad_key(largest, quad.x, quad.y, frame.frame_low, frame.views[view].key);
    if key > 0u {
        atomicAdd(&state.counts[key], 1u);
    }
    textureStore(keys_out, quad.xy, view, vec4<u32>(key, 0u, 0u, 0u));
}

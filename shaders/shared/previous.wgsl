//#use inputs
//#use past_frame
//#use reproject
// Previous position of a pixel's surface; shared by the methods that store surfaces. CPU twin: src/cpu/inputs.rs.

// All fields but the verdict are valid only if that is VERDICT_VALID or VERDICT_DISOCCLUDED.
struct Previous {
    verdict: u32,
    at: vec2f,
    nearest_at: vec2u,
    expected: f32,
    trust: f32,
}

fn no_previous(verdict: u32) -> Previous {
    return Previous(verdict, vec2f(0.0), vec2u(0u), INVALID_DISPARITY, 0.0);
}

// Previous position of a pixel's surface. `stored_lod` (negative: empty) and `stored_disparity`: of the texel `at`.
fn previous_of(
    px: vec2u,
    view: u32,
    motion: vec2f,
    disparity_now: f32,
    at: Reprojection,
    stored_lod: f32,
    stored_disparity: f32,
) -> Previous {
    if at.verdict != VERDICT_VALID {
        return no_previous(at.verdict);
    }
    if stored_lod < 0.0 {
        return no_previous(VERDICT_EMPTY);
    }
    var confidence = 1.0;
    if HAS_TRUST != 0u {
        confidence = trust(trust_at(px, view));
        if confidence == 0.0 {
            return no_previous(VERDICT_DISTRUSTED);
        }
    }
    let expected = expected_disparity(view, ray_at(px, view), disparity_now);
    let is_same = is_same_surface(px, view, disparity_now, expected, stored_disparity);
    let verdict = select(VERDICT_DISOCCLUDED, VERDICT_VALID, is_same);
    return Previous(verdict, vec2f(px) + motion, at.at, expected, confidence);
}

// Whether a neighbour in the 2x2 block has the same motion as the pixel.
fn is_coherent(px: vec2u, view: u32, own: vec2f) -> bool {
    if HAS_MOTION == 0u && CAMERA_MOTION == 0u {
        return true;
    }
    // At an odd border the pixel is its own neighbour.
    let across = min(px ^ vec2u(1u), frame.size - 1u);
    return moves_alike(own, motion_at(vec2u(across.x, px.y), view))
        || moves_alike(own, motion_at(vec2u(px.x, across.y), view));
}

//#use raster_frame
//#use raster_material
// Depth and motion of the first surface. Motion is previous minus current position in pixels, y down.

struct MotionVarying {
    @builtin(position) position: vec4f,
    @location(0) now: vec3f,
    @location(1) before: vec3f,
    @location(2) uvs: vec4f,
    @location(3) color: vec4f,
}

@vertex
fn motion_vertex(vertex: Vertex) -> MotionVarying {
    let now = homogeneous_px(frame.current, from_eye(frame.current, vertex.position));
    let before = homogeneous_px(frame.previous, from_eye(frame.previous, vertex.before));
    return MotionVarying(clip(now), now, before, vertex.uvs, vertex.color);
}

// Both positions are interpolated, instead of subtracting from the pixel's: vertices are snapped to a subpixel grid,
// and this way both positions have the same error.
@fragment
fn motion(in: MotionVarying) -> @location(0) vec2f {
    if !passes_alpha_test(base_at(in.uvs, in.color).w) {
        discard;
    }
    return moved(in.now, in.before);
}

@fragment
fn motion_opaque(in: MotionVarying) -> @location(0) vec2f {
    return moved(in.now, in.before);
}

@vertex
fn fullscreen(@builtin(vertex_index) index: u32) -> @builtin(position) vec4f {
    return fullscreen_position(index);
}

// The sky is infinitely far away: only camera rotation moves it.
@fragment
fn motion_far(@builtin(position) position: vec4f) -> @location(0) vec2f {
    let px = full_rate_px(position);
    let before = (frame.previous_px_from_px[0].xyz * px.x + frame.previous_px_from_px[1].xyz * px.y) + frame.previous_px_from_px[2].xyz;
    return moved(vec3f(px, 1.0), before);
}

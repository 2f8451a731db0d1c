//#use raster_frame
//#use raster_material
// Depth and motion of the first surface. Motion is previous minus current position in pixels, y down.

// Motion of points behind the previous camera.
const OFF_FRAME_PX: f32 = 1e6;

struct MotionVarying {
    @builtin(position) position: vec4<f32>,
    @location(0) now: vec3<f32>,
    @location(1) before: vec3<f32>,
    @location(2) uvs: vec4<f32>,
    @location(3) color: vec4<f32>,
}

@vertex
fn motion_vertex(vertex: Vertex) -> MotionVarying {
    let now = homogeneous_px(frame.current, from_eye(frame.current, vertex.position));
    let before = homogeneous_px(frame.previous, from_eye(frame.previous, vertex.before));
    return MotionVarying(clip(now), now, before, vertex.uvs, vertex.color);
}

fn moved(now: vec3<f32>, before: vec3<f32>) -> vec2<f32> {
    if before.z <= 0.0 {
        return vec2<f32>(OFF_FRAME_PX);
    }
    let off = vec2<f32>(OFF_FRAME_PX);
    return clamp(before.xy / before.z - now.xy / now.z, -off, off);
}

// Both positions are interpolated, instead of subtracting from the pixel's: vertices are snapped to a subpixel grid,
// and this way both positions have the same error.
@fragment
fn motion(in: MotionVarying) -> @location(0) vec2<f32> {
    if !passes_alpha_test(base_at(in.uvs, in.color).w) {
        discard;
    }
    return moved(in.now, in.before);
}

@fragment
fn motion_opaque(in: MotionVarying) -> @location(0) vec2<f32> {
    return moved(in.now, in.before);
}

@vertex
fn fullscreen(@builtin(vertex_index) index: u32) -> @builtin(position) vec4<f32> {
    return fullscreen_position(index);
}

// The sky is infinitely far away: only camera rotation moves it.
@fragment
fn motion_far(@builtin(position) position: vec4<f32>) -> @location(0) vec2<f32> {
    let px = full_rate_px(position);
    let before = (frame.previous_px_from_px[0].xyz * px.x + frame.previous_px_from_px[1].xyz * px.y) + frame.previous_px_from_px[2].xyz;
    return moved(vec3<f32>(px, 1.0), before);
}

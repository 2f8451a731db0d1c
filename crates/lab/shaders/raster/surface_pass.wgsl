//#use raster_frame
//#use raster_material
// Depth and motion of the first surface behind each pixel's centre: previous minus current, pixels, y down.

// What the previous camera could not have seen.
const OFF_FRAME_PX: f32 = 1e6;

struct Followed {
    @builtin(position) position: vec4<f32>,
    @location(0) now: vec3<f32>,
    @location(1) before: vec3<f32>,
    @location(2) uv: vec2<f32>,
    @location(3) color: vec4<f32>,
}

@vertex
fn follow(corner: Corner) -> Followed {
    let now = homogeneous_px(frame.now, from_eye(frame.now, corner.position));
    let before = homogeneous_px(frame.before, from_eye(frame.before, corner.before));
    return Followed(clip(now), now, before, corner.uv, corner.color);
}

fn moved(now: vec3<f32>, before: vec3<f32>) -> vec2<f32> {
    if before.z <= 0.0 {
        return vec2<f32>(OFF_FRAME_PX);
    }
    let off = vec2<f32>(OFF_FRAME_PX);
    return clamp(before.xy / before.z - now.xy / now.z, -off, off);
}

// Both places are interpolated, not the one subtracted from the pixel: where vertices are rounded to a grid of subpixels, both
// are off by the same.
@fragment
fn motion(in: Followed) -> @location(0) vec2<f32> {
    if !is_there(base_at(in.uv, in.color).w) {
        discard;
    }
    return moved(in.now, in.before);
}

@fragment
fn motion_opaque(in: Followed) -> @location(0) vec2<f32> {
    return moved(in.now, in.before);
}

@vertex
fn far(@builtin(vertex_index) index: u32) -> @builtin(position) vec4<f32> {
    return far_corner(index);
}

// The sky is infinitely far: only the camera's rotation moves it.
@fragment
fn motion_far(@builtin(position) position: vec4<f32>) -> @location(0) vec2<f32> {
    let px = position.xy - vec2<f32>(0.5);
    let before = (frame.turned[0].xyz * px.x + frame.turned[1].xyz * px.y) + frame.turned[2].xyz;
    return moved(vec3<f32>(px, 1.0), before);
}

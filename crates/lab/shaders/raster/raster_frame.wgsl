// Uniforms of a rasterized frame: current and previous camera, and lights. Twin of src/raster/frame.rs, lights.rs
// and lighting.rs.

// Camera. `high` plus `low` is the eye's position. The rows x, y, along project a point relative to the eye to
// homogeneous pixels: (x, y) / along is the pixel (centres at integers, y down), along the distance on the view axis.
struct Eye {
    high: vec4f,
    low: vec4f,
    x: vec4f,
    y: vec4f,
    along: vec4f,
}

struct RasterFrame {
    current: Eye,
    previous: Eye,
    // Columns: from a pixel (x, y, 1) to the homogeneous pixel of its direction in the previous frame.
    previous_px_from_px: array<vec4f, 3>,
    // World-space ray through pixel (0, 0), and steps to the right and lower neighbour.
    corner: vec4f,
    right: vec4f,
    down: vec4f,
    // Pixels of the viewport, each of which shows one pixel of the full-rate frame: pixel (x, y) of the viewport shows
    // first_px + step * (x, y).
    size: vec2f,
    near: f32,
    // Level of detail that is added to that of textures: -log2(step) where pixels are samples of a full-rate frame.
    texture_bias: f32,
    first_px: vec2f,
    // Corner of the viewport in the target.
    origin: vec2f,
    step: f32,
    per_step: f32,
    unused: vec2f,
}

struct RasterLight {
    position: vec3f,
    // 0 directional, 1 point, 2 spot, 3 one-sided panel, 4 two-sided panel.
    kind: u32,
    direction: vec3f,
    range: f32,
    // Radiance for panels.
    intensity: vec3f,
    cos_inner: f32,
    cos_outer: f32,
    area: f32,
    // Whether the sun's shadow map applies to the light: 1 or 0.
    has_shadow: f32,
    unused: f32,
}

const MAX_LIGHTS: u32 = 64u;

struct RasterLights {
    // Irradiance on faces towards +x, -x, +y, -y, +z, -z.
    ambient: array<vec4f, 6>,
    // Rows from world space to the shadow map: x and y in -1 to 1, z from 0 (far) to 1.
    sun: array<vec4f, 3>,
    // Radiance of indirect light, the same everywhere.
    bounced: vec3f,
    count: u32,
    // Size of a shadow map texel in metres.
    texel: f32,
    // Number of the sky's last mip level.
    last_level: f32,
    unused: vec2f,
    lights: array<RasterLight, MAX_LIGHTS>,
}

@group(0) @binding(0) var<uniform> frame: RasterFrame;
// Values that shaders branch and loop on are in a storage buffer, here and in raster_material.wgsl. For uniforms,
// software Vulkan (Mesa 22.3) compiles a variant each time the pipeline is bound, and keeps it as long as the pipeline
// lives.
@group(0) @binding(1) var<storage, read> lights: RasterLights;

// A vertex, with its position in the previous frame.
struct Vertex {
    @location(0) position: vec3f,
    @location(1) normal: vec3f,
    @location(2) tangent: vec4f,
    // First and second texture coordinates.
    @location(3) uvs: vec4f,
    @location(4) color: vec4f,
    @location(5) before: vec3f,
}

// Position relative to the eye. The eye's position has two parts, so that no precision is lost far from the origin.
fn from_eye(eye: Eye, world: vec3f) -> vec3f {
    return (world - eye.high.xyz) - eye.low.xyz;
}

fn homogeneous_px(eye: Eye, relative: vec3f) -> vec3f {
    return vec3f(dot(eye.x.xyz, relative), dot(eye.y.xyz, relative), dot(eye.along.xyz, relative));
}

// Clip position with reversed depth and no far plane: depth is near / distance.
fn clip(px: vec3f) -> vec4f {
    let at = (px.xy - frame.first_px * px.z) * frame.per_step;
    let x = (2.0 * at.x + px.z) / frame.size.x - px.z;
    let y = px.z - (2.0 * at.y + px.z) / frame.size.y;
    return vec4f(x, y, frame.near, px.z);
}

// Motion of points behind the previous camera.
const OFF_FRAME_PX: f32 = 1e6;

// Motion between two homogeneous pixels: previous minus current position, y down.
fn moved(now: vec3f, before: vec3f) -> vec2f {
    if before.z <= 0.0 {
        return vec2f(OFF_FRAME_PX);
    }
    let off = vec2f(OFF_FRAME_PX);
    return clamp(before.xy / before.z - now.xy / now.z, -off, off);
}

// Pixel of the full-rate frame that a fragment shows.
fn full_rate_px(position: vec4f) -> vec2f {
    return frame.first_px + ((position.xy - vec2f(0.5)) - frame.origin) * frame.step;
}

// A triangle that covers the frame, at infinite distance.
fn fullscreen_position(index: u32) -> vec4f {
    return vec4f(f32(index & 1u) * 4.0 - 1.0, f32(index >> 1u) * 4.0 - 1.0, 0.0, 1.0);
}

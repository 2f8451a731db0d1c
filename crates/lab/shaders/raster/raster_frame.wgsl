// What a frame of the rasteriser is told: where the eye is and was, and the light. src/raster/frame.rs fills it.

// A camera as rows that take a point, from the eye, to homogeneous pixels: x, y and the distance along the axis, so that
// (x, y) / distance is the pixel, whose centre is at integers, y down.
struct Eye {
    high: vec4<f32>,
    low: vec4<f32>,
    x: vec4<f32>,
    y: vec4<f32>,
    along: vec4<f32>,
}

struct RasterFrame {
    current: Eye,
    previous: Eye,
    // Columns: from a pixel (x, y, 1) to where its direction was, in homogeneous pixels.
    previous_px_from_px: array<vec4<f32>, 3>,
    // Ray through pixel (0, 0), and from a pixel to its right and lower neighbours, in world space.
    corner: vec4<f32>,
    right: vec4<f32>,
    down: vec4<f32>,
    size: vec2<f32>,
    near: f32,
    unused: f32,
}

struct RasterLight {
    position: vec3<f32>,
    // 0 directional, 1 point, 2 spot, 3 a panel that emits from its front, 4 one that emits from both sides.
    kind: u32,
    direction: vec3<f32>,
    range: f32,
    // Of panels radiance.
    intensity: vec3<f32>,
    cos_inner: f32,
    cos_outer: f32,
    area: f32,
    // Share of the light that the sun's shadow map tells of: 1 or 0.
    has_shadow: f32,
    unused: f32,
}

const MAX_LIGHTS: u32 = 64u;

struct RasterLights {
    // Irradiance on faces towards +x, -x, +y, -y, +z, -z.
    ambient: array<vec4<f32>, 6>,
    // Rows: from world space to the shadow map, x and y in -1 to 1, z in 0 (far) to 1.
    sun: array<vec4<f32>, 3>,
    // Radiance that reaches every place after many bounces.
    bounced: vec3<f32>,
    count: u32,
    // Metres on the ground that a texel of the shadow map covers.
    texel: f32,
    // Smallest level of the sky's map.
    last_level: f32,
    unused: vec2<f32>,
    lights: array<RasterLight, MAX_LIGHTS>,
}

@group(0) @binding(0) var<uniform> frame: RasterFrame;
// What shaders branch and loop by is in storage, here and in raster_material.wgsl: where that is a uniform, software Vulkan (Mesa
// 22.3) compiles a variant each time the pipeline is bound, and keeps it as long as the pipeline lives.
@group(0) @binding(1) var<storage, read> lights: RasterLights;

// A corner of a triangle, and where it was a frame ago.
struct Vertex {
    @location(0) position: vec3<f32>,
    @location(1) normal: vec3<f32>,
    @location(2) tangent: vec4<f32>,
    @location(3) uv: vec2<f32>,
    @location(4) color: vec4<f32>,
    @location(5) before: vec3<f32>,
}

// From the eye: the eye's place in two parts, so that nothing is lost far from the origin.
fn from_eye(eye: Eye, world: vec3<f32>) -> vec3<f32> {
    return (world - eye.high.xyz) - eye.low.xyz;
}

fn homogeneous_px(eye: Eye, relative: vec3<f32>) -> vec3<f32> {
    return vec3<f32>(dot(eye.x.xyz, relative), dot(eye.y.xyz, relative), dot(eye.along.xyz, relative));
}

// Reversed depth without a far plane: near / distance.
fn clip(px: vec3<f32>) -> vec4<f32> {
    let x = (2.0 * px.x + px.z) / frame.size.x - px.z;
    let y = px.z - (2.0 * px.y + px.z) / frame.size.y;
    return vec4<f32>(x, y, frame.near, px.z);
}

// A triangle that covers the frame, infinitely far.
fn fullscreen_position(index: u32) -> vec4<f32> {
    return vec4<f32>(f32(index & 1u) * 4.0 - 1.0, f32(index >> 1u) * 4.0 - 1.0, 0.0, 1.0);
}

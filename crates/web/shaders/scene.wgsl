// A courtyard of tiles and pillars, seen by a moving camera. Every lattice is drawn as a small view of its own.

struct Scene {
    // Scale and offset of clip space that leave the part that a lattice covers.
    scale: vec2<f32>,
    offset: vec2<f32>,
    // Size of the full-rate frame, and half of its extent at distance 1.
    size_px: vec2<f32>,
    tan: vec2<f32>,
    // Eye and turn around the vertical axis, in radians, of this frame and of the previous one.
    eye: vec4<f32>,
    eye_before: vec4<f32>,
    // log2 of the lattice's step: detail that is finer than the frame's pixels is left out, not what is finer than the
    // lattice's.
    level: f32,
}

@group(0) @binding(0) var<uniform> scene: Scene;

const NEAR: f32 = 0.1;
const PILLARS: u32 = 40u;

struct Varying {
    @builtin(position) position: vec4<f32>,
    @location(0) world: vec3<f32>,
    @location(1) @interpolate(flat) normal: vec3<f32>,
    @location(2) @interpolate(flat) albedo: vec3<f32>,
    @location(3) now: vec4<f32>,
    @location(4) before: vec4<f32>,
}

struct Targets {
    @location(0) color: vec4<f32>,
    @location(1) motion: vec2<f32>,
}

// Clip space with reversed depth and an infinite far plane.
fn projected(world: vec3<f32>, eye: vec4<f32>) -> vec4<f32> {
    let p = world - eye.xyz;
    let c = cos(eye.w);
    let s = sin(eye.w);
    let turned = vec3<f32>(c * p.x - s * p.z, p.y, s * p.x + c * p.z);
    return vec4<f32>(turned.xy / scene.tan, NEAR, -turned.z);
}

fn hash(n: u32) -> vec3<f32> {
    let x = n * 747796405u + 2891336453u;
    let w = ((x >> ((x >> 28u) + 4u)) ^ x) * 277803737u;
    let h = (w >> 22u) ^ w;
    return vec3<f32>(f32(h & 1023u), f32((h >> 10u) & 1023u), f32((h >> 20u) & 1023u)) / 1023.0;
}

// Corners of a quad as two triangles.
fn corner(i: u32) -> vec2<f32> {
    let order = array<u32, 6>(0u, 1u, 2u, 2u, 1u, 3u);
    let k = order[i];
    return vec2<f32>(f32(k & 1u), f32(k >> 1u));
}

// Instance 0 is the floor; the others are boxes, whose six faces have six vertices each.
@vertex
fn vertex(@builtin(vertex_index) i: u32, @builtin(instance_index) instance: u32) -> Varying {
    var world: vec3<f32>;
    var normal = vec3<f32>(0.0, 1.0, 0.0);
    var albedo = vec3<f32>(0.55, 0.5, 0.44);
    if instance == 0u {
        let at = corner(i % 6u);
        // Only the first face of the floor has an area.
        let extent = select(0.0, 80.0, i < 6u);
        world = vec3<f32>((at.x - 0.5) * extent, 0.0, (at.y - 0.5) * extent);
    } else {
        let h = hash(instance);
        let side = select(-1.0, 1.0, (instance & 1u) == 0u);
        let row = f32(instance / 2u);
        let isColumn = instance % 3u != 0u;
        let middle = vec3<f32>(side * select(1.6 + 2.5 * h.x, 2.6, isColumn), 0.0, 8.0 - 2.2 * row);
        let extent = select(vec3<f32>(0.5 + 0.5 * h.y, 0.3 + 0.7 * h.z, 0.5), vec3<f32>(0.35, 3.2, 0.35), isColumn);
        let face = i / 6u;
        let axis = face >> 1u;
        let sign = select(-1.0, 1.0, (face & 1u) == 1u);
        let at = corner(i % 6u) * 2.0 - 1.0;
        var local = vec3<f32>(sign, at.x, at.y);
        normal = vec3<f32>(sign, 0.0, 0.0);
        if axis == 1u {
            local = vec3<f32>(at.x, sign, at.y);
            normal = vec3<f32>(0.0, sign, 0.0);
        } else if axis == 2u {
            local = vec3<f32>(at.x, at.y, sign);
            normal = vec3<f32>(0.0, 0.0, sign);
        }
        world = middle + vec3<f32>(0.5, 0.5, 0.5) * extent * local + vec3<f32>(0.0, 0.5 * extent.y, 0.0);
        albedo = select(0.25 + 0.6 * h, vec3<f32>(0.72, 0.68, 0.6), isColumn);
    }
    let now = projected(world, scene.eye);
    let cropped = vec4<f32>(now.xy * scene.scale + scene.offset * now.w, now.zw);
    return Varying(cropped, world, normal, albedo, now, projected(world, scene.eye_before));
}

// Tiles with joints, and a fine print on them; both fade where a pixel of the frame is larger than they are.
fn pattern(at: vec2<f32>, width: vec2<f32>) -> f32 {
    let fine = max(width.x, width.y);
    let tile = abs(fract(at * 1.5) - 0.5);
    let joint = smoothstep(0.44, 0.44 + 1.5 * fine + 0.02, max(tile.x, tile.y));
    let wave = sin(at * 24.0);
    let print = wave.x * wave.y * (1.0 - smoothstep(0.04, 0.12, fine));
    return 1.0 - 0.6 * joint + 0.35 * print;
}

@fragment
fn fragment(in: Varying) -> Targets {
    var at = in.world.xz;
    if in.normal.x != 0.0 {
        at = in.world.zy;
    } else if in.normal.z != 0.0 {
        at = in.world.xy;
    }
    let width = fwidth(at) * exp2(-scene.level);
    let light = normalize(vec3<f32>(0.5, 0.9, 0.35));
    let lit = 0.3 + 0.7 * max(dot(in.normal, light), 0.0);
    let haze = 1.0 - exp(-0.03 * in.now.w);
    let color = mix(in.albedo * pattern(at, width) * lit, vec3<f32>(0.42, 0.55, 0.72), haze);
    let ndc = in.before.xy / in.before.w - in.now.xy / in.now.w;
    return Targets(vec4<f32>(color, 1.0), ndc * vec2<f32>(0.5, -0.5) * scene.size_px);
}

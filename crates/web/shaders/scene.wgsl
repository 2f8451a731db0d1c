// A colonnade by the sea in the evening, seen by a moving camera. One ray a pixel finds depth and motion. The color of
// a pixel is a mean of rays, so that edges are smooth, with shadows and reflections; only chosen pixels get one.

struct Scene {
    // Eye and turn around the vertical axis, in radians, of this frame and of the previous one.
    eye: vec4f,
    eye_before: vec4f,
    // Size of the full-rate frame, and half of its extent at distance 1.
    size_px: vec2f,
    tan: vec2f,
}

// The quads that the post-process chose (`quad_list`).
struct Quads {
    arguments: array<u32, 7>,
    count: u32,
    places: array<u32>,
}

@group(0) @binding(0) var<uniform> scene: Scene;
@group(0) @binding(1) var depth_out: texture_storage_2d<r32float, write>;
@group(0) @binding(2) var motion_out: texture_storage_2d<rg32float, write>;
@group(0) @binding(3) var color_out: texture_storage_2d<rgba32float, write>;
@group(0) @binding(4) var<storage, read> quads: Quads;
// Bits 0 to 3: pixels of a quad to shade.
@group(0) @binding(5) var quad_mask: texture_2d<u32>;

const NEAR: f32 = 0.1;
const FAR: f32 = 1e4;
const RAYS: u32 = 4u;
// Direction to the sun: normalize(0.75, 0.42, -0.22).
const SUN: vec3f = vec3f(0.8453, 0.4734, -0.2480);

// Lengths in metres.
const COLUMNS: f32 = 9.0;
const COLUMN_X: f32 = 2.6;
const COLUMN_STEP: f32 = 2.6;
const COLUMN_RADIUS: f32 = 0.27;
const COLUMN_TOP: f32 = 3.3;
const FIRST_Z: f32 = 7.0;
const LAST_Z: f32 = -15.0;
const BALLS: u32 = 6u;
const WALL_X: f32 = -5.2;
const WALL_TOP: f32 = 4.2;
const SHORE_X: f32 = 4.4;

const SKY: u32 = 0u;
const FLOOR: u32 = 1u;
const WALL: u32 = 2u;
const COLUMN: u32 = 3u;
const BEAM: u32 = 4u;
const BALL: u32 = 5u;
const LAMP: u32 = 16u;

struct Hit {
    t: f32,
    normal: vec3f,
    thing: u32,
}

// Direction through a place of the frame, whose component along the view is 1.
fn ray_through(px: vec2f) -> vec3f {
    let at = ((px + 0.5) / scene.size_px * 2.0 - 1.0) * vec2f(1.0, -1.0) * scene.tan;
    let c = cos(scene.eye.w);
    let s = sin(scene.eye.w);
    return vec3f(c * at.x - s, at.y, -s * at.x - c);
}

// Where the previous frame showed what lies in a direction from its eye, in pixels.
fn previous_px(p: vec3f) -> vec2f {
    let c = cos(scene.eye_before.w);
    let s = sin(scene.eye_before.w);
    let turned = vec3f(c * p.x - s * p.z, p.y, s * p.x + c * p.z);
    return (turned.xy / (scene.tan * -turned.z) * vec2f(0.5, -0.5) + 0.5) * scene.size_px - 0.5;
}

fn sphere(start: vec3f, d: vec3f, radius: f32) -> f32 {
    let a = dot(d, d);
    let b = dot(start, d);
    let root = b * b - a * (dot(start, start) - radius * radius);
    let t = (-b - sqrt(max(root, 0.0))) / a;
    return select(FAR, t, root > 0.0 && t > 1e-3);
}

// Distances to where a ray enters and leaves a box.
fn box(start: vec3f, d: vec3f, half: vec3f) -> vec2f {
    let inverse = 1.0 / d;
    let middle = -start * inverse;
    let reach = abs(inverse) * half;
    let enters = middle - reach;
    let leaves = middle + reach;
    return vec2f(max(max(enters.x, enters.y), enters.z), min(min(leaves.x, leaves.y), leaves.z));
}

// Distance to a row of columns. Only those are tried that stand where the ray is as far to the side as the row.
fn columns(start: vec3f, d: vec3f, side: f32) -> f32 {
    let beside = vec3f(start.x - side * COLUMN_X, start.y - 0.5 * COLUMN_TOP, start.z - 0.5 * (FIRST_Z + LAST_Z));
    let reach = box(beside, d, vec3f(COLUMN_RADIUS, 0.5 * COLUMN_TOP, 11.0));
    let enters = max(reach.x, 0.0);
    if enters > reach.y {
        return FAR;
    }
    let ends = (FIRST_Z - (start.z + vec2f(enters, reach.y) * d.z) - 1.0) / COLUMN_STEP;
    let away = select(1.0, -1.0, d.z > 0.0);
    let near = select(floor(ends.x + 0.2), ceil(ends.x - 0.2), away > 0.0);
    let a = dot(d.xz, d.xz);
    for (var i = near; away * i <= away * ends.y + 0.2; i += away) {
        let from_middle = vec2f(beside.x, start.z - FIRST_Z + 1.0 + COLUMN_STEP * i);
        let b = dot(from_middle, d.xz);
        let root = b * b - a * (dot(from_middle, from_middle) - COLUMN_RADIUS * COLUMN_RADIUS);
        let t = (-b - sqrt(max(root, 0.0))) / a;
        let y = start.y + t * d.y;
        if root > 0.0 && t > 1e-3 && y > 0.0 && y < COLUMN_TOP && i > -0.5 && i < COLUMNS {
            return t;
        }
    }
    return FAR;
}

fn beam_at(side: f32) -> vec3f {
    return vec3f(side * COLUMN_X, COLUMN_TOP + 0.25, 0.5 * (FIRST_Z + LAST_Z));
}

const BEAM_HALF: vec3f = vec3f(0.4, 0.25, 11.0);

// Balls on the floor, then lamps in the air: place and radius.
fn ball_at(i: u32) -> vec4f {
    if i >= BALLS {
        return vec4f(0.0, 2.75, 4.7 - 5.2 * f32(i - BALLS), 0.13);
    }
    let radius = 0.28 + 0.12 * fract(f32(i) * 0.618);
    return vec4f(select(-1.45, 1.55, i % 2u == 0u), radius, 3.2 - 2.6 * f32(i), radius);
}

fn nearest(start: vec3f, d: vec3f) -> Hit {
    var hit = Hit(FAR, vec3f(0.0), SKY);
    let down = -start.y / d.y;
    if down > 1e-3 {
        hit = Hit(down, vec3f(0.0, 1.0, 0.0), FLOOR);
    }
    let left = (WALL_X - start.x) / d.x;
    if left > 1e-3 && left < hit.t && start.y + left * d.y < WALL_TOP {
        hit = Hit(left, vec3f(1.0, 0.0, 0.0), WALL);
    }
    for (var side = -1.0; side < 2.0; side += 2.0) {
        let t = columns(start, d, side);
        if t < hit.t {
            let p = start + t * d;
            let along = fract((p.z - FIRST_Z + 1.0) / COLUMN_STEP + 0.5) - 0.5;
            hit = Hit(t, vec3f(p.x - side * COLUMN_X, 0.0, along * COLUMN_STEP) / COLUMN_RADIUS, COLUMN);
        }
        let middle = beam_at(side);
        let reach = box(start - middle, d, BEAM_HALF);
        if reach.x < reach.y && reach.x > 1e-3 && reach.x < hit.t {
            let p = (start + reach.x * d - middle) / BEAM_HALF;
            hit = Hit(reach.x, sign(p) * step(vec3f(0.999), abs(p)), BEAM);
        }
    }
    for (var i = 0u; i < BALLS + 4u; i++) {
        let ball = ball_at(i);
        let t = sphere(start - ball.xyz, d, ball.w);
        if t < hit.t {
            hit = Hit(t, (start + t * d - ball.xyz) / ball.w, select(BALL + i, LAMP, i >= BALLS));
        }
    }
    return hit;
}

// Share of the sun that reaches a point.
fn sunlight(start: vec3f) -> f32 {
    for (var side = -1.0; side < 2.0; side += 2.0) {
        let reach = box(start - beam_at(side), SUN, BEAM_HALF);
        if (reach.x < reach.y && reach.y > 1e-3) || columns(start, SUN, side) < FAR {
            return 0.0;
        }
    }
    for (var i = 0u; i < BALLS; i++) {
        let ball = ball_at(i);
        if sphere(start - ball.xyz, SUN, ball.w) < FAR {
            return 0.0;
        }
    }
    return 1.0;
}

fn sky(d: vec3f) -> vec3f {
    let up = max(d.y, 0.0);
    let glow = max(dot(d, SUN), 0.0);
    let haze = mix(vec3f(0.95, 0.48, 0.24), vec3f(0.06, 0.15, 0.36), 1.0 - exp(-4.0 * up));
    let bands = 0.5 + 0.5 * sin(14.0 * up + 2.0 * sin(3.0 * d.x + 9.0 * up));
    let cloud = vec3f(0.5, 0.24, 0.2) * bands * bands * exp(-7.0 * up) * smoothstep(0.0, 0.1, up);
    return haze + cloud + vec3f(1.0, 0.55, 0.22) * (0.5 * pow(glow, 10.0) + 9.0 * smoothstep(0.9988, 0.9992, glow));
}

// 1 inside an edge, 0 outside, with a ramp of a pixel's width.
fn inside(to_edge: f32, width: f32) -> f32 {
    return 1.0 - smoothstep(-0.5 * width, 0.5 * width, to_edge);
}

// Tiles with eight-pointed stars; `width`: a pixel's extent on them. They become their mean where they are finer.
fn tiles(at: vec2f, width: f32, star: vec3f, ground: vec3f) -> vec3f {
    let cell = floor(at);
    let p = abs(fract(at) - 0.5);
    let points = min(max(p.x, p.y), (p.x + p.y) * 0.7071);
    let shade = 0.75 + 0.5 * fract(sin(dot(cell, vec2f(12.99, 78.23))) * 437.5);
    var color = mix(ground, star * shade, inside(points - 0.3, width));
    color = mix(color, vec3f(0.9, 0.82, 0.62), inside(abs(points - 0.3) - 0.022, width));
    color = mix(color, vec3f(0.85, 0.45, 0.16), inside(points - 0.11, width));
    color = mix(color, vec3f(0.25, 0.2, 0.17), inside(0.485 - max(p.x, p.y), width));
    return mix(color, 0.5 * (star + ground), smoothstep(0.25, 0.9, width));
}

// Color of a point but for its reflection, and the share of that. `width`: a pixel's extent at distance 1.
fn surface(p: vec3f, d: vec3f, hit: Hit, width: f32) -> vec4f {
    let extent = width * hit.t / max(abs(dot(hit.normal, normalize(d))), 0.05);
    var normal = hit.normal;
    var albedo = vec3f(0.74, 0.66, 0.54);
    var mirror = 0.0;
    if hit.thing == LAMP {
        return vec4f(2.2, 1.5, 0.7, 0.0);
    } else if hit.thing == FLOOR && p.x > SHORE_X {
        albedo = vec3f(0.02, 0.1, 0.13);
        mirror = 0.75;
    } else if hit.thing == FLOOR {
        albedo = tiles(p.xz * 1.25, extent * 1.25, vec3f(0.05, 0.3, 0.36), vec3f(0.7, 0.6, 0.46));
        mirror = 0.2;
    } else if hit.thing == WALL {
        let dado = tiles(p.zy * 2.5, extent * 2.5, vec3f(0.1, 0.22, 0.5), vec3f(0.72, 0.68, 0.58));
        let courses = inside(abs(fract(p.y * 2.0) - 0.5) - 0.485, 2.0 * extent);
        albedo = mix(vec3f(0.74, 0.5, 0.36) * (0.75 + 0.25 * courses), dado, inside(p.y - 1.6, extent));
    } else if hit.thing == COLUMN {
        let shown = 1.0 - smoothstep(0.02, 0.06, extent);
        let flute = cos(22.0 * atan2(normal.z, normal.x)) * shown;
        normal = normalize(normal + 0.3 * flute * vec3f(-normal.z, 0.0, normal.x));
        let ring = inside(0.16 - abs(p.y - 0.5 * COLUMN_TOP) + 0.5 * COLUMN_TOP - 0.32, extent);
        albedo = mix(vec3f(0.82, 0.76, 0.66), vec3f(0.62, 0.3, 0.18), ring);
    } else if hit.thing == BEAM {
        let frieze = tiles(p.zy * 4.0, extent * 4.0, vec3f(0.5, 0.14, 0.1), vec3f(0.76, 0.66, 0.5));
        albedo = mix(albedo, frieze, abs(normal.x));
    } else if hit.thing >= BALL {
        let n = f32(hit.thing - BALL);
        albedo = 0.45 + 0.4 * cos(6.283 * (0.31 * n + vec3f(0.0, 0.33, 0.67)));
        mirror = 0.3;
    }
    var sun = max(dot(normal, SUN), 0.0);
    if sun > 0.0 {
        sun *= sunlight(p + 2e-3 * hit.normal);
    }
    // Corners get less of the sky: at the feet of columns and under beams.
    let open = select(1.0, 0.55 + 0.45 * smoothstep(0.0, 0.9, p.y), hit.thing != FLOOR);
    let ambient = mix(vec3f(0.2, 0.12, 0.08), vec3f(0.13, 0.17, 0.27), 0.5 + 0.5 * normal.y) * open;
    let grazing = 1.0 - abs(dot(normalize(d), normal));
    return vec4f(albedo * (sun * vec3f(2.3, 1.35, 0.62) + ambient), mirror * (0.25 + 0.75 * pow(grazing, 3.0)));
}

fn hazed(color: vec3f, d: vec3f, t: f32) -> vec3f {
    return mix(color, sky(normalize(vec3f(d.x, 0.02, d.z))), 1.0 - exp(-0.011 * t));
}

fn seen(d: vec3f, width: f32) -> vec3f {
    let start = scene.eye.xyz;
    let hit = nearest(start, d);
    if hit.thing == SKY {
        return sky(normalize(d));
    }
    let p = start + hit.t * d;
    var color = surface(p, d, hit, width);
    if color.a > 0.0 {
        let mirrored = reflect(normalize(d), hit.normal);
        let other = nearest(p + 2e-3 * hit.normal, mirrored);
        var reflection = sky(mirrored);
        if other.thing != SKY {
            let far = Hit(other.t + hit.t, other.normal, other.thing);
            reflection = surface(p + other.t * mirrored, mirrored, far, width).rgb;
        }
        color = vec4f(mix(color.rgb, reflection, color.a), 0.0);
    }
    return hazed(color.rgb, normalize(d), hit.t);
}

fn is_inside(px: vec2u) -> bool {
    return all(vec2f(px) < scene.size_px);
}

@compute @workgroup_size(8, 8)
fn surfaces(@builtin(global_invocation_id) id: vec3u) {
    if !is_inside(id.xy) {
        return;
    }
    let px = vec2f(id.xy);
    let d = ray_through(px);
    let hit = nearest(scene.eye.xyz, d);
    var moved = d;
    if hit.thing != SKY {
        moved = scene.eye.xyz + hit.t * d - scene.eye_before.xyz;
    }
    textureStore(depth_out, id.xy, vec4f(select(NEAR / hit.t, 0.0, hit.thing == SKY)));
    textureStore(motion_out, id.xy, vec4f(previous_px(moved) - px, 0.0, 0.0));
}

fn shade(px: vec2u) {
    if !is_inside(px) {
        return;
    }
    let width = 2.0 * scene.tan.x / scene.size_px.x;
    var sum = vec3f(0.0);
    for (var i = 0u; i < RAYS; i++) {
        // A grid of 2x2 that is turned, so that upright and level edges have four steps, too.
        let grid = vec2f(f32(i & 1u), f32(i >> 1u)) - 0.5;
        let at = vec2f(px) + vec2f(0.5 * grid.x + 0.25 * grid.y, 0.5 * grid.y - 0.25 * grid.x);
        let color = seen(ray_through(at), width);
        // Tones before the mean, as the eye sees edges: a filmic curve.
        sum += color * (2.51 * color + 0.03) / (color * (2.43 * color + 0.59) + 0.14);
    }
    textureStore(color_out, px, vec4f(sum / f32(RAYS), 1.0));
}

@compute @workgroup_size(64)
fn chosen(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_index) invocation: u32,
) {
    let i = 64u * (group.y * groups.x + group.x) + invocation;
    if i >= quads.count {
        return;
    }
    let quad = vec2u(quads.places[i] & 0xffffu, quads.places[i] >> 16u);
    let mask = textureLoad(quad_mask, quad, 0).x;
    for (var place = 0u; place < 4u; place++) {
        if ((mask >> place) & 1u) != 0u {
            shade(2u * quad + vec2u(place & 1u, place >> 1u));
        }
    }
}

@compute @workgroup_size(8, 8)
fn everything(@builtin(global_invocation_id) id: vec3u) {
    shade(id.xy);
}

//#use color
//#use depth
//#use doctor
//#use foveate
//#use origin
//#use reproject
// Evidence on the inputs of a view: the words of its tiles. CPU twin: words in src/cpu/doctor_pass.rs. One workgroup a
// tile, one invocation for 2x2 pixels. Words are sums of integers, so that their order does not matter.
//
// 416 reads of roots and 68 of color an invocation, 128 of roots more for distances, most of them cached; 244 bytes
// written a tile.

override HAS_DEPTH: u32 = 1u;
override HAS_MOTION: u32 = 1u;
// Whether the camera's motion and depths are known.
override HAS_CAMERA: u32 = 1u;

// src/gpu/doctor.rs: DoctorUniforms, which documents the fields
struct DoctorUniforms {
    size: vec2u,
    color_origin: u32,
    depth_origin: u32,
    motion_origin: u32,
    exposure: f32,
    disparity_flags: u32,
    unused: u32,
    ray_scale: vec2f,
    ray_offset: vec2f,
    jitter_px: vec2f,
    disparity_a: f32,
    disparity_b: f32,
    camera: ViewMotion,
    unused_camera: vec4f,
    maps: array<vec4f, HYPOTHESES>,
}

@group(0) @binding(0) var<uniform> frame: DoctorUniforms;
@group(0) @binding(1) var color_in: texture_2d_array<f32>;
@group(0) @binding(2) var depth_in: texture_2d_array<f32>;
@group(0) @binding(3) var motion_in: texture_2d_array<f32>;
@group(0) @binding(21) var roots_now: texture_2d_array<f32>;
@group(0) @binding(22) var roots_past: texture_2d_array<f32>;
// First pixel, level of the lattice.
@group(0) @binding(25) var<storage, read> tiles: array<vec4u>;
@group(0) @binding(26) var<storage, read_write> words: array<u32>;

var<workgroup> sums: array<atomic<u32>, SUMS>;

struct Axis {
    texels: vec4u,
    fraction: f32,
}

fn axis_at(at: f32, len: u32, level: u32) -> Axis {
    let count = lattice_len(len, level);
    let near = split(lattice_coordinate(at, level), count);
    return Axis(
        vec4u(
            lattice_texel(max(near.whole, 1u) - 1u, level, len),
            lattice_texel(near.whole, level, len),
            lattice_texel(min(near.whole + 1u, count - 1u), level, len),
            lattice_texel(min(near.whole + 2u, count - 1u), level, len),
        ),
        near.fraction,
    );
}

fn half_size() -> vec2u {
    return vec2u(level_len(frame.size.x, 1u), level_len(frame.size.y, 1u));
}

fn row_now(x: Axis, y: u32) -> f32 {
    return spline(
        vec4f(
            textureLoad(roots_now, vec2u(x.texels.x, y), 0, 0).x,
            textureLoad(roots_now, vec2u(x.texels.y, y), 0, 0).x,
            textureLoad(roots_now, vec2u(x.texels.z, y), 0, 0).x,
            textureLoad(roots_now, vec2u(x.texels.w, y), 0, 0).x,
        ),
        x.fraction,
    );
}

fn row_past(x: Axis, y: u32) -> f32 {
    return spline(
        vec4f(
            textureLoad(roots_past, vec2u(x.texels.x, y), 0, 0).x,
            textureLoad(roots_past, vec2u(x.texels.y, y), 0, 0).x,
            textureLoad(roots_past, vec2u(x.texels.z, y), 0, 0).x,
            textureLoad(roots_past, vec2u(x.texels.w, y), 0, 0).x,
        ),
        x.fraction,
    );
}

fn lookup_now(at: vec2f, level: u32) -> f32 {
    let x = axis_at(at.x, half_size().x, level);
    let y = axis_at(at.y, half_size().y, level);
    let rows = vec4f(row_now(x, y.texels.x), row_now(x, y.texels.y), row_now(x, y.texels.z), row_now(x, y.texels.w));
    return spline(rows, y.fraction);
}

fn lookup_past(at: vec2f, level: u32) -> f32 {
    let x = axis_at(at.x, half_size().x, level);
    let y = axis_at(at.y, half_size().y, level);
    let rows =
        vec4f(row_past(x, y.texels.x), row_past(x, y.texels.y), row_past(x, y.texels.z), row_past(x, y.texels.w));
    return spline(rows, y.fraction);
}

fn add(word: u32, count: u32) {
    atomicAdd(&sums[word], count);
}

// Compares the frame at a pixel with the previous frame at the position that each hypothesis predicts.
fn match_sample(px: vec2u, level: u32) {
    if HAS_MOTION == 0u {
        return;
    }
    let given = textureLoad(motion_in, from_origin(px, frame.motion_origin), 0, 0).xy;
    if !(is_finite(given.x) && is_finite(given.y)) {
        return;
    }
    let stored = vec2f(stored_motion(given.x), stored_motion(given.y));
    let at = vec2f(px / 2u);
    let shown = lookup_now(at, level);
    add(MATCHED, 1u);
    for (var h = 0u; h < HYPOTHESES; h++) {
        let map = frame.maps[h];
        let moved = select(stored, stored.yx, map.z > 0.0);
        let predicted = lookup_past(vec2f(at.x + moved.x * map.x, at.y + moved.y * map.y), level);
        add(ERRORS + h, fixed(abs(shown - predicted)));
    }
}

// Compares the frame at a pixel with the previous frame where the camera saw the pixel's surface, at the distance of
// each hypothesis.
fn match_distances(px: vec2u, level: u32) {
    if HAS_CAMERA == 0u {
        return;
    }
    let map = DisparityMap(frame.disparity_a, frame.disparity_b, frame.disparity_flags);
    let stored = disparity(textureLoad(depth_in, from_origin(px, frame.depth_origin), 0, 0).x, map);
    if stored <= frame.camera.sky {
        return;
    }
    let at = vec2f(px / 2u);
    let ray = vec2f(px) * frame.ray_scale + frame.ray_offset;
    let shown = lookup_now(at, level);
    add(PLACED, 1u);
    for (var i = 0u; i < DISTANCES; i++) {
        let moved = camera_vector(ray, stored * disparity_factor(i), frame.camera) + frame.jitter_px;
        let predicted = lookup_past(vec2f(at.x + moved.x * 0.5, at.y + moved.y * 0.5), level);
        add(DISTANCE_ERRORS + i, fixed(abs(shown - predicted)));
    }
}

fn signal_at(px: vec2u, axis: vec2i, offset: i32) -> f32 {
    let at = clamp(vec2i(px) + axis * offset, vec2i(0), vec2i(frame.size) - 1);
    let green = textureLoad(color_in, from_origin(vec2u(at), frame.color_origin), 0, 0).y;
    return signal(green * frame.exposure);
}

// Adds the differences of a pixel from its neighbours along both axes.
fn add_pixel(px: vec2u) {
    let at = signal_at(px, vec2i(0), 0);
    add(SIGNAL, fixed(at));
    add(CODES, select(0u, 1u, is_code(at)));
    let green = textureLoad(color_in, from_origin(px, frame.color_origin), 0, 0).y;
    add(BROKEN, select(1u, 0u, is_finite(green)));
    for (var a = 0u; a < 2u; a++) {
        let axis = select(vec2i(0, 1), vec2i(1, 0), a == 0u);
        let along = select(px.y, px.x, a == 0u);
        let before = signal_at(px, axis, -1);
        let after = signal_at(px, axis, 1);
        add(STEPS + boundary_class(along), fixed(abs(at - before)));
        let kink = kink_class(along);
        add(BENDS + kink, fixed(bend(before, at, after)));
        add(DECODED_BENDS + kink, fixed(bend(srgb_decode(before), srgb_decode(at), srgb_decode(after))));
        for (var i = 0u; i < WIDE; i++) {
            let reach = 2 << i;
            add(WIDE_BENDS + i, fixed(bend(signal_at(px, axis, -reach), at, signal_at(px, axis, reach))));
        }
    }
}

fn kept_depth(px: vec2u) -> u32 {
    return kept_bits(textureLoad(depth_in, from_origin(px, frame.depth_origin), 0, 0).x);
}

// Copies stored depths and motion.
fn copy_middle(px: vec2u, to: u32) {
    for (var i = SUMS; i < WORDS; i++) {
        words[to + i] = 0u;
    }
    if HAS_DEPTH != 0u {
        words[to + DEPTH] = kept_depth(px);
        words[to + DEPTH + 1u] = kept_depth(px - vec2u(DEPTH_STEP_PX, 0u));
        words[to + DEPTH + 2u] = kept_depth(px + vec2u(DEPTH_STEP_PX, 0u));
        words[to + DEPTH + 3u] = kept_depth(px - vec2u(0u, DEPTH_STEP_PX));
        words[to + DEPTH + 4u] = kept_depth(px + vec2u(0u, DEPTH_STEP_PX));
    }
    if HAS_MOTION != 0u {
        let stored = textureLoad(motion_in, from_origin(px, frame.motion_origin), 0, 0).xy;
        words[to + MOTION] = kept_bits(stored.x);
        words[to + MOTION + 1u] = kept_bits(stored.y);
    }
}

@compute @workgroup_size(8, 8)
fn main(@builtin(local_invocation_id) id: vec3u, @builtin(local_invocation_index) index: u32,
    @builtin(workgroup_id) group: vec3u) {
    let tile = tiles[group.x];
    let first = tile.xy + 2u * id.xy;
    match_sample(first, tile.z);
    match_distances(first, tile.z);
    for (var i = 0u; i < 4u; i++) {
        add_pixel(first + vec2u(i & 1u, i >> 1u));
    }
    workgroupBarrier();
    let to = group.x * WORDS;
    if index < SUMS {
        words[to + index] = atomicLoad(&sums[index]);
    }
    if index == 0u {
        copy_middle(tile.xy + TILE_PX / 2u, to);
    }
}

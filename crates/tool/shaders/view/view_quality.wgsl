//#use color
//#use lens
// Squared error of what is shown against the full-rate frame, beyond an eccentricity: a sum and a count for each tile
// of 64x16 pixels. CPU twin: Scorer::push_errors in crates/eval/src/metric/score.rs.

// src/commands/view/quality.rs: QualityConstants, which explains them
struct QualityConstants {
    ray_scale: vec2f,
    ray_offset: vec2f,
    gaze_ray: vec4f,
    size: vec2u,
    gain: f32,
    from_deg: f32,
}

@group(0) @binding(0) var<uniform> frame: QualityConstants;
@group(0) @binding(1) var full: texture_2d<f32>;
@group(0) @binding(2) var shown: texture_2d<f32>;
@group(0) @binding(3) var<storage, read_write> sums: array<vec2f>;

const TILE_ROWS: u32 = 16u;

var<workgroup> columns: array<vec2f, 64>;

// metric::encode. NaN fails the comparison.
fn encoded(color: vec3f) -> vec3f {
    let v = color * frame.gain;
    let c = select(vec3f(0.0), min(v, vec3f(1.0)), v > vec3f(0.0));
    return vec3f(srgb_encode(c.x), srgb_encode(c.y), srgb_encode(c.z));
}

@compute @workgroup_size(64, 1)
fn main(
    @builtin(local_invocation_index) column: u32,
    @builtin(workgroup_id) tile: vec3u,
    @builtin(num_workgroups) tiles: vec3u,
) {
    let x = tile.x * 64u + column;
    var sum = vec2f(0.0);
    for (var row = 0u; row < TILE_ROWS; row++) {
        let px = vec2u(x, tile.y * TILE_ROWS + row);
        if px.x < frame.size.x && px.y < frame.size.y {
            let ray = vec3f(vec2f(px) * frame.ray_scale + frame.ray_offset, 1.0);
            if eccentricity_deg(ray, frame.gaze_ray.xyz) > frame.from_deg {
                let error = encoded(textureLoad(shown, px, 0).xyz) - encoded(textureLoad(full, px, 0).xyz);
                sum += vec2f(dot(error, error) / 3.0, 1.0);
            }
        }
    }
    columns[column] = sum;
    for (var count = 32u; count > 0u; count /= 2u) {
        workgroupBarrier();
        if column < count {
            columns[column] += columns[column + count];
        }
    }
    if column == 0u {
        sums[tile.y * tiles.x + tile.x] = columns[0];
    }
}

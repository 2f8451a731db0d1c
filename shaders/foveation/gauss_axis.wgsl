//#use foveate
//#use foveated_views
//#use sanitize
// Gaussian blur along one axis; its width is that at the written pixel. Dispatched for x, then for y. CPU twin:
// blur_axis in src/simulator/gaussian.rs. One invocation a pixel; z is the view.
//
// 2 gauss_radius + 1 reads a pixel, 47 for a standard deviation of 7.5 pixels; 1 write, 2 with levels of detail. With a
// frame of 8 bytes a pixel and an intermediate texture of 16, both axes together read 8 + 16 and write 16 + 8 bytes a
// pixel, and 4 more with levels of detail.

// Axis: 0 for x, 1 for y.
override AXIS: u32 = 0u;
override WRITE_LOD: u32 = 0u;

@group(0) @binding(1) var color_in: texture_2d_array<f32>;
@group(0) @binding(2) var color_out: texture_storage_2d_array<rgba16float, write>;
@group(0) @binding(3) var lod_out: texture_storage_2d_array<r32float, write>;

// Pixel at an offset along the axis, clamped to the border.
fn tap(px: vec2u, offset: i32, view: u32) -> vec3f {
    var at = vec2i(px);
    if AXIS == 0u {
        at.x += offset;
    } else {
        at.y += offset;
    }
    at = clamp(at, vec2i(0), vec2i(frame.size) - 1);
    return color(textureLoad(color_in, at, view, 0).xyz).color;
}

@compute @workgroup_size(64, 1)
fn main(@builtin(global_invocation_id) id: vec3u, @builtin(workgroup_id) group: vec3u) {
    let px = id.xy;
    if px.x >= frame.size.x || px.y >= frame.size.y {
        return;
    }
    let view = group.z;
    let e_deg = region_angle_at(vec2f(px), view);
    let lod = blur_lod(e_deg, frame.fovea_radius_deg, frame.mid_radius_deg, frame.lod_mid, frame.lod_far);
    if WRITE_LOD != 0u {
        textureStore(lod_out, px, view, vec4f(lod, 0.0, 0.0, 0.0));
    }
    if lod <= 0.0 {
        // Full rate: a copy, bit for bit, along both axes.
        textureStore(color_out, px, view, vec4f(textureLoad(color_in, px, view, 0).xyz, 1.0));
        return;
    }
    let sigma_px = blur_sigma_px(lod);
    let radius = i32(gauss_radius(sigma_px));
    var gauss = gauss_center(sigma_px);
    var sum = tap(px, 0, view);
    var side = 0.0;
    for (var d = 1; d <= radius; d++) {
        gauss = gauss_next(gauss);
        side += gauss.weight;
        sum += (tap(px, -d, view) + tap(px, d, view)) * gauss.weight;
    }
    textureStore(color_out, px, view, vec4f(sum / (1.0 + 2.0 * side), 1.0));
}

//#use foveate
//#use foveated_views
//#use sanitize
// Mip filter: the frame as a renderer upscales it from fewer pixels. Trilinear: a blend of the two mip levels around
// each pixel's level of detail. CPU twin: Pyramid::trilinear in src/simulator/mip.rs. One invocation a pixel; z is the
// view.
//
// At most 9 reads a pixel (the pixel itself, 4 texels of each level); 1 write, 2 with levels of detail. Most pixels
// read the two coarsest levels: under 1 byte a pixel read, 8 written, and 4 more with levels of detail.

override WRITE_LOD: u32 = 0u;

@group(0) @binding(1) var full: texture_2d_array<f32>;
// Mip 0 is level 1. A mip may be larger than its level.
@group(0) @binding(2) var levels: texture_2d_array<f32>;
@group(0) @binding(3) var color_out: texture_storage_2d_array<rgba16float, write>;
@group(0) @binding(4) var lod_out: texture_storage_2d_array<r32float, write>;

fn read_level(px: vec2u, view: u32, level: u32) -> vec3f {
    let len = vec2u(level_len(frame.size.x, level), level_len(frame.size.y, level));
    let x = split(level_coordinate(f32(px.x), level), len.x);
    let y = split(level_coordinate(f32(px.y), level), len.y);
    let near = vec2u(x.whole, y.whole);
    let next = min(near + 1u, len - 1u);
    let mip = level - 1u;
    return bilinear(
        textureLoad(levels, near, view, mip).xyz,
        textureLoad(levels, vec2u(next.x, near.y), view, mip).xyz,
        textureLoad(levels, vec2u(near.x, next.y), view, mip).xyz,
        textureLoad(levels, next, view, mip).xyz,
        vec2f(x.fraction, y.fraction),
    );
}

@compute @workgroup_size(64, 1)
fn main(@builtin(global_invocation_id) id: vec3u, @builtin(workgroup_id) group: vec3u) {
    let px = id.xy;
    if px.x >= frame.size.x || px.y >= frame.size.y {
        return;
    }
    let view = group.z;
    let lod = blended_lod(region_angle_at(vec2f(px), view));
    if WRITE_LOD != 0u {
        textureStore(lod_out, px, view, vec4f(lod, 0.0, 0.0, 0.0));
    }
    let level = split(lod, frame.coarsest + 1u);
    var shown: vec3f;
    if level.whole == 0u {
        shown = textureLoad(full, px, view, 0).xyz;
    } else {
        shown = read_level(px, view, level.whole);
    }
    if level.fraction > 0.0 {
        if level.whole == 0u {
            shown = color(shown).color;
        }
        shown = blend(shown, read_level(px, view, level.whole + 1u), level.fraction);
    }
    textureStore(color_out, px, view, vec4f(shown, 1.0));
}

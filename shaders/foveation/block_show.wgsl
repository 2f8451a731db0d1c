//#use foveate
//#use foveated_views
//#use sanitize
// Block filter: one point sample a block, as coarse shading hardware renders. CPU twin: src/simulator/block.rs. One
// invocation a pixel; z is the view.
//
// 1 read and 1 write a pixel, 2 writes with levels of detail; up to one eccentricity a level. All pixels of a block
// read the same texel: under 1 byte a pixel read, 8 written, and 4 more with levels of detail.

override WRITE_LOD: u32 = 0u;

@group(0) @binding(1) var full: texture_2d_array<f32>;
// Mip 0 is level 1. A mip may be larger than its level.
@group(0) @binding(2) var levels: texture_2d_array<f32>;
@group(0) @binding(3) var color_out: texture_storage_2d_array<rgba16float, write>;
@group(0) @binding(4) var lod_out: texture_storage_2d_array<r32float, write>;

// Level of the coarsest aligned block around the pixel whose centre's level of detail is at least the block's level.
fn level_at(px: vec2u, view: u32) -> u32 {
    var level = frame.coarsest;
    for (; level > 0u; level--) {
        let block = px >> vec2u(level);
        let center = vec2f(
            block_center_px(block.x, level, frame.size.x),
            block_center_px(block.y, level, frame.size.y),
        );
        let lod = blended_lod(region_angle_at(center, view));
        if lod >= f32(level) {
            break;
        }
    }
    return level;
}

@compute @workgroup_size(64, 1)
fn main(@builtin(global_invocation_id) id: vec3u, @builtin(workgroup_id) group: vec3u) {
    let px = id.xy;
    if px.x >= frame.size.x || px.y >= frame.size.y {
        return;
    }
    let view = group.z;
    let level = level_at(px, view);
    if WRITE_LOD != 0u {
        textureStore(lod_out, px, view, vec4f(f32(level), 0.0, 0.0, 0.0));
    }
    let block = px >> vec2u(level);
    let at = vec2u(block_sample(block.x, level, frame.size.x), block_sample(block.y, level, frame.size.y));
    let source = block_sample_level(level);
    var shown: vec3f;
    if source == 0u {
        shown = textureLoad(full, at, view, 0).xyz;
    } else {
        shown = textureLoad(levels, at, view, source - 1u).xyz;
    }
    if level > 0u {
        shown = color(shown).color;
    }
    textureStore(color_out, px, view, vec4f(shown, 1.0));
}

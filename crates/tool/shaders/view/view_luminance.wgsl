//#use color
// Luminance of pictures as a display shows them, sRGB-encoded, one byte a pixel. Rows are padded to whole words.

// src/commands/view/burst.rs: LuminanceConstants
struct LuminanceConstants {
    size: vec2u,
    gain: f32,
    padding: u32,
}

@group(0) @binding(0) var<uniform> frame: LuminanceConstants;
@group(0) @binding(1) var full: texture_2d<f32>;
@group(0) @binding(2) var left: texture_2d<f32>;
@group(0) @binding(3) var right: texture_2d<f32>;
@group(0) @binding(4) var<storage, read_write> packed: array<u32>;

fn color_of(picture: u32, px: vec2u) -> vec3f {
    switch picture {
        case 0u: {
            return textureLoad(full, px, 0).xyz;
        }
        case 1u: {
            return textureLoad(left, px, 0).xyz;
        }
        default: {
            return textureLoad(right, px, 0).xyz;
        }
    }
}

// Luminance of what is shown of a linear color, in steps of 8 bits. NaN fails the comparison.
fn level(color: vec3f) -> u32 {
    let v = color * frame.gain;
    let shown = select(vec3f(0.0), min(v, vec3f(1.0)), v > vec3f(0.0));
    return u32(min(srgb_encode(luma(shown)), 1.0) * 255.0 + 0.5);
}

@compute @workgroup_size(64, 1)
fn main(@builtin(global_invocation_id) id: vec3u) {
    let row_words = (frame.size.x + 3u) / 4u;
    if id.x >= row_words {
        return;
    }
    var word = 0u;
    for (var i = 0u; i < 4u; i++) {
        let px = vec2u(4u * id.x + i, id.y);
        if px.x < frame.size.x {
            word |= level(color_of(id.z, px)) << (8u * i);
        }
    }
    packed[(id.z * frame.size.y + id.y) * row_words + id.x] = word;
}

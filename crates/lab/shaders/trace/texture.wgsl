//#use color
//#use texel
//#use records
// Texture lookup. Twin of trace/cpu/texture.rs.

const NEAREST: u32 = 16u;

struct TextureRecord {
    first: u32,
    size: vec2<u32>,
    wrap: vec2<u32>,
    is_nearest: bool,
}

fn texture_texel(t: TextureRecord, i: i32, j: i32, is_color: bool) -> vec4<f32> {
    let place = wrap_texel(j, t.size.y, t.wrap.y) * t.size.x + wrap_texel(i, t.size.x, t.wrap.x);
    let row = load(TEXELS + t.first + (place >> 2u));
    let value = texel_value(row[place & 3u]);
    if is_color {
        return vec4<f32>(srgb_decode(value.x), srgb_decode(value.y), srgb_decode(value.z), value.w);
    }
    return value;
}

// texture::texture
fn texture_value(id: u32, uv: vec2<f32>, is_color: bool) -> vec4<f32> {
    let record = load(TEXTURES + id);
    let wrap = vec2<u32>(record.w & 3u, (record.w >> 2u) & 3u);
    let t = TextureRecord(record.x, record.yz, wrap, (record.w & NEAREST) != 0u);
    let x = wrap_coordinate(uv.x, wrap.x) * f32(t.size.x);
    let y = wrap_coordinate(uv.y, wrap.y) * f32(t.size.y);
    if t.is_nearest {
        return texture_texel(t, i32(floor(x)), i32(floor(y)), is_color);
    }
    let i = floor(x - 0.5);
    let j = floor(y - 0.5);
    let r = (x - 0.5) - i;
    let s = (y - 0.5) - j;
    let a = texture_texel(t, i32(i), i32(j), is_color);
    let b = texture_texel(t, i32(i) + 1, i32(j), is_color);
    let c = texture_texel(t, i32(i), i32(j) + 1, is_color);
    let d = texture_texel(t, i32(i) + 1, i32(j) + 1, is_color);
    let top = a * (1.0 - r) + b * r;
    let bottom = c * (1.0 - r) + d * r;
    return top * (1.0 - s) + bottom * s;
}

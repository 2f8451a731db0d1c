//#use color
//#use texel
//#use records
//#use effects
// Texture lookup. Twin of src/cpu/texture.rs.

const NEAREST: u32 = 16u;
const SECOND: u32 = 32u;
// Bound of transformed texture coordinates, which keeps them finite.
const MAX_COORDINATE: f32 = 1e9;

struct TextureRecord {
    first: u32,
    size: vec2u,
    wrap: vec2u,
    is_nearest: bool,
}

fn texture_texel(t: TextureRecord, i: i32, j: i32, is_color: bool) -> vec4f {
    let place = wrap_texel(j, t.size.y, t.wrap.y) * t.size.x + wrap_texel(i, t.size.x, t.wrap.x);
    let row = load(TEXELS + t.first + (place >> 2u));
    let value = texel_value(row[place & 3u]);
    if is_color {
        return vec4f(srgb_decode(value.x), srgb_decode(value.y), srgb_decode(value.z), value.w);
    }
    return value;
}

// Coordinates::of
fn coordinates_of(id: u32, uv: vec2f) -> vec2f {
    let r0 = bitcast<vec4f>(load(TEXTURES + id * TEXTURE_ROWS + 1u));
    let r1 = bitcast<vec4f>(load(TEXTURES + id * TEXTURE_ROWS + 2u));
    // In the order to which Mesa would bring it.
    let at = vec2f((r0.x * uv.x + r0.z) + r0.y * uv.y, (r1.x * uv.x + r1.z) + r1.y * uv.y);
    return clamp(at, vec2f(-MAX_COORDINATE), vec2f(MAX_COORDINATE));
}

// texture::texture. `uvs` has the first and the second texture coordinates.
fn texture_value(id: u32, uvs: vec4f, is_color: bool) -> vec4f {
    let record = load(TEXTURES + id * TEXTURE_ROWS);
    var uv = uvs.xy;
    if EFFECT_TEXTURE_COORDINATES {
        if (record.w & SECOND) != 0u {
            uv = uvs.zw;
        }
        uv = coordinates_of(id, uv);
    }
    let wrap = vec2u(record.w & 3u, (record.w >> 2u) & 3u);
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

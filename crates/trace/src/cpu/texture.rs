//! Texture lookup. Twin of `shaders/trace/texture.wgsl`.

use crate::records::ADDRESSING_SECOND;
use crate::world::World;
use afterimage::kernel::color::srgb_decode;
use afterimage_lab::kernel::texel::{texel_value, wrap_coordinate, wrap_texel};
use afterimage_lab::scene::Coordinates;
use afterimage_lab::scene::effects::{Effect, Effects};
use glam::{Vec2, Vec4};

/// Texture value at the first or second of `uvs`: bilinear, or the nearest texel if the texture asks for that. Colors
/// are decoded from sRGB.
pub(super) fn texture(world: &World, id: u32, uvs: [Vec2; 2], is_color: bool, effects: Effects) -> Vec4 {
    let t = world.textures[id as usize];
    let mut uv = uvs[0];
    if effects.has(Effect::TextureCoordinates) {
        if t.addressing & ADDRESSING_SECOND != 0 {
            uv = uvs[1];
        }
        let [[a, b, c, _], [d, e, f, _]] = t.coordinates;
        uv = Coordinates { second: false, rows: [[a, b, c], [d, e, f]] }.of(uv);
    }
    let (wrap_u, wrap_v) = (t.addressing & 3, t.addressing >> 2 & 3);
    let x = wrap_coordinate(uv.x, wrap_u) * t.width as f32;
    let y = wrap_coordinate(uv.y, wrap_v) * t.height as f32;
    let texel = |i: i32, j: i32| {
        let (i, j) = (wrap_texel(i, t.width, wrap_u), wrap_texel(j, t.height, wrap_v));
        let value = texel_value(world.texels[(t.first * 4 + j * t.width + i) as usize]);
        if is_color { value.truncate().map(srgb_decode).extend(value.w) } else { value }
    };
    if t.addressing & 16 != 0 {
        return texel(x.floor() as i32, y.floor() as i32);
    }
    let (x, y) = (x - 0.5, y - 0.5);
    let (i, j) = (x.floor(), y.floor());
    let (s, t) = (x - i, y - j);
    let (i, j) = (i as i32, j as i32);
    let top = texel(i, j) * (1.0 - s) + texel(i + 1, j) * s;
    let bottom = texel(i, j + 1) * (1.0 - s) + texel(i + 1, j + 1) * s;
    top * (1.0 - t) + bottom * t
}

//! Materials of the room, and their places in the list.

use super::textures::Pattern;
use crate::scene::builtin::shapes::glossy;
use crate::scene::{Material, TextureRef};

pub(super) const FLOOR: u32 = 0;
pub(super) const WALLPAPER: u32 = 1;
pub(super) const TILES: u32 = 2;
pub(super) const RUG: u32 = 3;
pub(super) const PICTURE: u32 = 4;
pub(super) const PAINT: u32 = 5;
pub(super) const PLASTER: u32 = 6;
pub(super) const WHITE: u32 = 7;
pub(super) const BLIND: u32 = 8;
pub(super) const METAL: u32 = 9;
pub(super) const CARCASS: u32 = 10;
pub(super) const FRONT: u32 = 11;
pub(super) const COUNTER: u32 = 12;
pub(super) const TABLE: u32 = 13;
pub(super) const WOOD: u32 = 14;
pub(super) const GLAZE: u32 = 15;
pub(super) const SKIN: u32 = 16;
pub(super) const SHIRT: u32 = 17;
pub(super) const TROUSERS: u32 = 18;
pub(super) const FAN: u32 = 19;
pub(super) const PENDANT: u32 = 20;
pub(super) const SHADE: u32 = 21;
/// A material for each strip: the rasterizer merges lights of one material.
pub(super) const STRIPS: [u32; 2] = [22, 23];
pub(super) const DOME: u32 = 24;
pub(super) const FIRST_BOOK: u32 = 25;
/// Number of materials of books.
pub(super) const BOOKS: u32 = 6;

/// All materials, in the order of their places.
pub(super) fn all() -> Vec<Material> {
    let mut all = vec![
        textured("floor", Pattern::Planks, 0.35, 60.0),
        textured("wallpaper", Pattern::Wallpaper, 0.9, 4.0),
        textured("tiles", Pattern::Tiles, 0.2, 150.0),
        textured("rug", Pattern::Rug, 1.0, 2.0),
        textured("picture", Pattern::Picture, 0.5, 20.0),
        glossy("paint", [0.62, 0.66, 0.62], 0.9, 4.0),
        glossy("plaster", [0.8, 0.79, 0.76], 1.0, 2.0),
        glossy("white lacquer", [0.82, 0.82, 0.8], 0.4, 40.0),
        glossy("blind", [0.75, 0.72, 0.66], 0.5, 20.0),
        Material { metallic: 1.0, ..glossy("steel", [0.7, 0.69, 0.67], 0.3, 100.0) },
        glossy("carcass", [0.03, 0.028, 0.025], 0.9, 4.0),
        glossy("front", [0.42, 0.52, 0.55], 0.35, 60.0),
        glossy("counter", [0.12, 0.11, 0.1], 0.25, 120.0),
        glossy("table", [0.16, 0.07, 0.035], 0.08, 1000.0),
        glossy("wood", [0.36, 0.2, 0.09], 0.5, 30.0),
        glossy("glaze", [0.65, 0.28, 0.12], 0.15, 300.0),
        glossy("skin", [0.6, 0.38, 0.28], 0.6, 15.0),
        glossy("shirt", [0.62, 0.12, 0.1], 0.9, 4.0),
        glossy("trousers", [0.08, 0.1, 0.2], 0.9, 4.0),
        glossy("fan", [0.15, 0.35, 0.45], 0.4, 40.0),
        lamp("pendant", [9.0, 7.2, 4.8]),
        Material { double_sided: true, ..lamp("shade", [3.0, 2.1, 1.1]) },
        lamp("strip 0", [30.0, 26.0, 20.0]),
        lamp("strip 1", [30.0, 26.0, 20.0]),
        lamp("dome", [2.0, 1.8, 1.4]),
    ];
    let covers =
        [[0.5, 0.1, 0.08], [0.1, 0.2, 0.4], [0.12, 0.3, 0.16], [0.6, 0.5, 0.25], [0.7, 0.66, 0.58], [0.08, 0.07, 0.08]];
    all.extend(covers.map(|color| glossy("book", color, 0.7, 10.0)));
    all
}

fn textured(name: &str, pattern: Pattern, roughness: f32, exponent: f32) -> Material {
    let base_color_texture = Some(TextureRef { texture: pattern as u32 });
    Material { base_color_texture, ..glossy(name, [1.0; 3], roughness, exponent) }
}

fn lamp(name: &str, emissive: [f32; 3]) -> Material {
    Material { emissive, ..glossy(name, [0.1; 3], 1.0, 2.0) }
}

//! Pixels of an SVG. `resvg` rasterizes it with a font from a crate, so that the result does not depend on the fonts of
//! the machine.

use image::{DynamicImage, RgbImage, RgbaImage};
use resvg::{tiny_skia, usvg};
use std::sync::Arc;

/// PNG pixels per SVG pixel.
const PNG_SCALE: f32 = 2.0;

/// A composed plot as pixels.
pub fn png(svg: &str) -> RgbImage {
    let mut fonts = usvg::fontdb::Database::new();
    fonts.load_font_data(epaint_default_fonts::UBUNTU_LIGHT.to_vec());
    let family = fonts.faces().next().map_or_else(String::new, |face| face.families[0].0.clone());
    fonts.set_sans_serif_family(&family);
    let options = usvg::Options { font_family: family, fontdb: Arc::new(fonts), ..usvg::Options::default() };
    let tree = usvg::Tree::from_str(svg, &options).expect("a composed SVG is well-formed");
    let size = [tree.size().width(), tree.size().height()].map(|v| (v * PNG_SCALE).ceil() as u32);
    let mut pixels = tiny_skia::Pixmap::new(size[0], size[1]).expect("a plot has a size");
    pixels.fill(tiny_skia::Color::WHITE);
    resvg::render(&tree, tiny_skia::Transform::from_scale(PNG_SCALE, PNG_SCALE), &mut pixels.as_mut());
    // All pixels are opaque on white, so premultiplied colors are the colors.
    let rgba = RgbaImage::from_raw(size[0], size[1], pixels.take()).expect("four bytes a pixel");
    DynamicImage::from(rgba).into_rgb8()
}

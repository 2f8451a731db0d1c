//! Drawing of text and shapes on an 8-bit picture.

use embedded_graphics::mono_font::iso_8859_1::{FONT_7X13, FONT_9X18_BOLD, FONT_10X20};
use embedded_graphics::mono_font::{MonoFont, MonoTextStyle};
use embedded_graphics::pixelcolor::Rgb888;
use embedded_graphics::prelude::*;
use embedded_graphics::primitives::{Circle, Line, PrimitiveStyle, Rectangle};
use embedded_graphics::text::{Baseline, Text};
use image::{Rgb, RgbImage, imageops};
use std::convert::Infallible;

/// Height of a line of text in pixels.
pub const LINE_PX: u32 = 22;

/// Width of a character of body text in pixels.
pub const CHAR_PX: u32 = 10;

/// A picture to draw on.
pub struct Canvas(pub RgbImage);

impl OriginDimensions for Canvas {
    fn size(&self) -> Size {
        Size::new(self.0.width(), self.0.height())
    }
}

impl DrawTarget for Canvas {
    type Color = Rgb888;
    type Error = Infallible;

    fn draw_iter<I: IntoIterator<Item = Pixel<Rgb888>>>(&mut self, pixels: I) -> Result<(), Infallible> {
        for Pixel(at, c) in pixels {
            if let (Ok(x), Ok(y)) = (u32::try_from(at.x), u32::try_from(at.y))
                && let Some(pixel) = self.0.get_pixel_mut_checked(x, y)
            {
                *pixel = Rgb([c.r(), c.g(), c.b()]);
            }
        }
        Ok(())
    }
}

/// Unwraps a result that cannot be an error.
fn infallible<T>(result: Result<T, Infallible>) -> T {
    match result {
        Ok(value) => value,
        Err(never) => match never {},
    }
}

impl Canvas {
    /// A canvas of one color.
    pub fn new(width: u32, height: u32, background: [u8; 3]) -> Self {
        Self(RgbImage::from_pixel(width, height, Rgb(background)))
    }

    /// Puts a picture with its top left corner at (x, y).
    pub fn put(&mut self, picture: &RgbImage, x: u32, y: u32) {
        imageops::replace(&mut self.0, picture, i64::from(x), i64::from(y));
    }

    /// Draws a line of text in 10 by 20 pixels per character, its top left corner at (x, y).
    pub fn text(&mut self, text: &str, x: u32, y: u32, color: [u8; 3]) {
        self.write(text, x, y, color, &FONT_10X20);
    }

    /// Draws a line of bold text in 9 by 18 pixels per character.
    pub fn heading(&mut self, text: &str, x: u32, y: u32, color: [u8; 3]) {
        self.write(text, x, y, color, &FONT_9X18_BOLD);
    }

    /// Draws a line of small text in 7 by 13 pixels per character.
    pub fn small(&mut self, text: &str, x: u32, y: u32, color: [u8; 3]) {
        self.write(text, x, y, color, &FONT_7X13);
    }

    fn write(&mut self, text: &str, x: u32, y: u32, color: [u8; 3], font: &MonoFont<'_>) {
        let style = MonoTextStyle::new(font, rgb(color));
        let at = Point::new(x as i32, y as i32);
        infallible(Text::with_baseline(text, at, style, Baseline::Top).draw(self));
    }

    /// Draws the outline of a circle; skips centers far outside the picture.
    pub fn circle(&mut self, center: [f32; 2], radius: f32, width: u32, color: [u8; 3]) {
        if !(center[0].abs() < 1e5 && center[1].abs() < 1e5) {
            return;
        }
        let at = Point::new(center[0].round() as i32, center[1].round() as i32);
        let circle = Circle::with_center(at, (2.0 * radius).round().max(1.0) as u32);
        infallible(circle.into_styled(PrimitiveStyle::with_stroke(rgb(color), width)).draw(self));
    }

    /// Draws a straight line; skips positions that are not finite or far outside the picture.
    pub fn line(&mut self, from: [f32; 2], to: [f32; 2], width: u32, color: [u8; 3]) {
        if [from, to].as_flattened().iter().any(|v| !v.is_finite() || v.abs() > 1e5) {
            return;
        }
        let point = |p: [f32; 2]| Point::new(p[0].round() as i32, p[1].round() as i32);
        let line = Line::new(point(from), point(to));
        infallible(line.into_styled(PrimitiveStyle::with_stroke(rgb(color), width)).draw(self));
    }

    /// Draws the outline of a rectangle.
    pub fn frame(&mut self, corner: [u32; 2], size: [u32; 2], width: u32, color: [u8; 3]) {
        let corner = Point::new(corner[0] as i32, corner[1] as i32);
        let rectangle = Rectangle::new(corner, Size::new(size[0], size[1]));
        infallible(rectangle.into_styled(PrimitiveStyle::with_stroke(rgb(color), width)).draw(self));
    }
}

fn rgb(c: [u8; 3]) -> Rgb888 {
    Rgb888::new(c[0], c[1], c[2])
}

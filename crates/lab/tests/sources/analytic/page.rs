//! The page of text among the fixtures.

fn page() -> std::path::PathBuf {
    afterimage_testing::workspace().join("fixtures/text_page.png")
}

/// A page of text: black on white, 10x20 pixels per character, lines 28 pixels apart.
fn text_page() -> image::GrayImage {
    use embedded_graphics::mock_display::MockDisplay;
    use embedded_graphics::mono_font::{MonoTextStyle, ascii::FONT_10X20};
    use embedded_graphics::pixelcolor::BinaryColor;
    use embedded_graphics::prelude::*;
    use embedded_graphics::text::{Baseline, Text};

    const ORIGIN: [u32; 2] = [60, 16];
    const ADVANCE: u32 = 10;
    const LEADING: u32 = 28;
    let text = include_str!("../../../../../fixtures/alice.txt");
    let style = MonoTextStyle::new(&FONT_10X20, BinaryColor::On);
    let mut page = image::GrayImage::from_pixel(1280, 720, image::Luma([255]));
    for (line, row) in text.lines().enumerate() {
        for (column, character) in row.chars().enumerate() {
            // The mock display is a 64x64 canvas: draw one character at a time.
            let mut cell = MockDisplay::new();
            let glyph = character.to_string();
            Text::with_baseline(&glyph, Point::zero(), style, Baseline::Top).draw(&mut cell).unwrap();
            for (x, y) in (0..20).flat_map(|y| (0..10).map(move |x| (x, y))) {
                if cell.get_pixel(Point::new(x, y)) == Some(BinaryColor::On) {
                    let px = ORIGIN[0] + column as u32 * ADVANCE + x as u32;
                    let py = ORIGIN[1] + line as u32 * LEADING + y as u32;
                    page.put_pixel(px, py, image::Luma([0]));
                }
            }
        }
    }
    page
}

#[test]
#[ignore = "writes fixtures/text_page.png"]
fn write_text_page() {
    text_page().save(page()).unwrap();
}

#[test]
fn text_page_is_as_generated() {
    let kept = image::open(page()).unwrap();
    assert_eq!(kept.color(), image::ColorType::L8);
    assert!(kept.to_luma8() == text_page(), "run the regenerating command of fixtures/README.md");
    assert!(std::fs::metadata(page()).unwrap().len() < 200_000);
}

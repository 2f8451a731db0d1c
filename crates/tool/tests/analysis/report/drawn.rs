//! What the tests of plots read from an SVG.

use afterimage_cli::report::plot;
use resvg::usvg::roxmltree::{Document, Node};

pub fn with_class<'a>(document: &'a Document<'_>, class: &'a str) -> impl Iterator<Item = Node<'a, 'a>> {
    document.descendants().filter(move |n| n.attribute("class").is_some_and(|c| c.split(' ').any(|c| c == class)))
}

pub fn number(node: &Node<'_, '_>, name: &str) -> f64 {
    node.attribute(name).unwrap().parse().unwrap()
}

pub fn has_text(document: &Document<'_>, words: &str) -> bool {
    document.descendants().any(|n| n.text().is_some_and(|t| t.contains(words)))
}

/// Position of a mark.
pub fn mark_at(mark: &Node<'_, '_>) -> [f64; 2] {
    let path = mark.attribute("d").unwrap();
    points(&path[..path.find('m').unwrap()])[0]
}

/// Corners of a path of absolute moves and straight lines.
pub fn points(path: &str) -> Vec<[f64; 2]> {
    let point = |text: &str| {
        let (x, y) = text.split_once(' ').unwrap();
        [x.parse().unwrap(), y.parse().unwrap()]
    };
    path.split(['M', 'L']).filter(|part| !part.is_empty()).map(point).collect()
}

/// Checks that the picture is the same again, has a title, and in each of the colors of none, taa, wrs and smr more
/// than `least` pixels.
#[track_caller]
pub fn assert_marks_and_letters(svg: &str, least: usize) {
    let picture = plot::png(svg);
    assert_eq!(picture.width(), 1920);
    assert_eq!(picture, plot::png(svg));
    for color in [[122, 122, 122], [230, 159, 0], [0, 114, 178], [0, 158, 115]] {
        let count = picture.pixels().filter(|p| p.0 == color).count();
        assert!(count > least, "{color:?} has {count} pixels");
    }
    // Dark pixels in the title area are letters, which do not depend on the machine's fonts.
    let title = image::imageops::crop_imm(&picture, 150, 16, 1000, 40).to_image();
    let dark = title.pixels().filter(|p| p.0.iter().all(|v| *v < 128)).count();
    assert!(dark > 500, "{dark} pixels of letters");
}

/// Checks that no ink reaches the right border.
#[track_caller]
pub fn assert_ends_before_the_border(svg: &str) {
    let picture = plot::png(svg);
    let paper = *picture.get_pixel(0, 0);
    for from_right in [3, 4] {
        let x = picture.width() - from_right;
        assert!((0..picture.height()).all(|y| *picture.get_pixel(x, y) == paper), "ink at the border");
    }
}

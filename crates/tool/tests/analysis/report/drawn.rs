//! What the tests of plots read from an SVG.

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

//! The page of a plot: its size, the document, the legend above and the notes below.

use super::elements::{FAINT, INK, mark, text};
use super::labels::{WIDTH_PX, chars_from, shortened, visible};
use svg::Document;
use svg::node::element::{Group, Rectangle};

/// Upper left corner of the plot area.
pub const LOW_PX: [f64; 2] = [84.0, 78.0];
/// Lower right corner of the plot area.
pub const HIGH_PX: [f64; 2] = [886.0, 500.0];
/// Height of a line of notes.
pub const LINE_PX: f64 = 20.0;

/// The document: the title, then `content`, on a light ground. `class` names the kind of plot.
pub fn document(class: &str, title: &str, height: f64, content: Group) -> String {
    let heading = text(title, [LOW_PX[0], 24.0], "start").set("font-size", 17).set("class", "ink");
    Document::new()
        .set("class", class)
        .set("viewBox", format!("0 0 {WIDTH_PX} {height}"))
        .set("width", WIDTH_PX)
        .set("height", height)
        .set("font-family", "system-ui, sans-serif")
        .set("font-size", 13)
        .set("role", "img")
        .set("aria-label", title)
        .add(
            Rectangle::new().set("class", "ground").set("width", WIDTH_PX).set("height", height).set("fill", "#ffffff"),
        )
        .add(Group::new().set("fill", INK).add(heading).add(content))
        .to_string()
}

/// Legend: the methods in a line above the plot, each with the method whose mark it has.
pub fn legend<'a>(methods: impl IntoIterator<Item = (&'a str, &'a str)>) -> Group {
    let mut left = LOW_PX[0];
    methods.into_iter().fold(Group::new().set("class", "legend"), |legend, (method, of)| {
        let method = shortened(&visible(method), chars_from(left + 22.0));
        let mark = mark(of, [left + 8.0, 52.0], true);
        let name = text(&method, [left + 22.0, 57.0], "start").set("class", "ink");
        left += 48.0 + 8.0 * method.chars().count() as f64;
        legend.add(mark).add(name)
    })
}

/// Lines that say how the plot is read, from the height `y` on. Returns the height below them as well.
pub fn reading(lines: &[String], mut y: f64) -> (Group, f64) {
    let mut group = Group::new().set("class", "reading");
    for line in lines {
        group = group.add(text(line, [LOW_PX[0], y], "start").set("fill", FAINT).set("class", "faint"));
        y += LINE_PX;
    }
    (group, y)
}

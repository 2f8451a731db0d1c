//! Elements of a drawing: text, lines, marks. The page of a sweep gives colors to their classes.

use super::marks::Mark;
use svg::node::element::{Line, Path, Text};

/// Color of text and axes.
pub const INK: &str = "#1b1b1f";
/// Color of notes.
pub const FAINT: &str = "#5c5c66";

/// Text whose baseline is at a position; `anchor`: `start`, `middle` or `end`.
pub fn text(content: &str, at: [f64; 2], anchor: &str) -> Text {
    Text::new(content).set("x", at[0]).set("y", at[1]).set("text-anchor", anchor)
}

/// Text with an outline in the background color, legible on lines.
pub fn on_ground(text: Text) -> Text {
    let class = format!("{} over", text.get_attributes().get("class").map_or_else(String::new, ToString::to_string));
    let text = text.set("class", class).set("paint-order", "stroke").set("stroke", "#ffffff");
    text.set("stroke-width", 4).set("stroke-linejoin", "round")
}

/// A straight line.
pub fn line(from: [f64; 2], to: [f64; 2], color: &str) -> Line {
    Line::new().set("x1", from[0]).set("y1", from[1]).set("x2", to[0]).set("y2", to[1]).set("stroke", color)
}

/// A method's mark, filled or hollow.
pub fn mark(method: &str, at: [f64; 2], is_filled: bool) -> Path {
    let mark = Mark::of(method);
    let path = Path::new().set("d", mark.path(at)).set("fill", mark.color).set("stroke", mark.color);
    let path = path.set("stroke-width", 1.5).set("class", format!("mark {}", mark.class));
    if is_filled { path } else { path.set("fill-opacity", 0.15) }
}

/// Rounds to a tenth of a pixel.
pub fn px(v: f64) -> f64 {
    (v * 10.0).round() / 10.0
}

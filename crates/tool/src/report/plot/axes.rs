//! The axes of a plot, their ticks, names and grid.

use super::elements::{INK, line, px, text};
use super::page::{HIGH_PX, LOW_PX};
use super::scale::Scale;
use svg::node::element::Group;

const GRID: &str = "#dcdce2";

/// Axes with the names `along` and `up`.
pub fn axes(x: &Scale, y: &Scale, along: &str, up: &str) -> Group {
    let mut axes = Group::new().set("class", "axes");
    for (value, name) in x.ticks() {
        let at = px(x.px(value));
        axes = axes.add(line([at, LOW_PX[1]], [at, HIGH_PX[1]], GRID).set("class", "grid"));
        axes = axes.add(text(&name, [at, HIGH_PX[1] + 18.0], "middle").set("class", "ink"));
    }
    for (value, name) in y.ticks() {
        let at = px(y.px(value));
        axes = axes.add(line([LOW_PX[0], at], [HIGH_PX[0], at], GRID).set("class", "grid"));
        axes = axes.add(text(&name, [LOW_PX[0] - 8.0, at + 4.5], "end").set("class", "ink"));
    }
    let middle = [0, 1].map(|i| 0.5 * (LOW_PX[i] + HIGH_PX[i]));
    let turned = format!("rotate(-90 20 {})", middle[1]);
    axes.add(line([LOW_PX[0], HIGH_PX[1]], HIGH_PX, INK).set("class", "axis"))
        .add(line(LOW_PX, [LOW_PX[0], HIGH_PX[1]], INK).set("class", "axis"))
        .add(text(along, [middle[0], HIGH_PX[1] + 40.0], "middle").set("class", "ink"))
        .add(text(up, [20.0, middle[1]], "middle").set("transform", turned).set("class", "ink"))
}

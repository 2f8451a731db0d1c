//! The panel: the state, the keys that change it, and the graphs. Its rows can be clicked.

use super::graph::Graph;
use super::keys::rows;
use super::state::{Action, State};
use crate::report::canvas::Canvas;
use image::RgbImage;

/// Width of the panel in its own pixels.
const WIDTH: u32 = 300;
const MARGIN: u32 = 8;
const ROW_PX: u32 = 17;
const BACKGROUND: [u8; 3] = [18, 20, 24];
const TEXT: [u8; 3] = [225, 225, 225];
const KEY: [u8; 3] = [240, 200, 70];
const QUIET: [u8; 3] = [150, 155, 165];
/// X positions of a row's value and key.
const VALUE_X: u32 = 92;
const KEY_X: u32 = 216;

fn first_row_y(lines: usize) -> u32 {
    MARGIN + ROW_PX * lines as u32 + 4
}

/// Draws the panel: lines of text about input, resolution and device, the state, graphs.
pub fn draw(state: &State, lines: &[String], graphs: &[&Graph]) -> RgbImage {
    let rows = rows(state);
    let y = first_row_y(lines.len());
    let graphs_y = y + ROW_PX * rows.len() as u32 + MARGIN;
    let height = graphs_y + graphs.iter().map(|g| g.height() + MARGIN).sum::<u32>();
    let mut canvas = Canvas::new(WIDTH, height, BACKGROUND);
    for (i, line) in lines.iter().enumerate() {
        canvas.small(line, MARGIN, MARGIN + ROW_PX * i as u32, QUIET);
    }
    for (i, row) in rows.iter().enumerate() {
        let y = y + ROW_PX * i as u32;
        canvas.small(row.name, MARGIN, y, TEXT);
        canvas.small(&row.value, VALUE_X, y, TEXT);
        canvas.small(&row.key, KEY_X, y, KEY);
    }
    let mut y = graphs_y;
    for graph in graphs {
        graph.draw(&mut canvas, [MARGIN, y], WIDTH - 2 * MARGIN);
        y += graph.height() + MARGIN;
    }
    canvas.0
}

/// The action of a click at a position on the panel; `None` outside the panel, `Some(None)` outside its rows.
pub fn click(state: &State, lines: usize, panel: [u32; 2], at: [f32; 2]) -> Option<Option<Action>> {
    let inside = (0..2).all(|i| at[i] >= 0.0 && at[i] < panel[i] as f32);
    let row = (at[1] - first_row_y(lines) as f32) / ROW_PX as f32;
    inside.then(|| (row >= 0.0).then(|| rows(state).get(row as usize).map(|r| r.action)).flatten())
}

#[cfg(test)]
mod tests {
    use super::super::state::{Shows, Side, tests::state};
    use super::*;
    use afterimage::internal::MethodKind;

    /// The action of a click on the row of that name.
    fn click_on(state: &State, name: &str) -> Option<Action> {
        let row = rows(state).iter().position(|r| r.name == name).unwrap();
        let at = [40.0, first_row_y(3) as f32 + (row as f32 + 0.5) * ROW_PX as f32];
        click(state, 3, [300, 400], at).unwrap()
    }

    #[test]
    fn rows_do_what_they_say() {
        let mut state = state();
        assert_eq!(click_on(&state, "method"), Some(Action::Next(Side::Left)));
        assert_eq!(click_on(&state, "split"), Some(Action::Split));
        state.apply(Action::Show(Side::Right, Shows::Post(MethodKind::Wrs)));
        assert_eq!(click_on(&state, "right"), Some(Action::Next(Side::Right)));
        assert_eq!(click_on(&state, "frozen"), Some(Action::Freeze));
        assert!(rows(&state).iter().all(|r| r.name != "camera"), "there is none to steer");
        assert!(rows(&state).iter().all(|r| r.name != "rendered"), "frames are given");
        state.is_rasterised = true;
        assert_eq!(click_on(&state, "rendered"), Some(Action::Render));
    }

    #[test]
    fn what_is_beside_the_rows_does_nothing() {
        let state = state();
        assert_eq!(click(&state, 3, [300, 400], [301.0, 5.0]), None, "beside the panel is the picture");
        assert_eq!(click(&state, 3, [300, 400], [5.0, 5.0]), Some(None), "on its heading is nothing");
        assert_eq!(click(&state, 3, [300, 400], [5.0, 399.0]), Some(None), "on its graphs is nothing");
    }

    #[test]
    fn it_is_drawn_as_large_as_its_rows_and_graphs_need() {
        let graphs = [&Graph::new("ms a frame", &[("screen", [255; 3])])];
        let lines = ["input".to_owned()];
        let split = State { is_split: true, ..state() };
        let [one, two] = [&state(), &split].map(|s| draw(s, &lines, &graphs).dimensions());
        assert_eq!((one.0, two.0, two.1 - one.1), (WIDTH, WIDTH, ROW_PX));
    }
}

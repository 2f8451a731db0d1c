//! Small graphs over the last seconds.

use crate::report::canvas::Canvas;
use std::collections::VecDeque;

/// Seconds that a graph shows.
const SECONDS: f64 = 6.0;
const PLOT_PX: u32 = 44;
const TITLE_PX: u32 = 15;
const BACKGROUND: [u8; 3] = [34, 37, 44];
const TITLE: [u8; 3] = [150, 155, 165];

/// Values over time.
pub struct Graph {
    title: &'static str,
    series: Vec<Series>,
}

struct Series {
    name: &'static str,
    color: [u8; 3],
    /// (time in seconds, value)
    points: VecDeque<(f64, f64)>,
}

impl Graph {
    /// A graph of series with these names and colors.
    pub fn new(title: &'static str, series: &[(&'static str, [u8; 3])]) -> Self {
        let series = series.iter().map(|&(name, color)| Series { name, color, points: VecDeque::new() });
        Self { title, series: series.collect() }
    }

    /// Adds a value to a series and drops values older than [`SECONDS`].
    pub fn push(&mut self, series: usize, at_s: f64, value: f64) {
        let points = &mut self.series[series].points;
        points.push_back((at_s, value));
        while points.front().is_some_and(|p| p.0 < at_s - SECONDS) {
            points.pop_front();
        }
    }

    /// Removes all values.
    pub fn clear(&mut self) {
        self.series.iter_mut().for_each(|s| s.points.clear());
    }

    /// Height in pixels.
    pub fn height(&self) -> u32 {
        TITLE_PX * (1 + self.shown().count() as u32) + PLOT_PX
    }

    /// Series with values.
    fn shown(&self) -> impl Iterator<Item = &Series> {
        self.series.iter().filter(|s| !s.points.is_empty())
    }

    /// Draws the graph with its top left corner at (x, y).
    pub fn draw(&self, canvas: &mut Canvas, [x, y]: [u32; 2], width: u32) {
        canvas.small(self.title, x, y, TITLE);
        let top = y + TITLE_PX;
        for py in top..top + PLOT_PX {
            canvas.line([x as f32, py as f32], [(x + width - 1) as f32, py as f32], 1, BACKGROUND);
        }
        let values = || self.series.iter().flat_map(|s| &s.points);
        let end = values().map(|p| p.0).fold(f64::NEG_INFINITY, f64::max);
        let [low, high] = self.range();
        let place = |&(t, v): &(f64, f64)| {
            let along = (1.0 - (end - t) / SECONDS).clamp(0.0, 1.0);
            let up = ((v - low) / (high - low)).clamp(0.0, 1.0);
            let (w, h) = (f64::from(width - 3), f64::from(PLOT_PX - 4));
            [(f64::from(x) + 1.0 + along * w) as f32, (f64::from(top) + 1.0 + (1.0 - up) * h) as f32]
        };
        for (i, series) in self.shown().enumerate() {
            let color = series.color;
            for (from, to) in series.points.iter().zip(series.points.iter().skip(1)) {
                canvas.line(place(from), place(to), 1, color);
            }
            if let Some(last) = series.points.back() {
                let line_y = top + PLOT_PX + 2 + TITLE_PX * i as u32;
                canvas.small(series.name, x, line_y, color);
                canvas.small(&format!("{:6.1}", last.1), x + 110, line_y, color);
            }
        }
        canvas.small(&format!("{low:.0} to {high:.0}"), x + width - 90, y, TITLE);
    }

    /// Range of the vertical axis: multiples of 10 around all values.
    fn range(&self) -> [f64; 2] {
        let values = || self.series.iter().flat_map(|s| &s.points).map(|p| p.1);
        let (low, high) = (values().fold(f64::INFINITY, f64::min), values().fold(f64::NEG_INFINITY, f64::max));
        if !(low.is_finite() && high.is_finite()) {
            return [0.0, 10.0];
        }
        let low = (low / 10.0).floor() * 10.0;
        [low, ((high / 10.0).ceil() * 10.0).max(low + 10.0)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_old_leaves_and_the_axis_holds_the_rest() {
        let mut graph = Graph::new("ms", &[("a", [1; 3]), ("b", [2; 3])]);
        assert_eq!((graph.range(), graph.shown().count()), ([0.0, 10.0], 0));
        graph.push(0, 0.0, 99.0);
        graph.push(0, 1.0, 21.0);
        assert_eq!(graph.range(), [20.0, 100.0]);
        graph.push(0, 6.5, 34.0);
        assert_eq!((graph.range(), graph.shown().count()), ([20.0, 40.0], 1));
        graph.push(1, 6.5, f64::INFINITY);
        graph.draw(&mut Canvas::new(100, 200, [0; 3]), [0, 0], 100);
        graph.clear();
        assert_eq!(graph.range(), [0.0, 10.0]);
    }
}

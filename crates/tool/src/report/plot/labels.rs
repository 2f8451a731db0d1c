//! Room for text: characters that XML allows, that fit a line, and lines that do not overlap.

/// Width of a plot with its labels.
pub(super) const WIDTH_PX: f64 = 960.0;

/// Width of a character in notes: a little more than the font's mean.
const CHAR_PX: f64 = 6.9;

/// Distance of labels below each other.
const LABEL_PX: f64 = 15.0;

/// Replaces characters that XML forbids.
pub fn visible(text: &str) -> String {
    let forbidden = |c: char| c.is_control() || matches!(c, '\u{fffe}' | '\u{ffff}');
    text.chars().map(|c| if forbidden(c) { '\u{fffd}' } else { c }).collect()
}

/// Number of characters that fit between `x` and the border.
pub fn chars_from(x: f64) -> usize {
    ((WIDTH_PX - x).max(0.0) / CHAR_PX) as usize
}

/// Shortens a text to a number of characters.
pub fn shortened(text: &str, max: usize) -> String {
    if text.chars().count() <= max {
        return text.to_owned();
    }
    text.chars().take(max.saturating_sub(1)).chain(['…']).collect()
}

/// Heights of labels for the lines that end at `ends`, in the same order: as near as they can be without overlaps, and
/// between `low` and `high` as far as there is room.
pub fn spread(ends: &[f64], low: f64, high: f64) -> Vec<f64> {
    let mut order: Vec<usize> = (0..ends.len()).collect();
    order.sort_by(|&a, &b| ends[a].total_cmp(&ends[b]));
    let mut placed = ends.to_vec();
    let mut above = low - LABEL_PX;
    for &i in &order {
        above = ends[i].max(above + LABEL_PX);
        placed[i] = above;
    }
    let mut below = high + LABEL_PX;
    for &i in order.iter().rev() {
        below = placed[i].min(below - LABEL_PX);
        placed[i] = below;
    }
    placed
}

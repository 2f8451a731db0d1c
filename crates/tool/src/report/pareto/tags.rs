//! Placement of numbers beside points without overlaps.

/// Width and height of a number of two digits, pixels.
const TAG_PX: [f64; 2] = [18.0, 15.0];

/// Half the width of a mark and one pixel of margin.
const MARK_PX: f64 = 8.0;

/// Candidate distances from the point, nearest first, pixels.
const RINGS_PX: [f64; 7] = [15.0, 22.0, 30.0, 40.0, 52.0, 66.0, 82.0];

/// Candidate directions in sixteenths of a turn, clockwise from the right; those above first.
const DIRECTIONS: [u32; 16] = [14, 10, 12, 2, 6, 4, 0, 8, 13, 11, 15, 9, 1, 7, 3, 5];

/// Centers of the numbers of `points` within `low` to `high`. Numbers never overlap each other, and overlap as few
/// `marks` as possible.
pub fn place(points: &[[f64; 2]], marks: &[[f64; 2]], low: [f64; 2], high: [f64; 2]) -> Vec<[f64; 2]> {
    let mut placed: Vec<[f64; 2]> = vec![];
    for point in points {
        let tries = RINGS_PX.iter().flat_map(|&r| DIRECTIONS.iter().map(move |&d| at(point, r, d)));
        let inside =
            |p: &[f64; 2]| (0..2).all(|i| p[i] >= low[i] + 0.5 * TAG_PX[i] && p[i] <= high[i] - 0.5 * TAG_PX[i]);
        let free: Vec<[f64; 2]> =
            tries.filter(|p| inside(p) && !placed.iter().any(|q| overlap(p, q, TAG_PX))).collect();
        let over_marks =
            |p: &[f64; 2]| marks.iter().filter(|m| overlap(p, m, TAG_PX.map(|s| 0.5 * s + MARK_PX))).count();
        // `min_by_key` returns the first of equal candidates, which is the nearest.
        placed.push(free.into_iter().min_by_key(over_marks).unwrap_or(*point));
    }
    placed
}

/// Whether boxes around two centers overlap.
fn overlap(a: &[f64; 2], b: &[f64; 2], reach: [f64; 2]) -> bool {
    (0..2).all(|i| (a[i] - b[i]).abs() < reach[i])
}

fn at(point: &[f64; 2], radius: f64, sixteenths: u32) -> [f64; 2] {
    let angle = f64::from(sixteenths) * std::f64::consts::TAU / 16.0;
    [point[0] + radius * angle.cos(), point[1] + radius * angle.sin()]
}

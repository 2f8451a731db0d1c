//! Colours for numbers.

/// Stops of a ramp from black over violet and orange to white, of steadily rising lightness; sRGB-encoded.
const STOPS: [[f32; 3]; 6] =
    [[0.0, 0.0, 0.0], [0.23, 0.04, 0.42], [0.62, 0.13, 0.40], [0.93, 0.38, 0.18], [0.98, 0.75, 0.25], [1.0, 1.0, 0.95]];

/// Colour of a value in \[0, 1\], sRGB-encoded. NaN is shown as pure green, which the ramp does not hold.
pub fn color(value: f32) -> [f32; 3] {
    if value.is_nan() {
        return [0.0, 1.0, 0.0];
    }
    let position = value.clamp(0.0, 1.0) * (STOPS.len() - 1) as f32;
    let i = (position as usize).min(STOPS.len() - 2);
    let t = position - i as f32;
    [0, 1, 2].map(|c| STOPS[i][c] + (STOPS[i + 1][c] - STOPS[i][c]) * t)
}

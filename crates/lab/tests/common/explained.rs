//! Whether motion vectors explain a frame by the frame before.

use afterimage::Image;
use afterimage_lab::frame::SourceFrame;
use glam::Vec3;

/// Bilinear, clamped to the frame.
fn fetch(image: &Image<Vec3>, [x, y]: [f32; 2]) -> Vec3 {
    let (left, top) = (x.floor(), y.floor());
    let at = |x: f32, y: f32| {
        let last = [image.width() - 1, image.height() - 1];
        image.at((x.max(0.0) as usize).min(last[0]), (y.max(0.0) as usize).min(last[1]))
    };
    let row = |y: f32| at(left, y).lerp(at(left + 1.0, y), x - left);
    row(top).lerp(row(top + 1.0), y - top)
}

/// PSNR of frame `before`, fetched at `p + sign * motion`, against frame `now`, in colors that `tone` encodes; and the
/// share of the pixels that count. Those came from within the frame, and `was_seen` says of a pixel and where it came
/// from whether it shows the same surface there. All signs use the same pixels.
pub fn explained_db(
    before: &SourceFrame,
    now: &SourceFrame,
    sign: [f32; 2],
    tone: impl Fn([f32; 3]) -> [f32; 3],
    was_seen: impl Fn([usize; 2], [f32; 2]) -> bool,
) -> (f64, f64) {
    let [was, is] = [before, now].map(|frame| frame.color.map(|c| Vec3::from(tone(c))));
    let motion = now.motion.as_ref().unwrap();
    let (w, h) = (is.width(), is.height());
    let (mut sum, mut count) = (0.0, 0);
    for (x, y) in (0..h).flat_map(|y| (0..w).map(move |x| (x, y))) {
        let [mx, my] = motion.at(x, y);
        let from = [x as f32 + mx, y as f32 + my];
        let inside = (0.0..=(w - 1) as f32).contains(&from[0]) && (0.0..=(h - 1) as f32).contains(&from[1]);
        if inside && was_seen([x, y], from) {
            let there = fetch(&was, [x as f32 + sign[0] * mx, y as f32 + sign[1] * my]);
            sum += f64::from((there - is.at(x, y)).length_squared() / 3.0);
            count += 1;
        }
    }
    (-10.0 * (sum / f64::from(count)).log10(), f64::from(count) / (w * h) as f64)
}

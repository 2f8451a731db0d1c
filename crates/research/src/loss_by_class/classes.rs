//! Classes of pixels by what is seen there and by what the method decided. A pixel may be in several.

use afterimage::cpu::PixelTrace;
use afterimage::kernel::antialias::{Mean, mean_of};
use afterimage::kernel::color::luma;
use afterimage::kernel::stored_sample::unpack_stored;
use afterimage::{Image, Verdict};
use afterimage_lab::metric::{NO_PAST, Tracked};
use glam::Vec3;

/// Relative difference of disparity at a silhouette.
const EDGE: f32 = 0.05;
/// Relative second difference of disparity at a crease.
const CREASE: f32 = 0.005;
/// Difference of sRGB luma of a thin line from what is on both sides of it.
const LINE: f32 = 0.1;
/// Range of sRGB luma in 3x3 pixels with contrast.
const CONTRAST: f32 = 0.15;
/// Relative change of sRGB luma where light changed.
const CHANGE: f32 = 0.1;
/// Level of detail of coarse history.
const COARSE: f32 = 0.4;
/// Number of samples below which a mean has few.
const FEW: f32 = 4.0;

pub const NAMES: [&str; 14] = [
    "no history",
    "silhouette within 1 px",
    "silhouette within 2 px",
    "crease within 1 px",
    "crease within 2 px",
    "thin by depth",
    "thin by contrast",
    "history rejected",
    "coarse history",
    "change of light",
    "contrast, no silhouette",
    "the rest",
    "fine mean of few samples",
    "own sample in this frame",
];
/// Index of the pixels within one pixel of a silhouette.
pub const SILHOUETTE: usize = 1;
/// Index of the class of pixels that are in none of the classes before it.
const REST: usize = 11;

/// One color for each class up to the rest; a later class of a pixel hides an earlier one.
pub const COLORS: [[f32; 3]; REST + 1] = [
    [0.2, 0.4, 1.0],
    [1.0, 0.1, 0.1],
    [0.6, 0.1, 0.1],
    [1.0, 0.6, 0.1],
    [0.6, 0.4, 0.1],
    [1.0, 0.2, 1.0],
    [0.6, 0.2, 0.7],
    [1.0, 1.0, 1.0],
    [0.1, 0.7, 0.7],
    [1.0, 1.0, 0.3],
    [0.2, 0.7, 0.2],
    [0.15, 0.15, 0.15],
];

/// The reference of a frame, without jitter: what is seen.
pub struct Seen<'a> {
    pub disparity: Image<f32>,
    /// sRGB luma.
    pub luma: Image<f32>,
    /// That of the previous frame.
    pub luma_before: Option<&'a Image<f32>>,
    pub tracked: &'a Tracked,
}

/// What the method decided.
pub struct Decided {
    pub traces: Image<PixelTrace>,
    /// Whether a pixel was shaded.
    pub shaded: Image<bool>,
    /// What is stored for the next frame.
    pub stored: Image<Mean>,
}

/// Luma of an encoded image.
pub fn luma_of(encoded: &Image<[f32; 3]>) -> Image<f32> {
    encoded.map(|c| luma(Vec3::from(c)))
}

/// Means in packed texels.
pub fn means(size: [u32; 2], words: &[[u32; 2]]) -> Image<Mean> {
    Image::from_fn(size, |[x, y]| mean_of(unpack_stored(words[(y * size[0] + x) as usize]).lod))
}

/// Value at an offset from a pixel; at the border that of the border.
pub fn near<T: Copy>(image: &Image<T>, [x, y]: [u32; 2], [dx, dy]: [i32; 2]) -> T {
    let at = |v: u32, d: i32, size: u32| (v as i32 + d).clamp(0, size as i32 - 1) as usize;
    image.at(at(x, dx, image.size()[0]), at(y, dy, image.size()[1]))
}

/// Offsets in a square of `radius` pixels around a pixel.
pub fn square(radius: i32) -> impl Iterator<Item = [i32; 2]> {
    (-radius..=radius).flat_map(move |y| (-radius..=radius).map(move |x| [x, y]))
}

/// The four lines through a pixel.
const LINES: [[i32; 2]; 4] = [[1, 0], [0, 1], [1, 1], [1, -1]];

/// Whether the disparities on a line through a pixel are not those of a plane. Planes that are seen at grazing angles
/// have large differences between neighbours, too, and are no silhouettes.
fn bends(disparity: &Image<f32>, px: [u32; 2], relative: f32) -> bool {
    let own = near(disparity, px, [0, 0]);
    LINES.into_iter().any(|[dx, dy]| {
        let (a, b) = (near(disparity, px, [dx, dy]), near(disparity, px, [-dx, -dy]));
        (a + b - 2.0 * own).abs() > relative * own.max(a).max(b)
    })
}

/// Whether a pixel's surface is at most two pixels wide along a line: farther surfaces are on both sides.
fn is_thin(disparity: &Image<f32>, px: [u32; 2]) -> bool {
    let limit = near(disparity, px, [0, 0]) * (1.0 - EDGE);
    LINES.into_iter().any(|[dx, dy]| {
        let farther = |step: i32| near(disparity, px, [dx * step, dy * step]) < limit;
        [[-1, 1], [-1, 2], [-2, 1]].into_iter().any(|[a, b]| farther(a) && farther(b))
    })
}

/// Whether a pixel is brighter, or darker, than both of two opposite neighbours.
fn is_line(luma: &Image<f32>, px: [u32; 2]) -> bool {
    let own = near(luma, px, [0, 0]);
    LINES.into_iter().any(|[dx, dy]| {
        let (a, b) = (near(luma, px, [dx, dy]), near(luma, px, [-dx, -dy]));
        (own - a.max(b)).max(a.min(b) - own) > LINE
    })
}

/// Smallest and largest value in 3x3 pixels.
fn range(image: &Image<f32>, px: [u32; 2]) -> [f32; 2] {
    let widen = |[low, high]: [f32; 2], v: f32| [low.min(v), high.max(v)];
    square(1).map(|offset| near(image, px, offset)).fold([f32::MAX, f32::MIN], widen)
}

/// Whether the light on a surface changed: its luma lies outside of the range that the surface had around its place in
/// the previous frame.
fn is_relit(seen: &Seen<'_>, px: [u32; 2]) -> bool {
    let Some(before) = seen.luma_before else { return false };
    let past = near(&seen.tracked.past, px, [0, 0]);
    if past == NO_PAST {
        return false;
    }
    let width = before.size()[0];
    let [low, high] = range(before, [past % width, past / width]);
    let now = near(&seen.luma, px, [0, 0]);
    (now - high).max(low - now) > CHANGE * now.max(0.1)
}

fn widened(mask: &Image<bool>) -> Image<bool> {
    Image::from_fn(mask.size(), |px| square(1).any(|offset| near(mask, px, offset)))
}

/// The pixels of each class, in the order of [`NAMES`].
pub fn masks(seen: &Seen<'_>, decided: &Decided) -> Vec<Image<bool>> {
    let size = seen.luma.size();
    let silhouette = Image::from_fn(size, |px| bends(&seen.disparity, px, EDGE));
    let wide = widened(&silhouette);
    let without = |mask: Image<bool>, other: &Image<bool>| {
        Image::from_fn(size, |px| near(&mask, px, [0, 0]) && !near(other, px, [0, 0]))
    };
    let crease = without(Image::from_fn(size, |px| bends(&seen.disparity, px, CREASE)), &silhouette);
    let wide_crease = without(widened(&crease), &wide);
    let thin = Image::from_fn(size, |px| is_thin(&seen.disparity, px));
    let line = Image::from_fn(size, |px| is_line(&seen.luma, px));
    let contrast = Image::from_fn(size, |px| {
        let [low, high] = range(&seen.luma, px);
        high - low > CONTRAST
    });
    let relit = without(Image::from_fn(size, |px| is_relit(seen, px)), &wide);
    let by_trace = |of: &dyn Fn(PixelTrace, bool) -> bool| {
        Image::from_fn(size, |px| of(near(&decided.traces, px, [0, 0]), near(&decided.shaded, px, [0, 0])))
    };
    // A sample of the pixel itself replaces coarse history as a matter of course.
    let rejected = by_trace(&|t, shaded| {
        t.verdict == Verdict::Valid && (t.agreement < 0.5 || (t.history_share == 0.0 && !shaded))
    });
    let mut masks = vec![
        by_trace(&|t, _| t.verdict != Verdict::Valid),
        silhouette.clone(),
        wide,
        crease,
        wide_crease,
        thin,
        line,
        rejected,
        decided.stored.map(|mean| mean.lod > COARSE || mean.lod < 0.0),
        relit,
        without(contrast, &silhouette),
    ];
    masks.push(Image::from_fn(size, |px| masks.iter().all(|mask| !near(mask, px, [0, 0]))));
    masks.push(decided.stored.map(|mean| mean.lod == 0.0 && mean.samples < FEW));
    masks.push(decided.shaded.clone());
    masks
}

/// The classes as a picture.
pub fn picture(masks: &[Image<bool>]) -> Image<[f32; 3]> {
    // Silhouettes lie inside their wider neighbourhood, and creases do, too.
    const ORDER: [usize; REST + 1] = [11, 10, 8, 4, 3, 2, 1, 6, 5, 9, 7, 0];
    let color = |px| ORDER.into_iter().rfind(|&i| near(&masks[i], px, [0, 0])).map_or([0.0; 3], |i| COLORS[i]);
    Image::from_fn(masks[0].size(), color)
}

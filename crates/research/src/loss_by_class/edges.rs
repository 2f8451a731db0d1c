//! Squared errors within one pixel of silhouettes: what the shown color came from, and which surface it shows.

use super::classes::{Decided, SILHOUETTE, Seen, near, square};
use afterimage::kernel::antialias::move_together;
use afterimage::{Image, Verdict};
use afterimage_lab::frame::SourceFrame;
use afterimage_lab::metric::NO_PAST;
use glam::{Vec2, Vec3};

/// What a shown color came from.
const SOURCES: [&str; 8] = [
    "own sample, history below 0.1",
    "own sample, history 0.1 to 0.6",
    "own sample, history above 0.6",
    "no own sample, history from 0.9 on",
    "no own sample, history 0.1 to 0.9",
    "no own sample, history below 0.1",
    "no history, was hidden",
    "no history, was visible",
];
/// What is stored at the pixel.
const STORED: [&str; 5] = ["coarse", "1 sample", "2 to 3", "4 to 7", "8 and more"];
/// How the surfaces of the 3x3 pixels around move. Where they move together, history may show any of them.
const MOTIONS: [&str; 3] = ["they move together", "apart by at most 1 px", "apart by more"];
/// What is wrong with a shown color. The colors of the near and the far surface are those within three pixels.
const KINDS: [&str; 6] = [
    "surfaces of like color",
    "no pure color near",
    "the other surface",
    "one surface instead of a mixture",
    "a mixture instead of one surface",
    "a mixture of another share",
];

/// Squared error and number of pixels.
#[derive(Clone, Copy, Default)]
struct Cell {
    squared: f64,
    pixels: f64,
}

impl Cell {
    fn add(&mut self, squared: f64) {
        *self = Self { squared: self.squared + squared, pixels: self.pixels + 1.0 };
    }
}

/// Sums over the frames of a row.
#[derive(Default)]
pub struct Edges {
    all: Cell,
    sources: [[Cell; KINDS.len()]; SOURCES.len()],
    stored: [Cell; STORED.len()],
    motions: [[Cell; KINDS.len()]; MOTIONS.len()],
    /// Errors toward the near surface, toward the far one, and across.
    toward: [f64; 3],
    /// Squared errors of this frame's samples at full rate, and of taau.
    others: [f64; 2],
}

/// A frame as it was given, and pictures of it, sRGB-encoded.
pub struct Pictures<'a> {
    pub given: &'a SourceFrame,
    pub reference: &'a Image<[f32; 3]>,
    pub shown: &'a Image<[f32; 3]>,
    /// This frame's jittered samples at full rate.
    pub sampled: &'a Image<[f32; 3]>,
    /// taau at full rate.
    pub taau: &'a Image<[f32; 3]>,
}

fn color(image: &Image<[f32; 3]>, px: [u32; 2]) -> Vec3 {
    near(image, px, [0, 0]).into()
}

/// Mean reference colors of the near and the far surface around a silhouette, of pixels that show one surface alone.
fn surfaces(seen: &Seen<'_>, silhouette: &Image<bool>, reference: &Image<[f32; 3]>, px: [u32; 2]) -> Option<[Vec3; 2]> {
    let disparities = square(1).map(|offset| near(&seen.disparity, px, offset));
    let [low, high] = disparities.fold([f32::MAX, f32::MIN], |[low, high], d| [low.min(d), high.max(d)]);
    let mut sums = [(Vec3::ZERO, 0.0); 2];
    for offset in square(3).filter(|&offset| !near(silhouette, px, offset)) {
        let is_far = near(&seen.disparity, px, offset) < 0.5 * (low + high);
        let (sum, count) = &mut sums[usize::from(is_far)];
        *sum += Vec3::from(near(reference, px, offset));
        *count += 1.0;
    }
    sums.iter().all(|sum| sum.1 > 0.0).then(|| sums.map(|(sum, count)| sum / count))
}

fn source(seen: &Seen<'_>, decided: &Decided, px: [u32; 2]) -> usize {
    let trace = near(&decided.traces, px, [0, 0]);
    let is_own = near(&decided.shaded, px, [0, 0]);
    match trace.history_share {
        _ if trace.verdict != Verdict::Valid => 6 + usize::from(near(&seen.tracked.past, px, [0, 0]) != NO_PAST),
        share if is_own && share < 0.1 => 0,
        share if is_own && share < 0.6 => 1,
        _ if is_own => 2,
        share if share >= 0.9 => 3,
        share if share >= 0.1 => 4,
        _ => 5,
    }
}

fn stored(decided: &Decided, px: [u32; 2]) -> usize {
    let mean = near(&decided.stored, px, [0, 0]);
    match mean.samples {
        _ if mean.lod != 0.0 => 0,
        samples if samples < 2.0 => 1,
        samples if samples < 4.0 => 2,
        samples if samples < 8.0 => 3,
        _ => 4,
    }
}

/// How the nearest and the farthest surface around a pixel, and its own, move.
fn motion(given: &SourceFrame, px: [u32; 2]) -> usize {
    let (Some(depth), Some(motion)) = (&given.depth, &given.motion) else { return 0 };
    let by_depth = |a: &[i32; 2], b: &[i32; 2]| near(depth, px, *a).total_cmp(&near(depth, px, *b));
    let of = |offset: Option<[i32; 2]>| Vec2::from(near(motion, px, offset.unwrap_or([0, 0])));
    let [own, nearest, farthest] = [of(None), of(square(1).min_by(by_depth)), of(square(1).max_by(by_depth))];
    let apart = (own - nearest).abs().max((own - farthest).abs()).max_element();
    match apart {
        _ if move_together(own, nearest, farthest) => 0,
        apart if apart <= 1.0 => 1,
        _ => 2,
    }
}

/// Kind of an error from the shares of the near surface in the shown color and in the reference.
fn kind(shown: f32, reference: f32) -> usize {
    let is_pure = |share: f32| !(0.15..=0.85).contains(&share);
    match (is_pure(shown), is_pure(reference)) {
        _ if (shown - reference).abs() > 0.5 => 2,
        (true, false) => 3,
        (false, true) => 4,
        _ => 5,
    }
}

impl Edges {
    /// Adds a frame.
    pub fn add(&mut self, seen: &Seen<'_>, decided: &Decided, masks: &[Image<bool>], pictures: &Pictures<'_>) {
        let silhouette = &masks[SILHOUETTE];
        let [width, height] = silhouette.size();
        for px in (0..height).flat_map(|y| (0..width).map(move |x| [x, y])) {
            if near(silhouette, px, [0, 0]) {
                let surfaces = surfaces(seen, silhouette, pictures.reference, px);
                self.add_pixel(px, [source(seen, decided, px), stored(decided, px)], pictures, surfaces);
            }
        }
    }

    fn add_pixel(
        &mut self,
        px: [u32; 2],
        [source, stored]: [usize; 2],
        pictures: &Pictures<'_>,
        surfaces: Option<[Vec3; 2]>,
    ) {
        let reference = color(pictures.reference, px);
        let error = color(pictures.shown, px) - reference;
        let squared = f64::from(error.length_squared());
        let mut of_kind = 1;
        if let Some([near, far]) = surfaces {
            let axis = near - far;
            let length2 = axis.length_squared();
            of_kind = 0;
            if length2 > 0.01 {
                let share = |c: Vec3| (c - far).dot(axis) / length2;
                of_kind = kind(share(reference + error), share(reference));
                let along = error.dot(axis) / length2.sqrt();
                let along2 = f64::from(along * along);
                self.toward[usize::from(along < 0.0)] += along2;
                self.toward[2] += squared - along2;
            }
        }
        self.all.add(squared);
        self.sources[source][of_kind].add(squared);
        self.stored[stored].add(squared);
        self.motions[motion(pictures.given, px)][of_kind].add(squared);
        for (sum, other) in self.others.iter_mut().zip([pictures.sampled, pictures.taau]) {
            *sum += f64::from((color(other, px) - reference).length_squared());
        }
    }

    pub fn print(&self) {
        let percent = |part: f64, whole: f64| 100.0 * part / whole.max(1e-12);
        let line = |name: &str, cells: &[Cell]| {
            let pixels: f64 = cells.iter().map(|cell| cell.pixels).sum();
            let squared: f64 = cells.iter().map(|cell| cell.squared).sum();
            let (of_pixels, of_error) = (percent(pixels, self.all.pixels), percent(squared, self.all.squared));
            say!("    {name:54} {of_pixels:5.1} % of the pixels  {of_error:5.1} % of the squared error");
        };
        let rms = |squared: f64| (squared / (3.0 * self.all.pixels).max(1.0)).sqrt();
        say!("  within 1 px of a silhouette, of {} pixels:", self.all.pixels);
        say!(
            "    root of the mean squared error: {:.4} shown, {:.4} samples at full rate, {:.4} taau at full rate",
            rms(self.all.squared),
            rms(self.others[0]),
            rms(self.others[1])
        );
        for (name, cells) in SOURCES.iter().zip(&self.sources) {
            line(name, cells);
        }
        for (name, cells) in MOTIONS.iter().zip(&self.motions) {
            line(name, cells);
            line("  of it, the other surface", &cells[2..3]);
        }
        for (name, cells) in SOURCES.iter().zip(&self.sources) {
            line(&format!("the other surface: {name}"), &cells[2..3]);
        }
        for (i, name) in KINDS.iter().enumerate() {
            line(name, &self.sources.map(|cells| cells[i]));
        }
        for (name, cell) in STORED.iter().zip(self.stored) {
            line(&format!("stored: {name}"), &[cell]);
        }
        let shares = self.toward.map(|part| percent(part, self.toward.iter().sum()));
        say!(
            "    error toward the near surface {:.0} %, the far one {:.0} %, across {:.0} %",
            shares[0],
            shares[1],
            shares[2]
        );
    }
}

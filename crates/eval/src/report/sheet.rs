//! Contact sheet: reference and methods side by side, their errors, and a magnified area where the gaze was before.

use super::canvas::{CHAR_PX, Canvas, LINE_PX};
use crate::metric::Scores;
use crate::picture::to_rgb8;
use afterimage::kernel::debug_view::heat;
use afterimage::{Image, ViewGeometry};
use image::imageops::{self, FilterType};
use image::{Rgb, RgbImage};

const BACKGROUND: [u8; 3] = [24, 24, 28];
const INK: [u8; 3] = [235, 235, 235];
const FAINT: [u8; 3] = [160, 160, 170];
const GAZE: [u8; 3] = [255, 210, 60];
const TRAIL: [u8; 3] = [90, 200, 255];
const ZOOM: [u8; 3] = [120, 255, 140];

/// Width of a panel of a large frame in pixels.
const PANEL_PX: u32 = 640;

/// Small frames are enlarged by a whole factor to at least this width, the room for a caption.
const MIN_PANEL_PX: u32 = 480;
const GAP_PX: u32 = 12;

/// Loss in JOD that the map of visible differences shows as white.
const WORST_JOD: f32 = 5.0;

/// Magnification of the bottom row.
const ZOOM_FACTOR: u32 = 4;

/// One column of the contact sheet.
pub struct Column<'a> {
    /// Heading.
    pub name: &'a str,
    /// sRGB-encoded image.
    pub shown: &'a Image<[f32; 3]>,
    /// Scores over the clip; `None` for the reference.
    pub scores: Option<Scores>,
    /// Visible difference of the frame shown, in JOD ([`TestVideo::heat_map`]); `None` if it is not measured.
    ///
    /// [`TestVideo::heat_map`]: afterimage_metric::TestVideo::heat_map
    pub visible_jod: Option<Image<f32>>,
}

/// Contents of a contact sheet.
pub struct Sheet<'a> {
    /// First line.
    pub title: String,
    /// Columns, the reference first.
    pub columns: &'a [Column<'a>],
    /// View geometry of the frames.
    pub geometry: ViewGeometry,
    /// Gaze positions up to the frame shown, oldest first, in pixels; the last one is marked.
    pub gaze_px: &'a [[f32; 2]],
    /// Diameter of the fovea in degrees, drawn around the gaze.
    pub fovea_deg: f32,
}

impl Sheet<'_> {
    /// Draws the contact sheet.
    ///
    /// # Panics
    /// If the sheet has no column.
    pub fn draw(&self) -> RgbImage {
        let reference = self.columns[0].shown;
        let panel = panel_size(reference.size());
        let count = self.columns.len() as u32;
        let zoom_center = self.place_left();
        let has_visible = self.columns.iter().any(|column| column.visible_jod.is_some());
        let mut shown = "the last frame; yellow: gaze and fovea".to_owned();
        if self.gaze_px.windows(2).any(|pair| pair[0] != pair[1]) {
            shown += "; blue: path of the gaze";
        }
        if zoom_center.is_some() {
            shown += "; green: area magnified below";
        }
        let mut notes =
            vec![shown.as_str(), "error against the reference: black is zero, white is 25 % of full scale or more"];
        if has_visible {
            notes.push("what a person sees of it, with the gaze there: black is nothing, white loses 5 JOD or more");
        }
        if zoom_center.is_some() {
            notes.push("magnified area where the gaze rested before");
        }
        let rows = notes.len() as u32;
        let head = 2 * LINE_PX + GAP_PX;
        let row_height = panel[1] + LINE_PX + GAP_PX;
        let width = (count * (panel[0] + GAP_PX) + GAP_PX).max(120 * CHAR_PX);
        let mut canvas = Canvas::new(width, head + LINE_PX + rows * row_height + GAP_PX, BACKGROUND);
        canvas.heading(&self.title, GAP_PX, GAP_PX, INK);
        let row_y = |row: u32| 3 * LINE_PX + GAP_PX + row * row_height;
        for (i, column) in self.columns.iter().enumerate() {
            let x = GAP_PX + i as u32 * (panel[0] + GAP_PX);
            canvas.heading(column.name, x, LINE_PX + GAP_PX, INK);
            canvas.text(&caption(column), x, 2 * LINE_PX + GAP_PX, FAINT);
            self.draw_shown(&mut canvas, column, panel, [x, row_y(0)], zoom_center);
            self.draw_error(&mut canvas, column, panel, [x, row_y(1)]);
            if let Some(lost) = &column.visible_jod {
                let heat = lost.map(|jod| heat((jod / WORST_JOD).min(1.0)).to_array());
                canvas.put(&fit(&to_rgb8(&heat), panel), x, row_y(2));
            }
            if let Some(center) = zoom_center {
                canvas.put(&zoom(column.shown, center, panel), x, row_y(rows - 1));
                canvas.frame([x, row_y(rows - 1)], panel, 2, ZOOM);
            }
        }
        for (row, note) in notes.iter().enumerate() {
            canvas.text(note, GAP_PX, row_y(row as u32) + panel[1] + 2, FAINT);
        }
        canvas.0
    }

    fn draw_shown(
        &self,
        canvas: &mut Canvas,
        column: &Column<'_>,
        panel: [u32; 2],
        at: [u32; 2],
        zoom_center: Option<[f32; 2]>,
    ) {
        let scale = panel[0] as f32 / column.shown.width() as f32;
        let mut picture = Canvas(fit(&to_rgb8(column.shown), panel));
        let on_panel = |p: [f32; 2]| p.map(|v| (v + 0.5) * scale);
        for pair in self.gaze_px.windows(2) {
            picture.line(on_panel(pair[0]), on_panel(pair[1]), 1, TRAIL);
        }
        if let Some(gaze) = self.gaze_px.last() {
            let radius = scale * self.radius_px(*gaze);
            picture.circle(on_panel(*gaze), radius, 2, GAZE);
            picture.circle(on_panel(*gaze), 2.0, 2, GAZE);
        }
        if let Some(center) = zoom_center {
            let (corner, size) = zoom_window(column.shown.size(), center, panel);
            let corner = corner.map(|v| (v as f32 * scale) as u32);
            picture.frame(corner, size.map(|v| (v as f32 * scale) as u32), 2, ZOOM);
        }
        canvas.put(&picture.0, at[0], at[1]);
    }

    fn draw_error(&self, canvas: &mut Canvas, column: &Column<'_>, panel: [u32; 2], at: [u32; 2]) {
        let reference = self.columns[0].shown;
        let mut i = 0;
        let errors = column.shown.map(|c| {
            let r = reference.pixels()[i];
            i += 1;
            let sum: f32 = c.iter().zip(r).map(|(a, b)| (a - b).abs()).sum();
            heat((sum / 3.0 * 4.0).min(1.0)).to_array()
        });
        canvas.put(&fit(&to_rgb8(&errors), panel), at[0], at[1]);
    }

    /// Radius of the fovea around a gaze position in pixels, measured towards the center of the view.
    fn radius_px(&self, gaze: [f32; 2]) -> f32 {
        let side = if gaze[0] > 0.5 * self.geometry.size_px()[0] as f32 { -1.0 } else { 1.0 };
        let (mut low, mut high) = (0.0_f32, 2.0 * self.geometry.size_px()[0] as f32);
        for _ in 0..24 {
            let mid = 0.5 * (low + high);
            let e = self.geometry.eccentricity_deg([gaze[0] + side * mid, gaze[1]], gaze);
            if e < 0.5 * self.fovea_deg {
                low = mid;
            } else {
                high = mid;
            }
        }
        low
    }

    /// The latest position in the frame where the gaze rested, at least 8 degrees from the last gaze.
    fn place_left(&self) -> Option<[f32; 2]> {
        let last = *self.gaze_px.last()?;
        let [w, h] = self.geometry.size_px().map(|s| s as f32);
        let inside = |p: &[f32; 2]| (0.0..w).contains(&p[0]) && (0.0..h).contains(&p[1]);
        self.gaze_px.windows(4).rev().find_map(|four| {
            let p = four[3];
            let rested = self.geometry.eccentricity_deg(four[0], p) < 1.0;
            let away = self.geometry.eccentricity_deg(p, last) > 8.0;
            (rested && away && inside(&p)).then_some(p)
        })
    }
}

fn caption(column: &Column<'_>) -> String {
    let Some(scores) = column.scores else {
        return "all pixels at full rate".into();
    };
    let number = |v: Option<f64>, digits: usize| v.map_or("-".into(), |v| format!("{v:.digits$}"));
    // Frames without motion have no retained pixels.
    let last = match (scores.retained_psnr_db, scores.whole.flip) {
        (None, Some(flip)) => format!("FLIP {flip:.3}"),
        (retained, _) => format!("retained {}", number(retained, 1)),
    };
    let ssim = number(scores.whole.ssim, 3);
    let psnr = if scores.whole.mse == Some(0.0) { "exact".into() } else { number(scores.whole.psnr_db, 1) };
    // A panel holds 48 characters.
    match scores.whole.jod {
        Some(jod) => format!("JOD {jod:.2}  PSNR {psnr}  SSIM {ssim}  {last}"),
        None => format!("PSNR {psnr} dB  SSIM {ssim}  {last}"),
    }
}

fn panel_size(frame: [u32; 2]) -> [u32; 2] {
    let [w, h] = frame;
    if w >= PANEL_PX {
        return [PANEL_PX, (h * PANEL_PX / w).max(1)];
    }
    let factor = MIN_PANEL_PX.div_ceil(w);
    [w * factor, h * factor]
}

/// Scales a picture to a panel.
fn fit(picture: &RgbImage, panel: [u32; 2]) -> RgbImage {
    if picture.dimensions() == (panel[0], panel[1]) {
        return picture.clone();
    }
    let filter = if picture.width() > panel[0] { FilterType::Triangle } else { FilterType::Nearest };
    imageops::resize(picture, panel[0], panel[1], filter)
}

/// Corner and size of the magnified area, in frame pixels.
fn zoom_window(frame: [u32; 2], center: [f32; 2], panel: [u32; 2]) -> ([u32; 2], [u32; 2]) {
    let size = [0, 1].map(|i| (panel[i] / ZOOM_FACTOR).clamp(1, frame[i]));
    let corner = [0, 1].map(|i| {
        let first = center[i] - 0.5 * size[i] as f32;
        (first.max(0.0) as u32).min(frame[i] - size[i])
    });
    (corner, size)
}

fn zoom(shown: &Image<[f32; 3]>, center: [f32; 2], panel: [u32; 2]) -> RgbImage {
    let (corner, size) = zoom_window(shown.size(), center, panel);
    let mut picture = RgbImage::from_pixel(panel[0], panel[1], Rgb(BACKGROUND));
    let whole = Image::from_fn(size, |[x, y]| shown.at((x + corner[0]) as usize, (y + corner[1]) as usize));
    let (w, h) = (size[0] * ZOOM_FACTOR, size[1] * ZOOM_FACTOR);
    let enlarged = imageops::resize(&to_rgb8(&whole), w, h, FilterType::Nearest);
    imageops::replace(&mut picture, &enlarged, 0, 0);
    picture
}

//! Methods on the clip, and the scores of their frames with each class of pixels replaced.

use super::classes::{Decided, NAMES, Seen, means, near};
use super::edges::{Edges, Pictures};
use crate::error::AnyError;
use afterimage::Image;
use afterimage::cpu::{CpuAfterimage, Frame, PixelTrace};
use afterimage::internal::PixelNotes;
use afterimage::internal::{ContextDesc, Foveation, FoveationKind, Method, Reset, Settings, ViewFrame};
use afterimage_eval::clip::pixel::ExplainedPixel;
use afterimage_lab::frame::SourceFrame;
use afterimage_lab::metric::{Reference, Scorer, Tracked, encode};
use rayon::prelude::*;

/// A method with its foveation, on the clip.
pub struct Post {
    pub name: &'static str,
    post: CpuAfterimage,
    /// The context before the last frame, to explain its pixels.
    before: CpuAfterimage,
    pub scorer: Scorer,
    pub shown: Image<[f32; 3]>,
    pub decided: Decided,
}

/// The classes of a row's pixels.
#[derive(Default)]
pub struct Classes {
    pub masks: Vec<Image<bool>>,
    /// Scorers of the frames with a class of the reference, and with a class of taau.
    by_reference: Vec<Scorer>,
    by_taau: Vec<Scorer>,
    /// Number of pixels and squared error of each class, and of all.
    sums: Vec<[f64; 2]>,
    edges: Edges,
}

impl Post {
    pub fn new(name: &'static str, method: Method, foveation: Foveation, size: [u32; 2]) -> Result<Self, AnyError> {
        let settings = Settings { method, foveation, ..Settings::default() };
        let post = CpuAfterimage::new(&ContextDesc { settings, ..ContextDesc::new(size) })?;
        let decided = Decided {
            traces: Image::filled(size, PixelTrace::default()),
            shaded: Image::filled(size, true),
            stored: means(size, &vec![[0; 2]; (size[0] * size[1]) as usize]),
        };
        let (before, shown) = (post.clone(), Image::filled(size, [0.0; 3]));
        Ok(Self { name, post, before, scorer: Scorer::without_ssim(), shown, decided })
    }

    /// Shows a frame. `explained`: a pixel to print notes of, from the context before the last frame.
    pub fn show(
        &mut self,
        frame: &SourceFrame,
        view: &ViewFrame,
        index: u64,
        explained: Option<[u32; 2]>,
    ) -> Result<(), AnyError> {
        let (depth, motion) = (frame.depth.as_ref().ok_or("no depth")?, frame.motion.as_ref().ok_or("no motion")?);
        let (colors, depths, motions, views) = ([&frame.color], [depth], [motion], [*view]);
        let reset = if frame.cut { Reset::All } else { Reset::None };
        let input = Frame { depth: Some(&depths), motion: Some(&motions), reset, ..Frame::new(&colors, &views, index) };
        let size = frame.color.size();
        let mut shown = [Image::filled(size, [0.0; 3])];
        let mut traces = [self.decided.traces.clone()];
        if let Some(px) = explained {
            let mut again = self.before.clone();
            again.plan(&input)?;
            let mut notes = PixelNotes::new(0, px);
            again.process_noted(&input, &mut shown, Some(&mut traces), &mut notes)?;
            let pixel = ExplainedPixel { px, frames: 0..=usize::MAX };
            say!("{}", pixel.lines(index as usize, self.name, &notes.notes));
            return Ok(());
        }
        self.before = self.post.clone();
        if self.post.desc().settings.foveation.kind == FoveationKind::Quads {
            self.decided.shaded = self.post.plan(&input)?[0].clone();
        }
        self.post.process_traced(&input, &mut shown, &mut traces)?;
        [self.decided.traces] = traces;
        self.decided.stored = means(size, self.post.history().surfaces());
        self.shown = encode(&shown[0], 0.0);
        Ok(())
    }
}

/// A frame of the clip, for all scorers.
pub struct Scored<'a> {
    pub reference: &'a Reference<'a>,
    pub tracked: &'a Tracked,
    pub ecc_deg: &'a Image<f32>,
    /// Whether it is the first that counts.
    pub first: bool,
}

impl Scored<'_> {
    pub fn push(&self, scorer: &mut Scorer, shown: &Image<[f32; 3]>) {
        if self.first {
            scorer.restart();
        }
        scorer.push(self.reference, shown, self.tracked, self.ecc_deg);
    }
}

impl Classes {
    pub fn new() -> Self {
        let scorers = || NAMES.map(|_| Scorer::without_ssim()).to_vec();
        let sums = vec![[0.0; 2]; NAMES.len() + 1];
        Self { by_reference: scorers(), by_taau: scorers(), sums, ..Self::default() }
    }

    /// Scores a frame with each class replaced.
    pub fn push(&mut self, frame: &Scored<'_>, shown: &Image<[f32; 3]>, taau: &Image<[f32; 3]>) {
        let full = frame.reference.encoded();
        let replaced = |mask: &Image<bool>, by: &Image<[f32; 3]>| {
            Image::from_fn(shown.size(), |px| near(if near(mask, px, [0, 0]) { by } else { shown }, px, [0, 0]))
        };
        let scorers = self.by_reference.par_iter_mut().zip(&mut self.by_taau).zip(&self.masks);
        scorers.for_each(|((by_reference, by_taau), mask)| {
            frame.push(by_reference, &replaced(mask, full));
            frame.push(by_taau, &replaced(mask, taau));
        });
    }

    /// Counts a frame that is scored.
    pub fn count(&mut self, seen: &Seen<'_>, decided: &Decided, pictures: &Pictures<'_>) {
        let errors = squared_errors(pictures.shown, pictures.reference);
        let all = Image::filled(errors.size(), true);
        for (sum, mask) in self.sums.iter_mut().zip(self.masks.iter().chain([&all])) {
            for (error, _) in errors.pixels().iter().zip(mask.pixels()).filter(|(_, is_in)| **is_in) {
                *sum = [sum[0] + 1.0, sum[1] + f64::from(*error)];
            }
        }
        self.edges.add(seen, decided, &self.masks, pictures);
    }

    pub fn print(&self, jod: f64) {
        let whole = self.sums[NAMES.len()];
        say!("  {:26} pixels  sq. error  of the reference  of taau", "class");
        for (i, name) in NAMES.iter().enumerate() {
            let gained = |scorer: &Scorer| jod_of(scorer) - jod;
            say!(
                "  {name:26} {:4.1} %  {:4.1} %      {:+.3}            {:+.3}",
                100.0 * self.sums[i][0] / whole[0],
                100.0 * self.sums[i][1] / whole[1],
                gained(&self.by_reference[i]),
                gained(&self.by_taau[i]),
            );
        }
        self.edges.print();
    }
}

pub fn jod_of(scorer: &Scorer) -> f64 {
    scorer.scores().whole.jod.unwrap_or(f64::NAN)
}

/// Squared differences of sRGB-encoded colors.
pub fn squared_errors(shown: &Image<[f32; 3]>, reference: &Image<[f32; 3]>) -> Image<f32> {
    Image::from_fn(shown.size(), |px| {
        let [a, b] = [shown, reference].map(|image| glam::Vec3::from(near(image, px, [0, 0])));
        (a - b).length_squared()
    })
}

//! Frames of one view for the methods that store surfaces, and their results.

pub use crate::images::{Images, OneView, noise};
pub use afterimage::cpu::{CpuAfterimage, Frame};
pub use afterimage::kernel::debug_view::PixelTrace;
pub use afterimage::kernel::surface::{Surface, unpack_surface};
pub use afterimage::{
    ContextDesc, Exposure, Foveation, FrameStats, Gaze, Image, MethodKind, Reset, Settings, ViewFrame, ViewGeometry,
};
pub use afterimage_testing::Draws;

pub const SIZE: [u32; 2] = [52, 41];
pub const METHODS: [MethodKind; 3] = [MethodKind::Smr, MethodKind::Taa, MethodKind::Taau];
pub type Color = Image<[f32; 3]>;

/// Four pixels a block at the most: levels 0 to 4 of the mip chain, so that positions 16 pixels apart are alike.
pub fn settings(method: MethodKind) -> Settings {
    let foveation = Foveation { rate_mid: 4, rate_far: 4, ..Foveation::default() };
    Settings { method: method.into(), foveation, ..Settings::default() }
}

pub fn context(method: MethodKind) -> CpuAfterimage {
    CpuAfterimage::new(&ContextDesc { settings: settings(method), ..ContextDesc::new(SIZE) }).unwrap()
}

/// One view of one frame.
#[derive(Clone)]
pub struct Input {
    pub color: Color,
    pub lod: Option<Image<f32>>,
    pub depth: Option<Image<f32>>,
    pub motion: Option<Image<[f32; 2]>>,
    pub trust: Option<Image<f32>>,
    pub noise: Option<Image<[f32; 2]>>,
    pub gaze: Gaze,
    pub camera: Option<[[f32; 4]; 4]>,
    pub reset: Reset,
    pub exposure: Exposure,
}

impl Input {
    /// Full rate everywhere, nothing moves.
    pub fn sharp(color: Color) -> Self {
        let lod = Some(Image::filled(color.size(), 0.0));
        Self {
            color,
            lod,
            depth: None,
            motion: None,
            trust: None,
            noise: None,
            gaze: Gaze::Lost,
            camera: None,
            reset: Reset::None,
            exposure: Exposure::Same,
        }
    }

    pub fn at_lod(color: Color, lod: f32) -> Self {
        let lod = Some(Image::filled(color.size(), lod));
        Self { lod, ..Self::sharp(color) }
    }

    pub fn view(&self) -> OneView<'_> {
        let geometry = ViewGeometry::flat(self.color.size(), 70.0).unwrap();
        let facts = ViewFrame { previous_from_current: self.camera, ..ViewFrame::new(geometry, self.gaze) };
        OneView {
            facts,
            color: &self.color,
            depth: self.depth.as_ref(),
            motion: self.motion.as_ref(),
            trust: self.trust.as_ref(),
            lod: self.lod.as_ref(),
            noise: self.noise.as_ref(),
        }
    }
}

/// Result of a view.
#[derive(Clone, Debug, PartialEq)]
pub struct Made {
    pub shown: Color,
    pub words: Vec<[u32; 2]>,
    pub trace: Image<PixelTrace>,
    pub stats: FrameStats,
}

impl Made {
    pub fn surfaces(&self) -> Vec<Surface> {
        self.words.iter().map(|&w| unpack_surface(w)).collect()
    }

    /// Stored colors as an image.
    pub fn stored(&self) -> Color {
        let colors = self.surfaces().iter().map(|s| s.color.to_array()).collect();
        Image::from_pixels(self.shown.size(), colors).unwrap()
    }
}

/// One frame of several views; the reset and the exposure are the first one's.
pub fn step_views(post: &mut CpuAfterimage, index: u64, inputs: &[&Input]) -> Vec<Made> {
    let size = inputs[0].color.size();
    let mut shown = vec![Image::filled(size, [f32::NAN; 3]); inputs.len()];
    let mut trace = vec![Image::filled(size, PixelTrace::default()); inputs.len()];
    let views: Vec<_> = inputs.iter().map(|i| i.view()).collect();
    let images = Images::of(&views);
    let frame = Frame { reset: inputs[0].reset, exposure: inputs[0].exposure, ..images.frame(index) };
    let stats = post.process_traced(&frame, &mut shown, &mut trace).unwrap();
    let words = post.history().surfaces().chunks(shown[0].pixels().len());
    let made = shown.into_iter().zip(words).zip(trace);
    made.map(|((shown, words), trace)| Made { shown, words: words.to_vec(), trace, stats }).collect()
}

pub fn step(post: &mut CpuAfterimage, index: u64, input: &Input) -> Made {
    step_views(post, index, &[input]).remove(0)
}

/// Mip levels of an image in f64, with trilinear lookup: a second implementation, from the definition of the foveation.
pub struct LowPass(pub Vec<Image<[f64; 3]>>);

impl LowPass {
    pub fn new(full: &Color, count: usize) -> Self {
        let mut levels = vec![full.map(|c| c.map(f64::from))];
        for l in 0..count {
            let finer = &levels[l];
            let [w, h] = finer.size();
            let level = Image::from_fn([w.div_ceil(2), h.div_ceil(2)], |[x, y]| {
                let corners = [(0, 0), (1, 0), (0, 1), (1, 1)];
                let taps =
                    corners.map(|(i, j)| finer.at((2 * x + i).min(w - 1) as usize, (2 * y + j).min(h - 1) as usize));
                [0, 1, 2].map(|c| taps.iter().map(|t| t[c]).sum::<f64>() / 4.0)
            });
            levels.push(level);
        }
        Self(levels)
    }

    pub fn bilinear(&self, at: [f64; 2], level: usize) -> [f64; 3] {
        let image = &self.0[level];
        let axis = |i: usize| {
            let len = image.size()[i] as usize;
            let v = ((at[i] + 0.5) / f64::from(1 << level) - 0.5).clamp(0.0, (len - 1) as f64);
            (v as usize, (v as usize + 1).min(len - 1), v.fract())
        };
        let ((x0, x1, fx), (y0, y1, fy)) = (axis(0), axis(1));
        [0, 1, 2].map(|c| {
            let top = image.at(x0, y0)[c] * (1.0 - fx) + image.at(x1, y0)[c] * fx;
            let bottom = image.at(x0, y1)[c] * (1.0 - fx) + image.at(x1, y1)[c] * fx;
            top * (1.0 - fy) + bottom * fy
        })
    }

    pub fn at(&self, at: [f64; 2], lod: f32) -> [f32; 3] {
        let level = lod as usize;
        let (fine, coarse) = (self.bilinear(at, level), self.bilinear(at, level + 1));
        let t = f64::from(lod).fract();
        [0, 1, 2].map(|c| (fine[c] + (coarse[c] - fine[c]) * t) as f32)
    }

    /// The image as a foveating renderer would deliver it.
    pub fn render(&self, lods: &Image<f32>) -> Color {
        Image::from_fn(lods.size(), |[x, y]| self.at([f64::from(x), f64::from(y)], lods.at(x as usize, y as usize)))
    }
}

pub fn bits(color: [f32; 3]) -> [u32; 3] {
    color.map(f32::to_bits)
}

/// Stored level of detail: in sevenths, up to 62 of them.
pub fn stored_lod(lod: f32) -> f32 {
    (lod * 7.0).round().min(62.0) / 7.0
}

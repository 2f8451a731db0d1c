//! Frames of one view for the methods that store surfaces, and their results.

pub use crate::images::{Images, OneView, noise};
pub use crate::low_pass::LowPass;
pub use crate::surfaces_hard::{METHODS, SIZE, settings};
pub use afterimage::cpu::{CpuAfterimage, Frame};
pub use afterimage::kernel::debug_view::PixelTrace;
pub use afterimage::kernel::surface::{Surface, unpack_surface};
pub use afterimage::{
    ContextDesc, Exposure, FrameStats, Gaze, Image, MethodKind, Reset, Settings, ViewFrame, ViewGeometry,
};
pub use afterimage_testing::Draws;

pub type Color = Image<[f32; 3]>;

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

pub fn bits(color: [f32; 3]) -> [u32; 3] {
    color.map(f32::to_bits)
}

/// Stored level of detail: in sevenths, up to 62 of them.
pub fn stored_lod(lod: f32) -> f32 {
    (lod * 7.0).round().min(62.0) / 7.0
}

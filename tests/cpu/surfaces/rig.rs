//! Frames of one view for the methods that store surfaces, and their results.

pub use crate::depth_hard::{Color, Made, Steps};
pub use crate::images::{Images, View, held_words, noise};
pub use crate::low_pass::LowPass;
pub use crate::surfaces_hard::{METHODS, SIZE, at_lod, settings, sharp};
pub use afterimage::cpu::CpuAfterimage;
pub use afterimage::kernel::debug_view::PixelTrace;
pub use afterimage::kernel::surface::{Surface, unpack_surface};
pub use afterimage::{ContextDesc, Exposure, Image, MethodKind, Reset, Settings, ViewGeometry};
pub use afterimage_testing::Draws;

pub fn context(method: MethodKind) -> CpuAfterimage {
    context_of(SIZE, settings(method))
}

pub fn context_of(size: [u32; 2], settings: Settings) -> CpuAfterimage {
    CpuAfterimage::new(&ContextDesc { settings, ..ContextDesc::new(size) }).unwrap()
}

/// One frame of several views.
pub fn step_views(post: &mut CpuAfterimage, index: u64, views: &[&View]) -> Vec<Made> {
    let size = views[0].color.size();
    let mut shown = vec![Image::filled(size, [f32::NAN; 3]); views.len()];
    let mut trace = vec![Image::filled(size, PixelTrace::default()); views.len()];
    let views: Vec<_> = views.iter().map(|view| view.one()).collect();
    let stats = post.process_traced(&Images::of(&views).frame(index), &mut shown, &mut trace).unwrap();
    let words = held_words(post);
    let made = shown.into_iter().zip(words.chunks((size[0] * size[1]) as usize)).zip(trace);
    made.map(|((shown, words), trace)| Made { shown, words: words.to_vec(), trace, stats }).collect()
}

pub fn step(post: &mut CpuAfterimage, index: u64, view: &View) -> Made {
    post.make(index, view, Exposure::Same, Reset::None)
}

pub fn bits(color: [f32; 3]) -> [u32; 3] {
    color.map(f32::to_bits)
}

/// Stored level of detail: in sevenths, up to 62 of them.
pub fn stored_lod(lod: f32) -> f32 {
    (lod * 7.0).round().min(62.0) / 7.0
}

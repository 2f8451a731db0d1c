//! Images of frames, view by view, in the form of the CPU executor's inputs.

use afterimage::cpu::Frame;
use afterimage::{Image, ViewFrame};

/// All images of one view.
#[derive(Clone, Copy)]
pub struct OneView<'a> {
    pub facts: ViewFrame,
    pub color: &'a Image<[f32; 3]>,
    pub depth: Option<&'a Image<f32>>,
    pub motion: Option<&'a Image<[f32; 2]>>,
    pub trust: Option<&'a Image<f32>>,
    pub lod: Option<&'a Image<f32>>,
    pub noise: Option<&'a Image<[f32; 2]>>,
}

impl<'a> OneView<'a> {
    /// Without optional inputs.
    pub fn new(facts: ViewFrame, color: &'a Image<[f32; 3]>) -> Self {
        Self { facts, color, depth: None, motion: None, trust: None, lod: None, noise: None }
    }
}

/// Images of all views, input by input. All views have an input, or none.
pub struct Images<'a> {
    views: Vec<ViewFrame>,
    color: Vec<&'a Image<[f32; 3]>>,
    depth: Vec<&'a Image<f32>>,
    motion: Vec<&'a Image<[f32; 2]>>,
    trust: Vec<&'a Image<f32>>,
    lod: Vec<&'a Image<f32>>,
    noise: Vec<&'a Image<[f32; 2]>>,
}

impl<'a> Images<'a> {
    pub fn of(views: &[OneView<'a>]) -> Self {
        Self {
            views: views.iter().map(|v| v.facts).collect(),
            color: views.iter().map(|v| v.color).collect(),
            depth: views.iter().filter_map(|v| v.depth).collect(),
            motion: views.iter().filter_map(|v| v.motion).collect(),
            trust: views.iter().filter_map(|v| v.trust).collect(),
            lod: views.iter().filter_map(|v| v.lod).collect(),
            noise: views.iter().filter_map(|v| v.noise).collect(),
        }
    }

    pub fn frame(&self, index: u64) -> Frame<'_> {
        Frame {
            depth: given(&self.depth),
            motion: given(&self.motion),
            trust: given(&self.trust),
            lod: given(&self.lod),
            noise: given(&self.noise),
            ..Frame::new(&self.color, &self.views, index)
        }
    }
}

fn given<T>(images: &[T]) -> Option<&[T]> {
    (!images.is_empty()).then_some(images)
}

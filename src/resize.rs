//! Change of a context's size that keeps history, for both executors.

use crate::uniforms::ViewState;

/// Sizes of the views, and ratios that follow from them. `Resize` in `shaders/shared/resize_uniforms.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "gpu", derive(bytemuck::Pod, bytemuck::Zeroable))]
pub(crate) struct Resize {
    pub size_px: [u32; 2],
    pub old_size_px: [u32; 2],
    /// Old size over new size, for each axis.
    pub ratio: [f32; 2],
    /// Change of levels of detail: log2 of the new over the old edge of a pixel's area.
    pub lod_shift: f32,
    /// Padding to a multiple of 8 bytes.
    unused: u32,
}

impl Resize {
    pub fn new(old_size_px: [u32; 2], size_px: [u32; 2]) -> Self {
        let ratio = [0, 1].map(|i| old_size_px[i] as f32 / size_px[i] as f32);
        Self { size_px, old_size_px, ratio, lod_shift: -0.5 * (ratio[0] * ratio[1]).log2(), unused: 0 }
    }

    /// Converts the state of a view to pixels of the new size.
    pub fn state(&self, state: ViewState) -> ViewState {
        let position = |px: [f32; 2]| [0, 1].map(|i| (px[i] + 0.5) / self.ratio[i] - 0.5);
        let vector = |px: [f32; 2]| [0, 1].map(|i| px[i] / self.ratio[i]);
        ViewState {
            gaze_px: state.gaze_px.map(position),
            jitter_px: vector(state.jitter_px),
            previous_jitter_px: vector(state.previous_jitter_px),
            // The view directions at the edges stay the same.
            rays: None,
            previous_rays: None,
            exposure: state.exposure,
            previous_exposure: state.previous_exposure,
        }
    }
}

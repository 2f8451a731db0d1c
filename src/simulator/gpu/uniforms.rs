//! Uniforms of the simulators.

use crate::context::ContextDesc;
use crate::foveation::FoveationKind;
use crate::uniforms::{MAX_VIEWS, ViewState, ViewUniforms};
use crate::view::ViewFrame;
use bytemuck::{Pod, Zeroable};

/// `FoveationUniforms` in `shaders/foveation/foveated_views.wgsl`; the fields are those of `FrameUniforms`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub struct FoveationUniforms {
    pub size: [u32; 2],
    pub coarsest: u32,
    pub fovea_radius_deg: f32,
    pub mid_radius_deg: f32,
    pub blend_deg: f32,
    pub lod_mid: f32,
    pub lod_far: f32,
    /// One entry a view.
    pub views: [ViewUniforms; MAX_VIEWS],
}

impl FoveationUniforms {
    /// Uniforms of a frame. `state`: state of the views after this frame.
    pub(super) fn new(desc: &ContextDesc, views: &[ViewFrame], state: &[ViewState]) -> Self {
        let foveation = &desc.settings.foveation;
        let [lod_mid, lod_far] = foveation.lods();
        let mut uniforms = Self {
            size: desc.size_px,
            coarsest: if matches!(foveation.kind, FoveationKind::Off | FoveationKind::Quads) {
                0
            } else {
                foveation.max_level()
            },
            fovea_radius_deg: foveation.fovea_radius_deg(),
            mid_radius_deg: foveation.mid_radius_deg(),
            blend_deg: foveation.blend_deg,
            lod_mid,
            lod_far,
            ..Self::default()
        };
        for (i, ((to, view), state)) in uniforms.views.iter_mut().zip(views).zip(state).enumerate() {
            *to = ViewUniforms::new(desc, view, state, i, 0);
        }
        uniforms
    }
}

//! Uniforms of the simulators. A test checks order, offsets and sizes against the WGSL.

use crate::context::ContextDesc;
use crate::foveation::Filter;
use crate::gpu::MAX_VIEWS;
use crate::uniforms::{ViewState, ViewUniforms};
use crate::view::ViewFrame;
use bytemuck::{Pod, Zeroable};

/// `FoveationUniforms` in `shaders/foveation/foveated_views.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub struct FoveationUniforms {
    /// Width and height of a view in pixels.
    pub size: [u32; 2],
    /// Coarsest level.
    pub coarsest: u32,
    /// Radius of the fovea.
    pub fovea_radius_deg: f32,
    /// Radius of the middle region.
    pub mid_radius_deg: f32,
    /// Width of the blends outside the radii.
    pub blend_deg: f32,
    /// Level of detail of the middle region.
    pub lod_mid: f32,
    /// Level of detail of the periphery.
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
            coarsest: if matches!(foveation.filter, Filter::Off | Filter::Sparse | Filter::Quads) {
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

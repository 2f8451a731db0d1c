//! Fills depth and motion of every pixel of a sparse frame that has them at its samples only. CPU twin:
//! `src/cpu/fill_geometry.rs`.

use super::Textures;
use super::binding::Binding;
use super::compute::{ComputeShader, Sources};
use super::plane::{Plane, PlaneDesc};
use super::stage::{Job, Passes, Specialization};
use crate::context::ContextDesc;
use crate::convention::DepthConvention;
use std::sync::OnceLock;
use wgpu::{Device, Texture, TextureFormat, TextureUsages};

/// The stage. Its pass is made at the first frame with geometry at samples.
#[derive(Debug)]
pub(super) struct GeometryFill {
    sources: Sources,
    pass: OnceLock<GeometryPass>,
}

/// The pass, and the filled distances and motion vectors of the current frame.
#[derive(Debug)]
struct GeometryPass {
    shader: ComputeShader,
    depth: Plane,
    motion: Plane,
}

impl GeometryFill {
    pub fn new(sources: &Sources) -> Self {
        Self { sources: sources.clone(), pass: OnceLock::new() }
    }

    fn pass(&self, device: &Device, desc: &ContextDesc) -> &GeometryPass {
        self.pass.get_or_init(|| {
            let [depth, motion] = planes(desc).map(|plane| plane.create(device));
            GeometryPass { shader: self.sources.shader(device, "fill_geometry_pass"), depth, motion }
        })
    }
}

impl Passes for GeometryFill {
    fn resize(&mut self, device: &Device, desc: &ContextDesc) {
        if let Some(pass) = self.pass.get_mut() {
            [pass.depth, pass.motion] = planes(desc).map(|plane| plane.create(device));
        }
    }

    fn prewarm(&self, device: &Device, desc: &ContextDesc, special: &mut Specialization) {
        if special.is_at_samples {
            special.pipeline(device, desc, &self.pass(device, desc).shader);
            special.fill(desc);
        }
    }

    fn shaders(&self) -> Vec<&ComputeShader> {
        self.pass.get().map(|pass| &pass.shader).into_iter().collect()
    }

    fn added_bytes(&self) -> u64 {
        let bytes = |plane: &Plane| plane.desc.bytes();
        self.pass.get().map_or(0, |pass| bytes(&pass.depth) + bytes(&pass.motion))
    }

    fn filled_depth(&self) -> Option<&Texture> {
        self.pass.get().map(|pass| &pass.depth.texture)
    }

    fn record<'a>(&'a self, job: &mut Job<'a>) {
        if !job.special.is_at_samples {
            return;
        }
        let GeometryPass { shader, depth, motion } = self.pass(job.device, job.desc);
        let own = [(Binding::Write, (&depth.whole).into()), (Binding::WriteSecond, (&motion.whole).into())];
        for batch in job.batches() {
            job.dispatch(shader, &batch, &own, job.desc.size_px);
        }
        // The following stages get the filled geometry.
        let map = DepthConvention::Linear.disparity_map();
        job.uniforms.motion_scale = [1.0; 2];
        for view in &mut job.uniforms.views {
            (view.disparity_a, view.disparity_b) = (map.a, map.b);
            view.disparity_flags = map.flags();
            view.motion_offset = [0.0; 2];
        }
        let given = &mut job.textures[Binding::Depth as usize];
        *given = given.map(|_| Textures::Layers(&depth.texture));
        let has_motion = job.special.fill(job.desc);
        job.textures[Binding::Motion as usize] = has_motion.then_some(Textures::Layers(&motion.texture));
    }
}

fn planes(desc: &ContextDesc) -> [PlaneDesc; 2] {
    [TextureFormat::R32Float, TextureFormat::Rg32Float].map(|format| PlaneDesc {
        usage: TextureUsages::COPY_SRC,
        ..PlaneDesc::new("afterimage filled geometry", format, desc.size_px, desc.view_count)
    })
}

//! Comparison of the samples of a sparse frame with history, before the pass of smr that reconstructs its pixels. CPU
//! twin: `src/cpu/sparse_pass/mod.rs`.

use super::binding::Binding;
use super::compute::{ComputeShader, Sources};
use super::plane::{Plane, PlaneDesc};
use super::stage::{Job, Passes};
use super::textures::Batch;
use super::uniforms::{LatticeUniforms, ViewLattices};
use crate::context::ContextDesc;
use crate::lattice::Lattices;
use crate::uniforms::results_size;
use crate::view::ViewFrame;
use wgpu::{Device, TextureFormat};

/// Passes over the samples, and their results.
#[derive(Debug)]
pub(super) struct SamplePasses {
    observe: ComputeShader,
    light: ComputeShader,
    observed: Plane,
    lights: Plane,
}

impl SamplePasses {
    pub fn new(device: &Device, desc: &ContextDesc, sources: &Sources) -> Self {
        Self {
            observe: sources.shader(device, "sparse_observe_pass"),
            light: sources.shader(device, "sparse_light_pass"),
            observed: results(desc).create(device),
            lights: results(desc).create(device),
        }
    }
}

impl Passes for SamplePasses {
    fn resize(&mut self, device: &Device, desc: &ContextDesc) {
        [self.observed, self.lights] = [(); 2].map(|()| results(desc).create(device));
    }

    fn shaders(&self) -> Vec<&ComputeShader> {
        vec![&self.observe, &self.light]
    }

    fn record<'a>(&'a self, job: &mut Job<'a>) {
        let observe = [(Binding::Write, (&self.observed.whole).into())];
        let light = [(Binding::Read, (&self.observed.whole).into()), (Binding::Write, (&self.lights.whole).into())];
        for batch in job.batches() {
            for (shader, own) in [(&self.observe, &observe[..]), (&self.light, &light[..])] {
                for (lattice, points) in samples(job.views, &batch, job.desc.size_px) {
                    job.uniforms.lattice = lattice;
                    job.dispatch(shader, &batch, own, points);
                }
            }
        }
        job.uniforms.lattice = 0;
        job.lights = Some(&self.lights.whole);
    }
}

/// Lattices of a batch of views whose samples are compared, and the largest number of their samples along x and y.
fn samples(views: &[ViewFrame], batch: &Batch, size_px: [u32; 2]) -> impl Iterator<Item = (u32, [u32; 2])> {
    let mut most = [[0; 2]; Lattices::MAX];
    for view in &views[batch.views.start as usize..batch.views.end as usize] {
        let lattices =
            view.lattices.as_ref().map_or_else(ViewLattices::default, |l| LatticeUniforms::of_view(l, size_px));
        for (most, lattice) in most.iter_mut().zip(lattices).filter(|(_, lattice)| lattice.level > 0) {
            *most = [0, 1].map(|i| most[i].max(lattice.points[i]));
        }
    }
    (0..).zip(most).filter(|(_, points)| points.iter().all(|&n| n > 0))
}

/// Results for the samples of all views: the observations, or the lights.
pub(super) fn results(desc: &ContextDesc) -> PlaneDesc {
    PlaneDesc::new("afterimage samples", TextureFormat::Rg32Uint, results_size(desc.size_px), desc.view_count)
}

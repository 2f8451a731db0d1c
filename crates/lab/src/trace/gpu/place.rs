//! Copies samples of lattices from their films to their pixels, on the device.

use crate::device::Headless;
use crate::frame::DeviceSamples;
use crate::shader::SHADERS;
use afterimage::Lattice;
use afterimage::internal::{ComputeShader, array_view, filled};
use bytemuck::{Pod, Zeroable};
use wgpu::{BindingResource, BufferUsages};

/// Points along x of a dispatch; twin of `COLUMNS` in `shaders/trace/place_pass.wgsl`.
const COLUMNS: u32 = 4096;

/// A sampled point of a lattice. Twin of `points` in `shaders/trace/place_pass.wgsl`.
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[repr(C)]
pub struct SampledPoint {
    /// x in the low 16 bits, y in the high 16 bits.
    pub point: u32,
    /// Distance along the view axis in metres; infinity where the ray hits no surface.
    pub depth: f32,
    /// Pixels, y down, previous minus current.
    pub motion: [f32; 2],
}

/// Twin of `Placement` in `shaders/trace/place_pass.wgsl`.
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[repr(C)]
struct Placement {
    film_first: [u32; 2],
    film_size: [u32; 2],
    first_px: [u32; 2],
    step: u32,
    count: u32,
    missing: u32,
    unused: u32,
}

/// The kernel that writes samples to their pixels.
#[derive(Debug)]
pub(super) struct Place {
    shader: ComputeShader,
}

impl Place {
    pub fn new(device: &wgpu::Device) -> Self {
        Self { shader: ComputeShader::new(device, "place", &SHADERS.compose("place_pass").source) }
    }

    /// Writes `points` of a lattice to `samples`. `film`: their film, whose window is `film_first` and `film_size`;
    /// points without samples in the film become NaN.
    pub fn submit(
        &self,
        gpu: &Headless,
        lattice: &Lattice,
        points: &[SampledPoint],
        film: &wgpu::Buffer,
        [film_first, film_size]: [[u32; 2]; 2],
        samples: &DeviceSamples,
    ) {
        let device = &gpu.device;
        let count = points.len() as u32;
        if count == 0 {
            return;
        }
        let missing = f32::NAN.to_bits();
        let (first_px, step) = (lattice.first_px, lattice.step);
        let placement = Placement { film_first, film_size, first_px, step, count, missing, unused: 0 };
        let placement = filled(device, "placement", bytemuck::bytes_of(&placement), BufferUsages::UNIFORM);
        let points = filled(device, "points", bytemuck::cast_slice(points), BufferUsages::STORAGE);
        let DeviceSamples { color, noise, depth, motion, .. } = samples;
        let views = [color, noise, depth, motion].map(array_view);
        let buffers = [&placement, &points, film].map(wgpu::Buffer::as_entire_binding);
        let resources = buffers.into_iter().chain(views.iter().map(BindingResource::TextureView));
        let group = self.shader.group(device, resources);
        let mut encoder = device.create_command_encoder(&Default::default());
        let mut pass = encoder.begin_compute_pass(&Default::default());
        let size = [count.min(COLUMNS), count.div_ceil(COLUMNS)];
        self.shader.dispatch(device, &mut pass, &[], &group, size, 1);
        drop(pass);
        gpu.queue.submit([encoder.finish()]);
    }
}

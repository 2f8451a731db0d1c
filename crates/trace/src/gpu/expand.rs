//! Splits work into batches, and expands spans of pixels into lists of samples on the device.

use crate::shader::SHADERS;
use crate::work::Spans;
use afterimage::internal::{ComputeShader, filled};
use afterimage_lab::device::empty_buffer;
use bytemuck::{Pod, Zeroable};
use wgpu::{BindGroup, Buffer, BufferUsages, CommandEncoder, Device};

/// Number of paths in flight.
pub const BATCH: u32 = 1 << 17;
/// Bytes of an item: pixel and number of the sample.
const ITEM_BYTES: u64 = 8;

/// A part of the work that is traced at once. Twin of `Batch` in `shaders/trace/expand_pass.wgsl`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub(super) struct Batch {
    first_pixel: u32,
    first_sample: u32,
    samples: u32,
    pub items: u32,
}

/// Largest number of samples of one pixel in a batch. Software Vulkan leaves a loop after 65,535 iterations, and
/// `resolve` has one iteration per sample.
const MAX_SAMPLES_PER_PIXEL: u32 = 1 << 15;

/// Splits the work into batches. A pixel's running mean continues from one batch to the next.
pub(super) fn batches(spans: &Spans) -> Vec<Batch> {
    let (pixels, samples) = (spans.pixels(), spans.samples());
    let samples_at_once = (samples.len() as u32).clamp(1, MAX_SAMPLES_PER_PIXEL);
    let pixels_at_once = BATCH / samples_at_once;
    let mut batches = vec![];
    if spans.is_empty() {
        return batches;
    }
    for first_pixel in (0..pixels).step_by(pixels_at_once as usize) {
        let count = pixels_at_once.min(pixels - first_pixel);
        for first_sample in samples.clone().step_by(samples_at_once as usize) {
            let samples = samples_at_once.min(samples.end - first_sample);
            batches.push(Batch { first_pixel, first_sample, samples, items: count * samples });
        }
    }
    batches
}

/// The kernel that expands spans into lists.
#[derive(Debug)]
pub(super) struct Expand(ComputeShader);

/// Items of the current batch on the device, and what they are expanded from.
pub(super) struct Expansion {
    pub items: Buffer,
    uniforms: Buffer,
    bound: BindGroup,
}

impl Expand {
    pub fn new(device: &Device) -> Self {
        Self(ComputeShader::new(device, "expand", &SHADERS.compose("expand_pass").source))
    }

    /// Uploads the work, with room for a batch of its items.
    pub fn expansion(&self, device: &Device, work: &Spans) -> Expansion {
        let spans = filled(device, "spans", bytemuck::cast_slice(work.spans()), BufferUsages::STORAGE);
        let items = empty_buffer(device, "work", u64::from(BATCH) * ITEM_BYTES, BufferUsages::STORAGE);
        let uniform = BufferUsages::UNIFORM | BufferUsages::COPY_DST;
        let uniforms = empty_buffer(device, "batch", size_of::<Batch>() as u64, uniform);
        let bound = self.0.group(device, [&uniforms, &spans, &items].map(Buffer::as_entire_binding));
        Expansion { items, uniforms, bound }
    }

    /// Records the expansion of `batch`.
    pub fn record(&self, device: &Device, encoder: &mut CommandEncoder, expansion: &Expansion, batch: &Batch) {
        let contents = bytemuck::bytes_of(batch);
        let staged = filled(device, "batch", contents, BufferUsages::COPY_SRC);
        encoder.copy_buffer_to_buffer(&staged, 0, &expansion.uniforms, 0, contents.len() as u64);
        let mut pass = encoder.begin_compute_pass(&Default::default());
        self.0.dispatch(device, &mut pass, &[], &expansion.bound, [batch.items, 1], 1);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn batches_cover_the_work_once_in_whole_pixels() {
        for (width, samples) in [(1000, 1), (700, 32), (3, BATCH - 1), (3, BATCH), (2, BATCH + 5), (1, 3 * BATCH)] {
            let spans = Spans::uniform(width, 0..3, 7..7 + samples);
            let batches = batches(&spans);
            assert!(batches.iter().all(|b| b.samples <= MAX_SAMPLES_PER_PIXEL), "a loop cannot have more");
            assert_eq!(batches.iter().map(|b| u64::from(b.items)).sum::<u64>(), spans.len());
            assert!(batches.iter().all(|b| b.items <= BATCH && b.items > 0));
            let mut done = std::collections::BTreeMap::new();
            for batch in &batches {
                for pixel in batch.first_pixel..batch.first_pixel + batch.items / batch.samples {
                    let end = done.entry(pixel).or_insert(7);
                    assert_eq!(*end, batch.first_sample, "samples of a pixel come in order");
                    *end += batch.samples;
                }
            }
            assert!(done.len() == spans.pixels() as usize && done.values().all(|&end| end == 7 + samples));
        }
        assert!(batches(&Spans::default()).is_empty());
    }
}

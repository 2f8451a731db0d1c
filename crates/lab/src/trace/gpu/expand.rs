//! Splits work into batches, and expands spans of pixels into lists of samples on the device.

use super::compute::{Kernel, bind_group, empty_buffer};
use super::passes::WORKGROUP;
use crate::shader::SHADERS;
use crate::trace::work::{Spans, Work, WorkItem};
use afterimage::internal::filled;
use bytemuck::{Pod, Zeroable};
use wgpu::BufferUsages;

/// Number of paths in flight.
pub const BATCH: u32 = 1 << 17;

/// A part of the work that is traced at once.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Batch {
    /// Index of its first item in the list.
    pub first_item: u32,
    pub items: u32,
    /// For spans: uniforms of the `expand` kernel.
    expansion: Option<BatchUniforms>,
}

/// Twin of `Batch` in `shaders/trace/expand_pass.wgsl`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
struct BatchUniforms {
    first_pixel: u32,
    first_sample: u32,
    samples: u32,
    items: u32,
}

/// Largest number of samples of one pixel in a batch. Software Vulkan leaves a loop after 65,535 iterations, and
/// `resolve` has one iteration per sample.
const MAX_SAMPLES_PER_PIXEL: u32 = 1 << 15;

/// Splits the work into batches. A pixel's running mean continues from one batch to the next.
pub(super) fn batches(work: Work) -> Vec<Batch> {
    match work {
        Work::List(items) => of_list(items),
        Work::Spans(spans) => of_spans(spans),
    }
}

fn of_list(items: &[WorkItem]) -> Vec<Batch> {
    let mut batches = vec![];
    let mut first = 0;
    while first < items.len() {
        let batch = &items[first..items.len().min(first + BATCH as usize)];
        let mut count = 0;
        for run in batch.chunk_by(|a, b| a.pixel == b.pixel) {
            count += run.len().min(MAX_SAMPLES_PER_PIXEL as usize);
            if run.len() > MAX_SAMPLES_PER_PIXEL as usize {
                break;
            }
        }
        batches.push(Batch { first_item: first as u32, items: count as u32, expansion: None });
        first += count;
    }
    batches
}

fn of_spans(spans: &Spans) -> Vec<Batch> {
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
            let items = count * samples;
            let expansion = Some(BatchUniforms { first_pixel, first_sample, samples, items });
            batches.push(Batch { first_item: 0, items, expansion });
        }
    }
    batches
}

/// The kernel that expands spans into lists.
#[derive(Debug)]
pub(super) struct Expand {
    pipeline: wgpu::ComputePipeline,
}

/// Spans on the device, and the uniforms of the current batch.
pub(super) struct Expansion {
    uniforms: wgpu::Buffer,
    bound: wgpu::BindGroup,
}

impl Expand {
    pub fn new(device: &wgpu::Device) -> Self {
        let source = SHADERS.compose("expand_pass").source;
        let kernel = Kernel { module: "expand_pass", source, entry: "expand", layout: None, constants: &[] };
        Self { pipeline: kernel.pipeline(device) }
    }

    /// Device list of the work: uploaded, or an empty buffer that each batch's spans are expanded into.
    pub fn list(&self, device: &wgpu::Device, work: Work) -> (wgpu::Buffer, Option<Expansion>) {
        let stored = |label, contents: &[u8]| filled(device, label, contents, BufferUsages::STORAGE);
        let spans = match work {
            Work::List(items) => return (stored("work", bytemuck::cast_slice(items)), None),
            Work::Spans(spans) => stored("spans", bytemuck::cast_slice(spans.spans())),
        };
        let list = empty_buffer(device, "work", u64::from(BATCH) * size_of::<WorkItem>() as u64, BufferUsages::STORAGE);
        let uniforms = empty_buffer(
            device,
            "batch",
            size_of::<BatchUniforms>() as u64,
            BufferUsages::UNIFORM | BufferUsages::COPY_DST,
        );
        let resources = [&uniforms, &spans, &list].map(wgpu::Buffer::as_entire_binding);
        let bound = bind_group(device, "expand", &self.pipeline.get_bind_group_layout(0), &resources);
        (list, Some(Expansion { uniforms, bound }))
    }

    /// Records the expansion of `batch`, if the work consists of spans.
    pub fn record(
        &self,
        device: &wgpu::Device,
        encoder: &mut wgpu::CommandEncoder,
        expansion: Option<&Expansion>,
        batch: &Batch,
    ) {
        let Some((expansion, uniforms)) = expansion.zip(batch.expansion) else { return };
        let contents = bytemuck::bytes_of(&uniforms);
        let staged = filled(device, "batch", contents, BufferUsages::COPY_SRC);
        encoder.copy_buffer_to_buffer(&staged, 0, &expansion.uniforms, 0, contents.len() as u64);
        let mut pass = encoder.begin_compute_pass(&Default::default());
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &expansion.bound, &[]);
        pass.dispatch_workgroups(uniforms.items.div_ceil(WORKGROUP), 1, 1);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::trace::work::uniform;

    #[test]
    fn batches_cover_the_work_once_in_whole_pixels() {
        for (width, samples) in [(1000, 1), (700, 32), (3, BATCH - 1), (3, BATCH), (2, BATCH + 5), (1, 3 * BATCH)] {
            let spans = Spans::uniform(width, 0..3, 7..7 + samples);
            let batches = batches((&spans).into());
            assert_eq!(batches.iter().map(|b| u64::from(b.items)).sum::<u64>(), spans.len());
            assert!(batches.iter().all(|b| b.items <= BATCH && b.items > 0));
            let mut done = std::collections::BTreeMap::new();
            for uniforms in batches.iter().filter_map(|b| b.expansion) {
                for pixel in uniforms.first_pixel..uniforms.first_pixel + uniforms.items / uniforms.samples {
                    let end = done.entry(pixel).or_insert(7);
                    assert_eq!(*end, uniforms.first_sample, "samples of a pixel come in order");
                    *end += uniforms.samples;
                }
            }
            assert!(done.len() == spans.pixels() as usize && done.values().all(|&end| end == 7 + samples));
        }
        assert!(batches((&Spans::default()).into()).is_empty());
    }

    #[test]
    fn no_batch_has_more_of_a_pixel_than_a_loop_may_have() {
        let items = uniform(3, 0..1, 0..3 * MAX_SAMPLES_PER_PIXEL + 7);
        let batches = batches((&items).into());
        assert_eq!(batches.iter().map(|b| b.items as usize).sum::<usize>(), items.len());
        for b in &batches {
            let part = &items[b.first_item as usize..(b.first_item + b.items) as usize];
            assert!(part.chunk_by(|a, b| a.pixel == b.pixel).all(|run| run.len() <= MAX_SAMPLES_PER_PIXEL as usize));
        }
    }
}

//! Times of passes from timestamp queries.

use super::{Headless, mapped, wait_mapped};
use afterimage::gpu::Timestamps;
use std::ops::Range;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use wgpu::{
    Buffer, BufferUsages, BufferView, CommandEncoder, ComputePassDescriptor, ComputePassTimestampWrites, Features,
    QuerySet,
};

/// Timestamp queries at the begin and the end of each span.
#[derive(Debug)]
pub struct DeviceClock {
    queries: QuerySet,
    resolved: Buffer,
    readback: Buffer,
    period_ms: f64,
}

impl DeviceClock {
    /// A clock with `spans` spans. `None` if the device has no timestamp queries or a query set cannot hold two for
    /// each span.
    pub fn new(gpu: &Headless, spans: u32) -> Option<Self> {
        let count = spans.checked_mul(2).filter(|n| (1..=wgpu::QUERY_SET_MAX_QUERIES).contains(n))?;
        gpu.device.features().contains(Features::TIMESTAMP_QUERY).then(|| Self {
            queries: gpu.device.create_query_set(&wgpu::QuerySetDescriptor {
                label: Some("timestamps"),
                ty: wgpu::QueryType::Timestamp,
                count,
            }),
            resolved: gpu.buffer(u64::from(count) * 8, BufferUsages::QUERY_RESOLVE | BufferUsages::COPY_SRC),
            readback: gpu.buffer(u64::from(count) * 8, BufferUsages::COPY_DST | BufferUsages::MAP_READ),
            period_ms: f64::from(gpu.queue.get_timestamp_period()) * 1e-6,
        })
    }

    /// Queries of a span, for a pass of [`Afterimage`](afterimage::gpu::Afterimage).
    pub fn timestamps(&self, span: u32) -> Timestamps<'_> {
        Timestamps { queries: &self.queries, begin: 2 * span, end: 2 * span + 1 }
    }

    /// Queries of a span, for a compute pass.
    pub fn writes(&self, span: u32) -> ComputePassTimestampWrites<'_> {
        ComputePassTimestampWrites {
            query_set: &self.queries,
            beginning_of_pass_write_index: Some(2 * span),
            end_of_pass_write_index: Some(2 * span + 1),
        }
    }

    /// Writes the query at the begin of a span (`is_end` false) or at its end, after all work recorded before.
    pub fn mark(&self, encoder: &mut CommandEncoder, span: u32, is_end: bool) {
        let writes = self.writes(span);
        let timestamp_writes = Some(if is_end {
            ComputePassTimestampWrites { beginning_of_pass_write_index: None, ..writes }
        } else {
            ComputePassTimestampWrites { end_of_pass_write_index: None, ..writes }
        });
        // A pass without work: only passes write timestamps without a further feature of the device.
        drop(encoder.begin_compute_pass(&ComputePassDescriptor { label: Some("timestamp"), timestamp_writes }));
    }

    /// Resolves the queries of `spans`. Record it after their passes.
    pub fn resolve(&self, encoder: &mut CommandEncoder, spans: Range<u32>) {
        let bytes = u64::from(spans.end - spans.start) * 16;
        encoder.resolve_query_set(&self.queries, 2 * spans.start..2 * spans.end, &self.resolved, 0);
        encoder.copy_buffer_to_buffer(&self.resolved, 0, &self.readback, u64::from(spans.start) * 16, bytes);
    }

    /// Starts the readback of the resolved queries, after their submission. The flag becomes true when
    /// [`take_ms`](Self::take_ms) may be called.
    pub fn start_reading(&self) -> Arc<AtomicBool> {
        let done = Arc::new(AtomicBool::new(false));
        let mapped = done.clone();
        self.readback.map_async(wgpu::MapMode::Read, .., move |result| mapped.store(result.is_ok(), Ordering::Release));
        done
    }

    /// Milliseconds of every span. Values of spans that were not resolved are undefined. Empty on a lost device.
    pub fn take_ms(&self) -> Vec<f64> {
        mapped(&self.readback).map(|ticks| self.span_ms(ticks)).unwrap_or_default()
    }

    /// Waits for submitted work and returns the milliseconds of every span. Empty on a lost device.
    pub fn wait_ms(&self, gpu: &Headless) -> Vec<f64> {
        wait_mapped(&gpu.device, &self.readback).map(|ticks| self.span_ms(ticks)).unwrap_or_default()
    }

    fn span_ms(&self, mapped: BufferView) -> Vec<f64> {
        let ticks: Vec<u64> = mapped.chunks_exact(8).map(bytemuck::pod_read_unaligned).collect();
        drop(mapped);
        self.readback.unmap();
        let spans = ticks.as_chunks::<2>().0;
        spans.iter().map(|[begin, end]| end.saturating_sub(*begin) as f64 * self.period_ms).collect()
    }
}

//! Device timestamps around batches.

use super::compute::empty_buffer;
use crate::device::Headless;
use std::time::Duration;
use wgpu::BufferUsages;

/// Timestamps before and after each batch.
pub(super) struct Clock {
    queries: wgpu::QuerySet,
    resolved: wgpu::Buffer,
}

impl Clock {
    /// For `batches` batches. `None` if the device has no timestamps, or a query set cannot hold that many.
    pub fn new(device: &Headless, batches: u32) -> Option<Self> {
        let count = batches.checked_mul(2).filter(|n| (1..=wgpu::QUERY_SET_MAX_QUERIES).contains(n))?;
        device.device.features().contains(wgpu::Features::TIMESTAMP_QUERY).then(|| Self {
            queries: device.device.create_query_set(&wgpu::QuerySetDescriptor {
                label: Some("batches"),
                ty: wgpu::QueryType::Timestamp,
                count,
            }),
            resolved: empty_buffer(
                &device.device,
                "batches",
                u64::from(count) * 8,
                BufferUsages::QUERY_RESOLVE | BufferUsages::COPY_SRC,
            ),
        })
    }

    /// Timestamp writes around batch `index`.
    pub fn around(&self, index: u32) -> wgpu::ComputePassTimestampWrites<'_> {
        wgpu::ComputePassTimestampWrites {
            query_set: &self.queries,
            beginning_of_pass_write_index: Some(2 * index),
            end_of_pass_write_index: Some(2 * index + 1),
        }
    }

    /// Sum of all batches' times. All batches must have been submitted.
    pub fn read(&self, device: &Headless) -> Duration {
        let mut encoder = device.device.create_command_encoder(&Default::default());
        let count = (self.resolved.size() / 8) as u32;
        encoder.resolve_query_set(&self.queries, 0..count, &self.resolved, 0);
        device.queue.submit([encoder.finish()]);
        let ticks: Vec<u64> = bytemuck::pod_collect_to_vec(&device.read_buffer(&self.resolved));
        let spent: u64 = ticks.as_chunks::<2>().0.iter().map(|[begin, end]| end.saturating_sub(*begin)).sum();
        Duration::from_nanos((spent as f64 * f64::from(device.queue.get_timestamp_period())) as u64)
    }
}

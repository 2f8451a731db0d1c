//! How long a pass takes by the device's clock.

use super::*;
use afterimage::gpu::Timestamps;

impl Rig {
    /// Ticks of the pass alone; `None` where the device has no clock.
    pub fn ticks(&mut self, index: u64, view: &View) -> Option<u64> {
        if !self.device.features().contains(wgpu::Features::TIMESTAMP_QUERY) {
            return None;
        }
        self.upload(std::slice::from_ref(view));
        let (label, ty, count) = (None, wgpu::QueryType::Timestamp, 2);
        let queries = self.device.create_query_set(&wgpu::QuerySetDescriptor { label, ty, count });
        let resolved = self.device.create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size: 16,
            usage: BufferUsages::QUERY_RESOLVE | BufferUsages::COPY_SRC,
            mapped_at_creation: false,
        });
        let readback = self.readback(16);
        let frame = Frame {
            depth: view.depth.is_some().then_some(&self.textures.depth),
            motion: view.motion.is_some().then_some(&self.textures.motion),
            lod: view.lod.is_some().then_some(&self.textures.lod),
            timestamps: Some(Timestamps { queries: &queries, begin: 0, end: 1 }),
            ..Frame::new(&self.textures.color, &self.textures.output, std::slice::from_ref(&view.facts), index)
        };
        let mut encoder = self.device.create_command_encoder(&Default::default());
        self.gpu.record(&self.device, &mut encoder, &frame).unwrap();
        encoder.resolve_query_set(&queries, 0..2, &resolved, 0);
        encoder.copy_buffer_to_buffer(&resolved, 0, &readback, 0, 16);
        let ticks: Vec<u64> = bytemuck::pod_collect_to_vec(&self.bytes(encoder, &readback));
        Some(ticks[1] - ticks[0])
    }
}

//! A device of the tests' adapter, with room for scenes.

use afterimage::wgpu;
use afterimage_lab::device::Headless;
use std::sync::Arc;

/// A fresh device with the adapter's limits on textures and buffers: Sponza exceeds the default ones. `None`, after a
/// message, without an adapter.
pub fn roomy_device() -> Option<Arc<Headless>> {
    let adapter = afterimage_testing::gpu::adapter()?;
    let offered = adapter.limits();
    let required_limits = wgpu::Limits {
        max_texture_dimension_2d: offered.max_texture_dimension_2d,
        max_buffer_size: offered.max_buffer_size,
        max_storage_buffer_binding_size: offered.max_storage_buffer_binding_size,
        ..wgpu::Limits::default()
    };
    Some(Headless::on(adapter, required_limits).expect("a device with these limits"))
}

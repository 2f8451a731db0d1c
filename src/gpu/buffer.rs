//! Buffers with initial contents.

use wgpu::{Buffer, BufferUsages, Device};

/// A buffer that contains `bytes`, whose length must be a multiple of 4; at least 4 bytes large. Not wgpu's
/// `create_buffer_init`, which panics on a lost device (H77).
pub fn filled(device: &Device, label: &str, bytes: &[u8], usage: BufferUsages) -> Buffer {
    filled_if_alive(device, label, bytes, usage).0
}

/// As [`filled`], and whether wgpu knows nothing of a loss of the device. A browser tells only the application.
pub(super) fn filled_if_alive(device: &Device, label: &str, bytes: &[u8], usage: BufferUsages) -> (Buffer, bool) {
    let bytes = if bytes.is_empty() { &[0; 4] } else { bytes };
    let buffer = device.create_buffer(&wgpu::BufferDescriptor {
        label: Some(label),
        size: bytes.len() as u64,
        usage,
        mapped_at_creation: true,
    });
    // On a lost device the buffer is not mapped: wgpu 30 returns an error, wgpu 29 panics.
    #[cfg(feature = "wgpu-29")]
    let mapped = (!is_lost(device)).then(|| buffer.get_mapped_range_mut(..));
    #[cfg(not(feature = "wgpu-29"))]
    let mapped = buffer.get_mapped_range_mut(..).ok();
    let is_alive = mapped.is_some();
    if let Some(mut mapped) = mapped {
        mapped.copy_from_slice(bytes);
        drop(mapped);
        buffer.unmap();
    }
    (buffer, is_alive)
}

/// Whether the device is lost. wgpu reports a loss to the application only, so this creates a buffer and checks for a
/// validation error when it is unmapped. Lost devices do not recover: if this buffer is valid, so are all earlier ones.
#[cfg(feature = "wgpu-29")]
fn is_lost(device: &Device) -> bool {
    use std::future::Future;
    use std::task::{Context, Poll, Waker};
    let scope = device.push_error_scope(wgpu::ErrorFilter::Validation);
    let desc =
        wgpu::BufferDescriptor { label: None, size: 4, usage: BufferUsages::MAP_WRITE, mapped_at_creation: true };
    device.create_buffer(&desc).unmap();
    let error = std::pin::pin!(scope.pop()).poll(&mut Context::from_waker(Waker::noop()));
    matches!(error, Poll::Ready(Some(_)))
}

//! Buffers that are made with what they hold.

use wgpu::{Buffer, BufferUsages, BufferViewMut, Device};

/// A buffer that holds `bytes`, whose length is a multiple of 4; of 4 bytes at least. Not by wgpu's `create_buffer_init`, which panics on
/// a lost device (H77).
pub fn filled(device: &Device, label: &str, bytes: &[u8], usage: BufferUsages) -> Buffer {
    let bytes = if bytes.is_empty() { &[0; 4] } else { bytes };
    let buffer = device.create_buffer(&wgpu::BufferDescriptor {
        label: Some(label),
        size: bytes.len() as u64,
        usage,
        mapped_at_creation: true,
    });
    if buffer.slice(..).get_mapped_range_mut().fill(bytes) {
        buffer.unmap();
    }
    buffer
}

/// What mapping gives: a view with wgpu 29; with wgpu 30 a result, an error on a lost device.
trait Mapped {
    /// Whether there is something to write to.
    fn fill(self, bytes: &[u8]) -> bool;
}

impl Mapped for BufferViewMut {
    fn fill(mut self, bytes: &[u8]) -> bool {
        self.copy_from_slice(bytes);
        true
    }
}

impl<E> Mapped for Result<BufferViewMut, E> {
    fn fill(self, bytes: &[u8]) -> bool {
        self.is_ok_and(|view| view.fill(bytes))
    }
}

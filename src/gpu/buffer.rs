//! Buffers with initial contents.

use wgpu::{Buffer, BufferUsages, BufferViewMut, Device};

/// A buffer that contains `bytes`, whose length must be a multiple of 4; at least 4 bytes large. Not wgpu's
/// `create_buffer_init`, which panics on a lost device (H77).
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

/// Result of mapping a buffer: a view in wgpu 29, a `Result` in wgpu 30, which is an error on a lost device.
trait Mapped {
    /// Writes `bytes`; returns whether the buffer is mapped.
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

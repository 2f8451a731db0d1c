//! Contents of a mapped buffer.

use std::sync::mpsc;
use std::time::Duration;
use wgpu::{Buffer, BufferView, Device};

/// Time in which the callback of a mapping must arrive once all work is complete; exceeded only by a failing device.
const CALLBACK_LIMIT: Duration = Duration::from_secs(60);

/// Contents of a buffer after `map_async` has reported success. `None` if it is not mapped.
pub fn mapped(buffer: &Buffer) -> Option<BufferView> {
    buffer.get_mapped_range(..).ok()
}

/// Maps a buffer with usage `MAP_READ`, waits for all submitted work and for the mapping, and returns the contents.
/// `None` on a lost device.
///
/// The return of `poll` does not guarantee that the buffer is mapped: if several threads poll one device, the callback
/// may still be running on another thread.
pub(crate) fn wait_mapped(device: &Device, buffer: &Buffer) -> Option<BufferView> {
    let (sender, receiver) = mpsc::channel();
    buffer.map_async(wgpu::MapMode::Read, .., move |result| {
        let _ = sender.send(result.is_ok());
    });
    // A lost device is reported by the callback.
    let _ = device.poll(wgpu::PollType::wait_indefinitely());
    receiver.recv_timeout(CALLBACK_LIMIT).is_ok_and(|is_mapped| is_mapped).then(|| mapped(buffer)).flatten()
}

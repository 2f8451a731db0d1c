//! Contents of a mapped buffer, in either wgpu.

use wgpu::{Buffer, BufferView};

/// Contents of a buffer after `map_async` has reported success. `None` if it is not mapped; wgpu 29 panics then.
pub fn mapped(buffer: &Buffer) -> Option<BufferView> {
    let view = buffer.get_mapped_range(..);
    #[cfg(feature = "wgpu-29")]
    let view = Some(view);
    #[cfg(not(feature = "wgpu-29"))]
    let view = view.ok();
    view
}

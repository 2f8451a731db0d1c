//! Buffers and buffer views.

use super::container::{Container, read_file};
use super::errors::{damaged, printable};
use super::uri;
use crate::error::InputError;
use crate::scene::SceneLimits;
use gltf::json::{Index, buffer};

/// All buffers of a file.
pub(super) struct Buffers {
    buffers: Vec<Vec<u8>>,
    /// Bytes of all files and data URIs so far. Images continue the count.
    pub total_bytes: u64,
}

/// Reads all buffers. The binary chunk of a `.glb` is copied.
pub(super) fn load(file: &Container, limits: &SceneLimits) -> Result<Buffers, InputError> {
    let subject = file.subject.as_str();
    let mut total_bytes = file.bytes.len() as u64;
    let mut buffers = Vec::new();
    for (i, buffer) in file.root.buffers.iter().enumerate() {
        let bytes = match (&buffer.uri, &file.binary) {
            (Some(address), _) => {
                let bytes = fetch(file, address, total_bytes, limits)?;
                total_bytes += bytes.len() as u64;
                limits.check_file_bytes(subject, total_bytes)?;
                bytes
            }
            (None, Some(binary)) if i == 0 => file.bytes[binary.clone()].to_vec(),
            // Legal where nothing reads it: extensions describe what they decompress by such buffers.
            (None, _) if file.root.buffer_views.iter().all(|view| view.buffer.value() != i) => {
                buffers.push(Vec::new());
                continue;
            }
            (None, _) => return Err(damaged(subject, format!("buffer {i} has neither an address nor a binary chunk"))),
        };
        let claimed = buffer.byte_length.0;
        if claimed > bytes.len() as u64 {
            let problem = format!("buffer {i} claims {claimed} bytes and has {}", bytes.len());
            return Err(damaged(subject, problem));
        }
        buffers.push(bytes);
    }
    Ok(Buffers { buffers, total_bytes })
}

/// Contents of a URI. `so_far` bytes already count towards the limit of file bytes.
pub(super) fn fetch(file: &Container, address: &str, so_far: u64, limits: &SceneLimits) -> Result<Vec<u8>, InputError> {
    match uri::resolve(&file.subject, &file.folder, address)? {
        uri::Resolved::Data(bytes) => Ok(bytes),
        uri::Resolved::File(path) => {
            let subject = format!("{}: {}", file.subject, printable(address));
            read_file(&path, &subject, limits.max_file_bytes.saturating_sub(so_far), limits)
        }
    }
}

impl Buffers {
    /// Bytes of a buffer view, and its stride if it states one; `None` if it exceeds its buffer.
    pub fn view(&self, views: &[buffer::View], index: Index<buffer::View>) -> Option<(&[u8], Option<usize>)> {
        let view = views.get(index.value())?;
        let start = usize::try_from(view.byte_offset.unwrap_or_default().0).ok()?;
        let length = usize::try_from(view.byte_length.0).ok()?;
        let bytes = self.buffers.get(view.buffer.value())?.get(start..start.checked_add(length)?)?;
        Some((bytes, view.byte_stride.map(|s| s.0)))
    }
}
